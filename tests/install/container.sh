#!/usr/bin/env bash
# container.sh SOURCES [PACKAGES]: the Containerfile makes an image of packages of this tree (those in PACKAGES, if it is
# given), and the programs in it render. Its base is a minimal Debian made here, so nothing but packages is fetched. Ends
# with 77 where that can't be played.
set -euo pipefail
sources=$1
. "$(dirname "$0")/minimal_root.sh"
skip() { echo "not run: $*"; exit 77; }
for tool in buildah debootstrap; do command -v "$tool" >/dev/null || skip "$tool is not here"; done
[ "$(id -u)" -eq 0 ] || skip "it takes root"

folder=$(mktemp -d)
images() { buildah --root "$folder/images" --runroot "$folder/run" --storage-driver vfs "$@"; }
trap 'images rm --all >/dev/null 2>&1 || true; rm -rf --one-file-system "$folder"' EXIT
mkdir "$folder/context"
cp -r "$sources/Containerfile" "$sources/packaging" "$folder/context/"
if [ -n "${2-}" ]; then cp -r "$2" "$folder/context/out"; else "$sources/scripts/package.sh" "$folder/context/out" >/dev/null; fi

minimal_root "$folder/root" "$folder/log"
base=$(images from scratch)
images add "$base" "$folder/root" / >/dev/null
images commit "$base" debian-here >"$folder/log" 2>&1 || { cat "$folder/log"; skip "images can't be made here"; }

build() { images build --isolation chroot --network host --build-arg BASE=localhost/debian-here -t lightnet "$folder/context"; }
build >"$folder/log" 2>&1 || { tail -n 30 "$folder/log"; exit 1; }
container=$(images from localhost/lightnet)
inside() { images run --isolation chroot --network host "$container" -- "$@"; }
inside sh -c '[ "$(id -u)" = 1000 ]' || { echo "it runs as root"; exit 1; }
inside sh -c 'cp /usr/share/lightnet/graphs/cornell* . &&
    lightnet run cornell.lua --size 32x32 --samples 4 --progress none -o one.exr &&
    lightnet run cornell.lua --size 32x32 --samples 4 --progress none --local-workers 2 -o two.exr &&
    cmp one.exr two.exr'
# As a daemon it is well, and says so.
inside bash -c 'lightnetd --metrics 127.0.0.1:9199 --cache /cache & daemon=$!
    for i in $(seq 100); do lightnet-health 127.0.0.1:9199 2>/dev/null && break; sleep .1; done
    lightnet-health 127.0.0.1:9199 && kill $daemon && wait $daemon' || { echo "the daemon is not well"; exit 1; }
