#!/usr/bin/env python3
"""mattes.py PICTURE.exr: reads a picture with OpenImageIO, and holds its mattes to the specification of Cryptomatte 1.2
(https://github.com/Psyop/Cryptomatte), of which this is written. Prints what it found. 77: OpenImageIO is not here."""
import json
import struct
import sys

try:
    import numpy
    import OpenImageIO
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)


def murmur3(name):
    data, mask = name.encode(), 0xFFFFFFFF
    turned = lambda value, by: (value << by | value >> 32 - by) & mask
    mixed = lambda word: turned(word * 0xCC9E2D51 & mask, 15) * 0x1B873593 & mask
    whole, value = len(data) // 4 * 4, 0
    for i in range(0, whole, 4):
        value = (turned(value ^ mixed(int.from_bytes(data[i : i + 4], "little")), 13) * 5 + 0xE6546B64) & mask
    value ^= mixed(int.from_bytes(data[whole:], "little")) ^ len(data)
    value = (value ^ value >> 16) * 0x85EBCA6B & mask
    value = (value ^ value >> 13) * 0xC2B2AE35 & mask
    return value ^ value >> 16


def bits_of(name):
    bits = murmur3(name)
    return bits ^ 1 << 23 if (bits >> 23 & 255) in (0, 255) else bits


def expect(truth, what):
    if not truth:
        sys.exit(f"{sys.argv[1]}: {what}")


picture = OpenImageIO.ImageInput.open(sys.argv[1])
spec = picture.spec()
channels = {name: number for number, name in enumerate(spec.channelnames)}
formats = spec.channelformats or [spec.format] * spec.nchannels
pixels = numpy.asarray(picture.read_image(0, spec.nchannels, OpenImageIO.FLOAT))
attributes = {attribute.name: attribute.value for attribute in spec.extra_attribs}

for name in ("worldtocamera", "worldtoNDC"):
    found = [key for key in attributes if key.lower() == name.lower()]
    expect(found and len(attributes[found[0]]) == 16, f"no matrix {name}")
for name in ("seed", "graph"):
    expect(attributes.get(name), f"nothing of {name}")
expect(formats[channels["depth.Z"]] == OpenImageIO.FLOAT, "depth should have float32")
expect(formats[channels["normal.X"]] == OpenImageIO.HALF, "normals should have half floats")
expect(attributes.get("colorInteropID") == "lin_rec709_scene", "its colours should have a name")
primaries = (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329)
expect(numpy.allclose(attributes.get("chromaticities", 8 * [0]), primaries), "its primaries should be those of BT.709")
expect(formats[channels["R"]] == OpenImageIO.FLOAT, "the beauty should have float32")

keys = sorted({key.split("/")[1] for key in attributes if key.startswith("cryptomatte/")})
expect(len(keys) == 3, f"three mattes, not {keys}")
for key in keys:
    said = lambda what: attributes.get(f"cryptomatte/{key}/{what}")
    matte = said("name")
    expect(key == f"{murmur3(matte):08x}"[:7], f"{matte} has the key {key}")
    expect(said("hash") == "MurmurHash3_32" and said("conversion") == "uint32_to_float32", f"how {matte} is hashed")
    manifest = {name: int(digits, 16) for name, digits in json.loads(said("manifest")).items()}
    for name, bits in manifest.items():
        expect(bits == bits_of(name), f"{matte}: {name} is {bits:08x}")
    levels = 0
    while f"{matte}{levels:02}.R" in channels:
        levels += 1
    expect(levels > 0, f"{matte} has no channels")
    planes = [pixels[..., channels[f"{matte}{level:02}.{letter}"]] for level in range(levels) for letter in "RGBA"]
    ids = numpy.stack(planes[0::2], -1).copy().view(numpy.uint32)
    parts = numpy.stack(planes[1::2], -1)
    expect((numpy.diff(parts, axis=-1) <= 0).all(), f"{matte}: ranks are not in order")
    same = (numpy.diff(parts, axis=-1) == 0) & (parts[..., 1:] > 0)
    ordered = ids[..., 1:].astype(numpy.int64) > ids[..., :-1].astype(numpy.int64)
    expect(ordered[same].all(), f"{matte}: equal ranks are not in the order of their bits")
    expect(((parts > 0) == (ids != 0)).all(), f"{matte}: an id without a part, or a part without an id")
    expect(set(numpy.unique(ids[parts > 0])) <= set(manifest.values()), f"{matte}: an id that the manifest lacks")
    expect((parts.sum(-1) <= pixels[..., channels["A"]] + 1e-6).all(), f"{matte}: more than alpha")
    seen = {name: float(parts[ids == bits].sum() / parts.shape[0] / parts.shape[1]) for name, bits in manifest.items()}
    print(matte, {name: round(part, 4) for name, part in seen.items() if part > 0})
    if matte != "CryptoLamp":
        whole = numpy.abs(parts.sum(-1) - pixels[..., channels["A"]])
        expect(whole.max() < 1e-6, f"{matte}: not all of alpha")
expect(0 < pixels[..., channels["A"]].mean() < 1, "alpha is the same everywhere")
