#!/usr/bin/env bash
# build_identity.sh CMAKE SOURCES: what names a build (core/base/build_sources.cmake) follows the sources that answer, and
# nothing else.
set -euo pipefail
cmake=$1 sources=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
tree=$folder/tree
mkdir -p "$tree"/{core/base,nodes,transport,tools,lua,docs,tests}
echo 'id @LIGHTNET_SOURCES_HASH@' >"$folder/template"
echo 'a list' >"$folder/list.cpp"

id() {
    "$cmake" -D "ROOT=$tree" -D "MORE=$folder/list.cpp" -D "TEMPLATE=$folder/template" -D "OUTPUT=$folder/out" \
        -P "$sources/core/base/build_sources.cmake"
    cat "$folder/out"
}
status=0
expect() {  # expect SAME|OTHER WHAT
    local now
    now=$(id)
    if { [ "$1" = same ] && [ "$now" != "$before" ]; } || { [ "$1" = other ] && [ "$now" = "$before" ]; }; then
        echo "$2: the name of the build should be ${1/other/another}, and is $now after $before"
        status=1
    fi
    before=$now
}

echo 1 >"$tree/core/base/a.cpp"
before=$(id)
[[ $before =~ ^id\ [0-9a-f]{12}$ ]] || { echo "no name: $before"; exit 1; }
expect same "nothing done"
for file in docs/page.md README.md tests/a_test.cpp tools/options.cpp lua/script.cpp core/base/CMakeLists.txt; do
    echo 1 >"$tree/$file"
    expect same "a new $file"
done
for file in core/base/b.hpp nodes/node.cpp transport/packet.hpp; do
    echo 1 >"$tree/$file"
    expect other "a new $file"
    echo 2 >"$tree/$file"
    expect other "an edited $file"
done
mv "$tree/nodes/node.cpp" "$tree/nodes/other.cpp"
expect other "a renamed file"
echo 'another list' >"$folder/list.cpp"
expect other "another list of nodes"
mv "$tree" "$folder/elsewhere"
tree=$folder/elsewhere
expect same "the same tree elsewhere"
exit "$status"
