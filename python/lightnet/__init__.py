"""lightnet: pictures rendered by graphs of light operators, in one thread, in many, or on many machines, with the same
bytes.

    import lightnet as ln
    direct = ln.DirectLighting(name="direct")
    scene = ln.Scene("cornell_box.pbrt")
    picture = ln.render(ln.RayTracer(direct, scene=scene, samples=16), size=(128, 128))
    picture.beauty            # numpy, (128, 128, 3), float32
    picture.layers["direct"]

Constructors are those of `lightnet describe`, with the same parameters; help(ln.RayTracer) shows them.
"""

from .errors import Error, NoProgram, NoWorker, UnknownKey, UserError
from .graph import File, Node, check, dot, load
from .operators import Questions, operator
from .picture import Picture, read
from .race import Race, race
from .run import Run, progress, render
from .scenes import Lamp, Mesh, World
from .session import Session

__all__ = [
    "Error", "File", "Lamp", "Mesh", "NoProgram", "NoWorker", "Node", "Picture", "Questions", "Race", "Run", "Session", "UnknownKey", "UserError",
    "World", "check", "dot", "load", "operator", "progress", "race", "read", "render",
]  # fmt: skip

_classes = {}


def __getattr__(name):
    if name.startswith("_"):
        raise AttributeError(f"module 'lightnet' has no attribute {name!r}")
    if not _classes:
        from .kinds import all_classes

        _classes.update(all_classes())
    if name not in _classes:
        import difflib

        close = difflib.get_close_matches(name, [*_classes, *__all__], 1)
        hint = f" (did you mean {close[0]!r}?)" if close else ""
        raise AttributeError(f"module 'lightnet' has no attribute {name!r}{hint}")
    return _classes[name]


def __dir__():
    __getattr__("Scene")
    return sorted([*__all__, *_classes])
