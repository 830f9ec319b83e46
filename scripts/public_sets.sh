#!/bin/sh
# Reads every scene below folders of scenes, and prints a table: of each folder how many files it has, how many load,
# how many of these without any approximation, and how far pictures are from those that lie beside the scenes.
# usage: scripts/public_sets.sh BIN FOLDER... (BIN: where the programs are, build/release/bin)
#   SAMPLES=64     per pixel, of pictures that are compared; 0: none is rendered
#   PIXELS=300000  larger pictures are not compared
#   MESSAGES=20    how many messages are listed below the table, the most frequent first; without names and numbers
# A scene's reference is NAME.exr, want.exr, NAME_ref_rgb.exr, refs/NAME_ref_rgb.exr (as Mitsuba's tests have it, there
# without _volpath and its like) or TungstenRender.exr, in its folder. Files that are named for parts are no scenes:
# those in folders models, meshes, geometry, include, textures, and pbrt files without WorldBegin.
set -eu
if [ $# -lt 2 ]; then
    sed -n 's/^# //p' "$0" >&2
    exit 2
fi
bin=$1
shift
samples=${SAMPLES:-64} pixels=${PIXELS:-300000} messages=${MESSAGES:-20}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
: >"$work/messages"

scenes_in() {
    find -L "$1" -type f \( -name '*.pbrt' -o -name '*.xml' -o -name '*.gltf' -o -name '*.glb' -o -name '*.obj' \) |
        grep -v -e '/models/' -e '/meshes/' -e '/geometry/' -e '/include/' -e '/textures/' | sort |
        while read -r scene; do
            case $scene in
            *.pbrt) grep -q WorldBegin "$scene" || continue ;;
            *.xml) grep -q '<scene' "$scene" || continue ;;
            esac
            echo "$scene"
        done
}

reference_of() {
    place=$(dirname "$1") name=$(basename "${1%.*}")
    short=${name%_volpath}
    for picture in "$place/$name.exr" "$place/want.exr" "$place/${name}_ref_rgb.exr" "$place/refs/${short}_ref_rgb.exr" \
        "$place/TungstenRender.exr"; do
        if [ -f "$picture" ]; then
            echo "$picture"
            return
        fi
    done
}

# the mean relative difference of blocks of 16 x 16 pixels; nothing where it can't be had
blocks_of() {
    reference=$(reference_of "$1")
    [ -n "$reference" ] && [ "$samples" -gt 0 ] || return 0
    film=$(sed -n 's/^film  *\([0-9]*\) x \([0-9]*\),.*/\1 \2/p' "$work/info")
    [ "$(echo "$film" | awk '{ print $1 * $2 }')" -le "$pixels" ] || return 0
    "$bin/lightnet" render "$1" -o "$work/own.exr" --samples "$samples" --progress none >"$work/log" 2>&1 || return 0
    "$bin/lightnet" compare "$reference" "$work/own.exr" --json 2>"$work/log" |
        sed -n 's/.*"blocks": \([0-9.e+-]*\).*/\1/p' | head -1
}

echo '| set | files | loaded | without approximations | compared | blocks below 0.05 | median of blocks | worst |'
echo '|---|---|---|---|---|---|---|---|'
for folder in "$@"; do
    files=0 loaded=0 exact=0
    : >"$work/blocks"
    scenes_in "$folder" >"$work/scenes"
    while read -r scene; do
        files=$((files + 1))
        if ! "$bin/lightnet" scene info "$scene" >"$work/info" 2>"$work/errors" </dev/null; then
            sed 's/^/refused: /' "$work/errors" | head -1 >>"$work/messages"
            continue
        fi
        loaded=$((loaded + 1))
        grep -q '^approximations none' "$work/info" && exact=$((exact + 1))
        sed -n 's/^approximation  *//p' "$work/info" >>"$work/messages"
        blocks_of "$scene" </dev/null >"$work/one"
        [ ! -s "$work/one" ] || awk -v scene="$scene" '{ print $1, scene }' "$work/one" >>"$work/blocks"
    done <"$work/scenes"
    sort -g "$work/blocks" | awk -v set="$(basename "$folder")" -v files="$files" -v loaded="$loaded" -v exact="$exact" '
        { of[NR] = $1; if ($1 < 0.05) near++ }
        END {
            printf "| %s | %d | %d | %d | %d ", set, files, loaded, exact, NR
            if (NR) printf "| %d | %.4f | %.4f |\n", near, of[int((NR + 1) / 2)], of[NR]
            else print "| - | - | - |"
        }'
done

if [ "$messages" -gt 0 ] && [ -s "$work/messages" ]; then
    echo
    echo '| files | what was said |'
    echo '|---|---|'
    # a place in front, names in quotes and numbers tell one scene from another, not one message
    sed -e 's/^refused: [^ ]*: /refused: /' -e 's/^[^ ]*: //' -e "s/'[^']*'/'…'/g" -e 's/\/[^ :,]*/…/g' -e 's/[0-9][0-9.]*/N/g' -e 's/|/\\|/g' \
        "$work/messages" | sort | uniq -c | sort -rn | head -n "$messages" |
        awk '{ n = $1; $1 = ""; print "| " n " |" $0 " |" }'
fi
