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
3 1 4 2   # a comment is no colour
3 2 4 3
3 3 4 0
END
render() { "$lightnet" render tent.off --plugin "$plugin" --size 32x32 --samples 4 --progress none -o "$@"; }
render serial.exr --threads 1
render hosts.exr --local-workers 2
cmp serial.exr hosts.exr
"$lightnet" scene info tent.off --plugin "$plugin" >info.txt 2>&1
grep -q 'colours of faces are left out' info.txt || { cat info.txt; exit 1; }

sed 's/^3 1 4 2 .*/3 1 4 9/' tent.off >wrong.off
if "$lightnet" scene info wrong.off --plugin "$plugin" >wrong.txt 2>&1; then echo "a wrong mesh is taken"; exit 1; fi
grep -q 'wrong.off:11: there is no vertex 9' wrong.txt || { cat wrong.txt; exit 1; }
# Colours of vertices are seen, and have to be colours.
sed 's/^OFF/COFF/; 4,8s/$/ 1 0 0 1/' tent.off >red.off
"$lightnet" render red.off --plugin "$plugin" --size 32x32 --samples 4 --progress none -o red.exr --threads 1
if "$lightnet" compare serial.exr red.exr --max-relmse 0.01 >/dev/null; then echo "red is not seen"; exit 1; fi
sed '4s/ 1 0 0 1$/ 255 0 0 255/' red.off >bright.off
if "$lightnet" scene info bright.off --plugin "$plugin" >bright.txt 2>&1; then echo "255 is taken"; exit 1; fi
grep -q 'bright.off:4: colours of vertices are of 0 to 1' bright.txt || { cat bright.txt; exit 1; }
if "$lightnet" render tent.off -o none.exr >none.txt 2>&1; then echo "it is read without the plugin"; exit 1; fi
grep -q 'a scene must be' none.txt || { cat none.txt; exit 1; }
