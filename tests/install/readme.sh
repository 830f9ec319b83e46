#!/usr/bin/env bash
# readme.sh PROGRAMS SOURCES: does what the README's block of commands says, line by line, with small pictures.
set -euo pipefail
programs=$1 sources=$2
folder=$(mktemp -d) daemon=
trap '[ -z "$daemon" ] || kill "$daemon"; rm -rf "$folder"' EXIT
export PATH=$programs:$PATH HOME=$folder LIGHTNET_CONFIG=$folder/none.lua LIGHTNET_SIZE=256x256 LIGHTNET_SAMPLES=1
cp -r "$sources/graphs" "$folder"
cd "$folder"

# What lab.lua names.
: >listens
lightnetd --listen 'tcp://127.0.0.1:*' --places 1 >listens 2>daemon.log &
daemon=$!
until grep -q '^listening on ' listens; do
    kill -0 "$daemon" || { cat daemon.log; exit 1; }
    sleep .1
done
echo "place '$(sed -n 's/^listening on //p' listens)' {}" >lab.lua

sed -n 's/^    \(lightnet .*\)/\1/p' "$sources/README.md" >commands
[ "$(wc -l <commands)" -ge 10 ] || { echo "the README has lost its commands"; exit 1; }
while read -r line; do
    command -v dot >/dev/null || line=${line/| dot -Tsvg/}
    # A page is served until somebody ends it.
    case $line in 'lightnet view'*) line="timeout --foreground --preserve-status --signal TERM 3 $line" ;; esac
    code=0
    bash -c "$line" </dev/null >said 2>&1 || code=$?
    # Without a Slurm it can't be done, but it is understood.
    case $line in *--slurm*) grep -q sbatch said && [ "$code" = 1 ] && code=0 ;; esac
    [ "$code" = 0 ] || { echo "code $code: $line"; cat said; exit 1; }
done <commands
for made in cornell.exr cornell.png cornell.run.json cornell.remix.exr cornell_box.exr net.svg; do
    [ -s "$made" ] || { echo "there is no $made"; exit 1; }
done
