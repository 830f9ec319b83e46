#!/usr/bin/env bash
# The one check script: formatting, warnings, headers that compile alone, tests. `scripts/check.sh --fix` formats first.
# What touches threads, fibers or memory goes through scripts/sanitize.sh as well.
set -euo pipefail
cd "$(dirname "$0")/.."

mapfile -t files < <(git ls-files --cached --others --exclude-standard '*.cpp' '*.hpp')
if ! command -v clang-format >/dev/null; then
    echo "formatting is not checked: there is no clang-format here (Debian: clang-format)"
elif [ "${1-}" = --fix ]; then
    clang-format -i "${files[@]}"
else
    clang-format --dry-run -Werror "${files[@]}"
fi

scripts/build.sh dev all benchmarks   # each file alone: release and the sanitizers compile folders as one
scripts/build.sh dev all_verify_interface_header_sets
ctest --test-dir build/dev --parallel "$(nproc)" --output-on-failure -LE '^(slow|fuzz|bench)$' </dev/null
