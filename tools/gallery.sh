#!/usr/bin/env bash
# gallery.sh SCENES: makes docs/gallery.md and its pictures. SCENES: a folder with the scenes that the page credits, each
# in a folder of its own. Takes some ten minutes on two cores. LIGHTNET names the program, GRAPHS the example graphs.
set -euo pipefail
cd "$(dirname "$0")/.."
scenes=${1:?usage: tools/gallery.sh SCENES}
lightnet=${LIGHTNET:-build/release/bin/lightnet}
graphs=${GRAPHS:-graphs}
page=docs/gallery.md
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p docs/gallery

cores=$(nproc)
cat >"$page" <<END
# Gallery

Twelve pictures, each with the command that made it. Seconds are those of preparing and rendering, on $cores cores of
$(sed -n 's/^model name[[:space:]]*: //p' /proc/cpuinfo | head -n 1); reading the scene is left out. \`tools/gallery.sh\` makes this page.

