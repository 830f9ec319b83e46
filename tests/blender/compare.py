"""compare.py ADDON SCENE... (after `--`; no scene: all): pictures of Cycles and of lightnet, by Blender's own F12, whose means
differ by less than 2 %, and blocks of 16 x 16 pixels by 5 % on the average. With $PICTURES both are kept there. Leaves by 1 when
one is further off."""

import os
import sys
import tempfile

import bpy
import numpy as np

arguments = sys.argv[sys.argv.index("--") + 1 :]
sys.path[:0] = [arguments[0], os.path.dirname(os.path.abspath(__file__))]

import scenes  # noqa: E402

farthest_mean, farthest_block = 0.02, 0.05


def rendered(engine, folder):
    """The scene as floats, (height, width, 3), by an engine."""
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.render.filepath = os.path.join(folder, f"{engine}.exr")
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.array(image.pixels[:], np.float32).reshape(image.size[1], image.size[0], -1)[..., :3]
    bpy.data.images.remove(image)
    return pixels


def blocks(pixels):
    """Means of blocks of 16 x 16 pixels."""
    height, width = (side // 16 * 16 for side in pixels.shape[:2])
    return pixels[:height, :width].reshape(height // 16, 16, width // 16, 16, 3).mean((1, 3))


def compared(name):
    """How far the mean and the blocks are from those of Cycles, relatively."""
    import lightnet

    scene = scenes.begin()
    scene.render.resolution_x = scene.render.resolution_y = 64
    lightnet.register()
    try:
        scenes.all_scenes[name]()
        scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = 256, False, False
        scene.cycles.pixel_filter_type = "BOX"
        scene.cycles.max_bounces = scene.cycles.diffuse_bounces = scene.cycles.glossy_bounces = 32
        scene.cycles.sample_clamp_indirect, scene.cycles.blur_glossy = 0, 0
        scene.lightnet.samples = 256
        with tempfile.TemporaryDirectory() as folder:
            theirs, ours = rendered("CYCLES", folder), rendered("LIGHTNET", folder)
    finally:
        lightnet.unregister()
    if os.environ.get("PICTURES"):
        np.savez(os.path.join(os.environ["PICTURES"], name.replace(" ", "_")), theirs=theirs, ours=ours)
    mean = abs(ours.mean() / theirs.mean() - 1)
    there, here = blocks(theirs), blocks(ours)
    return mean, (np.abs(here - there) / (there + 0.01 * theirs.mean())).mean(), ours.mean() / theirs.mean()


def main():
    wrong = 0
    for name in arguments[1:] or scenes.all_scenes:
        mean, block, ratio = compared(name)
        bad = not (mean < farthest_mean and block < farthest_block)
        wrong += bad
        far = "  TOO FAR" if bad else ""
        print(f"{name:20} mean {100 * mean:6.2f} %  blocks {100 * block:6.2f} %  ours / Cycles {ratio:.4f}{far}", flush=True)
    sys.stdout.flush()
    os._exit(1 if wrong else 0)


main()
