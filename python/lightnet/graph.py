"""Graphs as values: nodes that name each other, and what the program reads of them."""

import json
import math
import numbers
import os
import re
import sys

from . import program

_here = os.path.dirname(os.path.abspath(__file__))


def _caller():
    """The file and line outside of this package on which a node is made."""
    frame = sys._getframe(1)
    while frame and os.path.dirname(os.path.abspath(frame.f_code.co_filename)) == _here:
        frame = frame.f_back
    if not frame:
        return ["python", 0]
    file = frame.f_code.co_filename
    inside = os.path.relpath(file) if os.path.isabs(file) and os.path.exists(file) else file
    return [file if inside.startswith("..") else inside, frame.f_lineno]


def _snake(kind):
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", kind).lower()


class Node:
    """A node of a graph. Inputs come first, parameters by name. `name` is what layers, hosts and random numbers go by;
    without one a node is called after its kind (`direct_lighting`, then `direct_lighting_2`). A value: it can stand in
    any number of graphs."""

    kind = ""
    role = "light"

    def __init__(self, *entries, name=None, **params):
        # what is a word of Python has a line behind it: except_
        self.entries, self.params, self.name = entries, {key.rstrip("_"): value for key, value in params.items()}, name
        self._where = _caller()

    def __repr__(self):
        inside = [repr(entry) if not isinstance(entry, Node) else entry._called() for entry in self.entries]
        inside += [f"{key}={value._called() if isinstance(value, Node) else value!r}" for key, value in self.params.items()]
        return f"{self.kind}({', '.join(inside)})"

    def _called(self):
        return self.name or _snake(self.kind)

    def _repr_svg_(self):
        return drawn(self)


class _Writer:
    """One graph on its way to the program."""

    def __init__(self, folder):
        self.names, self.taken, self.nodes, self.folder = {}, set(), [], folder

    def name_of(self, node):
        if id(node) not in self.names:
            self.names[id(node)] = self.free(node)
            self.write(node)
        return self.names[id(node)]

    def free(self, node):
        name, count = node._called(), 1
        while not node.name and name in self.taken:
            count += 1
            name = f"{node._called()}_{count}"
        self.taken.add(name)
        return name

    def write(self, node):
        name = self.names[id(node)]
        entries = [self.value(entry) for entry in node.entries]
        params = {key: self.value(value) for key, value in node.params.items() if value is not None}
        if "film" in params and isinstance(node.params["film"], dict):
            params["film"] = self.film(node.params["film"])
        self.nodes.append({"name": name, "kind": node.kind, "entries": entries, "params": params, "where": node._where})

    def film(self, film):
        rest = dict(film)
        size = self.value(list(rest.pop("size", (512, 512))))
        return {"list": size["list"], "named": self.value(rest)["named"]}

    def value(self, value):
        if isinstance(value, Node):
            return {"node": self.name_of(value)}
        if hasattr(value, "_write_scene"):
            return value._write_scene(self.folder)
        if isinstance(value, (bool, str)):
            return value
        if hasattr(value, "__fspath__"):
            return os.fspath(value)
        if isinstance(value, dict):
            return {"list": [], "named": {str(key): self.value(one) for key, one in value.items()}}
        if isinstance(value, numbers.Number) or getattr(value, "ndim", None) == 0:
            number = float(value)
            return number if math.isfinite(number) else {"number": repr(number)}
        return {"list": [self.value(one) for one in value], "named": {}}


class File:
    """A graph file, and what its constants are to be (`-D`)."""

    def __init__(self, file, **constants):
        self.file, self.constants = os.fspath(file), constants

    def __repr__(self):
        return f"load({self.file!r}{''.join(f', {key}={value!r}' for key, value in self.constants.items())})"

    def _repr_svg_(self):
        return drawn(self)


def load(file, **constants):
    """The graph of a Lua file. Keywords override constants of the file, as -D does: `load("g.lua", photons=1000)`."""
    return File(file, **constants)


def as_json(image, folder=None):
    """The graph of the node that makes the image, as the program reads it. Scenes that are made of arrays are written
    into `folder`."""
    writer = _Writer(folder)
    writer.name_of(image)
    return json.dumps({"file": "<python>", "nodes": writer.nodes})


def words_of(image, folder=None):
    """The words of a command line that name a graph, and the text for its standard input (None: it has none)."""
    if isinstance(image, Node):
        return ["-"], as_json(image, folder)
    if not isinstance(image, File):
        image = File(image)
    constants = [word for key, value in image.constants.items() for word in ("-D", f"{key}={_text(value)}")]
    return [image.file, *constants], None


def _text(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def check(image, **options):
    """What `lightnet check` says of a graph that is sound. Raises UserError with all mistakes of one that isn't."""
    with program.folder() as folder:
        words, text = words_of(image, folder)
        return program.said("check", *words, *program.flags(options), text=text)


def dot(image, **options):
    """The graph in Graphviz's language."""
    with program.folder() as folder:
        words, text = words_of(image, folder)
        return program.said("dot", *words, *program.flags(options), text=text)


def drawn(image):
    """The graph as SVG, where Graphviz is installed; else None."""
    import shutil
    import subprocess

    if not shutil.which("dot"):
        return None
    return subprocess.run(["dot", "-Tsvg"], input=dot(image), capture_output=True, text=True, check=True).stdout
