#!/usr/bin/env bash
# browser.sh PROGRAMS [PICTURES]: a browser watches a run on two daemons, one of which is killed (browser.mjs); screenshots
# go into PICTURES. 77: the browser, or what drives it, can't be had.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
page=$here/../../tools/watch/page
chromium=$(command -v chromium || command -v chromium-browser || true)
[ -n "$chromium" ] || { echo "skipped: there is no chromium"; exit 77; }
[ -d "$page/node_modules/playwright-core" ] || { echo "skipped: no playwright-core; npm ci in tools/watch/page"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
CHROMIUM=$chromium node "$here/browser.mjs" "$(cd "$1" && pwd)" "$work" ${2:+"$(mkdir -p "$2" && cd "$2" && pwd)"}
