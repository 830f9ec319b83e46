#!/usr/bin/env python3
"""The PNG beside a picture, held against what OpenImageIO makes of the EXR by the same view of OpenColorIO. Environment:
LIGHTNET. 77: OpenImageIO is not here, or was built without OpenColorIO."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy
    import OpenImageIO
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
CONFIG = """ocio_profile_version: 2
roles: {default: raw, scene_linear: lin_rec709}
displays:
  screen:
    - !<View> {name: Soft, colorspace: soft}
colorspaces:
  - !<ColorSpace> {name: raw, isdata: true}
  - !<ColorSpace> {name: lin_rec709}
  - !<ColorSpace>
    name: soft
    from_scene_reference: !<GroupTransform>
      children:
        - !<CDLTransform> {slope: [1.1, 1, 0.9], offset: [0.01, 0, 0.02], power: [0.8, 0.9, 1], sat: 0.6}
        - !<ExponentTransform> {value: 2.4, direction: inverse}
"""


class Views(unittest.TestCase):
    def test_are_those_that_another_program_makes(self):
        with tempfile.TemporaryDirectory() as folder:
            config, exr = os.path.join(folder, "config.ocio"), os.path.join(folder, "x.exr")
            pathlib.Path(config).write_text(CONFIG)
            words = [os.environ["LIGHTNET"], "run", ROOT / "graphs/cornell.lua", "--size", "48x48", "--samples", "4"]
            words += ["-o", exr, "--view", "Soft", "--exposure", "0", "--forget"]
            subprocess.run(list(map(str, words)), check=True, capture_output=True, env={**os.environ, "OCIO": config})
            picture = OpenImageIO.ImageBuf(exr)
            beauty = OpenImageIO.ImageBufAlgo.channels(picture, ("R", "G", "B"))
            shown = OpenImageIO.ImageBufAlgo.ociodisplay(
                beauty, "screen", "Soft", fromspace="lin_rec709", unpremult=False, colorconfig=config
            )
            if shown.has_error:
                self.skipTest(shown.geterror())
            wanted = numpy.clip(numpy.asarray(shown.get_pixels(OpenImageIO.FLOAT)), 0, 1)
            png = numpy.asarray(OpenImageIO.ImageBuf(exr[:-3] + "png").get_pixels(OpenImageIO.UINT8)) / 255
            self.assertLess(numpy.abs(png - wanted).max(), 0.51 / 255 + 1e-6)
            self.assertGreater(wanted.std(), 0.1)


if __name__ == "__main__":
    unittest.main()
