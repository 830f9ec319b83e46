#!/usr/bin/env bash
# labs.sh PROGRAMS SOURCES LAB: does what a lab says, word by word, in a folder of its own.
set -euo pipefail
programs=$1 sources=$2 lab=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export PATH=$programs:$PATH LIGHTNET_CONFIG=$folder/none.lua
commands() { sed -n '/^```sh$/,/^```$/p' "$1" | sed '/^```/d'; }
{
    commands "$sources/docs/labs/index.md" | sed "s|/usr/share/lightnet/graphs|$sources/graphs|"
    commands "$sources/docs/labs/$lab"
} >"$folder/commands.sh"
[ "$(grep -c '^ *lightnet ' "$folder/commands.sh")" -ge 2 ] || { echo "$lab has lost its commands"; exit 1; }
cd "$folder"
bash -eu commands.sh </dev/null
