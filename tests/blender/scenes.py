"""Small scenes that are made in Blender, by name: each is a room of Blender's own parts before a camera."""

import math

import bpy


def begin():
    """An empty scene with a camera that looks down at the origin, and a matt floor."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    sky((0, 0, 0))
    bpy.ops.object.camera_add(location=(0, -6, 4), rotation=(math.radians(56), 0, 0))
    scene.camera = bpy.context.object
    bpy.ops.mesh.primitive_plane_add(size=40)
    bpy.context.object.data.materials.append(made("BSDF_DIFFUSE", Color=(0.6, 0.5, 0.4, 1)))
    return scene


def sky(colour, strength=1):
    """One colour from all around."""
    node = bpy.context.scene.world.node_tree.nodes["Background"]
    node.inputs["Color"].default_value = (*colour, 1)
    node.inputs["Strength"].default_value = strength


def made(kind, **inputs):
    """A material of one node."""
    material = bpy.data.materials.new(kind)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    name = "ShaderNode" + {"BSDF_DIFFUSE": "BsdfDiffuse", "BSDF_GLOSSY": "BsdfGlossy", "BSDF_GLASS": "BsdfGlass"}.get(kind, kind)
    node = tree.nodes.new(name)
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material


def ball(material, at=(0, 0, 1)):
    """A smooth ball of radius 1."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, location=at)
    bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(material)
    return bpy.context.object


def lamp(kind, energy, at=(3, -1, 5), turned=(0, 0, 0), **more):
    """A lamp of Blender's, out of the picture."""
    bpy.ops.object.light_add(type=kind, location=at, rotation=turned)
    data = bpy.context.object.data
    data.energy = energy
    for name, value in more.items():
        setattr(data, name, value)


def grey():
    """The matt grey of most balls."""
    return made("BSDF_DIFFUSE", Color=(0.7, 0.7, 0.7, 1))


def under_sky(material, **more):
    """A ball of a material under an even sky."""
    sky((0.8, 0.9, 1.0))
    return ball(material, **more)


def lit(kind, energy, **more):
    """A matt ball under one lamp."""
    ball(grey())
    lamp(kind, energy, **more)


def instances():
    """Eight times one mesh, by a collection that stands twice."""
    under_sky(grey())
    thing = bpy.context.object
    for turn in range(7):
        copy = bpy.data.objects.new("copy", thing.data)
        copy.location = (turn - 3, 1.5, 0.4)
        copy.scale = (0.4,) * 3
        bpy.context.collection.objects.link(copy)


def subdivided():
    """A cube that a modifier rounds."""
    sky((1, 1, 1))
    bpy.ops.mesh.primitive_cube_add(location=(0, 0, 1))
    bpy.context.object.data.materials.append(grey())
    bpy.context.object.modifiers.new("smooth", "SUBSURF").render_levels = 3


def blurred():
    """A camera with a lens."""
    under_sky(grey())
    camera = bpy.context.scene.camera.data
    camera.dof.use_dof, camera.dof.focus_distance, camera.dof.aperture_fstop = True, 4, 0.2


def parallel():
    """A camera without perspective, moved aside."""
    under_sky(grey())
    camera = bpy.context.scene.camera.data
    camera.type, camera.ortho_scale, camera.shift_x = "ORTHO", 5, 0.1


def shifted():
    """A camera whose picture is moved, on a tall picture."""
    under_sky(grey())
    bpy.context.scene.render.resolution_x = 48
    camera = bpy.context.scene.camera.data
    camera.shift_x, camera.shift_y = 0.15, -0.1


def glowing():
    """A ball that shines."""
    ball(made("ShaderNodeEmission".replace("ShaderNode", ""), Color=(1, 0.8, 0.5, 1), Strength=2))


def panorama():
    """A picture all around, of four colours and a bright part, turned."""
    ball(made("BSDF_GLOSSY", Roughness=0, Color=(0.9, 0.9, 0.9, 1)))
    bpy.context.object.scale = (1.8,) * 3
    image = bpy.data.images.new("sky", 64, 32, float_buffer=True)
    pixels = []
    for y in range(32):
        for x in range(64):
            pixels += [x / 64, y / 32, 3.0 if 10 < x < 20 and y > 16 else 0.2, 1]
    image.pixels = pixels
    image.pack()
    tree = bpy.context.scene.world.node_tree
    node, turn, place = (tree.nodes.new("ShaderNode" + name) for name in ("TexEnvironment", "Mapping", "TexCoord"))
    node.image = image
    turn.inputs["Rotation"].default_value = (0, 0, 0.7)
    tree.links.new(place.outputs["Generated"], turn.inputs["Vector"])
    tree.links.new(turn.outputs["Vector"], node.inputs["Vector"])
    tree.links.new(node.outputs["Color"], tree.nodes["Background"].inputs["Color"])


def textured():
    """An image on the ball, packed in Blender's file."""
    material = grey()
    image = bpy.data.images.new("squares", 8, 4)
    image.pixels = [part for cell in range(32) for part in (((0.8, 0.2, 0.1, 1), (0.1, 0.5, 0.9, 1))[(cell + cell // 8) % 2])]
    image.pack()
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    node.interpolation = "Closest"
    diffuse = next(one for one in material.node_tree.nodes if one.type == "BSDF_DIFFUSE")
    material.node_tree.links.new(node.outputs["Color"], diffuse.inputs["Color"])
    under_sky(material)


all_scenes = {
    "matt": lambda: under_sky(grey()),
    "point": lambda: lit("POINT", 800, shadow_soft_size=0.3),
    "point without size": lambda: lit("POINT", 800, shadow_soft_size=0),
    "sun": lambda: lit("SUN", 3, turned=(0.5, 0.3, 0), angle=0),
    "area": lambda: lit("AREA", 500, at=(0, 0, 6), shape="RECTANGLE", size=2, size_y=1),
    "disk": lambda: lit("AREA", 500, at=(0, 0, 6), shape="DISK", size=2),
    "metal": lambda: under_sky(made("BSDF_GLOSSY", Roughness=0.4, Color=(0.9, 0.7, 0.4, 1))),
    "glass": lambda: under_sky(made("BSDF_GLASS", Roughness=0, IOR=1.5)),
    "principled": lambda: under_sky(made("BsdfPrincipled", Base_Color=(0.2, 0.4, 0.8, 1), Roughness=0.5)),
    "glowing": glowing,
    "instances": instances,
    "subdivided": subdivided,
    "blurred": blurred,
    "parallel": parallel,
    "shifted": shifted,
    "textured": textured,
    "panorama": panorama,
}
