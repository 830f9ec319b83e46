"""Colours and pictures, and what nodes do to them. Knows nothing of Blender.

A value is a constant (an array of 4 numbers, linear RGB and alpha) or a Picture. Functions on values work on each pixel,
so that a chain of nodes over one picture becomes one new picture.
"""

import dataclasses
import hashlib

import numpy

luminance = numpy.array((0.2126, 0.7152, 0.0722), numpy.float32)


@dataclasses.dataclass
class Picture:
    """Pixels on texture coordinates. `file`: where they lie unchanged, else None; `raw`: its numbers are no colours.

    pixels: (height, width, 4), linear, row 0 at the bottom; read when they are wanted.
    mapping: scale x and y, turn in radians, offset x and y; place in the picture = turned(scale * uv) + offset.
    """

    read: object
    file: str = None
    raw: bool = False
    mapping: tuple = (1.0, 1.0, 0.0, 0.0, 0.0)
    wrap: str = "repeat"
    nearest: bool = False
    channel: str = None

    @property
    def pixels(self):
        found = self.read()
        if self.channel == "a":
            return numpy.repeat(found[..., 3:4], 4, axis=2)
        return found

    def lies_as(self, other):
        return (self.mapping, self.wrap) == (other.mapping, other.wrap)

    def changed(self, pixels):
        return Picture(lambda: pixels, None, True, self.mapping, self.wrap, self.nearest)


def constant(*numbers):
    """Of one number, of three, or of four."""
    if len(numbers) == 1:
        numbers *= 3
    return numpy.array((*numbers[:3], numbers[3] if len(numbers) > 3 else 1), numpy.float32)


def is_constant(value):
    return not isinstance(value, Picture)


def pixels_of(value):
    return value if is_constant(value) else value.pixels


def mean(value):
    """The constant that stands best for it."""
    return value if is_constant(value) else value.pixels.mean(axis=(0, 1))


def grey(value):
    """As a number: that of all three channels."""
    if is_constant(value):
        return constant(float(value[:3] @ luminance))
    found = value.pixels
    first = found[..., :1]
    if value.channel or numpy.array_equal(found[..., 1:3], numpy.repeat(first, 2, axis=2)):
        return value
    return value.changed(numpy.repeat((found[..., :3] @ luminance)[..., None], 4, axis=2))


def number(value):
    """A constant's number, or the mean of a picture's."""
    return float(mean(value)[:3] @ luminance)


def combined(function, *values):
    """The function of arrays (…, 4), pixel by pixel. Of pictures that lie otherwise than the first, the mean is taken."""
    pictures = [value for value in values if not is_constant(value)]
    if not pictures:
        return numpy.asarray(function(*values), numpy.float32)
    first = max(pictures, key=lambda one: one.pixels.size)
    shape = first.pixels.shape
    arrays = []
    for value in values:
        if not is_constant(value) and not (first.lies_as(value) and value.pixels.shape == shape):
            value = mean(value)
        arrays.append(pixels_of(value))
    result = numpy.broadcast_to(numpy.asarray(function(*arrays), numpy.float32), shape)
    return first.changed(result)


def mixed(a, b, share):
    """a where the share is 0, b where it is 1."""
    return combined(lambda x, y, t: x + (y - x) * t[..., :1], a, b, share)


def scaled(value, factor):
    if is_constant(factor) and numpy.all(factor[:3] == 1):
        return value
    if is_constant(value) and numpy.all(value[:3] == 1):
        return factor
    return combined(lambda x, y: x * y, value, factor)


def is_black(value):
    return is_constant(value) and not numpy.any(value[:3] > 0)


def linear(encoded):
    """sRGB's curve taken back."""
    low = encoded / 12.92
    high = ((numpy.maximum(encoded, 0.04045) + 0.055) / 1.055) ** 2.4
    return numpy.where(encoded <= 0.04045, low, high)


def pfm(pixels):
    """The bytes of a PFM file, colours of (height, width, 4), row 0 at the bottom as PFM has it."""
    height, width = pixels.shape[:2]
    data = numpy.ascontiguousarray(pixels[..., :3], "<f4")
    return f"PF\n{width} {height}\n-1.0\n".encode() + data.tobytes()


def name_of(data):
    """Of a file by what is in it."""
    return hashlib.blake2b(data, digest_size=12).hexdigest()
