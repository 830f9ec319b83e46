#!/usr/bin/env bash
# fuzz.sh TARGET SECONDS: builds the targets of tests/fuzz with clang's libFuzzer, addresses and undefined behaviour
# checked (preset fuzz), and has it look for inputs that break TARGET for so long. It begins with the target's seeds and
# what earlier calls have kept in build/fuzz/fuzz/corpus/TARGET. What breaks it is put beside, as crash-… or timeout-…,
# and belongs into tests/fuzz/found/TARGET when it is mended. Without words: the names of the targets.
# Debian: clang and its libclang-rt-dev of the same version. It takes one core, and 2 GiB of memory.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ $# -ne 2 ]; then
    sed -n '/^set(targets/,/)/{s/^set(targets//;s/)//;p}' tests/fuzz/CMakeLists.txt | xargs -n 1
    exit 2
fi
target=$1 seconds=$2
cmake --preset fuzz --log-level=WARNING >/dev/null
cmake --build --preset fuzz --target fuzzers
known=()
[ -d "tests/fuzz/found/$target" ] && known=("tests/fuzz/found/$target")
export FUZZ_TARGET=$target
exec build/fuzz/fuzz/fuzz -max_total_time="$seconds" -rss_limit_mb=2048 -timeout=10 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/fuzz/$target-" "build/fuzz/fuzz/corpus/$target" "${known[@]}"
