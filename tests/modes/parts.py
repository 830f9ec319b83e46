#!/usr/bin/python3
"""parts.py WHOLE.exr PARTS.exr: do both files have the same channels with the same numbers, as OpenImageIO reads them?
77: OpenImageIO is not here."""
import sys

try:
    import numpy
    import OpenImageIO
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)


def channels(name):
    """By name, over all parts; and the parts' names."""
    found, parts = {}, []
    file = OpenImageIO.ImageInput.open(name)
    if not file:
        sys.exit(f"{name}: {OpenImageIO.geterror()}")
    while file.seek_subimage(len(parts), 0):
        spec = file.spec()
        pixels = numpy.asarray(file.read_image(len(parts), 0, 0, spec.nchannels, OpenImageIO.FLOAT))
        parts.append(spec.getattribute("name") or "")
        for number, channel in enumerate(spec.channelnames):
            found[channel] = pixels[..., number]
    return found, parts


whole, one = channels(sys.argv[1])
apart, several = channels(sys.argv[2])
print(several)
assert len(one) == 1 and len(several) > 3, (one, several)
assert set(apart) == set(whole), (sorted(apart), sorted(whole))
for channel, pixels in whole.items():
    assert numpy.array_equal(pixels, apart[channel], equal_nan=True), channel
