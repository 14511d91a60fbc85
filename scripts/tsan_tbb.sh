#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# tsan_tbb.sh SOURCE: builds libtbb from oneTBB's source folder for the preset 'tsan', into build/tsan/tbb.
#
# The thread sanitizer sees only synchronisation in code that it has compiled. With Debian's libtbb it misses
# every hand-over from thread to thread, and reports thousands of races that there are none of; suppressing
# what touches libtbb would suppress all, since every band is baked in its threads. With libtbb of the same
# version built like limn the tests are quiet, and a race of limn's would show. The test preset looks for it
# first. The source: apt-get source onetbb.
set -eu
[ $# -eq 1 ] || { echo "usage: scripts/tsan_tbb.sh SOURCE-OF-ONETBB" >&2; exit 2; }
root=$(CDPATH='' cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
to="$root/build/tsan/tbb"
cmake -S "$1" -B "$to/build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS=-fsanitize=thread \
    -DCMAKE_INSTALL_PREFIX="$to" -DCMAKE_INSTALL_LIBDIR=lib -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF \
    -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON
cmake --build "$to/build"
cmake --install "$to/build"
