"""Script for Blender: does what docs/compositor.md says, with a picture of graphs/compositing.lua.

blender -b --factory-startup --python compositor_test.py
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import traceback

import bpy
import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]


def blocks(language):
    """The page's text in a language, block by block."""
    return re.findall(rf"```{language}\n(.*?)```", (ROOT / "docs" / "compositor.md").read_text(), re.S)


def pixels(file, *channels):
    import OpenImageIO

    opened = OpenImageIO.ImageInput.open(file)
    names, found = list(opened.spec().channelnames), opened.read_image("float")
    opened.close()
    return numpy.stack([found[..., names.index(name)] for name in channels], axis=-1)


def composed(file):
    """What the compositor makes: (height, width, 4)."""
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 64, 48, 100
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.image_settings.color_mode = "RGBA"
    scene.render.filepath = file
    bpy.ops.render.render(write_still=True)
    return pixels(file, "R", "G", "B", "A")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        subprocess.run(
            [os.environ["LIGHTNET"], "run", ROOT / "graphs" / "compositing.lua", "--size", "64x48", "--samples", "16",
             "--progress", "none", "-o", "shot.exr"],
            check=True,
        )  # fmt: skip
        remixed = [os.environ["LIGHTNET"], "remix", "shot.exr"]
        remixed += [f"{operator}.key=0.5" for operator in ("direct", "bounce", "emission")]
        subprocess.run([*remixed, "-o", "remixed.exr"], check=True, stdout=subprocess.DEVNULL)
        mix, matte = blocks("python")
        names = {}
        exec(compile(mix, "compositor.md", "exec"), names)
        wanted, found = pixels("remixed.exr", "R", "G", "B"), composed(folder + "/mixed.exr")
        assert wanted.max() > 0.1
        assert abs(found[..., :3] - wanted).max() < 1e-5 * wanted.max(), abs(found[..., :3] - wanted).max()
        exec(compile(matte, "compositor.md", "exec"), names)
        alpha, whole = composed(folder + "/matte.exr")[..., 3], pixels("shot.exr", "A")[..., 0]
        assert alpha.max() > 0.99 and 0.001 < alpha.mean() < whole.mean(), (alpha.max(), alpha.mean(), whole.mean())
        assert (alpha < whole + 1e-3).all()
        if shutil.which("oiiotool"):
            for block in blocks("sh"):
                subprocess.run(["sh", "-e", "-c", block], check=True, stdout=subprocess.DEVNULL)
            assert (pixels("key.exr", "direct.key.R") == pixels("shot.exr", "direct.key.R")).all()
    print("PASSED")


try:
    main()
except BaseException:
    traceback.print_exc()
    sys.exit(1)
