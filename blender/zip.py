#!/usr/bin/env python3
"""zip.py FOLDER: puts the add-on for Blender there, as a zip that Blender installs. The same sources give the same bytes.
Prints its name."""

import pathlib
import sys
import zipfile

here = pathlib.Path(__file__).resolve().parent


def main():
    name = pathlib.Path(sys.argv[1]) / "lightnet-blender.zip"
    with zipfile.ZipFile(name, "w") as packed:
        for file in sorted((here / "lightnet").glob("*.py")):
            entry = zipfile.ZipInfo(f"lightnet/{file.name}", (2020, 1, 1, 0, 0, 0))
            entry.external_attr = 0o644 << 16
            packed.writestr(entry, file.read_bytes(), zipfile.ZIP_DEFLATED)
    print(name)


if __name__ == "__main__":
    main()
