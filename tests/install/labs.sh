#!/usr/bin/env bash
# labs.sh PROGRAMS SOURCES LAB: does what a lab says, word by word, in a folder of its own, and looks for the figures of
# its answers in what was printed: each, rounded as it is there. Those that nobody prints stand in a comment of the page:
# <!-- reckoned: 1.25 -->.
set -euo pipefail
programs=$1 sources=$2 lab=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export PATH=$programs:$PATH LIGHTNET_CONFIG=$folder/none.lua
page=$sources/docs/labs/$lab
commands() { sed -n '/^```sh$/,/^```$/p' "$1" | sed '/^```/d'; }
{
    commands "$sources/docs/labs/index.md" | sed "s|/usr/share/lightnet/graphs|$sources/graphs|"
    commands "$page"
} >"$folder/commands.sh"
[ "$(grep -c '^ *lightnet ' "$folder/commands.sh")" -ge 2 ] || { echo "$lab has lost its commands"; exit 1; }
cd "$folder"
bash -eu commands.sh </dev/null | tee printed

answers() { sed -n '/^## Answers$/,$p' "$page"; }
figures=$(answers | grep -v '^<!-- reckoned:' | grep -o '[0-9]\+\.[0-9]\+' || true)
reckoned=$(answers | sed -n 's/^<!-- reckoned: \(.*\) -->$/\1/p')
for figure in $figures; do
    case " $reckoned " in *" $figure "*) continue ;; esac
    digits=${figure#*.}
    tr -cs '0-9.e+-' '\n' <printed | awk -v figure="$figure" -v digits="${#digits}" \
        'sprintf("%." digits "f", $0) == figure { found = 1 } END { exit !found }' ||
        { echo "$lab says $figure, and nothing that was printed is so"; exit 1; }
done
