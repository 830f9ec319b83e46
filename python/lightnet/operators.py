"""Operators that are Python functions: columns in, columns out."""

import contextlib
import functools
import hashlib
import inspect
import itertools
import os
import socket
import struct
import threading
import weakref

import numpy

from .errors import Error, UserError
from .graph import Node

elsewhere = ("hosts", "local_workers", "ssh")  # options that let other processes answer
longest_path = 100  # bytes, of a socket

_known = weakref.WeakValueDictionary()  # functions that live, by the names that graphs have for them
_making = threading.Lock()


class Questions:
    """The questions of one call. Row i of every array belongs to question i: an answer may depend on its own row alone,
    for how many questions come at once, and which, differs from mode to mode.

    p, n, out, albedo: (count, 3), float32: position (scene units), normal on the side that is asked about, direction
    that the answer goes to, and what of the surface scatters evenly.
    """

    def __init__(self, line, count):
        self._line, self._count, self._columns = line, count, {}

    def __len__(self):
        return self._count

    def _column(self, kind):
        if kind not in self._columns:
            self._columns[kind] = self._line.wants(kind, b"", 3, self._count)
        return self._columns[kind]

    p = property(lambda self: self._column(b"p"))
    n = property(lambda self: self._column(b"n"))
    out = property(lambda self: self._column(b"o"))
    albedo = property(lambda self: self._column(b"a"))

    def random(self, which=0, of=1):
        """Point `which` (from 0) of `of` points of each question in the unit square, well spread over all samples of a
        pixel: (count, 2). Other random numbers would not be the same in every mode."""
        if not 0 <= which < of <= 65536:
            raise ValueError("random(which, of) gives point which of so many, from 0, and there are 65536 at most")
        return self._line.wants(b"r", struct.pack("<II", which, of), 2, self._count)

    def hemisphere(self, normals, points):
        """Directions around normals, as many as their cosine: q.hemisphere(q.n, q.random())."""
        return self._line.wants(b"h", self._rows(normals, 3) + self._rows(points, 2), 3, self._count)

    def open(self, directions, distance=0):
        """Where nothing is in the way, as far as `distance` (scene units; 0: however far): (count,), bool."""
        packed = struct.pack("<f", distance) + self._rows(directions, 3)
        return self._line.wants(b"f", packed, 1, self._count)[:, 0] != 0

    def _rows(self, array, width):
        rows = numpy.ascontiguousarray(array, "<f4")
        if rows.shape != (self._count, width):
            raise ValueError(f"wants an array of shape ({self._count}, {width}), not {rows.shape}")
        return rows.tobytes()


class _Line:
    """One line of a run to its functions, which serves one call after the other."""

    def __init__(self, connection):
        self._connection, self._stream = connection, connection.makefile("rb")

    def hear(self):
        """Kind and bytes of the next message; None: the run is over."""
        head = self._stream.read(5)
        if len(head) < 5:
            return None
        length = int.from_bytes(head[1:], "little")
        data = self._stream.read(length)
        return (head[:1], data) if len(data) == length else None

    def say(self, kind, data):
        self._connection.sendall(kind + len(data).to_bytes(4, "little") + data)

    def wants(self, kind, data, width, count):
        self.say(kind, data)
        heard = self.hear()
        if heard is None:
            raise _Over
        return numpy.frombuffer(heard[1], "<f4").reshape(count, width)

    def close(self):
        self._stream.close()
        self._connection.close()


class _Over(Exception):
    """Nobody wants the answer any more."""


def _answer(function, line, count, inputs):
    """The value of a function, as bytes of one or three numbers for each question."""

    def ask(index=0, directions=None):
        if not 0 <= index < inputs:
            raise IndexError(f"there {'is' if inputs == 1 else 'are'} {inputs} to ask, from 0, and no input {index}")
        packed = struct.pack("<I", index)
        if directions is None:
            return line.wants(b"i", packed, 3, count)
        return line.wants(b"d", packed + questions._rows(directions, 3), 3, count)

    questions = Questions(line, count)
    value = numpy.asarray(function(questions, ask), "<f4")
    if value.shape not in ((), (count,), (count, 1), (count, 3)):
        raise ValueError(
            f"{function.__name__} returns one number, or an array of shape ({count},) or ({count}, 3), not {value.shape}"
        )
    width = value.shape[1] if value.ndim == 2 else 1
    return numpy.ascontiguousarray(numpy.broadcast_to(value.reshape(-1, width), (count, width))).tobytes()


class Served:
    """Answers for the functions of this process, to the run that `environment` and `options` are handed to."""

    def __init__(self, folder):
        path = os.path.join(folder, "functions")
        if len(os.fsencode(path)) > longest_path:
            raise Error(f"{path}: too long for the name of a socket; $TMPDIR may name a shorter folder")
        self.environment, self.failure = {"LIGHTNET_OUTSIDE": path}, None
        self.options = {"cache": "none"}  # what nodes learn by a function goes into no other run: it may be another by then
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(path)
        self._listener.listen(64)
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        while True:
            try:
                connection, _ = self._listener.accept()
            except OSError:
                return  # closed
            threading.Thread(target=self._serve, args=(_Line(connection),), daemon=True).start()

    def _serve(self, line):
        with contextlib.closing(line):
            try:
                while (heard := line.hear()) is not None:
                    self._call(line, heard[1])
            except (_Over, OSError):
                pass

    def _call(self, line, opening):
        count, inputs = struct.unpack_from("<II", opening)
        name = opening[8:].decode()
        try:
            function = _known.get(name)
            if function is None:
                raise Error(f"there is no function {name!r} here any more")
            said = b"v", _answer(function, line, count, inputs)
        except (_Over, OSError):
            raise
        except BaseException as problem:  # the run ends with it
            self.failure = self.failure or problem
            said = b"e", f"{name}: {type(problem).__name__}: {problem}".encode()[:60000]
        line.say(*said)

    def close(self):
        with contextlib.suppress(OSError):
            self._listener.shutdown(socket.SHUT_RDWR)  # close() alone would not wake who accepts
        self._listener.close()


class _Nobody:
    """What is served where a graph has no functions."""

    environment, options, failure = {}, {}, None

    def close(self):
        pass


def served(image, folder, options):
    """Whoever answers for the functions of a graph while it is rendered; to be closed. Raises UserError where options
    let processes answer that can't ask this one."""
    names = sorted(node.function_name for node in _called_in(image))
    if not names:
        return _Nobody()
    for option in elsewhere:
        if options.get(option):
            raise UserError(
                f"{option}: {names[0]!r} is a function of this Python process, which other processes can't ask; "
                "threads=… can, and functions in Lua travel (Custom)"
            )
    return Served(folder)


def _called_in(value, seen=None):
    """All nodes of functions that a graph has."""
    seen = set() if seen is None else seen
    if isinstance(value, Node):
        if id(value) in seen:
            return
        seen.add(id(value))
        if isinstance(value, Called):
            yield value
        value = [*value.entries, *value.params.values()]
    elif isinstance(value, dict):
        value = value.values()
    elif not isinstance(value, (list, tuple)):
        return
    for one in value:
        yield from _called_in(one, seen)


class Called(Node):
    """A node that a function answers for. Made by calling what operator() makes."""

    kind = "Outside"

    def __init__(self, function, inputs, name, constants):
        self.function = functools.partial(function, **constants)
        functools.update_wrapper(self.function, function)
        self.function_name = _named(self.function, constants)
        super().__init__(*inputs, name=name, function=self.function_name)

    def _called(self):
        return self.name or self.function.__name__.strip("<>")


def _named(function, constants):
    """A name that no other function has. It goes by what the function says, so that pictures of one script say the same of
    themselves each time."""
    try:
        text = inspect.getsource(function.func)
    except (OSError, TypeError):
        text = repr(getattr(function.func, "__code__", function.func))
    said = hashlib.sha256(f"{text}{sorted(constants.items())!r}".encode()).hexdigest()[:12]
    with _making:
        for number in itertools.count(1):
            name = f"{function.__name__} {said}" + (f" {number}" if number > 1 else "")
            if name not in _known:
                _known[name] = function
                return name


def operator(function):
    """Makes an operator of a function, in place of one that is written in C++ or Lua:

        @ln.operator
        def facing(q, ask, power=1):
            return numpy.abs((q.n * q.out).sum(axis=1)) ** power * 0.5 + ask(0).mean(axis=1)

        light = facing(direct, power=2, name="facing")     # a node, with what its function is to be called with

    The function is called with Questions and with `ask`: ask(i) is what input i (from 0) answers to the same questions,
    ask(i, directions) the light that arrives from there and that some surface has scattered; (count, 3), radiance in
    W·sr⁻¹·m⁻². It returns radiance, as an array of shape (count,) or (count, 3), or one number.

    It is called in threads of this process, several at a time where a run has several, with a few thousand questions
    each. Rows must not meet, and nothing may be remembered from call to call: then bits are the same with any number
    of threads. Hosts and local workers can't ask it. What it raises, render() raises.
    """

    @functools.wraps(function)
    def make(*inputs, name=None, **constants):
        return Called(function, inputs, name, constants)

    return make
