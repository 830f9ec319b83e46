"""Constructors of nodes, made of the schemas that `lightnet describe --json` prints."""

import inspect
import json
import keyword

from . import program
from .graph import Node


def schemas():
    """The schema of each kind, by its name."""
    return json.loads(program.said("describe", "--json"))


def class_of(kind, schema):
    """A subclass of Node whose docstring and signature are those of the kind."""
    members = {"kind": kind, "role": schema["gives"], "__doc__": docstring(kind, schema), "__module__": "lightnet"}
    made = type(kind, (Node,), members)
    made.__signature__ = signature(schema)
    return made


def in_python(name):
    """What a parameter is called here: `except_`, where `except` is a word of the language."""
    return name + "_" if keyword.iskeyword(name) else name


def signature(schema):
    """What help() shows. What is left out has the default that the schema names; None does, too."""
    parameters = [inspect.Parameter("inputs", inspect.Parameter.VAR_POSITIONAL)]
    for name in schema.get("params", {}):
        parameters.append(inspect.Parameter(in_python(name), inspect.Parameter.KEYWORD_ONLY, default=None))
    parameters.append(inspect.Parameter("name", inspect.Parameter.KEYWORD_ONLY, default=None))
    return inspect.Signature(parameters)


def docstring(kind, schema):
    """All that `lightnet describe` knows of a kind."""
    lines = [f"{schema['help']}.", ""]
    inputs = schema.get("inputs", {"least": 0, "most": 0})
    if inputs["most"]:
        many = inputs["most"] > 1000
        lines += [f"Inputs: {inputs['least']}{' or more' if many else ''} that give light.", ""]
    for name, param in schema.get("params", {}).items():
        facts = [param["type"]]
        if "unit" in param:
            facts.append(f"in {param['unit']}")
        if "choices" in param:
            facts.append(" | ".join(json.dumps(choice) for choice in param["choices"]))
        if "default" in param:
            facts.append(f"default {json.dumps(param['default'])}")
        if "least" in param or "most" in param:
            facts.append(f"{param.get('least', '')} … {param.get('most', '')}")
        lines += [f"{name}: {', '.join(facts)}", f"    {param['help']}"]
    return "\n".join(lines)


def all_classes():
    """A class for each kind, by name."""
    return {kind: class_of(kind, schema) for kind, schema in schemas().items()}
