"""Scenes made of arrays, with no file of the user's: they go to the program as binary meshes, in memory."""

import os
import re

import numpy

from .errors import UserError

_points = {"from", "to"}
_spectra = {"eta", "k"}
_colours = {"L", "I", "reflectance", "transmittance"}


class Mesh:
    """Triangles of one material.

    vertices: (n, 3), in scene units. indices: (m, 3), whole numbers below n, counterclockwise as seen from outside.
    normals: (n, 3), else the triangles' own. uv: (n, 2), else none.
    material: a dict of pbrt's parameters: {"type": "diffuse", "reflectance": (0.8, 0.2, 0.2)}, {"type": "conductor",
    "eta": "metal-Cu-eta", "k": "metal-Cu-k", "roughness": 0.1}; the name of a picture stands for a texture of it.
    emission: the radiance that it sends out, (r, g, b), W·sr⁻¹·m⁻². name: what mattes and Select call it.
    """

    def __init__(self, vertices, indices, normals=None, uv=None, material=None, emission=None, name="mesh"):
        self.name = name
        self.vertices = self._array("vertices", vertices, "<f4", 3)
        self.indices = self._array("indices", indices, "<i4", 3)
        self.normals = None if normals is None else self._array("normals", normals, "<f4", 3)
        self.uv = None if uv is None else self._array("uv", uv, "<f4", 2)
        self.material = dict(material or {"type": "diffuse", "reflectance": (0.5, 0.5, 0.5)})
        self.emission = emission
        if not re.fullmatch(r"[\w.-]+", name):
            raise UserError(f"Mesh {name!r}: a name is made of letters, digits and . _ -")
        for what, values in (("normals", self.normals), ("uv", self.uv)):
            if values is not None and len(values) != len(self.vertices):
                raise UserError(f"Mesh {name!r}: {len(values)} {what} for {len(self.vertices)} vertices")
        if len(self.indices) and not (0 <= self.indices.min() and self.indices.max() < len(self.vertices)):
            raise UserError(f"Mesh {name!r}: indices must be from 0 to {len(self.vertices) - 1}")

    def _array(self, what, values, dtype, width):
        array = numpy.asarray(values)
        if array.ndim != 2 or array.shape[1] != width:
            raise UserError(f"Mesh {self.name!r}: {what} must be of shape (n, {width}), not {array.shape}")
        if dtype == "<i4" and not numpy.issubdtype(array.dtype, numpy.integer):
            raise UserError(f"Mesh {self.name!r}: {what} must be whole numbers, not {array.dtype}")
        return numpy.ascontiguousarray(array, dtype)

    def _write(self, file):
        columns = [("x", self.vertices), ("n", self.normals), ("u", self.uv)]
        names = {"x": ["x", "y", "z"], "n": ["nx", "ny", "nz"], "u": ["u", "v"]}
        there = [(names[key], values) for key, values in columns if values is not None]
        properties = "".join(f"property float {name}\n" for words, _ in there for name in words)
        faces = numpy.empty(len(self.indices), numpy.dtype([("count", "u1"), ("corners", "<i4", 3)]))
        faces["count"], faces["corners"] = 3, self.indices
        with open(file, "wb") as out:
            out.write(
                f"ply\nformat binary_little_endian 1.0\nelement vertex {len(self.vertices)}\n{properties}"
                f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n".encode()
            )
            numpy.concatenate([values for _, values in there], 1).tofile(out)
            faces.tofile(out)


class Lamp:
    """A lamp without a surface, by pbrt's names: Lamp("point", I=(5, 5, 5), **{"from": (0, 2, 0)}), Lamp("distant",
    L=(1, 1, 1), to=(0, -1, 0)), Lamp("infinite", L=(0.4, 0.45, 0.5))."""

    def __init__(self, kind, **params):
        self.kind, self.params = kind, params


class World:
    """All that there is to see: the first argument of Scene, in the place of a file's name. The camera is Scene's."""

    def __init__(self, meshes=(), lamps=()):
        self.meshes, self.lamps = list(meshes), list(lamps)
        names = [mesh.name for mesh in self.meshes]
        for name in names:
            if names.count(name) > 1:
                raise UserError(f"World: {names.count(name)} meshes are called {name!r}; each has a name of its own")

    def _write_scene(self, folder):
        if folder is None:
            return "<arrays>"
        own = os.path.join(folder, f"world{len(os.listdir(folder))}")
        os.mkdir(own)
        lines, textures = ["WorldBegin"], {}
        for lamp in self.lamps:
            lines.append(f'LightSource "{lamp.kind}" {_params(lamp.params, textures)}')
        for mesh in self.meshes:
            mesh._write(os.path.join(own, mesh.name + ".ply"))
            material = dict(mesh.material)
            kind = material.pop("type", "diffuse")
            lines += ["AttributeBegin", f'Material "{kind}" {_params(material, textures)}']
            if mesh.emission is not None:
                lines.append(f'AreaLightSource "diffuse" {_param("L", mesh.emission, textures)}')
            lines += [f'Shape "plymesh" "string filename" "{mesh.name}.ply"', "AttributeEnd"]
        for file, name in textures.items():
            lines.insert(1, f'Texture "{name}" "spectrum" "imagemap" "string filename" "{file}"')
        path = os.path.join(own, "world.pbrt")
        with open(path, "w", encoding="utf-8") as out:
            out.write("\n".join(lines) + "\n")
        return path


def _params(params, textures):
    return " ".join(_param(name, value, textures) for name, value in params.items())


def _param(name, value, textures):
    if isinstance(value, bool):
        return f'"bool {name}" {str(value).lower()}'
    if isinstance(value, str) and name in _spectra:
        return f'"spectrum {name}" "{value}"'
    if isinstance(value, (str, os.PathLike)):
        file = os.path.abspath(value)
        return f'"texture {name}" "{textures.setdefault(file, f"texture{len(textures)}")}"'
    numbers = numpy.asarray(value, float).ravel()
    if numbers.size == 1 and name in _colours:
        numbers = numpy.repeat(numbers, 3)
    kind = "float" if numbers.size == 1 else "point3" if name in _points else "rgb"
    return f'"{kind} {name}" [ {" ".join(repr(float(number)) for number in numbers)} ]'
