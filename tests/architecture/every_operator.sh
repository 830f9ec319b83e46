#!/usr/bin/env bash
# every_operator.sh LIGHTNET DOCUMENT: fails where an operator has no section of its own in the document with a graph and
# a picture that is there, or a section no operator. Examples of wrapped classes, and functions from
# outside (python.md), are told of elsewhere.
set -euo pipefail
lightnet=$1 document=$2

wrong=0
kinds=$("$lightnet" describe | awk '$2 != "scene" && $1 !~ /^Candela|^Outside$/ { print $1 }')
for kind in $kinds; do
    awk -v kind="$kind" '/^## / { inside = $2 == kind } inside && /^```lua/ { found = 1 } END { exit !found }' "$document" || { echo "$kind has no section with a graph in $document"; wrong=1; }
    [ -s "$(dirname "$document")/gallery/nodes/$kind.png" ] || { echo "there is no picture of $kind"; wrong=1; }
done
for kind in $(sed -n 's/^## //p' "$document"); do
    grep -qx "$kind" <<<"$kinds" || { echo "$document tells of $kind, which is no operator"; wrong=1; }
done
exit $wrong
