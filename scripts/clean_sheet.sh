#!/usr/bin/env bash
# clean_sheet.sh SHARED [PICTURES]: makes docs/gallery/cleaned.jpg: of each scene a row with the noisy picture (32
# samples), the cleaned one, the reference, and how far the cleaned one is from it (four times as bright). SHARED: the
# folder with `reference` and `scenes`; PICTURES: one that keeps noisy pictures, as LIGHTNET_BENCH_PICTURES of
# `./bench clean` does. Wants chromium, and npm ci in tools/watch/page. LIGHTNET_BIN: where the programs are.
set -euo pipefail
cd "$(dirname "$0")/.."
shared=${1:?usage: scripts/clean_sheet.sh SHARED [PICTURES]}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
kept=${2:-$work}
bin=${LIGHTNET_BIN:-build/release/bin}
own=$shared/reference real=$shared/reference/scenes

cells=()
# row NAME SIZE SCENE REFERENCE [FOLDER]: FOLDER has what the scene names, if that doesn't lie beside it.
row() {
    local name=$1 size=$2 scene=$3 reference=$4
    local noisy=$kept/$name.32.1.exr
    if [ ! -e "$noisy" ]; then
        if [ $# -gt 4 ]; then
            mkdir "$work/$name"
            ln -s "$(dirname "$scene")"/* "$work/$name/"
            ln -s -t "$work/$name" "$5"/* 2>/dev/null || true
            scene=$work/$name/$(basename "$scene")
        fi
        "$bin/lightnet" render "$scene" --clean --samples 32 --seed 1 --size "$size" --forget --progress none -o "$noisy"
    fi
    "$bin/lightnet" clean "$noisy" -o "$work/$name.clean.exr"
    "$bin/lightnet" compare "$reference" "$work/$name.clean.exr" --difference "$work/$name.png" --exposure 2 >/dev/null
    cells+=("$noisy" "$work/$name.clean.exr" "$reference" "$work/$name.png")
}
row cornell_grey 256x256 "$own/cornell_grey.pbrt" "$own/cornell_grey.mits_path_2048.exr"
row indirect 256x256 "$own/indirect.pbrt" "$own/indirect.mits_path_2048.exr"
row caustic 256x256 "$own/caustic.pbrt" "$own/caustic.mits_bdpt_1280.exr"
for scene in veach-mis:320x240 veach-ajar:320x180 living-room:320x180 staircase2:320x320 bmw-m6:320x228; do
    name=${scene%:*}
    row "$name" "${scene#*:}" "$real/$name/$name.pbrt" "$real/$name/$name.exr" "$shared/scenes/$name-pbrt"
done
"$bin/lightnet-contact-sheet" "$work/sheet.png" --pairs 2 "${cells[@]}"
CHROMIUM=$(command -v chromium) node --input-type=module - "$PWD" "$work/sheet.png" <<'SCRIPT'
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
const [root, sheet] = process.argv.slice(2);
const { chromium } = createRequire(`${root}/tools/watch/page/`)("playwright-core");
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox"] });
const page = await browser.newPage();
await page.setContent(`<img src="data:image/png;base64,${readFileSync(sheet).toString("base64")}">`);
await page.locator("img").screenshot({ path: `${root}/docs/gallery/cleaned.jpg`, type: "jpeg", quality: 78 });
await browser.close();
SCRIPT
