#!/usr/bin/env bash
# installed.sh CMAKE BUILD SOURCES: installs a build into a folder of its own, and uses it from there.
set -euo pipefail
cmake=$1 build=$2 sources=$3
# Beside the build: programs run from there, which not every machine's folder for temporary files allows.
folder=$(mktemp -d "$build/installed-XXXXXX")
trap 'rm -rf "$folder"' EXIT
trap 'echo "line $LINENO: $BASH_COMMAND"' ERR
"$cmake" --install "$build" --prefix "$folder/usr" --strip >/dev/null
cd "$folder"
export PATH=$folder/usr/bin:$PATH

fail() { echo "$*"; exit 1; }

lightnet run usr/share/lightnet/graphs/ambient.lua --size 16x16 --samples 1 --threads 1 -o one.exr --progress none
lightnet run usr/share/lightnet/graphs/ambient.lua --size 16x16 --samples 1 --local-workers 1 -o two.exr --progress none
cmp one.exr two.exr || fail "the installed launcher and its daemon make other bytes"

# The page Start, word by word: its blocks of commands, one after the other.
mkdir start
sed -n '/^```sh$/,/^```$/p' "$sources/docs/start.md" | sed '/^```/d' | sed "s|/usr/share/|$folder/usr/share/|" >start/commands.sh
[ "$(grep -c '^lightnet ' start/commands.sh)" -ge 8 ] || fail "the page Start has lost its commands"
(cd start && MANPATH=$folder/usr/share/man LIGHTNET_CONFIG=$folder/none.lua bash -eu commands.sh >log 2>&1 </dev/null) || { cat start/log; fail "the page Start fails"; }
[ -s start/graphs/facing.png ] || fail "the page Start makes no picture"

for page in lightnet lightnet-run lightnet-scene-info lightnetd; do
    grep -q '^\.TH ' "usr/share/man/man1/$page.1" || fail "no manual page $page"
done
bash -n usr/share/bash-completion/completions/lightnet

# The completion completes: verbs, flags of a verb, values of a flag.
complete_line() {
    bash -c 'source "$1"; shift; COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)); _lightnet; echo "${COMPREPLY[*]-}"' \
        bash usr/share/bash-completion/completions/lightnet "$@"
}
expect() { [ "$1" = "$2" ] || fail "completed '$1' instead of '$2'"; }
expect "$(complete_line lightnet des)" describe
expect "$(complete_line lightnet run --local)" --local-workers
expect "$(complete_line lightnet run --progress js)" json
expect "$(complete_line lightnet scene in)" info
expect "$(complete_line lightnet run graphs/co)" ""

unit=usr/lib/systemd/system/lightnetd.service
grep -q "^ExecStart=$folder/usr/bin/lightnetd --listen" "$unit" || fail "the unit starts another program"
if command -v systemd-analyze >/dev/null; then systemd-analyze verify --man=no "$unit"; fi
