"""Pictures that the program has written as arrays (`--npz`). Knows nothing of Blender."""

import io
import json
import zipfile

import numpy


class Picture:
    """beauty (height, width, 3), layers and shown by name, mattes (height, width, ranks, 2); row 0 on top."""

    def __init__(self, file):
        with zipfile.ZipFile(file) as archive:
            arrays = {}
            for name in archive.namelist():
                data = archive.read(name)
                if name.endswith(".npy"):
                    arrays[name[:-4]] = numpy.load(io.BytesIO(data))
                else:
                    facts = json.loads(data)
        self.beauty, self.alpha, self.facts = arrays["beauty"], arrays.get("alpha"), facts
        self.layers = {one["name"]: arrays["layers/" + one["name"]] for one in facts["layers"]}
        self.shown = {one["name"]: arrays["shown/" + one["name"]] for one in facts["shown"]}
        self.mattes = {one["name"]: arrays["mattes/" + one["name"]] for one in facts["mattes"]}
        self.manifests = {one["name"]: one["manifest"] or "{}" for one in facts["mattes"]}

    def combined(self):
        """(height, width, 4)."""
        alpha = numpy.ones(self.beauty.shape[:2], numpy.float32) if self.alpha is None else self.alpha.reshape(self.beauty.shape[:2])
        return numpy.concatenate((self.beauty, alpha[..., None]), axis=-1)

    def passes(self, groups=()):
        """All that there is, by Blender's names of passes, as (height, width, channels)."""
        found = {"Combined": self.combined()}
        for name, pixels in self.layers.items():
            found["Layer " + name] = pixels
            if "." not in name:  # without groups, all is of the rest
                found[f"Layer {name}.rest"] = pixels
            if name.split(".")[0] == "emission":
                found["Emit"] = found.get("Emit", 0) + pixels
        for group in groups:
            parts = [pixels for name, pixels in self.layers.items() if name.split(".")[-1] == group]
            if parts:
                found["Combined_" + group] = numpy.sum(parts, axis=0)
        for name, pixels in self.shown.items():
            found[name] = pixels if pixels.ndim == 3 else pixels[..., None]
        for name, ranks in self.mattes.items():
            pairs = ranks.reshape(*ranks.shape[:2], -1)
            for index in range(pairs.shape[2] // 4):
                found[f"{name}{index:02d}"] = pairs[..., 4 * index : 4 * index + 4]
        return found
