#!/usr/bin/env bash
# rebuild.sh: builds the page anew from its sources, and compares it with the one that is in the program. 77: npm, or
# what npm would fetch, can't be had.
set -euo pipefail
page=$(cd "$(dirname "$0")/../../tools/watch/page" && pwd)
command -v npm >/dev/null || { echo "skipped: there is no npm"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r "$page"/{build.mjs,index.html,package-lock.json,package.json,vite.config.mjs,src} "$work"
if [ -d "$page/node_modules" ]; then
    ln -s "$page/node_modules" "$work/node_modules"
else
    (cd "$work" && timeout 120 npm ci --no-audit --no-fund --ignore-scripts >/dev/null 2>&1) ||
        { echo "skipped: npm can't fetch what the page is built with"; exit 77; }
fi
(cd "$work" && node build.mjs "$work/watch.html")
cmp "$work/watch.html" "$page/../assets/watch.html"
