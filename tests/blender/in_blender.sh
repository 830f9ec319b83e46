#!/usr/bin/env bash
# in_blender.sh FOLDER SCRIPT WORD...: runs a script of this folder in Blender, with the add-on of the sources in FOLDER.
# Without Blender it says so, and leaves by 77.
set -euo pipefail
if ! command -v blender >/dev/null; then
    echo "Blender is not installed"
    exit 77
fi
here=$(dirname "$(readlink -f "$0")")
root=$1 script=$2
shift 2
blender -b --factory-startup --python-exit-code 1 --python "$here/$script" -- "$root/blender" "$@" 2>&1 | grep -v '^Fra:\|^Saved:\|^ Time:\|^$'
