#!/usr/bin/env bash
# run.sh SCENE...: compares pictures of scenes with those of Cycles. `run.sh engine` installs the add-on from its zip and tries
# it; `run.sh viewport` does so in a window, on a screen of its own; `run.sh compositor` does what docs/compositor.md says.
# `run.sh example` renders the scene of examples/blender. Needs $LIGHTNET. Without Blender, or a screen, it says so, and leaves by 77.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
command -v blender >/dev/null || { echo "Blender is not installed"; exit 77; }
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
export BLENDER_USER_CONFIG=$place/config BLENDER_USER_SCRIPTS=$place/scripts
export TMPDIR=$place/temporary
mkdir -p "$BLENDER_USER_CONFIG" "$BLENDER_USER_SCRIPTS/addons" "$TMPDIR"
script=against_cycles.py
blender=(blender -b)
case ${1-} in
    compositor) script=compositor_test.py ;;
    example)
        cp -R "$here/../../blender/lightnet" "$BLENDER_USER_SCRIPTS/addons/"
        script=../../examples/blender/monkeys.py
        set -- "$place/monkeys.png" 1
        ;;
    engine | viewport)
        script=$1_test.py
        [ "$1" = engine ] || {
            command -v xvfb-run >/dev/null || { echo "xvfb-run is not installed"; exit 77; }
            blender=(xvfb-run -a -s "-screen 0 1280x800x24" blender --window-geometry 0 0 1200 760)
        }
        set -- "$(/usr/bin/python3 "$here/../../blender/zip.py" "$place")"
        ;;
esac
"${blender[@]}" --factory-startup --python "$here/$script" -- "$@" >"$place/log" 2>&1 && failed=0 || failed=1
[ ! -e "$place/monkeys.exr" ] || echo PASSED >>"$place/log"
[ "$failed" = 0 ] && grep 'FIGURE\|PASSED' "$place/log" || { cat "$place/log"; failed=1; }
exit "$failed"
