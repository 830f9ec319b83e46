#!/usr/bin/env python3
"""wheel.py FOLDER: puts a wheel of the module there, by the standard library alone (the binary distribution format, PEP
427). The same sources give the same bytes. Prints its name."""

import base64
import hashlib
import pathlib
import re
import sys
import zipfile

here = pathlib.Path(__file__).resolve().parent
facts = dict(re.findall(r'^([\w-]+) = "(.*)"', (here / "pyproject.toml").read_text(encoding="utf-8"), re.MULTILINE))
name = f"{facts['name']}-{facts['version']}"


def files():
    """Names in the wheel, and what is in them."""
    for file in sorted((here / "lightnet").iterdir()):
        if file.suffix in (".py", ".pyi", ".typed"):
            yield f"lightnet/{file.name}", file.read_bytes()
    info = f"{name}.dist-info"
    yield f"{info}/WHEEL", b"Wheel-Version: 1.0\nGenerator: lightnet\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    lines = ["Metadata-Version: 2.1", f"Name: {facts['name']}", f"Version: {facts['version']}"]
    lines += [f"Summary: {facts['description']}", f"Requires-Python: {facts['requires-python']}", "Requires-Dist: numpy"]
    yield f"{info}/METADATA", ("\n".join(lines) + "\n").encode()


def main():
    wheel = pathlib.Path(sys.argv[1]) / f"{name}-py3-none-any.whl"
    record = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in files():
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record.append(f"{path},sha256={digest},{len(content)}")
            archive.writestr(zipfile.ZipInfo(path), content, zipfile.ZIP_DEFLATED)
        path = f"{name}.dist-info/RECORD"
        archive.writestr(zipfile.ZipInfo(path), "\n".join([*record, f"{path},,"]) + "\n", zipfile.ZIP_DEFLATED)
    print(wheel.name)


if __name__ == "__main__":
    main()
