#!/usr/bin/env bash
# plugin.sh CMAKE BUILD SOURCES: the example of a plugin, built against an installed lightnet as its own script says, and
# what becomes of libraries that don't fit.
set -euo pipefail
cmake=$1 build=$2 sources=$3
# Beside the build: programs run from there, which not every machine's folder for temporary files allows.
folder=$(mktemp -d "$build/plugin-XXXXXX")
daemon=
trap 'if [ -n "$daemon" ]; then kill "$daemon" 2>/dev/null || true; fi; rm -rf "$folder"' EXIT
trap 'echo "line $LINENO: $BASH_COMMAND"' ERR
"$cmake" --install "$build" --prefix "$folder/usr" --strip >/dev/null
export CMAKE_PREFIX_PATH=$folder/usr PATH=$folder/usr/bin:$PATH LIGHTNET_CONFIG=$folder/none.lua
unset CMAKE_CXX_COMPILER_LAUNCHER
CXX=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$build/CMakeCache.txt")   # plugins of another compiler are refused
export CXX

fail() { echo "$*"; exit 1; }
# says WORDS COMMAND...: the command fails, and says so.
says() {
    local words=$1 said
    shift
    if said=$("$@" 2>&1); then fail "this should have failed: $*"; fi
    [[ $said == *"$words"* ]] || fail "wanted '$words', and it says: $said"
}

cp -r "$sources/examples/plugin" "$folder/plugin"
cd "$folder/plugin"
./ci.sh >"$folder/ci.log" 2>&1 || { cat "$folder/ci.log"; exit 1; }
fog=$folder/plugin/build/fog.so

# A format of scenes.
if ! { cmake -S "$sources/examples/format" -B "$folder/format" && cmake --build "$folder/format" &&
    ctest --test-dir "$folder/format" --output-on-failure; } >"$folder/ci.log" 2>&1; then
    cat "$folder/ci.log"
    fail "the example of a format fails"
fi

# Two that wrap libraries of others; each is left out where its library is not here.
wraps() {
    local example=$1 header=$2 package=$3
    if [ ! -e "/usr/include/$header" ]; then echo "not built: examples/$example wants $package"; return; fi
    if ! { cmake -S "$sources/examples/$example" -B "$folder/$example" && cmake --build "$folder/$example" &&
        ctest --test-dir "$folder/$example" --output-on-failure; } >"$folder/ci.log" 2>&1; then
        cat "$folder/ci.log"
        fail "the example $example fails"
    fi
}
wraps wrapped libnoise/noise.h libnoise-dev
wraps integrators gsl/gsl_monte_miser.h libgsl-dev

lightnet describe Fog --plugin "$fog" >described.txt
grep -q '^  from  ' described.txt || { cat described.txt; fail "Fog is not described"; }
says "no kind 'Fog'" lightnet describe Fog

# A daemon without it says what it lacks; one with it in its folder of plugins serves.
cp "$folder/usr/share/lightnet/graphs/cornell_box.pbrt" box.pbrt
start() {
    "$@" lightnetd --listen 'tcp://127.0.0.1:*' --cache "$folder/cache" >"$folder/daemon.log" 2>&1 &
    daemon=$!
    for _ in $(seq 100); do
        grep -q '^listening on ' "$folder/daemon.log" && break
        sleep 0.1
    done
    echo "place \"$(sed -n 's/^listening on //p' "$folder/daemon.log")\" {}" >hosts.lua
}
render=(lightnet run fog.lua --plugin "$fog" --size 16x16 --samples 1 --hosts hosts.lua)
start env
says "it lacks the plugin fog 1.0 (" "${render[@]}" --wait 1 -o lacking.exr
kill "$daemon"
wait "$daemon" || true
mkdir "$folder/plugins"
cp "$fog" "$folder/plugins/"
start env LIGHTNET_PLUGIN_FOLDER="$folder/plugins"
"${render[@]}" -o there.exr >there.log 2>&1 || { cat there.log; exit 1; }
grep -q '"plugin fog": "fog 1.0 (' there.run.json || fail "the report does not name the plugin"

# Libraries that don't fit.
says "can't be read" lightnet describe --plugin nothing.so
echo 'int main_of_nothing() { return 0; }' >bare.cpp
g++ -shared -fPIC -o bare.so bare.cpp
says "is no plugin: it has no function lightnet_plugin()" lightnet describe --plugin ./bare.so
says "the kind 'Fog'" bash -c 'cp "$0" again.so; echo >>again.so; lightnet describe --plugin "$0" --plugin ./again.so' "$fog"
mkdir -p old/core/network
sed 's/hash\[\] = ".*"/hash[] = "0123456789ab"/' "$folder/usr/include/lightnet/core/network/interface_hash.hpp" \
    >old/core/network/interface_hash.hpp
cat >old.cpp <<'END'
#include "core/network/light/plugin.hpp"
extern "C" const lightnet::PluginCard* lightnet_plugin() {
    static const lightnet::PluginCard card{.name = "old", .version = "1"};
    return &card;
}
END
g++ -std=c++20 -shared -fPIC -I old -I "$folder/usr/include/lightnet" -o old.so old.cpp
says "it was built against the headers 0123456789ab, this program has" lightnet describe --plugin ./old.so
cp old.so "$folder/plugins/"
LIGHTNET_PLUGIN_FOLDER=$folder/plugins lightnet describe Fog >/dev/null 2>left_out.log || fail "an old plugin stops the program"
grep -q 'left out: .*old.so: the plugin can' left_out.log
