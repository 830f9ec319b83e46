#!/usr/bin/env bash
# test.sh LIGHTNET PLUGIN: both integrators make the same picture in every mode, and the plain one's is that of path tracing.
set -euo pipefail
lightnet=$1 plugin=$2 here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp "$here/gather.lua" "$folder/"
cp "$(dirname "$lightnet")/../share/lightnet/graphs/cornell_box.pbrt" "$folder/box.pbrt"
cd "$folder"
sed 's/PlainGather    { first, calls = 16 }/MiserGather { first, calls = 1024 }/' gather.lua >miser.lua
sed 's/{ direct, soft }/{ direct, bounce }/' gather.lua >paths.lua
sed 's/{ direct, bounce }/{ direct }/' gather.lua >once.lua

render() { "$lightnet" run "$1" --plugin "$plugin" --progress none -o "${@:2}"; }
for graph in gather miser; do
    small=(--size 4x4 --samples 1)
    render "$graph.lua" serial.exr "${small[@]}" --threads 1
    render "$graph.lua" threads.exr "${small[@]}" --threads 3
    render "$graph.lua" hosts.exr "${small[@]}" --local-workers 2 --check-answers
    cmp serial.exr threads.exr
    cmp serial.exr hosts.exr
    mv serial.exr "$graph.small.exr"
done
if cmp -s gather.small.exr miser.small.exr; then echo "both are the same integrator"; exit 1; fi

# Pictures agree inside noise: they differ as two do that each have the noise of one of them, which other random numbers
# show. What has one bounce alone does not agree.
size=(--size 32x32)
differ() { "$lightnet" compare "$1" "$2" --json | sed -n 's/.*"blocks": \([0-9.e-]*\).*/\1/p' | head -n 1; }  # of the beauty
twice() {
    render "$1.lua" "$1.exr" "${size[@]}" "${@:2}"
    render "$1.lua" "$1.other.exr" "${size[@]}" --seed 2 "${@:2}"
    differ "$1.exr" "$1.other.exr"
}
paths=$(twice paths --samples 128)
agrees() {
    local own found
    own=$(twice "$1")
    found=$(differ paths.exr "$1.exr")
    echo "$1: differs by $found; noise $own, of paths $paths"
    awk -v found="$found" -v own="$own" -v paths="$paths" 'BEGIN { exit !(found < 1.5 * sqrt((own * own + paths * paths) / 2)) }'
}
agrees gather
if agrees once; then echo "one bounce passes for all"; exit 1; fi
