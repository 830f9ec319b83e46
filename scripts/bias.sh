#!/usr/bin/env bash
# bias.sh [--references FOLDER] [--scenes FOLDER] [--seeds N] [--algorithm NAME]... [--budget 1|2|3]... [SCENE...]
# Renders scenes with known answers by each algorithm, with three budgets, and prints how far the pictures are off as a
# table in Markdown: the bias that is left beside the noise. Several seeds tell one from the other: of the mean ratio
# and of blocks of 16 x 16 pixels (see lightnet compare), the mean over the seeds and, in brackets, the worst of them.
#
# References: a folder with NAME.pbrt and NAME.*.exr of the strict scenes; else $LIGHTNET_SHARED/reference, or a folder
# `reference` beside the project. Scenes: a folder with NAME/NAME.pbrt (or .xml) and its reference NAME/NAME.exr. What
# is not there is named at the end. LIGHTNET names the program, build/release/bin/lightnet by itself.
set -euo pipefail

project=$(cd "$(dirname "$0")/.." && pwd)
lightnet=${LIGHTNET:-$project/build/release/bin/lightnet}
references= scenes= seeds=3 algorithms=() budgets=() wanted=()
while [ $# -gt 0 ]; do
    case $1 in
        --references) references=$2; shift 2 ;;
        --scenes) scenes=$2; shift 2 ;;
        --seeds) seeds=$2; shift 2 ;;
        --algorithm) algorithms+=("$2"); shift 2 ;;
        --budget) budgets+=("$2"); shift 2 ;;
        -*) sed -n '2,10s/^# //p' "$0" >&2; exit 2 ;;
        *) wanted+=("$1"); shift ;;
    esac
done
if [ -z "$references" ]; then
    for folder in ${LIGHTNET_SHARED:+"$LIGHTNET_SHARED/reference"} "$project/../reference"; do
        [ -d "$folder" ] && references=$folder && break
    done
fi
[ -x "$lightnet" ] || { echo "$lightnet is not there: build it, or name it in LIGHTNET" >&2; exit 2; }

# name, width and height of the reference
strict="cornell_grey cornell_rgb caustic indirect furnace05 furnace08 terrain"
real="veach-ajar:320:180 living-room:320:180 staircase2:320:320 water-caustic:256:256"
# name, graph, constants of the three budgets
table="path|path.lua|samples=16|samples=64|samples=256
path_all|path_all.lua|samples=4|samples=16|samples=64
irradiance_cache|irradiance_cache.lua|rays=64|rays=256|rays=1024
figure5|paper/figure5.lua|wanted_error=0.04|wanted_error=0.02|wanted_error=0.01
progressive|progressive.lua|samples=16|samples=64|samples=256"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
missing=()
among() { local name=$1; shift; [ $# -eq 0 ] && return 0; for one; do [ "$one" = "$name" ] && return 0; done; return 1; }

# One line per seed: ratio of the channel that is farthest off, ratios of all, blocks.
measure() { # graph, constant, scene, reference, width, height
    for seed in $(seq "$seeds"); do
        "$lightnet" run "$project/graphs/$1" -D "$2" -D "file=$3" --size "$5x$6" --seed "$seed" \
            -o "$work/picture.exr" --progress none --forget >"$work/log" 2>&1 || { cat "$work/log" >&2; return 1; }
        "$lightnet" compare "$4" "$work/picture.exr" --json | tr -d ' \n' |
            sed -E 's/.*"blocks":([^,}]*),"mean_ratio":\[([^,]*),([^,]*),([^]]*)\].*/\2 \3 \4 \1\n/'
    done
}

row() { # scene's name, its file, its reference, width, height
    while IFS='|' read -r name graph first second third; do
        among "$name" ${algorithms[@]+"${algorithms[@]}"} || continue
        local budget=0
        for constant in "$first" "$second" "$third"; do
            budget=$((budget + 1))
            among "$budget" ${budgets[@]+"${budgets[@]}"} || continue
            measure "$graph" "$constant" "$2" "$3" "$4" "$5" >"$work/found" || { missing+=("$1 by $name, $constant"); continue; }
            LC_ALL=C awk -v scene="$1" -v name="$name" -v constant="$constant" '
                function off(x) { return x < 1 ? 1 - x : x - 1 }
                { for (c = 1; c <= 3; c++) { sum[c] += $c; if (off($c) > worst) worst = off($c) }
                  blocks += $4; if ($4 > most) most = $4 }
                END { printf "| %s | %s | %s | %.4f %.4f %.4f (%.2f %%) | %.2f %% (%.2f %%) |\n", scene, name, constant,
                      sum[1] / NR, sum[2] / NR, sum[3] / NR, 100 * worst, 100 * blocks / NR, 100 * most }' "$work/found"
        done
    done <<<"$table"
}

echo "| scene | algorithm | budget | mean R G B (worst) | blocks (worst) |"
echo "|---|---|---|---|---|"
for name in $strict; do
    among "$name" ${wanted[@]+"${wanted[@]}"} || continue
    reference=$(ls "$references/$name".*.exr 2>/dev/null | head -n 1) || true
    if [ -n "$reference" ]; then row "$name" "$references/$name.pbrt" "$reference" 256 256; else missing+=("$name"); fi
done
for entry in $real; do
    IFS=: read -r name width height <<<"$entry"
    among "$name" ${wanted[@]+"${wanted[@]}"} || continue
    for file in "$scenes/$name/$name.pbrt" "$scenes/$name/$name.xml"; do [ -e "$file" ] && break; done
    if [ -e "$file" ] && [ -e "$scenes/$name/$name.exr" ]; then
        row "$name" "$file" "$scenes/$name/$name.exr" "$width" "$height"
    else
        missing+=("$name")
    fi
done
[ ${#missing[@]} -eq 0 ] || { echo; echo "Not run:"; printf -- '- %s\n' "${missing[@]}"; }
