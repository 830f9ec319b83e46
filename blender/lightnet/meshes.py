"""Meshes as binary PLY files, one for each material."""

import hashlib
import os

import numpy as np


def arrays(mesh):
    """Corners of triangles: (positions, normals, texture coordinates or None), each (triangles, 3, n), and the material's
    slot of each triangle."""
    mesh.calc_loop_triangles()
    mesh.calc_normals_split() if hasattr(mesh, "calc_normals_split") else None
    count = len(mesh.loop_triangles)
    corners = _got(mesh.loop_triangles, "loops", count * 3, np.int32)
    at = _got(mesh.vertices, "co", len(mesh.vertices) * 3, np.float32).reshape(-1, 3)
    of_corner = _got(mesh.loops, "vertex_index", len(mesh.loops), np.int32)
    normals = _got(mesh.loops, "normal", len(mesh.loops) * 3, np.float32).reshape(-1, 3)
    slots = _got(mesh.loop_triangles, "material_index", count, np.int32)
    layer = mesh.uv_layers.active
    uv = _got(layer.data, "uv", len(mesh.loops) * 2, np.float32).reshape(-1, 2)[corners] if layer else None
    if uv is not None:
        uv[:, 1] = 1 - uv[:, 1]  # Mitsuba counts rows of pictures from the top
    return at[of_corner[corners]], normals[corners], uv, slots


def _got(collection, name, count, kind):
    values = np.empty(count, kind)
    collection.foreach_get(name, values)
    return values


def write(folder, mesh):
    """Writes a file for each slot that has triangles; files are named after what is in them, and equal ones are written
    once. Gives {slot: name of the file}."""
    at, normals, uv, slots = arrays(mesh)
    parts = [at.reshape(-1, 3), normals] + ([uv] if uv is not None else [])
    table = np.concatenate(parts, axis=1).astype("<f4").reshape(len(slots), -1)
    return {int(slot): _file(folder, table[slots == slot], uv is not None) for slot in np.unique(slots)}


def _file(folder, rows, has_uv):
    name = hashlib.sha256(rows.tobytes()).hexdigest()[:24] + ".ply"
    path = os.path.join(folder, name)
    if not os.path.exists(path):
        with open(path, "wb") as file:
            file.write(_head(len(rows), has_uv))
            file.write(rows.tobytes())
            file.write(_faces(len(rows)).tobytes())
    return name


def _head(triangles, has_uv):
    names = ["x", "y", "z", "nx", "ny", "nz"] + (["u", "v"] if has_uv else [])
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {3 * triangles}"]
    lines += [f"property float {name}" for name in names]
    lines += [f"element face {triangles}", "property list uchar int vertex_indices", "end_header"]
    return ("\n".join(lines) + "\n").encode()


def _faces(triangles):
    faces = np.empty(triangles, np.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    faces["count"] = 3
    faces["corners"] = np.arange(3 * triangles).reshape(-1, 3)
    return faces
