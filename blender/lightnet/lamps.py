"""Lamps and the world of Blender, whose strengths are watts, as emitters of Mitsuba's format."""

import math

from mathutils import Matrix

from . import xml
from .materials import behind, black, image_file


def lamp(thing, at, warnings):
    """Text of a lamp that stands at `at`."""
    data = thing.data
    light = [data.energy * part for part in data.color]
    at = at.normalized()
    if data.type == "SUN":
        return sun(data, light, at, warnings, thing.name)
    if data.type == "AREA":
        return area(data, light, at, thing.matrix_world.to_scale())
    if data.type == "SPOT":
        return spot(data, light, at, warnings, thing.name)
    return point(data, light, at)


def sun(data, light, at, warnings, name):
    """Irradiance of a plane that faces it, in W/m²."""
    if data.angle > math.radians(1):
        warnings[f"{name}: shadows of the sun are sharp, without its angle"] = None
    inside = [xml.matrix("to_world", at @ Matrix.Diagonal((-1, 1, -1, 1))), xml.rgb("irradiance", light)]
    return xml.element("emitter", "", inside, type="directional")


def point(data, light, at):
    """A sphere of radiance P / (4 π² r²), or without a radius an intensity of P / (4 π)."""
    radius = data.shadow_soft_size
    if radius <= 0:
        place = "".join(f' {axis}="{float(value)!r}"' for axis, value in zip("xyz", at.translation))
        inside = [f'<point name="position"{place}/>\n', xml.rgb("intensity", _times(light, 1 / (4 * math.pi)))]
        return xml.element("emitter", "", inside, type="point")
    glow = _times(light, 1 / (4 * math.pi**2 * radius**2))
    return _shining("sphere", glow, at @ Matrix.Diagonal((radius, radius, radius, 1)))


def spot(data, light, at, warnings, name):
    """A point whose light is kept to a cone; Mitsuba's edge is linear in the angle, Blender's smooth in its cosine."""
    if data.shadow_soft_size > 0:
        warnings[f"{name}: shadows of the spot are sharp, without its radius"] = None
    half = math.degrees(data.spot_size) / 2
    inner = half * (1 - data.spot_blend) if data.spot_blend > 0 else half * 0.999
    inside = [xml.matrix("to_world", at @ Matrix.Diagonal((-1, 1, -1, 1))), xml.number("cutoff_angle", half)]
    inside += [xml.number("beam_width", inner), xml.rgb("intensity", _times(light, 1 / (4 * math.pi)))]
    return xml.element("emitter", "", inside, type="spot")


def area(data, light, at, scale):
    """A rectangle or an ellipse of radiance P / (4 A), as Cycles has it."""
    across = data.size * scale.x
    along = (data.size_y if data.shape in ("RECTANGLE", "ELLIPSE") else data.size) * scale.y
    is_round = data.shape in ("DISK", "ELLIPSE")
    surface = across * along * (math.pi / 4 if is_round else 1)
    at = at @ Matrix.Diagonal((-across / 2, along / 2, -1, 1))
    return _shining("disk" if is_round else "rectangle", _times(light, 1 / (4 * surface)), at)


def _shining(kind, glow, at):
    inside = [xml.matrix("to_world", at), black(), xml.element("emitter", "", [xml.rgb("radiance", glow)], type="area")]
    return xml.element("shape", "", inside, type=kind)


def _times(light, factor):
    return [factor * part for part in light]


def world(data, folder, warnings):
    """Light from all around: a colour, or a picture turned about z."""
    if data is None:
        return _constant((0, 0, 0))
    if not data.use_nodes:
        return _constant(data.color)
    output = data.node_tree.get_output_node("CYCLES") or data.node_tree.get_output_node("ALL")
    node = behind(output.inputs["Surface"]) if output else None
    if node is None:
        return _constant((0, 0, 0))
    if node.type != "BACKGROUND":
        warnings[f"{data.name}: node '{node.name}' is not known, and black"] = None
        return _constant((0, 0, 0))
    strength, sky = node.inputs["Strength"].default_value, behind(node.inputs["Color"])
    if sky is None:
        return _constant(_times(tuple(node.inputs["Color"].default_value)[:3], strength))
    if sky.type != "TEX_ENVIRONMENT" or sky.image is None or sky.projection != "EQUIRECTANGULAR":
        warnings[f"{data.name}: node '{sky.name}' is not known, and black"] = None
        return _constant((0, 0, 0))
    return _panorama(sky, strength, folder, warnings, data.name)


def _constant(colour):
    return xml.element("emitter", "", [xml.rgb("radiance", colour)], type="constant")


def _panorama(sky, strength, folder, warnings, name):
    turn, mapping = Matrix.Identity(4), behind(sky.inputs["Vector"])
    if mapping is not None and mapping.type == "MAPPING":
        turn = mapping.inputs["Rotation"].default_value.to_matrix().to_4x4().inverted()
    elif mapping is not None and mapping.type != "TEX_COORD":
        warnings[f"{name}: node '{mapping.name}' is not known, and left out"] = None
    # Mitsuba has y up in its maps, Blender z; this turns the middle of one onto that of the other.
    upright = Matrix(((0, 0, 1, 0), (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 0, 1)))
    inside = [xml.single("string", "filename", image_file(sky.image, folder)), xml.number("scale", strength)]
    return xml.element("emitter", "", inside + [xml.matrix("to_world", turn @ upright)], type="envmap")
