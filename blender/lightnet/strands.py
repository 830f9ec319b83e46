"""Strands of hair as files of Mitsuba's `bsplinecurve`. Knows nothing of Blender."""

import math

import numpy

least_points = 3


def through(points):
    """Control points (s, n + 2, k) of uniform cubic B-splines that go through points (s, n, k), straight at their ends."""
    count = points.shape[1]
    matrix = numpy.zeros((count, count))
    matrix[0, 0] = matrix[-1, -1] = 1
    for i in range(1, count - 1):
        matrix[i, i - 1 : i + 2] = 1 / 6, 4 / 6, 1 / 6
    inner = numpy.einsum("ij,sjk->sik", numpy.linalg.inv(matrix), points)
    first, last = 2 * inner[:, :1] - inner[:, 1:2], 2 * inner[:, -1:] - inner[:, -2:-1]
    return numpy.concatenate((first, inner, last), axis=1)


def along(places):
    """How far along its strand each point lies, 0 to 1, of places (s, n, 3)."""
    steps = numpy.linalg.norm(numpy.diff(places, axis=1), axis=2)
    lengths = numpy.concatenate((numpy.zeros((len(places), 1)), numpy.cumsum(steps, axis=1)), axis=1)
    return lengths / numpy.maximum(lengths[:, -1:], 1e-30)


def radii(part, root, tip, shape, closed):
    """Of Blender's hair at parts (s, n) of its length; shape: -1 to 1, thin or thick between; closed: ends in a point."""
    power = 1 + shape if shape < 0 else 1 / max(1 - shape, 1e-6)
    found = (1 - part) ** power * (root - tip) + tip
    if closed:
        found[:, -1] = 0
    return found


def text(groups):
    """The bytes of a file, of groups of strands (s, n, 4) with places and radii. Those without a length are left out."""
    lines = []
    for points in groups:
        points = refined(points)
        long = numpy.linalg.norm(numpy.diff(points[..., :3], axis=1), axis=2).sum(axis=1) > 0
        for strand in through(points[long & numpy.isfinite(points).all(axis=(1, 2))]):
            strand[:, 3] = strand[:, 3].clip(0, None)
            lines += ["%.7g %.7g %.7g %.7g" % tuple(point) for point in strand]
            lines.append("")
    return ("\n".join(lines) + "\n").encode() if lines else b""


def refined(points):
    """With points half-way, where there are too few."""
    while points.shape[1] < least_points:
        whole = numpy.empty((len(points), 2 * points.shape[1] - 1, points.shape[2]), points.dtype)
        whole[:, ::2], whole[:, 1::2] = points, (points[:, :-1] + points[:, 1:]) / 2
        points = whole
    return points


def absorption_of_melanin(melanin, redness):
    """Of Blender's melanin, 0 to 1, and its share of pheomelanin: d'Eon et al. 2011, by radius."""
    amount = -math.log(max(1 - melanin, 1e-4))
    eumelanin, pheomelanin = amount * (1 - redness), amount * redness
    return eumelanin * numpy.array((0.506, 0.841, 1.653)) + pheomelanin * numpy.array((0.343, 0.733, 1.924))


def absorption_of_colour(colour, around):
    """That which makes hair look so, of an azimuthal roughness: Chiang et al. 2016, equation 9."""
    b = around
    whole = 5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + b * 0.245))))
    return (numpy.log(numpy.clip(colour, 1e-5, 1)) / whole) ** 2
