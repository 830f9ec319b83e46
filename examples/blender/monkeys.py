"""A scene that Blender makes and lightnet renders: brass, glass and clay on a table, by paths, in light groups.

blender -b --factory-startup --python examples/blender/monkeys.py -- monkeys.png [SAMPLES]

The add-on has to be installed (docs/blender.md). Beside monkeys.png, monkeys.exr has all passes.
"""

import math
import sys

import bpy


def material(name, colour, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    surface = made.node_tree.nodes["Principled BSDF"]
    surface.inputs["Base Color"].default_value = (*colour, 1)
    for word, value in inputs.items():
        surface.inputs[word.replace("_", " ")].default_value = value
    return made


def monkey(place, turn, look):
    bpy.ops.mesh.primitive_monkey_add(size=1.6, location=place, rotation=(-0.35, 0, turn))
    made = bpy.context.object
    made.modifiers.new("Smooth", "SUBSURF").levels = 2
    bpy.ops.object.shade_smooth()
    made.data.materials.append(look)


def lamp(kind, place, watts, group, **settings):
    data = bpy.data.lights.new(group, kind)
    data.energy = watts
    for name, value in settings.items():
        setattr(data, name, value)
    made = bpy.data.objects.new(group, data)
    made.location, made.lightgroup = place, group
    bpy.context.scene.collection.objects.link(made)
    target = made.constraints.new("TRACK_TO")
    target.target = bpy.data.objects["Table"]


def main():
    picture, samples = sys.argv[sys.argv.index("--") + 1], int((sys.argv[sys.argv.index("--") + 2 :] or [256])[0])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="lightnet")
    scene = bpy.context.scene
    for group in ("key", "rim"):
        scene.view_layers[0].lightgroups.add(name=group)
    bpy.ops.mesh.primitive_plane_add(size=30)
    bpy.context.object.name = "Table"
    bpy.context.object.data.materials.append(material("Linen", (0.62, 0.58, 0.52), Roughness=0.9, Specular=0.1))
    monkey((-2.1, 0.3, 0.75), 0.35, material("Brass", (0.9, 0.62, 0.28), Metallic=1, Roughness=0.22))
    monkey((0, -0.5, 0.75), 0, material("Glass", (0.95, 0.98, 1), Transmission=1, Roughness=0, IOR=1.5))
    monkey((2.1, 0.3, 0.75), -0.35, material("Clay", (0.55, 0.2, 0.12), Roughness=0.8, Specular=0.2))
    lamp("AREA", (-4, -4, 6), 500, "key", shape="DISK", size=2.5)
    lamp("AREA", (5, 4, 3.5), 220, "rim", shape="RECTANGLE", size=1, size_y=3, color=(0.6, 0.75, 1))
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.12, 0.14, 0.18, 1)
    eye = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    eye.location, eye.rotation_euler = (0, -8.5, 2.9), (math.radians(76), 0, 0)
    scene.collection.objects.link(eye)
    scene.camera = eye
    scene.render.engine = "LIGHTNET"
    scene.lightnet.samples, scene.lightnet.clean = samples, True
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 480, 270, 100
    scene.view_settings.view_transform = "Standard"
    scene.render.filepath = picture
    bpy.ops.render.render(write_still=True)
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    bpy.data.images["Render Result"].save_render(picture.rsplit(".", 1)[0] + ".exr")


main()
