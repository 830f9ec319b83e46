"""A scene of Blender as a file of Mitsuba's format: objects as they are after modifiers, lamps, world and camera."""

import math
import os

from mathutils import Matrix

from . import lamps, meshes, xml
from .materials import Materials


def write(folder, depsgraph, size):
    """Writes scene.xml and its meshes to the folder. Gives what can't be said, each once. Raises ValueError without a
    camera."""
    scene = depsgraph.scene
    if scene.camera is None:
        raise ValueError("the scene has no camera")
    warnings = {}
    materials = Materials(folder, warnings)
    parts = [camera(scene.camera.evaluated_get(depsgraph), scene, size), lamps.world(scene.world, folder, warnings)]
    written = {}
    for instance in depsgraph.object_instances:
        thing = instance.object
        if not instance.show_self:
            continue
        if thing.type == "LIGHT":
            parts.append(lamps.lamp(thing, instance.matrix_world, warnings))
        elif thing.type in {"MESH", "CURVE", "SURFACE", "FONT", "META"}:
            parts.append(placed(folder, thing, instance.matrix_world, materials, written))
    with open(os.path.join(folder, "scene.xml"), "w", encoding="utf-8") as file:
        file.write(xml.element("scene", "", parts, version="3.0.0"))
    return list(warnings)


def placed(folder, thing, at, materials, written):
    """Shapes of an object at a place; the mesh of several instances is written once."""
    key = thing.name_full, getattr(thing.data, "name_full", "")
    if key not in written:
        mesh = thing.to_mesh()
        if mesh is None:
            written[key] = {}, []
        else:
            written[key] = (meshes.write(folder, mesh) if len(mesh.polygons) else {}), list(mesh.materials)
            thing.to_mesh_clear()
    files, of_mesh = written[key]
    return "".join(shape(name, slot, thing, of_mesh, at, materials) for slot, name in files.items())


def shape(name, slot, thing, of_mesh, at, materials):
    """One file of a mesh, with its material."""
    slots = [one.material for one in thing.material_slots] or of_mesh
    bsdf, glow = materials.of(slots[min(slot, len(slots) - 1)] if slots else None)
    inside = [xml.single("string", "filename", name), xml.matrix("to_world", at), bsdf]
    if glow:
        inside.append(xml.element("emitter", "", [xml.rgb("radiance", glow)], type="area"))
    return xml.element("shape", "", inside, type="ply")


def camera(thing, scene, size):
    """The sensor: Blender's camera looks along -z, with x to the right; Mitsuba's along z, with x to the left."""
    data = thing.data
    at = thing.matrix_world.normalized() @ Matrix.Diagonal((-1, 1, -1, 1))
    aspect = size[0] / size[1]
    wide = data.sensor_fit == "HORIZONTAL" or (data.sensor_fit == "AUTO" and aspect >= 1)
    film = [xml.single("integer", "width", size[0]), xml.single("integer", "height", size[1])]
    inside = [xml.element("film", "", film, type="hdrfilm")]
    if data.type == "ORTHO":
        half = data.ortho_scale / 2 * (1 if wide else aspect)
        moved = Matrix.Translation((data.shift_x * data.ortho_scale, data.shift_y * data.ortho_scale, 0))
        at = thing.matrix_world.normalized() @ moved @ Matrix.Diagonal((-half, half, -1, 1))
        return xml.element("sensor", "", inside + [xml.matrix("to_world", at)], type="orthographic")
    sensor = data.sensor_height if data.sensor_fit == "VERTICAL" else data.sensor_width
    fov = 2 * math.degrees(math.atan(sensor / (2 * data.lens)))
    inside += [xml.matrix("to_world", at), xml.number("fov", fov), xml.single("string", "fov_axis", "x" if wide else "y")]
    across = (size[0], size[0]) if wide else (size[1], size[1])
    inside.append(xml.number("principal_point_offset_x", data.shift_x * across[0] / size[0]))
    inside.append(xml.number("principal_point_offset_y", -data.shift_y * across[1] / size[1]))
    inside.append(xml.number("near_clip", data.clip_start))
    if not data.dof.use_dof:
        return xml.element("sensor", "", inside, type="perspective")
    distance = data.dof.focus_distance
    if data.dof.focus_object:
        distance = abs((thing.matrix_world.normalized().inverted() @ data.dof.focus_object.matrix_world.translation).z)
    radius = data.lens / 1000 / (2 * data.dof.aperture_fstop)
    inside += [xml.number("aperture_radius", radius), xml.number("focus_distance", distance)]
    return xml.element("sensor", "", inside, type="thinlens")
