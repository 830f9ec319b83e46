#!/usr/bin/env bash
# build.sh PRESET [TARGET...]: configures build/PRESET and builds it (all targets, if none is named), on all cores.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=$1
shift

if command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache
    export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS-pch_defines,time_macros}   # else it keeps nothing of the tests
fi
cmake --preset "$preset" --log-level=WARNING >/dev/null
cmake --build --preset "$preset" --parallel "$(nproc)" ${1:+--target "$@"}
