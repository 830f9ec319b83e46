#!/usr/bin/env bash
# site.sh [FOLDER]: makes the documents into a site (default: build/site), with a reference that the program writes. Needs
# python3-sphinx, python3-myst-parser and furo, and no network. A link that leads nowhere is an error.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p "${1:-build/site}"
folder=$(cd "${1:-build/site}" && pwd)
python=/usr/bin/python3   # the one that Debian's packages are for
[ -x "$python" ] || python=python3
for module in sphinx myst_parser furo; do
    "$python" -c "import $module" 2>/dev/null ||
        { echo "please install python3-sphinx, python3-myst-parser and furo" >&2; exit 77; }
done
program=${LIGHTNET:-build/release/bin/lightnet}
[ -x "$program" ] || scripts/build.sh release lightnet

pages=$(mktemp -d)
trap 'rm -rf "$pages"' EXIT
"$program" manual --all "$pages/share"
mv "$pages/share/reference" "$pages/reference"
rm -r "$pages/share"
cp docs/site/conf.py docs/site/scorer.js docs/site/index.md README.md CONTRIBUTING.md DECISIONS.md CHANGELOG.md LICENSE "$pages/"
mkdir "$pages/docs"
cp -r docs/*.md docs/*.png docs/gallery docs/labs docs/notebook docs/schemas "$pages/docs/"
"$python" -m sphinx -q -W --keep-going -b html "$pages" "$folder"
echo "$folder/index.html"
