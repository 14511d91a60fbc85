#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of the pages again, by the commands that stand in them:
#
#   scripts/pictures.sh PROGRAM [--check] [PAGE...]
#
# PROGRAM is limn; the pages are README.md and docs/*.md unless named. A picture docs/images/X.png is
# what the page's commands leave in out/X.png. With --check nothing is written; status 1 tells that
# some picture is not, to the byte, what the commands make.
set -eu
cd "$(dirname "$0")/.."
root=$PWD

program=$(realpath "$1")
shift
check=
if [ "${1:-}" = --check ]; then
    check=yes
    shift
fi
[ $# -gt 0 ] || set -- README.md docs/*.md

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
ln -s "$root/scenes" "$root/tests" "$scratch"
mkdir "$scratch/bin"
ln -s "$program" "$scratch/bin/limn"
# The program looks for its image module beside itself, not beside the link.
ln -s "$(dirname "$program")"/limn_images.so "$scratch/bin" 2>/dev/null || true

# list_commands PAGE: those that write to out/, a line each.
list_commands() {
    sed -n 's/^    //p' "$1" | sed -e ':join' -e '/\\$/{N;s/\\\n */ /;bjoin' -e '}' |
        sed -n -e 's/^\.\/limn /limn /' -e '/^\(limn\|awk\) .*out\//p'
}

# list_pictures PAGE: X of each picture images/X.png.
list_pictures() {
    grep -o '](\(docs/\)\?images/[^)]*\.png)' "$1" | sed 's/.*images\/\(.*\)\.png)/\1/' | sort -u
}

status=0
for page in "$@"; do
    pictures=$(list_pictures "$page")
    [ -n "$pictures" ] || continue
    echo "$page" >&2
    rm -rf "$scratch/out"
    mkdir "$scratch/out"
    list_commands "$page" >"$scratch/commands"
    (cd "$scratch" && PATH="$scratch/bin:$PATH" sh -eu commands >/dev/null)
    for picture in $pictures; do
        made=$scratch/out/$picture.png kept=docs/images/$picture.png
        if [ -z "$check" ]; then
            mkdir -p "$(dirname "$kept")"
            cp "$made" "$kept"
        elif ! cmp -s "$made" "$kept"; then
            echo "$page: $kept is not what its command makes" >&2
            status=1
        fi
    done
done
exit $status
