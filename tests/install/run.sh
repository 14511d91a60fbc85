#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Installs a build tree into a scratch prefix, builds the programs of this folder and of the examples
# against it, and holds what they print to docs/library.md and to laws.
# usage: run.sh BUILD-TREE SOURCE-TREE SCRATCH GROUPED
# GROUPED: 1 to compile sources in groups, as the build tree does
# shellcheck disable=SC2016  # fields of awk's and addresses of sed's are not for the shell
set -eu
build=$1 source=$2 scratch=$3 grouped=$4

rm -rf "$scratch"
cmake --install "$build" --prefix "$scratch/prefix" >/dev/null
PATH="$scratch/prefix/bin:$PATH"
for programs in tests/install examples/evaluator examples/library; do
    tree="$scratch/$programs"
    cmake -S "$source/$programs" -B "$tree" -G Ninja -DCMAKE_PREFIX_PATH="$scratch/prefix" \
        -DCMAKE_CXX_FLAGS='-Wall -Werror' -DCMAKE_UNITY_BUILD="$grouped" >/dev/null
    cmake --build "$tree" -- --quiet
    PATH="$tree:$PATH"
done
cd "$scratch"
ln -s "$source/scenes" scenes
spot=scenes/spot/spot.obj

# holds LAW CONDITION: every line of stdin, of which there is one at least, fulfils awk's condition.
holds() {
    awk "!($2) { isBroken = 1 } END { exit isBroken || NR == 0 }" && return
    echo "broken: $1" >&2
    return 1
}

# The page's commands, one after the other, print what stands below them there.
sed -n '/^```text$/,/^```$/p' "$source/docs/library.md" | grep -v '^```' >page.txt
while IFS= read -r line; do
    case $line in '$ '*)
        echo "$line"
        eval "${line#??}" </dev/null
        ;;
    esac
done <page.txt >printed.txt
diff page.txt printed.txt

for file in share/man/man1/limn.1 share/bash-completion/completions/limn \
    share/fish/vendor_completions.d/limn.fish share/zsh/site-functions/_limn \
    share/doc/limn/LICENSE share/doc/limn/docs/command-line.md \
    share/doc/limn/examples/library/CMakeLists.txt; do
    test -s "prefix/$file"
done
limn completion bash | cmp - prefix/share/bash-completion/completions/limn

consumer
evaluator
{ version && limn --version; } | awk '{ print $1 }' | uniq | wc -l |
    holds 'header and program are of one version' '$1 == 1'

bake_to_memory "$spot" | same_texels out/spot.normal.1001.exr
test -s out/spot.normal.1001.png
bake_to_memory "$spot" | grep 'texels' >memory.txt
bake_to_files "$spot" out/again.exr | grep 'texels' | diff memory.txt -

evaluate_places | sed -n 's/,//g; s/^mean //p' |
    holds 'a sphere of radius 2 has curvatures 1/2 and 1/4' \
        '$2 > 0.499 && $4 < 0.501 && $7 > 0.249 && $9 < 0.251'

fit_mesh "$spot" out/fit.obj | grep -o '[0-9.]*e-[0-9]*' |
    holds 'the limit passes within the tolerance of the vertices' '$1 <= 1e-9'
limn fit "$spot" -o out/by_limn.obj --tolerance 1e-9 --precision double --quiet
cmp out/fit.obj out/by_limn.obj

bake_to_sink "$spot" >sink.txt
bake_to_files "$spot" 'out/{map}.<UDIM>.exr' | sed '/texels/d; s,out/,,; s/exr/raw/' | diff sink.txt -
wc -c <normal.1001.raw | holds 'a sink is given every texel' '$1 == 3 * 4 * 256 * 256'

host_job "$spot" 600 | sed -n 's/^baking spot: //p' >progress.txt
sed -n '1p' progress.txt | holds 'progress begins with nothing' '$1 == 0'
sed -n '$p' progress.txt | holds 'progress ends with all' '$1 == $3'
host_job "$spot" 0 | tail -n 1 | holds 'a job stops when its host asks' '$0 == "stopped"'
awk '$1 == "vt" { $2 -= 10 } { print }' "$spot" >elsewhere.obj
host_job elsewhere.obj 600 | grep -c 'leave the UDIM range' | holds 'a host hears warnings' '$1 == 1'

run_command measure x --scheme bilinear | awk -F '[:,]' '/"area"/ { print $2 / 8 / sqrt(3) }
    /"volume"/ { print $2 / 8 * 3 }' | holds 'the tetrahedron has its area and volume' '$1 == 1'
