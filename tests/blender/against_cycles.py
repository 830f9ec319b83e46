"""Script for Blender: renders scenes by Cycles and by lightnet, and says how far the pictures are from each other.

blender -b --factory-startup --python against_cycles.py -- [--sheet SHEET.png] [SCENE ...]
Ends with 1 where a mean is off by more than 2 %, or blocks of 8 x 8 pixels by more than 5 % (the root of the mean square
over all of them, by the mean of the picture).
"""

import os
import sys
import tempfile

import addon_utils
import bpy
import numpy

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "../../blender")]
import scenes  # noqa: E402
import volume_scenes  # noqa: E402

size, block = 64, 8
samples = {"CYCLES": 512, "LIGHTNET": 256}


def rendered(engine, path):
    """The picture of the scene that there is: (height, width, 3), row 0 at the bottom."""
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.resolution_percentage, scene.render.filepath = 100, path
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.filter_size = 0.01
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = samples["CYCLES"], False, False
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.sample_clamp_indirect = scene.cycles.blur_glossy = 0
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = scene.cycles.glossy_bounces = 32
    scene.cycles.transmission_bounces = scene.cycles.transparent_max_bounces = 32
    scene.cycles.volume_bounces = 32
    scene.cycles_curves.shape = "THICK"  # round, as lightnet's; else they are ribbons
    scene.lightnet.samples = samples["LIGHTNET"]
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(path)
    pixels = numpy.empty(size * size * 4, numpy.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(size, size, 4)[..., :3]


def blocks(pixels):
    return pixels.reshape(size // block, block, size // block, block, 3).mean(axis=(1, 3))


def distance(wanted, got):
    """How far the mean and the blocks are, relative to the mean."""
    mean = wanted.mean()
    return (got.mean() - mean) / mean, float(numpy.sqrt(((blocks(got) - blocks(wanted)) ** 2).mean()) / mean)


def shown(pixels):
    pixels = numpy.clip(pixels, 0, 1)
    return numpy.where(pixels < 0.0031308, pixels * 12.92, 1.055 * pixels ** (1 / 2.4) - 0.055)


def write_sheet(path, pairs):
    """Cycles on the left, lightnet on the right, four pairs to a row."""
    cells = [numpy.concatenate((shown(a), shown(b), numpy.zeros((size, 8, 3))), axis=1) for a, b in pairs]
    while len(cells) % 4:
        cells.append(numpy.zeros_like(cells[0]))
    rows = [numpy.concatenate(cells[i : i + 4], axis=1) for i in range(0, len(cells), 4)]
    whole = numpy.concatenate(rows[::-1], axis=0)
    image = bpy.data.images.new("sheet", whole.shape[1], whole.shape[0])
    image.pixels.foreach_set(numpy.concatenate((whole, numpy.ones_like(whole[..., :1])), -1).astype(numpy.float32).ravel())
    image.filepath_raw, image.file_format = path, "PNG"
    image.save()


def main():
    words = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    sheet = words[words.index("--sheet") + 1] if "--sheet" in words else None
    chosen = [word for word in words if word not in ("--sheet", sheet)]
    addon_utils.enable("lightnet", default_set=True)
    worst, pairs = 0, []
    with tempfile.TemporaryDirectory() as folder:
        for make in [*scenes.all_scenes, *volume_scenes.all_scenes]:
            if chosen and make.__name__ not in chosen:
                continue
            scenes.empty()
            make()
            wanted = rendered("CYCLES", os.path.join(folder, "cycles.exr"))
            got = rendered("LIGHTNET", os.path.join(folder, "lightnet.exr"))
            mean, off = distance(wanted, got)
            good = abs(mean) <= 0.02 and off <= 0.05
            worst += not good
            print(f"FIGURE {make.__name__:22} mean {100 * mean:+6.2f} %  blocks {100 * off:6.2f} %{'' if good else '  FAR'}")
            sys.stdout.flush()
            pairs.append((wanted, got))
    if sheet:
        write_sheet(sheet, pairs)
    print(f"FIGURE {len(pairs)} scenes, {worst} too far")
    sys.stdout.flush()
    os._exit(1 if worst or not pairs else 0)


try:
    main()
except BaseException:
    import traceback

    traceback.print_exc()
    os._exit(2)
