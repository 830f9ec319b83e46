"""A scene of references/NAME.scene.json by Cycles: blender -b --factory-startup --python THIS -- SCENE SAMPLES OUT THREADS SEED

The lamp is Blender's own area light before a black plate, since lamps of Blender stop no rays; balls are finely cut."""

import json
import math
import os
import re
import sys

import bpy
import numpy as np
from mathutils import Matrix, Vector

BALL_STEPS = 256
ALL_BOUNCES = 64

description, samples, out, threads, seed = sys.argv[sys.argv.index("--") + 1 :]
FOLDER = os.path.dirname(os.path.abspath(description))
with open(description, encoding="utf-8") as text:
    wanted = json.load(text)

for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
scene = bpy.context.scene


def placed(name, data):
    thing = bpy.data.objects.new(name, data)
    scene.collection.objects.link(thing)
    return thing


def material(name, kind, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    shader = tree.nodes.new(kind)
    if hasattr(shader, "distribution"):
        shader.distribution = "SHARP"
    for key, value in inputs.items():
        shader.inputs[key].default_value = value
    tree.links.new(shader.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made


def mesh(name, corners, faces, made_of, smooth=False):
    corners = np.asarray(corners, np.float32)
    faces = np.asarray(faces, np.int32)
    data = bpy.data.meshes.new(name)
    data.vertices.add(len(corners))
    data.vertices.foreach_set("co", corners.ravel())
    data.loops.add(faces.size)
    data.loops.foreach_set("vertex_index", faces.ravel())
    data.polygons.add(len(faces))
    data.polygons.foreach_set("loop_start", np.arange(0, faces.size, 3, dtype=np.int32))
    data.polygons.foreach_set("loop_total", np.full(len(faces), 3, np.int32))
    data.polygons.foreach_set("use_smooth", np.full(len(faces), smooth))
    data.update()
    data.materials.append(made_of)
    placed(name, data)


def ply(file):
    """Of binary files with three coordinates a corner and three corners a face."""
    with open(os.path.join(FOLDER, file), "rb") as opened:
        data = opened.read()
    head = data.index(b"end_header\n") + len(b"end_header\n")
    count = [int(re.search(rb"element %s (\d+)" % what, data).group(1)) for what in (b"vertex", b"face")]
    corners = np.frombuffer(data, "<f4", count[0] * 3, head).reshape(-1, 3)
    face = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
    return corners, np.frombuffer(data, face, count[1], head + corners.nbytes)["corners"]


def lamp(name, light):
    corner, along, across = (Vector(light[key]) for key in ("p", "e1", "e2"))
    normal = along.cross(across).normalized()
    brightest = max(light["L"])
    data = bpy.data.lights.new(name, "AREA")
    data.shape = "RECTANGLE"
    data.size, data.size_y = along.length, across.length
    data.color = [part / brightest for part in light["L"]]
    data.energy = brightest * 4 * along.length * across.length  # radiance: energy / (4 area)
    data.cycles.max_bounces = 1024
    thing = placed(name, data)
    middle = corner + 0.5 * along + 0.5 * across
    z, x = -normal, along.normalized()
    y = z.cross(x)
    thing.matrix_world = Matrix([(x[i], y[i], z[i], middle[i]) for i in range(3)] + [(0, 0, 0, 1)])
    thing.visible_camera = True
    behind = corner - normal * (0.0005 * max(along.length, across.length))
    corners = [behind, behind + along, behind + along + across, behind + across]
    mesh(name + ".plate", corners, [[0, 1, 2], [0, 2, 3]], material(name, "ShaderNodeEmission", Strength=0))


def ball(name, sphere):
    if sphere["mat"] == "glass":
        made_of = material(name, "ShaderNodeBsdfGlass", Color=(1, 1, 1, 1), Roughness=0, IOR=sphere["ior"])
    else:
        made_of = material(name, "ShaderNodeBsdfGlossy", Color=(0.9999, 0.9999, 0.9999, 1), Roughness=0)
    rows, columns = BALL_STEPS, 2 * BALL_STEPS
    polar, around = np.linspace(0, np.pi, rows + 1)[1:-1], np.arange(columns) * 2 * np.pi / columns
    points = np.stack(
        [
            np.outer(np.sin(polar), np.cos(around)),
            np.outer(np.cos(polar), np.ones(columns)),
            -np.outer(np.sin(polar), np.sin(around)),
        ],
        -1,
    ).reshape(-1, 3)
    corners = np.concatenate([points, [[0, 1, 0], [0, -1, 0]]]) * sphere["r"] + np.array(sphere["c"])
    top, bottom, last = len(points), len(points) + 1, (rows - 2) * columns
    faces = []
    for i in range(columns):
        right = (i + 1) % columns
        faces += [[top, i, right], [bottom, last + right, last + i]]
        for row in range(rows - 2):
            a, b, c, d = (r * columns + k for r, k in ((row, i), (row, right), (row + 1, right), (row + 1, i)))
            faces += [[a, d, c], [a, c, b]]
    mesh(name, corners, faces, made_of, smooth=True)


for one in wanted["meshes"]:
    matte = material(one["name"], "ShaderNodeBsdfDiffuse", Color=(*one["albedo"], 1), Roughness=0)
    mesh(one["name"], *(ply(one["ply"]) if "ply" in one else (one["vertices"], one["triangles"])), matte)
for index, one in enumerate(wanted["lights"]):
    lamp(f"lamp{index}", one)
for index, one in enumerate(wanted["spheres"]):
    ball(f"ball{index}", one)

sky = bpy.data.worlds.new("sky")
sky.use_nodes = True
around_all = wanted.get("env", [0, 0, 0])
sky.node_tree.nodes["Background"].inputs[0].default_value = (*around_all, 1)
sky.node_tree.nodes["Background"].inputs[1].default_value = 1
sky.cycles.sampling_method = "AUTOMATIC" if "env" in wanted else "NONE"
sky.cycles.max_bounces = 1024
scene.world = sky

view = wanted["cam"]
data = bpy.data.cameras.new("camera")
data.sensor_fit = "HORIZONTAL"
data.angle = math.radians(view["fov"])
data.clip_start, data.clip_end = 0.01, 1e5
eye = Vector(view["eye"])
ahead = (Vector(view["look"]) - eye).normalized()
right = ahead.cross(Vector(view["up"])).normalized()
up = right.cross(ahead)
scene.camera = placed("camera", data)
scene.camera.matrix_world = Matrix([(right[i], up[i], -ahead[i], eye[i]) for i in range(3)] + [(0, 0, 0, 1)])

render = scene.render
render.engine = "CYCLES"
render.resolution_x = render.resolution_y = wanted["resolution"]
render.resolution_percentage = 100
render.threads_mode, render.threads = "FIXED", int(threads)
render.use_compositing = render.use_sequencer = False
render.dither_intensity = 0
render.filepath, render.use_file_extension = os.path.abspath(out), False
render.image_settings.file_format = "OPEN_EXR"
render.image_settings.color_mode, render.image_settings.color_depth = "RGB", "32"
scene.view_settings.view_transform = "Standard"

cycles = scene.cycles
cycles.device = "CPU"
cycles.samples, cycles.seed = int(samples), int(seed)
cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_fast_gi = cycles.use_auto_tile = False
cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = ALL_BOUNCES
cycles.transmission_bounces = cycles.transparent_max_bounces = ALL_BOUNCES
cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
cycles.caustics_reflective = cycles.caustics_refractive = True
cycles.pixel_filter_type, cycles.filter_width = "BOX", 1
if hasattr(cycles, "use_guiding"):
    cycles.use_guiding = False
bpy.ops.render.render(write_still=True)
