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
import volume_scenes  # noqa: E402


def folders():
    """Those of this process in memory, where others are beside it, and all in its own folder for temporary files (run.sh)."""
    return set(glob.glob(f"/dev/shm/lightnet-{os.getpid()}-*") + glob.glob(os.path.join(tempfile.gettempdir(), "lightnet-*")))


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


def lightings(folder):
    """Every lighting of the panel gives a picture, cleaned and in layers, of particles and of a bump as well."""
    scene = prepared(4)
    bumpy = scenes.material("ShaderNodeBsdfDiffuse")
    bump, check = scenes.add_node(bumpy, "ShaderNodeBump"), scenes.add_node(bumpy, "ShaderNodeTexChecker")
    scenes.link(bumpy, check, "Fac", bump, "Height")
    scenes.link(bumpy, bump, "Normal", scenes.shader_of(bumpy), "Normal")
    scenes.usual(bumpy)
    grown = scenes.ball(scenes.material(), place=(-2, 0, 0.5), radius=0.4)
    seed = scenes.cube(scenes.material(), place=(9, 9, 9))
    particles = grown.modifiers.new("particles", "PARTICLE_SYSTEM").particle_system.settings
    particles.frame_start, particles.frame_end = 0, 1
    particles.type, particles.render_type, particles.instance_object, particles.count = "EMITTER", "OBJECT", seed, 5
    for lighting in ("path", "guided", "progressive", "figure5", "direct", "ao"):
        scene.lightnet.lighting = lighting
        scene.lightnet.clean = scene.lightnet.layers = True
        found, _ = saved(scene, folder)
        names = [name for name, pixels in found.items() if pixels.max() > 0]
        assert any(name.endswith("Combined.R") for name in names), (lighting, names)
        assert any("Noisy Image" in name for name in names), (lighting, names)
        assert lighting in ("guided", "ao") or any("Layer direct" in name for name in names), (lighting, names)
    scene.lightnet.lighting, scene.lightnet.graph = "file", os.path.join(folder, "own.lua")
    with open(scene.lightnet.graph, "w", encoding="utf-8") as out:
        out.write("scene = Scene { 'x.pbrt' } light = DirectLighting {} image = RayTracer { light, scene = scene, film = { 8, 8 } }")
    scene.lightnet.clean = scene.lightnet.layers = False
    found, _ = saved(scene, folder)
    assert max(pixels.max() for name, pixels in found.items() if name.endswith("Combined.R")) > 0


def moving_lamps(folder):
    """Lamps that move shine as the mean of what they do at moments (Cycles has them stand still)."""
    for kind, more in (("AREA", {"size": 1}), ("POINT", {"shadow_soft_size": 0.3}), ("POINT", {"shadow_soft_size": 0}), ("SPOT", {})):
        scene = prepared(64)
        scenes.floor(), scenes.ball()
        scenes.moved(scenes.lamp(kind, 400, (0, -2, 4), **more), (2, 0, 0))
        combined = lambda: next(pixels for name, pixels in saved(scene, folder)[0].items() if name.endswith("Combined.R"))
        scenes.open_shutter(1.0, "START")
        blurred, stills = combined(), []
        assert scene.frame_current == 1 and scene.frame_subframe == 0, (scene.frame_current, scene.frame_subframe)
        scene.render.use_motion_blur = False
        for part in (0.125, 0.375, 0.625, 0.875):
            scene.frame_set(1, subframe=part)
            stills.append(combined())
        scene.frame_set(1)
        wanted = numpy.mean(stills, axis=0)
        off = (blurred.mean() - wanted.mean()) / wanted.mean()
        apart = numpy.sqrt(((blurred - wanted) ** 2).mean()) / wanted.mean()
        still = numpy.sqrt(((stills[0] - wanted) ** 2).mean()) / wanted.mean()
        assert abs(off) < 0.02 and apart < 0.25 and apart < still / 2, (kind, more, off, apart, still)


def vectors(folder):
    """Those of things that move, change their form, and are seen by a camera that moves, are Cycles' own."""
    scene = prepared(64)
    thing = scenes.moved(scenes.usual(), (0.5, 0, 0.2), (0, 0, 0.3))
    scenes.moved(scene.camera, (0, 0.3, 0.1), (0, 0.05, 0))
    bent = scenes.cube(place=(-1.5, 0, 1))
    bent.shape_key_add(name="Basis")
    key = bent.shape_key_add(name="high")
    for point in key.data:
        point.co.z *= 1.5
    for frame, value in ((0, 0.0), (2, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    scene.frame_set(1)
    scene.view_layers[0].use_pass_vector = True
    found = {}
    for engine in ("CYCLES", "LIGHTNET"):
        scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = engine, 64, False
        layers, _ = saved(scene, folder)
        found[engine] = numpy.stack([next(p for n, p in layers.items() if n.endswith("Vector." + c)) for c in "XYZW"], -1)
    assert scene.frame_current == 1
    wanted, got = found["CYCLES"], found["LIGHTNET"]
    off = abs(wanted - got).max(axis=-1)
    assert abs(wanted[16, 24]).max() > 5
    assert numpy.quantile(off, 0.8) < 0.01, numpy.quantile(off, 0.8)  # pixels; edges are mixed by other filters


def changing_forms(_):
    """Meshes that change their form in the shutter are named, and stand as in their frame."""
    from lightnet import motion

    class Clock:
        def frame_set(self, frame, subframe):
            bpy.context.scene.frame_set(frame, subframe=subframe)

    scene = prepared()
    thing = scenes.usual()
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="wide")
    key.data[0].co.x += 2
    for frame, value in ((1, 0.0), (3, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    scene.frame_set(2)
    scenes.open_shutter(0.5)
    found = motion.look(Clock(), bpy.context.evaluated_depsgraph_get())
    assert found.deforming == ["Sphere"] and not found.moves(), (found.deforming, found.keys)
    assert scene.frame_current == 2 and scene.frame_subframe == 0


def unsaid(_):
    """What a material can't say is named, with the node."""
    from lightnet.report import Report
    from lightnet.shaders import Shaders

    made = scenes.material("ShaderNodeBsdfDiffuse")
    noise = scenes.add_node(made, "ShaderNodeTexNoise")
    scenes.link(made, noise, "Color", scenes.shader_of(made), "Color")
    report = Report()
    Shaders("Wall", report).shader(made.node_tree.nodes["Material Output"].inputs["Surface"])
    assert list(report.lines()) == ["the node Noise Texture is taken as a mean (Wall: Noise Texture)"], list(report.lines())


def unsaid_volumes(_):
    """Grids are named, and so is what changes inside of a volume."""
    from lightnet.export import Export

    scene = prepared()
    scenes.usual(volume_scenes.filled("ShaderNodeVolumePrincipled"))
    made = bpy.data.objects["Sphere"].data.materials[0]
    noise, volume = scenes.add_node(made, "ShaderNodeTexNoise"), made.node_tree.nodes["Principled Volume"]
    scenes.link(made, noise, "Fac", volume, "Density")
    volume.inputs["Blackbody Intensity"].default_value = 1
    grid = bpy.data.objects.new("Cloud", bpy.data.volumes.new("Cloud"))
    scene.collection.objects.link(grid)
    with tempfile.TemporaryDirectory() as folder:
        export = Export(folder, scene, bpy.context.evaluated_depsgraph_get(), bpy.context.view_layer)
        export.write()
    told = "; ".join(export.report.lines())
    for words in ("grids of volumes are left out (Cloud)", "blackbodies in volumes are left out", "Noise Texture is taken as a mean"):
        assert words in told, told


def said(wanted):
    """Whether rendering fails, with these words."""
    try:
        bpy.ops.render.render()
    except RuntimeError as error:
        return wanted in str(error)
    return False


def mistakes(_):
    scene = prepared()
    scenes.usual()
    scene.lightnet.hosts = "no such file.lua"
    assert said("no such file")
    scene.lightnet.hosts = ""
    kept = {name: os.environ[name] for name in ("LIGHTNET", "PATH")}
    os.environ.update(dict.fromkeys(kept, ""))
    assert said("lightnet")
    os.environ.update(kept)
    scene.camera = None
    assert said("camera")
    assert not folders() - before


before = folders()
code = 0
bpy.ops.preferences.addon_install(filepath=sys.argv[-1], overwrite=True)
bpy.ops.preferences.addon_enable(module="lightnet")
with tempfile.TemporaryDirectory() as place:
    for check in (passes, animation, moving_lamps, changing_forms, vectors, lightings, unsaid, unsaid_volumes, mistakes):
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
