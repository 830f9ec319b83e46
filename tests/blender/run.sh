#!/usr/bin/env bash
# run.sh SCENE...: compares pictures of scenes with those of Cycles; `run.sh engine` installs the add-on from its zip and tries
# it. Needs $LIGHTNET. Without Blender it says so, and leaves by 77.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
command -v blender >/dev/null || { echo "Blender is not installed"; exit 77; }
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
export BLENDER_USER_CONFIG=$place/config BLENDER_USER_SCRIPTS=$place/scripts
export TMPDIR=$place/temporary
mkdir -p "$BLENDER_USER_CONFIG" "$BLENDER_USER_SCRIPTS/addons" "$TMPDIR"
script=against_cycles.py
[ "${1-}" != engine ] || { script=engine_test.py; set -- "$(/usr/bin/python3 "$here/../../blender/zip.py" "$place")"; }
blender -b --factory-startup --python "$here/$script" -- "$@" >"$place/log" 2>&1 && failed=0 || failed=1
[ "$failed" = 0 ] && grep 'FIGURE\|PASSED' "$place/log" || cat "$place/log"
exit "$failed"
