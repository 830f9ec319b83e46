#!/usr/bin/env python3
"""stubs.py: prints python/lightnet/__init__.pyi, whose constructors are those of `lightnet describe`. Run by
`PYTHONPATH=python LIGHTNET=build/release/bin/lightnet python3 python/stubs.py > python/lightnet/__init__.pyi`; a test
holds the two together."""

import json

from lightnet.kinds import docstring, in_python, schemas

TYPES = {
    "number": "float",
    "integer": "int",
    "flag": "bool",
    "text": "str",
    "numbers": "Sequence[float]",
    "table": "Mapping[str, Any]",
    "table of names": "Mapping[str, str | Sequence[str]]",
    "table of colours": "Mapping[str, float | Sequence[float]]",
    "file or colour": "str | Sequence[float]",
    "film": "Sequence[int] | Mapping[str, Any]",
    "scene": "Node",
    "node": "Node",
    "list of nodes": "Sequence[Node]",
    "name or list of names": "str | Sequence[str]",
}

HEAD = '''"""Types of lightnet. Written by python/stubs.py."""

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any

from .errors import Error as Error, NoProgram as NoProgram, NoWorker as NoWorker, UnknownKey as UnknownKey
from .errors import UserError as UserError
from .graph import File as File, Node as Node, check as check, dot as dot, load as load
from .operators import Questions as Questions, operator as operator
from .picture import Picture as Picture, read as read
from .race import Race as Race, race as race
from .run import Run as Run, progress as progress, render as render
from .scenes import Lamp as Lamp, Mesh as Mesh, World as World
from .session import Session as Session
'''


def type_of(param):
    if "choices" in param and param["type"] == "text":
        return f"Literal[{', '.join(json.dumps(choice) for choice in param['choices'])}]"
    return TYPES[param["type"]]


def stub(kind, schema):
    lines = [f"class {kind}(Node):", '    """' + docstring(kind, schema).replace("\n", "\n    ").rstrip() + '\n    """', ""]
    lines = [line.rstrip() for line in "\n".join(lines).split("\n")]
    entries = "str | PathLike[str] | World" if schema["gives"] == "scene" else "Node"
    lines += ["    def __init__(", "        self,", f"        *inputs: {entries},"]
    for name, param in schema.get("params", {}).items():
        lines.append(f"        {in_python(name)}: {type_of(param)} | None = ...,")
    lines += ["        name: str | None = ...,", "    ) -> None: ..."]
    return "\n".join(lines)


def main():
    kinds = schemas()
    literal = any("choices" in param for schema in kinds.values() for param in schema.get("params", {}).values())
    print(HEAD.replace("import Any\n", "import Any, Literal\n") if literal else HEAD)
    print("\n\n".join(stub(kind, schema) for kind, schema in kinds.items()))


if __name__ == "__main__":
    main()
