#!/bin/sh
# Installs a build tree into a scratch prefix and builds and runs a consumer against it.
# usage: run.sh BUILD-TREE SOURCE-OF-CONSUMER SCRATCH
set -eu
rm -rf "$3"
cmake --install "$1" --prefix "$3/prefix" >/dev/null
cmake -S "$2" -B "$3/build" -G Ninja -DCMAKE_PREFIX_PATH="$3/prefix" >/dev/null
cmake --build "$3/build" >/dev/null
"$3/build/consumer"
"$3/prefix/bin/limn" --version
