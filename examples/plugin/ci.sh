#!/usr/bin/env bash
# What a continuous integration runs: on Debian with the packages lightnet, lightnet-dev, g++ and cmake.
set -euo pipefail
cd "$(dirname "$0")"
cmake -B "${1:-build}" -DCMAKE_BUILD_TYPE=Release
cmake --build "${1:-build}"
ctest --test-dir "${1:-build}" --output-on-failure
