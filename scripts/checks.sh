# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=sh
# The parts of ./check, a function each, run in the checkout's root. Their arguments are ctest's.

# in_folder NAME KIND [COMMAND...]: runs one of setup.sh's functions on build/NAME, with the packages
# of that kind. Runs that start at once take turns.
in_folder() {
    build="build/$1"
    kind=$2
    shift 2
    mkdir -p "$build"
    (
        flock 9
        install_packages "$kind"
        "$@"
    ) 9>"$build/.lock"
}

run_tests() {
    folder="build/$1"
    shift
    ctest --test-dir "$folder" --output-on-failure -j "$(nproc)" "$@"
}

# Sources are grouped as for ./limn: this is what ships. That each compiles alone, clang shows.
check_tests() {
    in_folder check check build_target all -DLIMN_DEVELOPER=ON -DCMAKE_UNITY_BUILD=ON
    run_tests check "$@"
}

check_clang() {
    in_folder clang tools build_target all -DLIMN_DEVELOPER=ON -DCMAKE_CXX_COMPILER=clang++-19
    run_tests clang "$@"
}

# Assertions are on here; debug information goes as far as a stack needs.
check_sanitizers() {
    in_folder asan tools build_target all -DLIMN_DEVELOPER=ON -DLIMN_SANITIZE=address,undefined \
        -DCMAKE_UNITY_BUILD=ON -DCMAKE_CXX_FLAGS_RELEASE='-O1 -g1'
    (
        export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
        run_tests asan "$@"
    )
}

# longest_input NAME: the most bytes that a fuzzer makes up. What is longer says nothing more, but
# takes longer.
longest_input() {
    case $1 in
        images) echo 2048 ;;
        verbs | commands) echo 512 ;;
        *) echo 1024 ;;
    esac
}

# fuzz NAME SECONDS: runs a fuzzer on what it has kept from earlier runs, the seeds, and all that ever
# failed. What it finds it writes to build/fuzz.
#
# A third of the time went into what a find is told with, the stack of each allocation, and into
# stacks that outlive their functions, for which check_sanitizers looks. Who replays a find has both.
fuzz() {
    name=$1 seconds=$2
    lean=malloc_context_size=0:quarantine_size_mb=8:detect_stack_use_after_return=0
    log="build/fuzz/$name.log"
    set -- "build/fuzz/kept/$name" "tests/fuzz/seeds/$name"
    mkdir -p "$1"
    if [ -d "tests/fuzz/failed/$name" ]; then set -- "$@" "tests/fuzz/failed/$name"; fi
    if [ -d "tests/fuzz/dictionaries/$name" ]; then
        cat tests/fuzz/dictionaries/"$name"/*.dict >"build/fuzz/$name.dict"
        set -- "-dict=build/fuzz/$name.dict" "$@"
    fi
    say "fuzzing $name for $seconds seconds"
    if ! ASAN_OPTIONS=$lean TMPDIR=/dev/shm "build/fuzz/tests/fuzz/${name}_fuzzer" \
        -max_total_time="$seconds" -max_len="$(longest_input "$name")" -reload=0 -timeout=20 \
        -rss_limit_mb=3072 -close_fd_mask=3 -print_final_stats=1 \
        -artifact_prefix="build/fuzz/$name." "$@" >"$log" 2>&1; then
        found=$(sed -n 's/.*Test unit written to //p' "$log" | tail -n 1)
        die "the fuzzer of $name has found ${found:-something}; once it is mended, keep it in tests/fuzz/failed/$name" "$log" 40
    fi
    say "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs, nothing found"
}

# shellcheck disable=SC2154 # ./check has read $fuzz_seconds
check_fuzz() {
    in_folder fuzz tools build_target fuzzers -DLIMN_FUZZ=ON -DCMAKE_UNITY_BUILD=ON \
        -DCMAKE_CXX_COMPILER=clang++-19 -DCMAKE_CXX_FLAGS_RELEASE='-O1 -g1'
    fuzzers='readers tables images deflate verbs commands'
    share=$((fuzz_seconds / 6))
    for fuzzer in $fuzzers; do fuzz "$fuzzer" "$share"; done
}

# list_sources PATTERN...: of the files in the folders of code, those whose names fit.
list_sources() {
    for pattern in "$@"; do find far_ext eval engine tests bench examples -name "$pattern"; done
}

check_format() {
    in_folder clang tools :
    say "format of sources and scripts"
    list_sources '*.h' '*.cpp' | xargs clang-format-19 --dry-run --Werror
    shellcheck -x limn check .ci/run scripts/*.sh tests/install/run.sh
}

# source_of FILE: the file itself, if it is a source; for a header, its source, or one that includes it,
# be it by way of other headers.
source_of() {
    file=$1
    while [ "${file##*.}" = h ]; do
        if [ -e "${file%.h}.cpp" ]; then
            file=${file%.h}.cpp
        else
            name=${file#tests/} name=${name#bench/}
            file=$(list_sources '*.cpp' '*.h' |
                xargs grep -lF -e "\"$name\"" -e "<limn/$name>" | head -n 1)
        fi
    done
    if [ -z "$file" ]; then say "nothing includes $1"; fi
    echo "$file"
}

# list_changed COMMIT: the sources that changed since, and those that stand in for headers.
list_changed() {
    git diff --name-only --diff-filter=d "$1" -- '*.h' '*.cpp' |
        while read -r changed; do source_of "$changed"; done | sort -u
}

# configure_again [CMAKE-ARGUMENT...]: lists of sources and compile commands are those of now.
configure_again() {
    configure "$@"
    ninja -C "$build" build.ninja >"$build/build.log" 2>&1 || die "cmake failed" "$build/build.log" 30
}

# tidy SECONDS SOURCE...: clang-tidy, for no longer than that; 0 is for as long as it takes. It reads
# how sources are compiled from the folder of the clang build, where nothing needs to be built for that.
tidy() {
    seconds=$1
    shift
    say "clang-tidy on $# sources"
    if [ $# -eq 0 ]; then return 0; fi
    in_folder clang tools configure_again -DLIMN_DEVELOPER=ON -DCMAKE_CXX_COMPILER=clang++-19
    log=build/clang/tidy.log
    status=0
    # Without a buffer, which would be lost with what was found when the time is over.
    PYTHONUNBUFFERED=1 timeout "$seconds" \
        run-clang-tidy-19 -quiet -j "$(nproc)" -p build/clang "$@" >"$log" 2>&1 || status=$?
    seen=$(grep -c '^\[ *[0-9]*/' "$log" || true)
    if [ $status -eq 124 ]; then
        say "stopped after $seconds seconds, with $(($# - seen)) of $# sources not looked at"
    fi
    if grep -E -A3 ' (warning|error): ' "$log" >&2; then die "clang-tidy found something" "$log" 0; fi
    case $status in
    0) if [ "$seen" -lt $# ]; then die "CMake compiles only $seen of $# sources" "$log" 0; fi ;;
    124) ;;
    *) die "clang-tidy failed" "$log" ;;
    esac
}

# Names of sources hold no spaces.
# shellcheck disable=SC2046
check_tidy() { tidy 0 $(list_sources '*.cpp'); }

# shellcheck disable=SC2046,SC2154 # ./check has read $tidy_since
check_tidy_since() {
    git rev-parse --verify "$tidy_since^{commit}" >/dev/null ||
        die "--tidy-since needs a commit, not '$tidy_since'"
    tidy 600 $(list_changed "$tidy_since")
}
