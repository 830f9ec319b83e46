#!/usr/bin/env bash
# gallery.sh SCENES: makes docs/gallery.md and its pictures. SCENES: a folder with the scenes that the page credits, each
# in a folder of its own. Takes some ten minutes on two cores. LIGHTNET names the program.
set -euo pipefail
cd "$(dirname "$0")/.."
scenes=${1:?usage: scripts/gallery.sh SCENES}
lightnet=${LIGHTNET:-build/release/bin/lightnet}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
page=$work/gallery.md
mkdir "$work/gallery"

processor=$(sed -n 's/^model name[[:space:]]*: //p' /proc/cpuinfo | head -n 1)
cat >"$page" <<END
# Gallery

Pictures of this project's scenes and of others, each with the command that made it. Seconds are those of preparing and
rendering, on $(nproc) cores of $processor; reading the scene is left out. Layers are named with their part of the light
in the picture. \`scripts/gallery.sh\` makes this page.

END

# What the record of a run tells: seconds, and its layers where there are several.
facts() {
    python3 -c 'import json, sys
run = json.load(open(sys.argv[1]))
seconds = sum(phase["seconds"] for phase in run["phases"] if phase["name"] in ("prepare", "render"))
layers = ["%s %.0f %%" % (layer["name"], 100 * layer["share"]) for layer in run["layers"] if layer["share"] >= 0.005]
print("%.0f s." % seconds, "Layers: %s." % ", ".join(layers) if len(layers) > 1 else "")' "$1" | sed 's/ *$//'
}

# picture NAME TITLE CREDIT VERB FILE OPTIONS...
picture() {
    local name=$1 title=$2 credit=$3 verb=$4 file=$5
    shift 5
    if [ ! -e "$file" ]; then
        echo "left out: $title, as $file is not there" >&2
        return
    fi
    "$lightnet" "$verb" "$file" "$@" -o "$work/$name.exr" --forget --progress none
    cp "$work/$name.png" "$work/gallery/$name.png"
    local words="lightnet $verb $file $*"
    printf '## %s\n\n![%s](gallery/%s.png)\n\n    %s\n\n%s %s\n\n' "$title" "$title" "$name" "${words//"$scenes/"/}" \
        "$(facts "$work/$name.run.json")" "$credit" >>"$page"
    echo "$name"
}

own="The scene is this project's own."
picture cornell "The Cornell box" "Data: Cornell University's Program of Computer Graphics." \
    run graphs/cornell.lua --size 360x360 --samples 256
picture studio "A studio with groups of lamps" "$own" run graphs/studio.lua --size 480x360 --samples 128
picture plates "Multiple importance sampling" "$own After Veach and Guibas (1995)." \
    run graphs/labs/mis.lua --size 480x360 --samples 256
picture ball "Glass and a mirror, by progressive photon mapping" "$own" \
    run graphs/progressive.lua --size 360x360 --samples 256
picture beam "Light through a ball of glass in fog, by photon beams" "$own" run graphs/beam.lua --size 360x360 --samples 64
picture living_room "The grey and white room, by the network of the paper's figure 5" \
    "Scene: Wig42, CC BY 3.0, by way of Benedikt Bitterli." \
    render "$scenes/living-room-pbrt/living-room.pbrt" --lighting graphs/paper/figure5.lua --size 480x270 --samples 256
picture staircase "Modern hall, by path tracing" "Scene: NewSee2l035, CC BY 3.0, by way of Benedikt Bitterli." \
    render "$scenes/staircase2-mitsuba/scene.xml" --size 360x480 --samples 256
picture ajar "A door ajar, by guided path tracing" "Scene: Benedikt Bitterli, CC0, after Eric Veach." \
    render "$scenes/veach-ajar-pbrt/veach-ajar.pbrt" --lighting graphs/guided.lua --size 480x270 --samples 128
picture mis "Plates and lamps, by path tracing" "Scene: Benedikt Bitterli, CC0, after Eric Veach." \
    render "$scenes/veach-mis-mitsuba/scene.xml" --size 480x270 --samples 64
picture water "A caustic under water, by progressive photon mapping" "Scene: Benedikt Bitterli, CC0." \
    render "$scenes/water-caustic-mitsuba/scene.xml" --lighting graphs/progressive.lua --size 480x270 --samples 128
picture car "A car, by path tracing" "Scene: tyrant monkey, CC0." \
    render "$scenes/bmw-m6-pbrt/bmw-m6.pbrt" --size 480x270 --samples 128
picture vase "A vase of flowers, from glTF" "Scene: Eric Chadwick and Rico Cilliers, CC0; environment: Poly Haven, CC0." \
    render "$scenes/gltf-GlassVaseFlowers/glTF/GlassVaseFlowers.gltf" --env "$scenes/hdri/studio_small_03_1k.hdr" \
    --size 360x360 --samples 256
picture openness "The same car by ambient occlusion" "Scene: tyrant monkey, CC0." \
    render "$scenes/bmw-m6-pbrt/bmw-m6.pbrt" --lighting ao --size 480x270 --samples 128

# From Blender, where it is installed with the add-on.
if command -v blender >/dev/null && LIGHTNET=$(realpath "$lightnet") blender -b --factory-startup \
    --python examples/blender/monkeys.py -- "$work/gallery/monkeys.png" 128 >/dev/null 2>&1; then
    rm -f "$work/gallery/monkeys.exr"
    cat >>"$page" <<END
## Brass, glass and clay, from Blender

![Brass, glass and clay, from Blender](gallery/monkeys.png)

    blender -b --factory-startup --python examples/blender/monkeys.py -- monkeys.png 128

END
else
    echo "left out: the scene from Blender" >&2
fi
cat >>"$page" <<END
## In a notebook

The [labs](labs/index.md) are notebooks as well, with their pictures: [strategies and their weights](labs/notebooks/02-mis.ipynb).

END

# A noisy picture beside the cleaned one, for the README.
if [ -e "$scenes/living-room-pbrt/living-room.pbrt" ]; then
    "$lightnet" render "$scenes/living-room-pbrt/living-room.pbrt" --size 480x270 --samples 32 --clean \
        -o "$work/room.exr" --forget --progress none
    cp "$work/room.png" "$work/gallery/room_32_samples.png"
    cp "$work/room.clean.png" "$work/gallery/room_32_samples_clean.png"
fi

# All of it, or nothing.
mkdir -p docs/gallery
cp "$work"/gallery/*.png docs/gallery/
cp "$page" docs/gallery.md
