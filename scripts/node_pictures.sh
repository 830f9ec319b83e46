#!/usr/bin/env bash
# node_pictures.sh: renders the graphs of docs/nodes.md into docs/gallery/nodes; of those that show something beside
# the picture, that. Takes some minutes, and needs python3-numpy. LIGHTNET names the program.
set -euo pipefail
cd "$(dirname "$0")/.."
lightnet=$(realpath "${LIGHTNET:-build/release/bin/lightnet}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp -R graphs/. "$folder/"
mkdir -p docs/gallery/nodes

awk -v folder="$folder" '
    /^## /     { kind = $2 }
    /^```lua$/ { inside = 1; file = folder "/node_" kind ".lua"; next }
    /^```/     { if (inside) close(file); inside = 0; next }
    inside     { print > file }
' docs/nodes.md
# shown ARRAYS PNG: writes what is shown beside the picture, colours from 0 to 1, as a PNG.
shown() {
    /usr/bin/python3 - "$1" "$2" <<'END'
import struct, sys, zlib
import numpy as np

arrays = np.load(sys.argv[1])
name = next(name for name in arrays.files if name.startswith("shown/"))
linear = np.clip(arrays[name], 0, 1)
levels = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
rows = np.round(255 * levels).astype(np.uint8)

def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

head = struct.pack(">IIBBBBB", rows.shape[1], rows.shape[0], 8, 2, 0, 0, 0)
lines = b"".join(b"\0" + row.tobytes() for row in rows)
with open(sys.argv[2], "wb") as png:
    png.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b""))
END
}

for graph in "$folder"/node_*.lua; do
    kind=$(basename "$graph" .lua)
    kind=${kind#node_}
    "$lightnet" run "$graph" -o "$folder/$kind.exr" --npz "$folder/$kind.npz" --forget --progress none
    case $kind in
        GuideRadiance | RecordPositions | SurfaceFact | SurfaceFeature) shown "$folder/$kind.npz" "docs/gallery/nodes/$kind.png" ;;
        *) cp "$folder/$kind.png" "docs/gallery/nodes/$kind.png" ;;
    esac
    echo "$kind"
done
