"""Script for Blender, in which the add-on is installed from its zip: passes, animations, errors, and what is left behind.

blender -b --factory-startup --python engine_test.py -- LIGHTNET.zip
"""

import glob
import os
import sys
import tempfile
import traceback

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scenes  # noqa: E402


def folders():
    return set(glob.glob("/dev/shm/lightnet-*") + glob.glob(os.path.join(tempfile.gettempdir(), "lightnet-*")))


def prepared(samples=16):
    scenes.empty()
    scene = bpy.context.scene
    scene.render.engine = "LIGHTNET"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 48, 32, 100
    scene.lightnet.samples = samples
    return scene


def saved(scene, folder):
    """Layers of the picture, by name, as the multilayer EXR of Blender's has them."""
    import OpenImageIO

    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = os.path.join(folder, "passes.exr")
    bpy.ops.render.render(write_still=True)
    file = OpenImageIO.ImageInput.open(scene.render.filepath)
    spec, pixels = file.spec(), file.read_image("float")
    file.close()
    return {name: pixels[..., i] for i, name in enumerate(spec.channelnames)}, spec


def passes(folder):
    scene = prepared()
    scenes.usual()
    layer = scene.view_layers[0]
    layer.use_pass_z = layer.use_pass_normal = layer.use_pass_cryptomatte_object = layer.use_pass_diffuse_color = True
    layer.lightgroups.add(name="key lamp")
    bpy.data.objects["AREA"].lightgroup = "key lamp"
    found, spec = saved(scene, folder)
    only = lambda ending: next(pixels for name, pixels in found.items() if name.endswith(ending))
    assert abs(only("DiffCol.R")[16, 24] - 0.7) < 0.01, only("DiffCol.R")[16, 24]
    assert 4 < only("Depth.Z")[16, 24] < 7, only("Depth.Z")[16, 24]
    assert only("Normal.Y")[16, 24] < -0.5
    assert 0 < only("Combined_key_lamp.R").mean() < only("Combined.R").mean()
    ids = only("CryptoObject00.R")
    assert len(numpy.unique(ids)) > 2
    manifests = [a.value for a in spec.extra_attribs if a.name.endswith("/manifest")]
    assert any("Sphere" in text and "Plane" in text for text in manifests), manifests


def animation(folder):
    scene = prepared()
    scenes.usual()
    thing = bpy.data.objects["Sphere"]
    for frame, x in ((1, -1.0), (3, 1.0)):
        thing.location.x = x
        thing.keyframe_insert("location", frame=frame)
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = os.path.join(folder, "frame_")
    bpy.ops.render.render(animation=True)
    frames = sorted(glob.glob(os.path.join(folder, "frame_*.png")))
    assert len(frames) == 3, frames
    data = [open(name, "rb").read() for name in frames]
    assert len(set(data)) == 3
    assert not folders() - before


def mistakes(folder):
    scene = prepared()
    scenes.usual()
    scene.lightnet.hosts = "no such file.lua"
    try:
        bpy.ops.render.render()
    except RuntimeError as error:
        assert "no such file" in str(error), error
    else:
        raise AssertionError("a hosts file that is not there was no mistake")
    scene.lightnet.hosts = ""
    assert not folders() - before


before = folders()
code = 0
bpy.ops.preferences.addon_install(filepath=sys.argv[-1], overwrite=True)
bpy.ops.preferences.addon_enable(module="lightnet")
with tempfile.TemporaryDirectory() as place:
    for check in (passes, animation, mistakes):
        try:
            check(place)
            print("PASSED", check.__name__)
        except BaseException:
            traceback.print_exc()
            code = 1
left = folders() - before
if left:
    print("left behind:", left)
    code = 1
sys.stdout.flush()
os._exit(code)
