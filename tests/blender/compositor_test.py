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


def channels(file):
    import OpenImageIO

    opened = OpenImageIO.ImageInput.open(file)
    names = list(opened.spec().channelnames)
    opened.close()
    return names


def composed(file):
    """What the compositor makes: (height, width, 4)."""
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 64, 48, 100
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.image_settings.color_mode = "RGBA"
    scene.render.filepath = file
    bpy.ops.render.render(write_still=True)
    return pixels(file, "R", "G", "B", "A")


def page_script(program, gains):
    """The script that the live page copies for a program; None where what builds the page is not installed."""
    if not (ROOT / "tools/watch/page/node_modules/esbuild").is_dir():
        return None
    layers = [f"{name}={','.join(map(str, gain))}" for name, gain in gains.items()]
    command = ["node", ROOT / "tests/watch/mix_script.mjs", program, os.path.abspath("shot.exr"), *layers]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def picture_by_nuke(script):
    """What a script of Nuke makes, as its manual describes the stack of nodes and these few of them."""
    stack, kept = [], {}
    for line, kind, knobs in re.findall(r"^(?:((?:set|push) .*)|(\w+) \{\n((?: .*\n)*)\})$", script, re.M):
        knob = dict(one.strip().split(" ", 1) for one in knobs.splitlines())
        if line.startswith("set "):
            kept[line.split()[1]] = stack[-1]
        elif line:
            stack.append(kept[line.split("$")[1]])
        elif kind == "Read":
            assert knob["inputs"] == "0"
            stack.append(knob["file"].strip('"'))
        elif kind == "Shuffle":
            names = {name.replace(".", "_"): name for name in channels(stack[-1])}
            stack.append(pixels(stack.pop(), *(names[f"{knob['in']}_{part}"] for part in "RGB")))
        elif kind == "Multiply":
            stack.append(stack.pop() * [float(gain) for gain in knob["value"].strip("{}").split()[:3]])
        else:
            assert kind == "Merge2" and knob["inputs"] == "2" and knob["operation"] == "plus", (kind, knob)
            stack.append(stack.pop() + stack.pop())
    (picture,) = stack
    return picture


def try_page_scripts():
    """Layers with gains, one of them coloured, as remixing adds them up."""
    gains = {"direct.key": (0.5, 0.5, 0.5), "bounce.key": (1, 0.25, 2), "emission.key": (1, 1, 1)}
    script = page_script("blender", gains)
    if script is None:
        print("FIGURE the page's scripts were not tried: npm ci in tools/watch/page")
        return
    parts = [pixels("shot.exr", *(f"{name}.{part}" for part in "RGB")) * gain for name, gain in gains.items()]
    wanted = sum(parts)
    assert wanted.max() > 0.1
    bpy.context.scene.use_nodes = True
    bpy.context.scene.node_tree.nodes.clear()
    exec(compile(script, "page.py", "exec"), {})
    tree = bpy.context.scene.node_tree
    tree.links.new(tree.nodes[-1].outputs[0], tree.nodes.new("CompositorNodeComposite").inputs[0])
    found = composed(os.path.abspath("paged.exr"))
    assert abs(found[..., :3] - wanted).max() < 1e-5 * wanted.max(), abs(found[..., :3] - wanted).max()
    by_nuke = picture_by_nuke(page_script("nuke", gains))
    assert abs(by_nuke - wanted).max() < 1e-5 * wanted.max(), abs(by_nuke - wanted).max()


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
        try_page_scripts()
    print("PASSED")


try:
    main()
except BaseException:
    traceback.print_exc()
    sys.exit(1)
