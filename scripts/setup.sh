# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=sh disable=SC2154 # who reads this file sets $root and $build
# Shell functions shared by ./limn and ./check: Debian packages and the build. They read $root, the
# checkout, and $build, the build folder. What they say goes to stderr; stdout belongs to the program.

say() { printf 'limn set-up: %s\n' "$*" >&2; }

# die MESSAGE [LOG [LINES]]: ends with the log's last lines, the message, and where the log is.
die() {
    if [ $# -gt 1 ]; then
        tail -n "${3:-20}" "$2" >&2
        say "$1; the full log is $2"
    else
        say "$1"
    fi
    exit 1
}

# wanted_packages KIND: of packages.txt, 'build' needs the unmarked lines, 'check' those marked
# 'check', too, 'tools' all.
wanted_packages() {
    case $1 in
    build) marks= ;;
    check) marks=check ;;
    tools) marks='check tools' ;;
    esac
    sed 's/#.*//' "$root/scripts/packages.txt" |
        awk -v marks=" $marks " 'NF == 1 || (NF == 2 && index(marks, " " $2 " ")) {print $1}'
}

missing_packages() {
    for package in $(wanted_packages "$1"); do
        dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed ||
            printf ' %s' "$package"
    done
}

# A machine that has just booted runs updates of its own: wait for their locks.
apt_get() {
    LC_ALL=C DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300 \
        -o Acquire::Retries=3 -o Dpkg::Use-Pty=0 "$@" </dev/null >>"$apt_log" 2>&1
}

# The time-out above does not hold for the lock of the package lists. Where an update fails for
# other reasons the lists that are there may do.
update_package_lists() {
    tries=30
    until apt_get update; do
        tries=$((tries - 1))
        if [ $tries -eq 0 ] || ! tail -n 3 "$apt_log" | grep -q 'lock'; then return 0; fi
        sleep 10
    done
}

# install_packages KIND: installs what is missing of a kind's packages.
install_packages() {
    list="$root/scripts/packages.txt"
    stamp="$build/.packages-$1"
    if [ -e "$stamp" ] && [ -z "$(find "$list" -newer "$stamp")" ]; then return 0; fi
    missing=$(missing_packages "$1")
    if [ -n "$missing" ]; then
        if [ "$(id -u)" -ne 0 ]; then
            say "packages are missing; install them and run this again:"
            die "  sudo apt-get install --no-install-recommends$missing"
        fi
        say "installing$missing"
        apt_log=$(mktemp)
        update_package_lists
        # shellcheck disable=SC2086 # a list of names
        apt_get install -y --no-install-recommends $missing ||
            die "apt-get could not install the packages" "$apt_log"
        rm -f "$apt_log"
    fi
    mkdir -p "$build" && : >"$stamp"
}

# configure [CMAKE-ARGUMENT...]: once per build folder; from then on CMake sees to it by itself.
configure() {
    if [ -e "$build/build.ninja" ]; then return 0; fi
    say "configuring (once)"
    cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@" >"$build/build.log" 2>&1 ||
        die "cmake failed" "$build/build.log" 30
}

# build_target TARGET [CMAKE-ARGUMENT...]: configures once, then builds what changed.
build_target() {
    target=$1
    shift
    configure "$@"
    if ninja -C "$build" -n "$target" 2>/dev/null | grep -q 'no work to do'; then return 0; fi
    say "building (a few minutes the first time)"
    if ! ninja -C "$build" "$target" >"$build/build.log" 2>&1; then
        grep -E -A8 'error|FAILED' "$build/build.log" | head -n 40 >&2
        die "the build failed" "$build/build.log" 0
    fi
}
