"""Script for a second Blender: renders a world to a picture of all directions, and measures suns in its skies.

blender -b --factory-startup --python bake_world.py -- WORLD.blend NAME TOLD.json
"""

import json
import math
import os
import sys

import bpy
import numpy

width = 1024


def render(path, size, samples=4):
    """Pixels (height, width, 4), linear, row 0 at the bottom."""
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.cycles.samples = samples
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(path)
    pixels = numpy.empty(size[0] * size[1] * 4, numpy.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(size[1], size[0], 4)


def prepared():
    """An empty scene whose camera sees all directions as Blender's textures of environments have them."""
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.use_denoising = False
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.rotation_euler = (math.pi / 2, 0, -math.pi / 2)  # looks along +x
    return camera


def sun_of(node, camera, folder):
    """Irradiance, direction and width of the disk of a sky's sun, measured by a camera that sees little else."""
    data = camera.data
    data.type, data.sensor_fit = "PERSP", "HORIZONTAL"
    node.sun_disc = True
    turn, height = node.sun_rotation, node.sun_elevation
    towards = (math.cos(height) * math.sin(turn), math.cos(height) * math.cos(turn), math.sin(height))
    camera.rotation_euler = (height + math.pi / 2, 0, -turn)
    data.angle = node.sun_size * 1.2
    size = 64
    seen = render(os.path.join(folder, "sun.exr"), (size, size), 16)
    node.sun_disc = False
    behind = render(os.path.join(folder, "behind.exr"), (size, size), 1)
    solid = (2 * math.tan(data.angle / 2)) ** 2
    light = numpy.maximum(seen - behind, 0)[..., :3].mean(axis=(0, 1)) * solid
    return {"irradiance": light.tolist(), "direction": [-x for x in towards], "angle": math.degrees(node.sun_size)}


def main():
    library, name, told = sys.argv[sys.argv.index("--") + 1 :]
    folder = os.path.dirname(told)
    with bpy.data.libraries.load(library) as (there, here):
        here.worlds = [name]
    camera = prepared()
    world = bpy.data.worlds[name] if name in bpy.data.worlds else here.worlds[0]
    bpy.context.scene.world = here.worlds[0] if hasattr(here.worlds[0], "node_tree") else world
    tree = bpy.context.scene.world.node_tree
    suns = [n for n in tree.nodes if n.type == "TEX_SKY" and n.sky_type == "NISHITA" and n.sun_disc and n.outputs[0].is_linked]
    for node in suns:
        node.sun_disc = False
    camera.data.type = "PANO"
    camera.data.cycles.panorama_type = "EQUIRECTANGULAR"
    pixels = render(os.path.join(folder, "sky.exr"), (width, width // 2))
    numpy.save(os.path.join(folder, "sky.npy"), pixels)
    facts = {"pixels": os.path.join(folder, "sky.npy"), "suns": [sun_of(node, camera, folder) for node in suns]}
    with open(told, "w", encoding="utf-8") as file:
        json.dump(facts, file)


main()
