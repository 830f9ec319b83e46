#!/usr/bin/env bash
# test.sh LIGHTNET PLUGIN: a mesh is read, here and by other hosts; mistakes are told with their line.
set -euo pipefail
lightnet=$1 plugin=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cat >tent.off <<'END'
OFF
# four corners and a top
5 5 8
-1 0 -1
1 0 -1
1 0 1
-1 0 1
0 1.5 0
4 0 1 2 3
3 0 4 1   255 0 0
3 1 4 2
3 2 4 3
3 3 4 0
END
render() { "$lightnet" render tent.off --plugin "$plugin" --size 32x32 --samples 4 --progress none -o "$@"; }
render serial.exr --threads 1
render hosts.exr --local-workers 2
cmp serial.exr hosts.exr
"$lightnet" scene info tent.off --plugin "$plugin" >info.txt 2>&1
grep -q 'colours of faces are left out' info.txt || { cat info.txt; exit 1; }

sed 's/^3 1 4 2$/3 1 4 9/' tent.off >wrong.off
if "$lightnet" scene info wrong.off --plugin "$plugin" >wrong.txt 2>&1; then echo "a wrong mesh is taken"; exit 1; fi
grep -q 'wrong.off:11: there is no vertex 9' wrong.txt || { cat wrong.txt; exit 1; }
if "$lightnet" render tent.off -o none.exr >none.txt 2>&1; then echo "it is read without the plugin"; exit 1; fi
grep -q 'a scene must be' none.txt || { cat none.txt; exit 1; }
