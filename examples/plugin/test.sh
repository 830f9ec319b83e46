#!/usr/bin/env bash
# test.sh LIGHTNET PLUGIN: the operator does what it says, and the same in every mode.
set -euo pipefail
lightnet=$1 plugin=$2 here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp "$here/fog.lua" "$folder/"
cp "$(dirname "$lightnet")/../share/lightnet/graphs/cornell_box.pbrt" "$folder/box.pbrt"
cd "$folder"

render() { "$lightnet" run fog.lua --plugin "$plugin" --size 32x32 --samples 2 --progress none -o "$@"; }
render serial.exr --threads 1
render threads.exr --threads 3
render hosts.exr --local-workers 2
cmp serial.exr threads.exr
cmp serial.exr hosts.exr

# Fog takes light away, and all of it where nothing is clear.
sed 's/half = 800/half = 0.001/' fog.lua >dark.lua
"$lightnet" run dark.lua --plugin "$plugin" --size 32x32 --samples 2 --progress none -o dark.exr
if "$lightnet" compare serial.exr dark.exr --max-relmse 0.01 >/dev/null; then echo "the fog changes nothing"; exit 1; fi
