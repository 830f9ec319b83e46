#!/usr/bin/env bash
# test.sh LIGHTNET PLUGIN: the operator makes the same picture in every mode, and its parameters do something.
set -euo pipefail
lightnet=$1 plugin=$2 here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp "$here/marble.lua" "$folder/"
cp "$(dirname "$lightnet")/../share/lightnet/graphs/cornell_box.pbrt" "$folder/box.pbrt"
cd "$folder"

render() { "$lightnet" run "$1" --plugin "$plugin" --size 32x32 --samples 2 --progress none -o "${@:2}"; }
render marble.lua serial.exr --threads 1
render marble.lua threads.exr --threads 3
render marble.lua hosts.exr --local-workers 2 --check-answers
cmp serial.exr threads.exr
cmp serial.exr hosts.exr

sed 's/size = 300/size = 300, pattern = 2/' marble.lua >other.lua
render other.lua other.exr
if cmp -s serial.exr other.exr; then echo "another pattern changes nothing"; exit 1; fi
