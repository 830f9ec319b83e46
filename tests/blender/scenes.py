"""Scenes made in Blender itself, each of one thing that an export has to get right."""

import math

import bpy
import numpy


def empty():
    """An empty scene seen by a camera that looks along +y, a little down; its world is black."""
    data = bpy.data
    for kind in (data.objects, data.collections, data.meshes, data.lights, data.cameras, data.materials, data.images, data.worlds):
        data.batch_remove(list(kind))
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    scene.render.use_motion_blur = False
    scene.frame_set(1)
    background(0)
    data = bpy.data.cameras.new("Camera")
    camera = bpy.data.objects.new("Camera", data)
    camera.location, camera.rotation_euler = (0, -6, 2.5), (math.radians(70), 0, 0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    return scene


def background(strength, colour=(1, 1, 1)):
    node = bpy.context.scene.world.node_tree.nodes["Background"]
    node.inputs["Color"].default_value, node.inputs["Strength"].default_value = (*colour, 1), strength
    return node


def material(shader="ShaderNodeBsdfDiffuse", **inputs):
    """A material of one shader; names of inputs have _ for spaces."""
    made = bpy.data.materials.new(shader)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output, node = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new(shader)
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    for name, value in inputs.items():
        if name in ("distribution", "parametrization"):
            setattr(node, name, value)
        else:
            socket = node.inputs[name.replace("_", " ")]
            socket.default_value = (*value, 1) if isinstance(value, tuple) and socket.type == "RGBA" else value
    return made


def dress(thing, made):
    thing.data.materials.clear()
    thing.data.materials.append(made)
    return thing


def floor(made=None):
    bpy.ops.mesh.primitive_plane_add(size=12)
    return dress(bpy.context.object, made or material(Color=(0.6, 0.6, 0.6)))


def ball(made=None, place=(0, 0, 1), radius=1.0):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=radius, location=place)
    bpy.ops.object.shade_smooth()
    return dress(bpy.context.object, made or material(Color=(0.7, 0.3, 0.2)))


def cube(made=None, place=(0, 0, 1), turn=0.5):
    bpy.ops.mesh.primitive_cube_add(size=1.6, location=place, rotation=(0, 0, turn))
    return dress(bpy.context.object, made or material(Color=(0.3, 0.5, 0.7)))


def lamp(kind, energy, place=(2, -3, 5), towards=(0, 0, 0.5), **more):
    data = bpy.data.lights.new(kind, kind)
    data.energy = energy
    for name, value in more.items():
        setattr(data, name, value)
    thing = bpy.data.objects.new(kind, data)
    thing.location = place
    from mathutils import Vector

    thing.rotation_euler = (Vector(towards) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(thing)
    return thing


def usual(made=None, shape=ball):
    """A thing on a floor, below a large lamp and a grey sky."""
    background(0.4)
    floor()
    lamp("AREA", 400, size=2)
    return shape(made)


def link(made, source, output, target, socket):
    made.node_tree.links.new(source.outputs[output], target.inputs[socket])


def add_node(made, kind):
    return made.node_tree.nodes.new(kind)


def shader_of(made):
    return next(n for n in made.node_tree.nodes if n.type not in ("OUTPUT_MATERIAL",))


def pattern(size=32):
    """An image in which no side is like another."""
    image = bpy.data.images.new("pattern", size, size)
    y, x = numpy.mgrid[0:size, 0:size] / size
    pixels = numpy.stack((x, y, 0.5 * (x > 0.5) + 0.5 * (y > 0.75), numpy.ones_like(x)), axis=-1)
    image.pixels.foreach_set(pixels.astype(numpy.float32).ravel())
    image.pack()
    return image


# One function for each scene, in the order of the table.


def point_lamp():
    floor(), ball(), lamp("POINT", 600, shadow_soft_size=0.5)


def small_point_lamp():
    floor(), ball(), lamp("POINT", 600, shadow_soft_size=0)


def sun_lamp():
    floor(), ball(), lamp("SUN", 3, angle=math.radians(10))


def spot_lamp():
    floor(), ball(), lamp("SPOT", 1200, spot_size=math.radians(35), spot_blend=0.5, shadow_soft_size=0)


def square_lamp():
    floor(), ball(), lamp("AREA", 400, size=2)


def disk_lamp():
    floor(), ball(), lamp("AREA", 400, shape="ELLIPSE", size=3, size_y=1)


def shining_mesh():
    floor(), ball()
    bpy.ops.mesh.primitive_plane_add(size=1.5, location=(1.5, 0.5, 2.6), rotation=(0.7, 0.4, 0))
    dress(bpy.context.object, material("ShaderNodeEmission", Color=(1, 0.7, 0.4), Strength=8.0))


def grey_sky():
    floor(), cube(), background(0.8, (0.6, 0.8, 1.0))


def environment_picture():
    floor(), ball(material("ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.9), Roughness=0.2))
    tree = bpy.context.scene.world.node_tree
    image = bpy.data.images.new("round", 64, 32, float_buffer=True)
    y, x = numpy.mgrid[0:32, 0:64]
    bright = 0.2 + 6 * numpy.exp(-((x - 20) ** 2 + (y - 22) ** 2) / 20)
    image.colorspace_settings.name = "Linear"
    image.pixels.foreach_set(numpy.stack((bright, bright * (x / 64), bright * (y / 32), 1 + 0 * x), -1).astype(numpy.float32).ravel())
    image.pack()
    picture, mapping, place = (tree.nodes.new("ShaderNode" + k) for k in ("TexEnvironment", "Mapping", "TexCoord"))
    picture.image = image
    mapping.inputs["Rotation"].default_value = (0.2, 0, 1.0)
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], picture.inputs[0])
    tree.links.new(picture.outputs[0], background(1).inputs["Color"])


def nishita_sky():
    floor(), ball()
    tree = bpy.context.scene.world.node_tree
    sky = tree.nodes.new("ShaderNodeTexSky")
    sky.sky_type, sky.sun_elevation, sky.sun_rotation, sky.sun_size = "NISHITA", 0.6, 2.2, math.radians(4)
    tree.links.new(sky.outputs[0], background(0.1).inputs["Color"])


def matt():
    usual(material(Color=(0.2, 0.6, 0.3)))


def gloss():
    usual(material("ShaderNodeBsdfGlossy", Color=(0.9, 0.6, 0.3), Roughness=0.4, distribution="GGX"))


def rough_glass():
    usual(material("ShaderNodeBsdfGlass", Color=(0.9, 1.0, 0.95), Roughness=0.35, IOR=1.45, distribution="GGX"))


def clear_glass():
    usual(material("ShaderNodeBsdfGlass", Color=(1.0, 1.0, 1.0), Roughness=0.0, IOR=1.5))


def principled_plastic():
    usual(material("ShaderNodeBsdfPrincipled", Base_Color=(0.7, 0.2, 0.15), Roughness=0.35, Specular=0.5))


def principled_metal():
    usual(material("ShaderNodeBsdfPrincipled", Base_Color=(0.9, 0.7, 0.3), Roughness=0.5, Metallic=1.0))


def principled_coat():
    usual(material("ShaderNodeBsdfPrincipled", Base_Color=(0.1, 0.2, 0.6), Roughness=0.6, Clearcoat=1.0, Clearcoat_Roughness=0.1))


def mixed_shaders():
    made = material("ShaderNodeMixShader")
    mix = shader_of(made)
    mix.inputs[0].default_value = 0.3
    first, second = add_node(made, "ShaderNodeBsdfDiffuse"), add_node(made, "ShaderNodeBsdfGlossy")
    first.inputs["Color"].default_value, second.inputs["Roughness"].default_value = (0.1, 0.3, 0.7, 1), 0.5
    second.distribution = "GGX"
    link(made, first, 0, mix, 1), link(made, second, 0, mix, 2)
    usual(made)


def half_transparent():
    usual(material("ShaderNodeBsdfPrincipled", Base_Color=(0.7, 0.2, 0.15), Roughness=0.7, Alpha=0.5), cube)


def image_texture():
    made = material(Color=(1, 1, 1))
    picture, mapping, place = (add_node(made, "ShaderNode" + k) for k in ("TexImage", "Mapping", "TexCoord"))
    picture.image = pattern()
    mapping.inputs["Scale"].default_value = (2, 1.5, 1)
    mapping.inputs["Rotation"].default_value, mapping.inputs["Location"].default_value = (0, 0, 0.4), (0.1, 0.25, 0)
    shader = next(n for n in made.node_tree.nodes if n.type == "BSDF_DIFFUSE")
    link(made, place, "UV", mapping, "Vector"), link(made, mapping, 0, picture, "Vector"), link(made, picture, 0, shader, "Color")
    usual(made, cube)


def normal_map():
    made = material(Color=(0.7, 0.7, 0.7))
    shader, image = shader_of(made), bpy.data.images.new("normals", 64, 64)
    y, x = numpy.mgrid[0:64, 0:64] / 64 * 4 * math.pi
    normal = numpy.stack((0.4 * numpy.sin(x), 0.4 * numpy.sin(y), 1 + 0 * x), -1)
    normal = normal / numpy.linalg.norm(normal, axis=-1, keepdims=True) * 0.5 + 0.5
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(numpy.concatenate((normal, 1 + 0 * normal[..., :1]), -1).astype(numpy.float32).ravel())
    image.pack()
    picture, bumps = add_node(made, "ShaderNodeTexImage"), add_node(made, "ShaderNodeNormalMap")
    picture.image = image
    link(made, picture, 0, bumps, "Color"), link(made, bumps, 0, shader, "Normal")
    usual(made, cube)


def many_instances():
    floor(), lamp("AREA", 400, size=2), background(0.3)
    group = bpy.data.collections.new("group")
    for made, x in ((material(Color=(0.8, 0.2, 0.2)), 0), (material(Color=(0.2, 0.7, 0.2)), 0.5)):
        thing = ball(made, (x, 0, 0.3), 0.25)
        bpy.context.scene.collection.objects.unlink(thing)
        group.objects.link(thing)
    for i in range(9):
        place = bpy.data.objects.new("place", None)
        place.instance_type, place.instance_collection = "COLLECTION", group
        place.location = ((i % 3 - 1) * 1.3, (i // 3 - 1) * 1.3, 0)
        place.scale, place.rotation_euler = (1, 1, 1 + 0.4 * (i % 2)), (0, 0, i)
        bpy.context.scene.collection.objects.link(place)


def subdivision():
    thing = usual(None, cube)
    modifier = thing.modifiers.new("smooth", "SUBSURF")
    modifier.levels = modifier.render_levels = 2


def depth_of_field():
    usual()
    ball(material(Color=(0.2, 0.3, 0.8)), (1.3, 4, 1))
    ball(material(Color=(0.2, 0.8, 0.3)), (-0.9, -3, 0.7), 0.4)
    dof = bpy.context.scene.camera.data.dof
    dof.use_dof, dof.focus_distance, dof.aperture_fstop = True, 6.0, 0.1


def shifted_camera():
    usual(None, cube)
    data = bpy.context.scene.camera.data
    data.shift_x, data.shift_y, data.lens = 0.2, -0.15, 40


def orthographic_camera():
    usual(None, cube)
    data = bpy.context.scene.camera.data
    data.type, data.ortho_scale, data.shift_x = "ORTHO", 6, 0.1


def moved(thing, by=(0, 0, 0), turn=(0, 0, 0)):
    """Goes and turns evenly, so far in one frame, and is where it was in frame 1."""
    for name, rate in (("location", by), ("rotation_euler", turn)):
        now = tuple(getattr(thing, name))
        for frame in (-1, 3):
            setattr(thing, name, [a + (frame - 1) * b for a, b in zip(now, rate)])
            thing.keyframe_insert(name, frame=frame)
    for curve in thing.animation_data.action.fcurves:
        curve.extrapolation = "LINEAR"
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    bpy.context.scene.frame_set(1)
    return thing


def open_shutter(frames, position="CENTER"):
    scene = bpy.context.scene
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, frames
    scene.cycles.motion_blur_position = position


def moving_things():
    """A ball that goes, with a child beside it, a cube that turns, and two instances that are carried."""
    moved(usual(), (1.2, 0, 0), (0, 0, 0.6))
    child = ball(material(Color=(0.2, 0.6, 0.3)), (0.8, -1.6, 0.2), 0.35)
    child.parent = bpy.data.objects["Sphere"]
    moved(cube(place=(-1.6, 1.5, 0.8)), turn=(0, 0, 1.8))
    group = bpy.data.collections.new("group")
    thing = ball(material(Color=(0.8, 0.7, 0.2)), (0, 0, 0.3), 0.3)
    bpy.context.scene.collection.objects.unlink(thing)
    group.objects.link(thing)
    for x in (-1.5, 1.5):
        place = bpy.data.objects.new("place", None)
        place.instance_type, place.instance_collection, place.location = "COLLECTION", group, (x, -2, 0)
        bpy.context.scene.collection.objects.link(place)
        moved(place, (0.5, 0.5, 0))
    open_shutter(0.8)


def moving_from_its_frame_on():
    moved(usual(None, cube), (0.8, 0, 0.3))
    open_shutter(1.0, "START")


def moving_camera():
    usual(None, cube)
    moved(bpy.context.scene.camera, (1.0, 0.5, 0), (0, 0.3, 0))
    open_shutter(0.7, "END")


def furry(made, curved=0.15):
    """A ball of another material with hair of particles that are bent."""
    background(0.6), floor(), lamp("AREA", 500, size=2)
    thing = ball(material(Color=(0.3, 0.25, 0.2)), radius=0.7)
    thing.data.materials.append(made)
    system = thing.modifiers.new("fur", "PARTICLE_SYSTEM").particle_system
    settings = system.settings
    settings.type, settings.count, settings.hair_length, settings.render_step = "HAIR", 700, 0.6, 3
    settings.material, settings.radius_scale, settings.root_radius, settings.tip_radius = 2, 0.06, 1.0, 0.3
    settings.kink, settings.kink_amplitude, settings.child_type = "NO", 0, "NONE"
    settings.tangent_factor = curved
    return thing


def hair_by_melanin():
    furry(material("ShaderNodeBsdfHairPrincipled", parametrization="MELANIN", Melanin=0.5, Melanin_Redness=0.6))


def hair_by_colour():
    thing = furry(material("ShaderNodeBsdfHairPrincipled", parametrization="COLOR", Color=(0.6, 0.25, 0.1), Radial_Roughness=0.5))
    thing.scale = (1.5, 1.5, 1)


def instances_of_hair():
    furry(material("ShaderNodeBsdfHairPrincipled", parametrization="ABSORPTION", Absorption_Coefficient=(0.2, 0.5, 1.2), Roughness=0.5))
    thing = bpy.context.object
    group = bpy.data.collections.new("group")
    bpy.context.scene.collection.objects.unlink(thing)
    group.objects.link(thing)
    for x, size in ((-1, 0.8), (1, 1.3)):
        place = bpy.data.objects.new("place", None)
        place.instance_type, place.instance_collection, place.location, place.scale = "COLLECTION", group, (x, 0, 0), 3 * [size]
        bpy.context.scene.collection.objects.link(place)


def matt_hair():
    furry(material(Color=(0.7, 0.5, 0.2)))


def hair_as_curves():
    thing = furry(material("ShaderNodeBsdfHairPrincipled", parametrization="MELANIN", Melanin=0.3))
    bpy.ops.object.select_all(action="DESELECT")
    thing.select_set(True)
    bpy.context.view_layer.objects.active = thing
    bpy.ops.curves.convert_from_particle_system()
    for curves in (one for one in bpy.data.objects if one.type == "CURVES"):
        curves.data.materials.clear()
        curves.data.materials.append(thing.data.materials[1])
    thing.modifiers.clear()


all_scenes = [
    point_lamp, small_point_lamp, sun_lamp, spot_lamp, square_lamp, disk_lamp, shining_mesh, grey_sky,
    environment_picture, nishita_sky, matt, gloss, rough_glass, clear_glass, principled_plastic, principled_metal,
    principled_coat, mixed_shaders, half_transparent, image_texture, normal_map, many_instances, subdivision,
    depth_of_field, shifted_camera, orthographic_camera, moving_things, moving_from_its_frame_on, moving_camera,
    hair_by_melanin, hair_by_colour, instances_of_hair, matt_hair, hair_as_curves,
]
