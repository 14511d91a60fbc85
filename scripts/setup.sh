# SPDX-License-Identifier: Apache-2.0
# Shell functions shared by ./limn and ./check: Debian packages and the build.
# Everything they say goes to stderr; stdout belongs to the program.

say() { printf 'limn set-up: %s\n' "$*" >&2; }

# install_packages KIND: 'build' needs the unmarked lines of packages.txt, 'check' all of them.
install_packages() {
    kind=$1
    list="$root/scripts/packages.txt"
    stamp="$build/.packages-$kind"
    if [ -e "$stamp" ] && [ ! "$list" -nt "$stamp" ]; then return 0; fi
    wanted=$(sed 's/#.*//' "$list" | awk -v kind="$kind" 'NF == 1 || (NF == 2 && kind == "check") {print $1}')
    missing=
    for package in $wanted; do
        dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed ||
            missing="$missing $package"
    done
    if [ -n "$missing" ]; then
        if [ "$(id -u)" -ne 0 ]; then
            say "packages are missing; install them and run this again:"
            say "  sudo apt-get install --no-install-recommends$missing"
            exit 1
        fi
        say "installing$missing"
        log=$(mktemp)
        apt_get() { DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 "$@" </dev/null >>"$log" 2>&1; }
        # shellcheck disable=SC2086
        apt_get update || true
        if ! apt_get install -y --no-install-recommends $missing; then
            tail -n 20 "$log" >&2
            say "apt-get could not install the packages; the full log is $log"
            exit 1
        fi
        rm -f "$log"
    fi
    mkdir -p "$build" && : >"$stamp"
}

# build_target TARGET [CMAKE-ARGUMENT...]: configures once, then builds what changed.
build_target() {
    target=$1
    shift
    log="$build/build.log"
    if [ ! -e "$build/build.ninja" ]; then
        say "configuring (once)"
        if ! cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@" >"$log" 2>&1; then
            tail -n 30 "$log" >&2
            say "cmake failed; the full log is $log"
            exit 1
        fi
    fi
    if ninja -C "$build" -n "$target" 2>/dev/null | grep -q 'no work to do'; then return 0; fi
    say "building (a few minutes the first time)"
    if ! ninja -C "$build" "$target" >"$log" 2>&1; then
        grep -E -A8 'error|FAILED' "$log" | head -n 40 >&2
        say "the build failed; the full log is $log"
        exit 1
    fi
}
