#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Installs a build tree into a scratch prefix and builds and runs a consumer and the example against it.
# usage: run.sh BUILD-TREE SOURCE-OF-CONSUMER SOURCE-OF-EXAMPLE SCRATCH
set -eu
rm -rf "$4"
cmake --install "$1" --prefix "$4/prefix" >/dev/null
for source in "$2" "$3"; do
    build="$4/build_$(basename "$source")"
    cmake -S "$source" -B "$build" -G Ninja -DCMAKE_PREFIX_PATH="$4/prefix" >/dev/null
    cmake --build "$build" >/dev/null
done
"$4/build_install/consumer"
"$4/build_evaluator/evaluator"
"$4/prefix/bin/limn" --version
