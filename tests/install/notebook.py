#!/usr/bin/python3
"""notebook.py PROGRAMS SOURCES LAB: executes the notebook of a lab as Jupyter does. 77: what that takes is not here."""
import os
import pathlib
import sys
import tempfile

try:
    import nbformat
    from nbclient import NotebookClient
    from jupyter_client.kernelspec import KernelSpecManager

    KernelSpecManager().get_kernel_spec("python3")
except Exception as missing:  # of several packages
    print(f"skipped: {missing} (python3-nbclient, python3-ipykernel)")
    sys.exit(77)

programs, sources, lab = sys.argv[1:]
book = nbformat.read(pathlib.Path(sources, "docs/labs/notebooks", lab + ".ipynb"), as_version=4)
nbformat.validate(book)
with tempfile.TemporaryDirectory() as home:
    os.environ.update(PATH=programs + ":" + os.environ["PATH"], HOME=home, LIGHTNET_CONFIG=home + "/none.lua",
                      LIGHTNET_GRAPHS=sources + "/graphs", PYDEVD_DISABLE_FILE_VALIDATION="1")
    NotebookClient(book, timeout=300, kernel_name="python3").execute()
pictures = sum("image/png" in output.get("data", {}) for cell in book.cells for output in cell.get("outputs", []))
commands = sum(cell.source.startswith("%%bash") for cell in book.cells)
print(f"{lab}: {commands} cells of commands, {pictures} pictures")
sys.exit(0 if commands and pictures else 1)
