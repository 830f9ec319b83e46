#!/bin/sh
# Renders every scene below a folder small and lays it beside the picture that was given with it.
# usage: scripts/contact_sheet.sh BIN FOLDER SHEET.png [SAMPLES]     (BIN: where the programs are, build/dev/bin)
set -eu
bin=$1 folder=$2 sheet=$3 samples=${4:-16}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
count=0
set --
for scene in $(find -L "$folder" -type f \( -name '*.pbrt' -o -name '*.xml' -o -name '*.gltf' -o -name '*.glb' -o -name '*.obj' \) |
    grep -v -e /models/ -e /geometry/ -e /textures/ | sort); do
    count=$((count + 1))
    place=$(dirname "$scene")
    given=-
    for picture in "${scene%.*}.png" "$place/TungstenRender.png" "$place"/../screenshot/*.png "$place"/../screenshot/*.jpg; do
        [ -f "$picture" ] && given=$picture && break
    done
    out=$work/$count.exr
    # as wide as it is high in the file, but small
    film=$("$bin/lightnet" scene info "$scene" 2>/dev/null | sed -n 's/^film  *\([0-9]*\) x \([0-9]*\),.*/\1 \2/p')
    size=$(echo "${film:-4 3}" | awk '{ printf "320x%d", 320 * $2 / $1 }')
    if "$bin/lightnet" render "$scene" -o "$out" --samples "$samples" --size "$size" --progress none >"$work/log" 2>&1; then
        echo "$scene: beside $given"
    else
        echo "$scene: not rendered: $(head -1 "$work/log")"
        out=-
    fi
    set -- "$@" "$out" "$given"
done
"$bin/lightnet-contact-sheet" "$sheet" "$@"
