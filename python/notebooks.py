#!/usr/bin/env python3
"""Makes notebooks of the labs: docs/labs/NUMBER-NAME.md becomes docs/labs/notebooks/NUMBER-NAME.ipynb.

notebooks.py [--check] [LAB ...]: commands become cells of the shell, each followed by the pictures that it writes;
tasks and answers stay text. --check compares with the notebooks that are there, and ends with 1 where one differs.
"""
import json
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent.parent / "docs" / "labs"
BEGIN = '''\
# A folder of this notebook's own, with a copy of the example graphs.
import os, pathlib, shutil, tempfile
from IPython.display import Image, display

program = pathlib.Path(shutil.which("lightnet") or "/usr/bin/lightnet").resolve()
tree = [place / "graphs" for place in program.parents if (place / "graphs" / "labs").is_dir()]
graphs = os.environ.get("LIGHTNET_GRAPHS") or (tree[0] if tree else "/usr/share/lightnet/graphs")
folder = tempfile.TemporaryDirectory(prefix="lightnet-lab-")
shutil.copytree(graphs, folder.name + "/graphs")
os.chdir(folder.name + "/graphs/labs")
shown = set()


def new_pictures():
    for picture in sorted(set(pathlib.Path().glob("*.png")) - shown, key=lambda one: one.stat().st_mtime_ns):
        shown.add(picture)
        print(picture)
        display(Image(str(picture)))'''
END = '''\
os.chdir("/")
folder.cleanup()'''


def cell(kind, source):
    made = {"cell_type": kind, "metadata": {}, "source": source.splitlines(keepends=True)}
    if kind == "code":
        made.update(execution_count=None, outputs=[])
    return made


def link_from_below(text):
    """Links of a page, seen from one folder deeper."""
    return re.sub(r"\]\((?!https?:|#)([^)]+)\)", r"](../\1)", text)


def cells(page):
    yield cell("code", BEGIN)
    for part in re.split(r"(^```sh\n.*?^```$\n?)", page, flags=re.MULTILINE | re.DOTALL):
        if not part.strip():
            continue
        if not part.startswith("```sh"):
            for section in re.split(r"(?=^## )", part.strip(), flags=re.MULTILINE):
                if section.strip():
                    yield cell("markdown", link_from_below(section.strip()))
            continue
        commands = part.split("\n", 1)[1].rsplit("```", 1)[0].strip()
        yield cell("code", "%%bash\nset -eu\n" + commands)
        if ".exr" in commands:
            yield cell("code", "new_pictures()")
    yield cell("code", END)


def notebook(page):
    all_cells = list(cells(page))
    for number, one in enumerate(all_cells):
        one["id"] = f"cell-{number}"
    return {
        "cells": all_cells,
        "metadata": {
            "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
            "language_info": {"name": "python"},
        },
        "nbformat": 4,
        "nbformat_minor": 5,
    }


def main(words):
    check = "--check" in words
    names = [word for word in words if word != "--check"]
    pages = [HERE / f"{name}.md" for name in names] or sorted(HERE.glob("[0-9]*.md"))
    differing = []
    (HERE / "notebooks").mkdir(exist_ok=True)
    for page in pages:
        text = json.dumps(notebook(page.read_text()), indent=1, ensure_ascii=False) + "\n"
        made = HERE / "notebooks" / f"{page.stem}.ipynb"
        if not check:
            made.write_text(text)
        elif not made.exists() or made.read_text() != text:
            differing.append(str(made))
    for name in differing:
        print(f"{name}: is not what its page says; python/notebooks.py makes it anew", file=sys.stderr)
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
