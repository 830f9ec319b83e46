"""Meshes of Blender as PLY files, one for each material of them."""

import numpy

from . import values


def arrays_of(mesh):
    """Of an evaluated mesh: its vertices, and what triangles make of them.

    Vertices (v, 3); their numbers (n, 3), normals (n, 3, 3) and texture coordinates (n, 3, 2) or None by triangle and
    corner; materials (n).
    """
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    loops, corners = numpy.empty(3 * count, numpy.int32), numpy.empty(3 * count, numpy.int32)
    mesh.loop_triangles.foreach_get("loops", loops)
    mesh.loop_triangles.foreach_get("vertices", corners)
    which = numpy.empty(count, numpy.int32)
    mesh.loop_triangles.foreach_get("material_index", which)
    places = numpy.empty(3 * len(mesh.vertices), numpy.float32)
    mesh.vertices.foreach_get("co", places)
    normals = normals_of(mesh)
    layer = next((one for one in mesh.uv_layers if one.active_render), None)
    uv = None
    if layer is not None:
        uv = numpy.empty(2 * len(mesh.loops), numpy.float32)
        layer.data.foreach_get("uv", uv)
        uv = uv.reshape(-1, 2)[loops].reshape(-1, 3, 2)
    return places.reshape(-1, 3), corners.reshape(-1, 3), normals[loops].reshape(-1, 3, 3), uv, which


def normals_of(mesh):
    """Of each corner of a polygon."""
    found = numpy.empty(3 * len(mesh.loops), numpy.float32)
    if hasattr(mesh, "corner_normals"):
        mesh.corner_normals.foreach_get("vector", found)
    else:
        mesh.calc_normals_split()
        mesh.loops.foreach_get("normal", found)
    return found.reshape(-1, 3)


def shared_corners(places, corners, normals, uv):
    """Vertices and triangles, where all corners of each vertex agree; None: they don't."""
    first = numpy.empty(len(places), numpy.int64)
    flat = corners.reshape(-1)
    first[flat] = numpy.arange(len(flat))
    same = first[flat]
    flat_normals = normals.reshape(-1, 3)
    if not numpy.array_equal(flat_normals, flat_normals[same]):
        return None
    parts = [places, numpy.zeros_like(places)]
    parts[1][flat] = flat_normals
    if uv is not None:
        flat_uv = uv.reshape(-1, 2)
        if not numpy.array_equal(flat_uv, flat_uv[same]):
            return None
        parts.append(numpy.zeros((len(places), 2), numpy.float32))
        parts[2][flat] = flat_uv
    return numpy.concatenate(parts, axis=1), corners


def ply(places, corners, normals, uv):
    """The bytes of a binary PLY file. Texture coordinates go down, as Mitsuba's do."""
    if uv is not None:
        uv = numpy.stack((uv[..., 0], 1 - uv[..., 1]), axis=-1)
    found = shared_corners(places, corners, normals, uv)
    if found is None:
        parts = [places[corners.reshape(-1)], normals.reshape(-1, 3)] + ([uv.reshape(-1, 2)] if uv is not None else [])
        found = numpy.concatenate(parts, axis=1), numpy.arange(corners.size).reshape(-1, 3)
    vertices, triangles = found
    words = ["x", "y", "z", "nx", "ny", "nz"] + (["u", "v"] if uv is not None else [])
    head = "ply\nformat binary_little_endian 1.0\n" + f"element vertex {len(vertices)}\n"
    head += "".join(f"property float {word}\n" for word in words)
    head += f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    faces = numpy.empty(len(triangles), numpy.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    faces["count"], faces["corners"] = 3, triangles
    return head.encode() + numpy.ascontiguousarray(vertices, "<f4").tobytes() + faces.tobytes()


def parts_of(mesh):
    """A file's bytes for each material's number in a mesh."""
    places, corners, normals, uv, which = arrays_of(mesh)
    for number in numpy.unique(which):
        chosen = which == number
        if chosen.all():
            yield int(number), ply(places, corners, normals, uv)
            continue
        used, renamed = numpy.unique(corners[chosen], return_inverse=True)
        part_uv = None if uv is None else uv[chosen]
        yield int(number), ply(places[used], renamed.reshape(-1, 3), normals[chosen], part_uv)


def file_name(data):
    return f"mesh-{values.name_of(data)}.ply"
