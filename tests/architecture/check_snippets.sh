#!/usr/bin/env bash
# check_snippets.sh LIGHTNET ROOT DOCUMENT: runs `lightnet check` on every ```lua block of the document, beside the
# graphs of the project. A block with `place "…"` is a hosts file for the graph that its first line names
# (`-- for graphs/NAME.lua`), or else for the graph block before it.
set -euo pipefail
lightnet=$1 root=$2 document=$3

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp -R "$root/graphs/." "$folder/"

awk -v folder="$folder" '
    /^```lua$/ { inside = 1; file = sprintf("%s/snippet_%02d.lua", folder, ++count); next }
    /^```/     { if (inside) close(file); inside = 0; next }
    inside     { print > file }
' "$root/$document"

graph=
for snippet in "$folder"/snippet_*.lua; do
    [ -e "$snippet" ] || { echo "$document shows no graph"; exit 0; }
    if grep -q '^place ' "$snippet"; then
        named=$(sed -n '1s|^-- for graphs/||p' "$snippet")
        "$lightnet" check "${named:+$folder/}${named:-$graph}" --hosts "$snippet"
    else
        graph=$snippet
        "$lightnet" check "$graph"
    fi
done
