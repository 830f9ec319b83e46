#!/usr/bin/env bash
# Builds with sanitizers and runs the tests under them; a finding fails a test. `scripts/sanitize.sh tsan` (threads) or
# `scripts/sanitize.sh asan` (addresses, undefined behaviour, leaks) does one of the two; without a name, both.
# Asio's fences, which ThreadSanitizer does not know, are left out for it: Asio's locks order all that we hand over.
set -euo pipefail
cd "$(dirname "$0")/.."

[ $# -gt 0 ] || set -- tsan asan
for preset in "$@"; do
    scripts/build.sh "$preset"
    ctest --test-dir "build/$preset" --parallel "$(nproc)" --output-on-failure -LE '^(slow|fuzz|bench)$' </dev/null
done
