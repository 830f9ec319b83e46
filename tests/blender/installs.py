"""installs.py ADDON: Blender installs the zip, renders a frame of its own and an animation, and reports what is wrong; no folder
is left."""

import glob
import importlib
import os
import subprocess
import sys
import tempfile

import bpy

source = sys.argv[sys.argv.index("--") + 1]


def left():
    """Folders of the add-on that are there now."""
    return glob.glob(os.path.join(tempfile.gettempdir(), "lightnet-blender-*"))


def said(wanted):
    """Whether rendering fails, with these words."""
    try:
        bpy.ops.render.render()
    except RuntimeError as error:
        return wanted in str(error)
    return False


def covered(scene, name):
    """A clean picture by guided paths, whose alpha is that of a cube before nothing."""
    scene.lightnet.clean, scene.lightnet.lighting, scene.render.film_transparent = True, "GUIDED", True
    scene.render.filepath = name
    bpy.ops.render.render(write_still=True)
    pixels = bpy.data.images.load(name).pixels[:]
    assert pixels[3] == 0 and pixels[4 * (12 * 32 + 16) + 3] == 1
    assert max(pixels[4 * (12 * 32 + 16) :][:3]) > 0


def unsaid(scene):
    """What the material of the cube can't say, with a bump map in front of it."""
    tree = bpy.data.materials["Material"].node_tree
    tree.links.new(tree.nodes.new("ShaderNodeBump").outputs[0], tree.nodes["Principled BSDF"].inputs["Normal"])
    warnings = {}
    with tempfile.TemporaryDirectory() as folder:
        importlib.import_module("lightnet.materials").Materials(folder, warnings).of(bpy.data.materials["Material"])
    return list(warnings)


def main():
    with tempfile.TemporaryDirectory() as folder:
        tempfile.tempdir = os.environ["BLENDER_USER_SCRIPTS"] = folder
        maker = ["/usr/bin/python3", os.path.join(source, "zip.py"), folder]
        name = subprocess.run(maker, check=True, capture_output=True, text=True).stdout.strip()
        bpy.ops.preferences.addon_install(filepath=name, target="DEFAULT")
        bpy.ops.preferences.addon_enable(module="lightnet")
        scene = bpy.context.scene
        scene.render.engine = "LIGHTNET"
        scene.render.resolution_x, scene.render.resolution_y, scene.lightnet.samples = 32, 24, 4
        scene.frame_start, scene.frame_end = 1, 2
        scene.render.filepath = os.path.join(folder, "film-")
        bpy.ops.render.render(animation=True)
        assert sorted(glob.glob("film-*", root_dir=folder)) == ["film-0001.png", "film-0002.png"]
        covered(scene, os.path.join(folder, "cut.png"))
        assert unsaid(scene) == ["Material: node 'Principled BSDF' is without what feeds its 'Normal'"]
        scene.camera = None
        assert said("camera")
        scene.camera = next(one for one in scene.objects if one.type == "CAMERA")
        kept, os.environ["LIGHTNET"], os.environ["PATH"] = os.environ["LIGHTNET"], "", ""
        assert said("there is no program lightnet")
        os.environ["LIGHTNET"] = kept
        scene.lightnet.hosts = "/nowhere/hosts.lua"
        assert said("/nowhere/hosts.lua")
        assert not left()
    print("installed, rendered, and said what is wrong", flush=True)
    os._exit(0)  # Blender's own code is 1 once any picture failed


main()
