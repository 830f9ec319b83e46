#!/usr/bin/env bash
# screenshot.sh [PROGRAMS]: has a browser watch a run, and keeps what it shows as docs/watch.png. Wants chromium, and
# npm ci in tools/watch/page.
set -euo pipefail
cd "$(dirname "$0")/../.."
root=$PWD
programs=$(cd "${1:-build/release/bin}" && pwd)
work=$(mktemp -d)
cd "$work"
"$programs/lightnet" run "$root/graphs/paper/figure5.lua" --size 224x224 --samples 1024 --local-workers 2 --watch \
    -o x.exr 2>run.log >/dev/null &
run=$!
trap 'kill "$run"; wait "$run" || true; rm -rf "$work"' EXIT
until grep -q '^watch it at' run.log; do sleep 0.1; done
url=$(sed -n 's/^watch it at //p' run.log)
CHROMIUM=$(command -v chromium) node --input-type=module - "$root" "$url" <<'SCRIPT'
import { createRequire } from "node:module";
const [root, url] = process.argv.slice(2);
const { chromium } = createRequire(`${root}/tools/watch/page/`)("playwright-core");
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox"] });
const page = await browser.newPage({ viewport: { width: 1200, height: 1400 } });  // the whole graph
await page.goto(url);
// All of the picture is there, and better than it was at first.
await page.waitForFunction(() => parseFloat(document.querySelector('[data-testid="done"]')?.textContent) > 2, null,
    { timeout: 300000 });
// Of what scrolls by itself, all is shown as well.
const bottom = await page.evaluate(() =>
    Math.max(...[...document.querySelectorAll(".card")].map((card) => card.getBoundingClientRect().bottom)));
await page.setViewportSize({ width: 1200, height: Math.ceil(bottom) + 12 });
await page.waitForTimeout(1000);
await page.screenshot({ path: `${root}/docs/watch.png`, fullPage: true });
await browser.close();
SCRIPT
