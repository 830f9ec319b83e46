#!/bin/sh
# Renders scenes of media with as many scatterings as they say for Mitsuba, and prints how far each picture is from its own.
# usage: scripts/media_scenes.sh BIN FOLDER (BIN: where the programs are, build/release/bin; FOLDER: Mitsuba's
# tests/scenes/participating_media, whose references are in refs/)
#   SAMPLES=128  per pixel
set -eu
if [ $# -ne 2 ]; then
    sed -n 's/^# //p' "$0" >&2
    exit 2
fi
bin=$1 folder=$(cd "$2" && pwd) samples=${SAMPLES:-128}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# a count of segments, of which the first and the last have no scattering between two others
depth_of() {
    include=$(sed -n 's/.*<include filename="\([^"]*\)".*/\1/p' "$1" | head -1)
    cat "$1" ${include:+"$folder/$include"} | sed -n 's/.*"max_depth" value="\([0-9]*\)".*/\1/p' | head -1
}

echo '| scene | means, as parts of the reference | blocks |'
echo '|---|---|---|'
for scene in "$folder"/*_volpath.xml; do
    name=$(basename "$scene" _volpath.xml)
    reference="$folder/refs/${name}_ref_rgb.exr"
    [ -f "$reference" ] || continue
    size=$("$bin/lightnet" scene info "$scene" | sed -n 's/^film  *\([0-9]*\) x \([0-9]*\),.*/\1, \2/p')
    cat >"$work/media.lua" <<END
scene  = Scene { "$scene" }
direct = DirectLighting {}
bounce = PathTracing { max_depth = $(($(depth_of "$scene") - 2)) }
light  = Combine { direct, bounce }
image  = RayTracer { light, scene = scene, samples = $samples, film = { $size } }
END
    "$bin/lightnet" run "$work/media.lua" -o "$work/own.exr" --progress none >"$work/log" 2>&1 ||
        { echo "| $name | $(tail -1 "$work/log") | |"; continue; }
    { "$bin/lightnet" compare "$reference" "$work/own.exr" || true; } 2>&1 | awk -v name="$name" '
        $1 == "beauty" {
            for (i = 1; i < NF; ++i) {
                if ($i == "blocks") blocks = $(i + 1)
                if ($i == "ratio") means = $(i + 1) " " $(i + 2) " " $(i + 3)
            }
            print "| " name " | " means " | " blocks " |"
            exit
        }'
done
