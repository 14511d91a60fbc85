#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# A kernel's object defines its table and nothing else that a linker sees: see eval/kernels/dispatch.h.
# usage: objects.sh NM OBJECT...
set -eu
nm=$1
shift
[ $# -gt 0 ]
for object; do
    symbols=$("$nm" -C --defined-only --extern-only "$object" | cut -d ' ' -f 2-)
    if ! printf '%s' "$symbols" | grep -qxE '[DR] limn::[a-z]+::[A-Za-z]+Kernel::[a-z0-9]+' ||
        [ "$(printf '%s\n' "$symbols" | wc -l)" != 1 ]; then
        printf '%s defines more than its table:\n%s\n' "$object" "$symbols"
        exit 1
    fi
done
