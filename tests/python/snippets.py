#!/usr/bin/env python3
"""snippets.py DOCUMENT: runs the ```python blocks of a document, one after the other, beside the graphs of the project.
77: NumPy is not here."""

import pathlib
import re
import shutil
import sys
import tempfile

try:
    import numpy  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

root = pathlib.Path(__file__).resolve().parents[2]
text = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")
blocks = list(re.finditer(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL))
assert blocks, "the document shows no Python"
names = {}
with tempfile.TemporaryDirectory() as folder:
    shutil.copytree(root / "graphs", folder, dirs_exist_ok=True)
    import os

    os.chdir(folder)
    for block in blocks:
        line = text.count("\n", 0, block.start()) + 1
        exec(compile("\n" * line + block[1], sys.argv[1], "exec"), names)
