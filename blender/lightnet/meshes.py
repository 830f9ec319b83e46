"""Meshes of Blender as PLY files, one for each material of them."""

import numpy


def is_flat(mesh):
    """Are all of its normals those of its polygons?"""
    smooth = numpy.empty(len(mesh.polygons), bool)
    mesh.polygons.foreach_get("use_smooth", smooth)
    return not smooth.any() and not mesh.has_custom_normals


def arrays_of(mesh, flat):
    """Of an evaluated mesh: its vertices, and what triangles make of them.

    Vertices (v, 3); their numbers (n, 3), normals (n, 3, 3) or None (flat) and texture coordinates (n, 3, 2) or None by
    triangle and corner; materials (n).
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
    normals = None if flat else normals_of(mesh)[loops].reshape(-1, 3, 3)
    layer = next((one for one in mesh.uv_layers if one.active_render), None)
    uv = None
    if layer is not None:
        uv = numpy.empty(2 * len(mesh.loops), numpy.float32)
        layer.data.foreach_get("uv", uv)
        uv = uv.reshape(-1, 2)[loops].reshape(-1, 3, 2)
    return places.reshape(-1, 3), corners.reshape(-1, 3), normals, uv, which


def normals_of(mesh):
    """Of each corner of a polygon."""
    found = numpy.empty(3 * len(mesh.loops), numpy.float32)
    if hasattr(mesh, "corner_normals"):
        mesh.corner_normals.foreach_get("vector", found)
    else:
        mesh.calc_normals_split()
        mesh.loops.foreach_get("normal", found)
    return found.reshape(-1, 3)


def shared_corners(places, corners, by_corner):
    """Vertices and triangles, where all corners of each vertex agree; None: they don't. by_corner: arrays (n, 3, k)."""
    first = numpy.empty(len(places), numpy.int64)
    flat = corners.reshape(-1)
    first[flat] = numpy.arange(len(flat))
    same = first[flat]
    parts = [places]
    for one in by_corner:
        found = one.reshape(len(flat), -1)
        if not numpy.array_equal(found, found[same]):
            return None
        parts.append(numpy.zeros((len(places), found.shape[1]), numpy.float32))
        parts[-1][flat] = found
    return numpy.concatenate(parts, axis=1), corners


def ply(places, corners, normals, uv):
    """The bytes of a binary PLY file. Texture coordinates go down, as Mitsuba's do."""
    words, by_corner = ["x", "y", "z"], []
    if normals is not None:
        words += ["nx", "ny", "nz"]
        by_corner.append(normals)
    if uv is not None:
        words += ["u", "v"]
        by_corner.append(numpy.stack((uv[..., 0], 1 - uv[..., 1]), axis=-1))
    found = shared_corners(places, corners, by_corner)
    if found is None:
        parts = [places[corners.reshape(-1)], *(one.reshape(corners.size, -1) for one in by_corner)]
        found = numpy.concatenate(parts, axis=1), numpy.arange(corners.size).reshape(-1, 3)
    vertices, triangles = found
    head = "ply\nformat binary_little_endian 1.0\n" + f"element vertex {len(vertices)}\n"
    head += "".join(f"property float {word}\n" for word in words)
    head += f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    faces = numpy.empty(len(triangles), numpy.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    faces["count"], faces["corners"] = 3, triangles
    return head.encode() + numpy.ascontiguousarray(vertices, "<f4").tobytes() + faces.tobytes()


def parts_of(mesh, flat):
    """A file's bytes for each material's number in a mesh."""
    places, corners, normals, uv, which = arrays_of(mesh, flat)
    for number in numpy.unique(which):
        chosen = which == number
        if chosen.all():
            yield int(number), ply(places, corners, normals, uv)
            continue
        used, renamed = numpy.unique(corners[chosen], return_inverse=True)
        of_part = [None if one is None else one[chosen] for one in (normals, uv)]
        yield int(number), ply(places[used], renamed.reshape(-1, 3), *of_part)
