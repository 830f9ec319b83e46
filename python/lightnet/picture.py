"""Pictures, whose pixels are NumPy arrays that lie in the memory which the program wrote them to."""

import json
import mmap
import os
import zipfile

import numpy

from . import program


class Picture:
    """A picture and what it is the sum of: linear RGB with the primaries of BT.709, float32, (height, width, 3), row 0
    on top. Arrays are views of one mapped block of memory, which lives as long as any of them; they can be written to,
    and no file changes.

    beauty: the whole picture, exactly the float32 sum of its layers times their gains, from the left to the right.
    layers: what each operator, group of lamps or path expression adds, by name, without gains.
    shown: what else the graph shows (AOVs): (height, width) for depths, (…, 2) for texture coordinates, else (…, 3).
    mattes: ids and parts of what is seen, (height, width, ranks, 2); `mask(name)` makes a mask of them.
    alpha, samples: (height, width), or None. gains: of the layers. notes, matrices: what the file says of itself.
    done: how much of the work is in it, 1 when it is finished. report: what `x.run.json` tells of the run.
    """

    def __init__(self, npz, exr=None, png=None, report=None, message=""):
        with open(npz, "rb") as file:
            memory = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_COPY)
            facts, arrays = _members(file, memory)
        self.width, self.height = facts["width"], facts["height"]
        self.place = facts["x"], facts["y"], facts["whole_width"], facts["whole_height"]
        self.done, self.notes, self.matrices = facts["done"], facts["notes"], facts["matrices"]
        self.beauty = arrays["beauty"]
        self.layers = {layer["name"]: arrays["layers/" + layer["name"]] for layer in facts["layers"]}
        self.gains = {layer["name"]: tuple(layer["gain"]) for layer in facts["layers"]}
        self.shown = {one["name"]: _of_letters(arrays["shown/" + one["name"]], one["letters"]) for one in facts["shown"]}
        self.mattes = {matte["name"]: arrays["mattes/" + matte["name"]] for matte in facts["mattes"]}
        self.manifests = {matte["name"]: json.loads(matte["manifest"] or "{}") for matte in facts["mattes"]}
        self.alpha, self.samples = arrays.get("alpha"), arrays.get("samples")
        self.report, self.message = report or {}, message
        self._compression, self._png = facts["compression"], png
        self._exr = os.open(exr, os.O_RDONLY) if exr else None

    def __del__(self):
        if getattr(self, "_exr", None) is not None:
            os.close(self._exr)

    def __repr__(self):
        state = "" if self.done == 1 else f", {100 * self.done:.0f} % done"
        return f"<Picture {self.width}x{self.height}, layers: {', '.join(self.layers)}{state}>"

    def __getitem__(self, name):
        """A layer, or what is shown beside them."""
        for arrays in (self.layers, self.shown):
            if name in arrays:
                return arrays[name]
        raise KeyError(f"no layer is called {name!r}; there are {', '.join([*self.layers, *self.shown])}")

    def __array__(self, dtype=None, copy=None):
        return numpy.asarray(self.beauty, dtype) if not copy else numpy.array(self.beauty, dtype)

    def mask(self, name, matte=None):
        """How much of each pixel that covers which has this name in a matte (the first, if none is named)."""
        matte = matte or next(iter(self.mattes))
        bits = numpy.uint32(int(self.manifests[matte][name], 16))
        ids = numpy.ascontiguousarray(self.mattes[matte][..., 0]).view(numpy.uint32)
        return numpy.where(ids == bits, self.mattes[matte][..., 1], 0).sum(-1)

    def mixed(self, **gains):
        """The beauty with other gains of its layers, by the same sum in the same order: the bits of `lightnet remix`."""
        unknown = set(gains) - set(self.layers)
        if unknown:
            raise KeyError(f"no layer is called {', '.join(sorted(unknown))}; there are {', '.join(self.layers)}")
        total = numpy.zeros_like(self.beauty)
        for name, pixels in self.layers.items():
            total += pixels * numpy.asarray(gains.get(name, 1), numpy.float32)
        return total

    def save(self, file, **options):
        """Writes it as `lightnet run` would have: x.exr, with x.png beside it. Options are those of `lightnet remix`:
        compression, view, exposure, alpha, npz. Raises Error."""
        if self._exr is None:
            raise ValueError("a picture that is not finished can't be saved")
        options.setdefault("compression", "zip" if self._compression == "none" else self._compression)
        source = f"/proc/self/fd/{self._exr}"
        program.said(
            "remix", source, "--keep-gains", "-o", os.fspath(file), *program.flags(options), pass_fds=(self._exr,)
        )

    def _repr_png_(self):
        return self._png


def read(file):
    """A picture that `lightnet` has written as EXR. Raises Error."""
    with program.folder() as folder:
        exr = os.path.join(folder, "picture.exr")
        program.said("remix", os.fspath(file), "-o", exr, "--compression", "none", "--npz", exr[:-3] + "npz", "--keep-gains")
        return in_folder(folder)


def in_folder(folder, message="", whole=True):
    """The picture that a run has left there. `whole`: it is finished, and can be saved."""
    beside = lambda ending: os.path.join(folder, "picture" + ending)
    report = None
    if os.path.exists(beside(".run.json")):
        with open(beside(".run.json"), encoding="utf-8") as file:
            report = json.load(file)
    with open(beside(".png"), "rb") as file:
        png = file.read()
    return Picture(beside(".npz"), beside(".exr") if whole else None, png, report, message)


def _of_letters(pixels, letters):
    return pixels[..., 0] if len(letters) == 1 else pixels[..., : len(letters)]


def _members(file, memory):
    """The JSON of an archive, and its arrays, as views of its bytes."""
    arrays, facts = {}, None
    with zipfile.ZipFile(file) as archive:
        for member in archive.infolist():
            if member.filename == "picture.json":
                facts = json.loads(archive.read(member))
                continue
            with archive.open(member) as stream:
                numpy.lib.format.read_magic(stream)
                shape, _, dtype = numpy.lib.format.read_array_header_1_0(stream)
            count = int(numpy.prod(shape))
            begin = _data_of(memory, member) + member.file_size - count * dtype.itemsize
            arrays[member.filename[:-4]] = numpy.frombuffer(memory, dtype, count, begin).reshape(shape)
    return facts, arrays


def _data_of(memory, member):
    at = member.header_offset
    length = lambda offset: int.from_bytes(memory[at + offset : at + offset + 2], "little")
    return at + 30 + length(26) + length(28)
