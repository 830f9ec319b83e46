"""Lamps of Blender as emitters of Mitsuba's, in the same units: watts, and of suns watts per square metre."""

import math

import numpy
from mathutils import Matrix

from . import values, xml

half_turn = Matrix.Rotation(math.pi, 4, "Y")  # lamps of Blender shine along -z, those of Mitsuba along +z


def shining(name, radiance, hidden):
    """What a surface that is a lamp has: an emitter, and a black material; hidden ones are met by no ray."""
    black = xml.Element("bsdf", type="diffuse").add(xml.colour("reflectance", (0, 0, 0)))
    emitter = xml.Element("emitter", type="area", id=name).add(xml.colour("radiance", radiance))
    if not hidden:
        return black, emitter
    return xml.Element("bsdf", type="mask").add(xml.number("opacity", 0), black), emitter.add(xml.flag("unseen"))


def is_hidden(lamp, middle, radius, export):
    """Must it not be met by rays? The camera sees no lamp in Blender, but mirrors and glass do."""
    if not export.may_see(middle, radius):
        return False
    export.report.approximate("lamps before the camera are not seen in mirrors and through glass", lamp.name)
    return True


def stretch_of(matrix):
    return [matrix.col[i].to_3d().length for i in range(3)]


def strength_of(lamp, report):
    """Colour times power. Nodes of a lamp may say more, of which an Emission's own numbers are taken."""
    strength = numpy.array(lamp.color[:]) * lamp.energy
    if not lamp.use_nodes or lamp.node_tree is None:
        return strength
    node = next((node for node in lamp.node_tree.nodes if node.type == "EMISSION"), None)
    if node is None or any(socket.is_linked for socket in node.inputs):
        report.approximate("linked nodes of lamps do nothing", lamp.name)
    if node is None:
        return strength
    return strength * numpy.array(node.inputs["Color"].default_value[:3]) * node.inputs["Strength"].default_value


def standing(way, name):
    """Where the middle of what has no sides stands."""
    if way.keys is not None:
        return way.element(lambda matrix: Matrix.Translation(matrix.translation))
    place = way.now.translation
    return xml.Element("point", name=name, x=place.x, y=place.y, z=place.z)


def point(lamp, way, name, strength, export):
    intensity = strength / (4 * math.pi)
    place, radius = way.now.translation, lamp.shadow_soft_size
    if radius <= 0:
        return xml.Element("emitter", type="point", id=name).add(
            standing(way, "position"), xml.colour("intensity", intensity)
        )
    return xml.Element("shape", type="sphere").add(
        standing(way, "center"), xml.number("radius", radius),
        *shining(name, intensity / (math.pi * radius**2), is_hidden(lamp, place, radius, export)),
    )


def slide(angle, blend, size=512):
    """The picture that a spot throws: its soft edge, by the cosine, as Cycles has it; on a plane before the lamp."""
    tangent = math.tan(angle / 2)
    x, y = numpy.meshgrid(*2 * [(numpy.arange(size) + 0.5) / size * 2 - 1])
    cosine = 1 / numpy.sqrt(1 + (x**2 + y**2) * tangent**2)
    edge = math.cos(angle / 2)
    soft = (1 - edge) * blend
    t = numpy.clip((cosine - edge) / max(soft, 1e-6), 0, 1)
    return numpy.repeat((t * t * (3 - 2 * t))[..., None], 4, axis=2).astype(numpy.float32)


def spot(lamp, way, name, strength, export):
    if lamp.shadow_soft_size > 0:
        export.report.approximate("spot lamps shine from a point, so that their shadows are sharp", lamp.name)
    angle = min(lamp.spot_size, math.radians(178))
    cutoff = math.degrees(angle / 2)
    stood = lambda matrix: Matrix.Translation(matrix.translation) @ matrix.to_3x3().normalized().to_4x4() @ half_turn
    file = export.write_data(values.pfm(slide(angle, lamp.spot_blend)), "slide", ".pfm")
    picture = xml.Element("texture", type="bitmap", name="texture").add(xml.word("filename", file), xml.flag("raw"))
    return xml.Element("emitter", type="spot", id=name).add(
        way.element(stood), xml.colour("intensity", strength / (4 * math.pi)),
        xml.number("cutoff_angle", cutoff), xml.number("beam_width", cutoff), picture,
    )


def sun(lamp, way, name, strength, export):
    if way.keys is not None:
        export.report.approximate("suns stand still while the shutter is open", lamp.name)
    ahead = way.now.to_3x3().normalized() @ Matrix.Identity(3).col[2] * -1
    return xml.Element("emitter", type="directional", id=name).add(
        xml.Element("vector", name="direction", x=ahead.x, y=ahead.y, z=ahead.z),
        xml.colour("irradiance", strength), xml.number("angle", math.degrees(min(lamp.angle, 3.1))),
    )


def area(lamp, way, name, strength, export):
    """Radiance is a quarter of the power over the area, as Cycles has it."""
    round_ = lamp.shape in ("DISK", "ELLIPSE")
    even = lamp.shape in ("SQUARE", "DISK")
    wide, high = lamp.size, lamp.size if even else lamp.size_y
    x, y, _ = stretch_of(way.now)
    size = max(wide * x * high * y * (math.pi / 4 if round_ else 1), 1e-12)
    if lamp.spread < math.pi - 1e-3:
        export.report.approximate("area lamps shine to all sides, whatever their spread", lamp.name)
    hidden = is_hidden(lamp, way.now.translation, math.hypot(wide * x, high * y) / 2, export)
    own = Matrix.Diagonal((wide / 2, high / 2, 1, 1)) @ half_turn
    return xml.Element("shape", type="disk" if round_ else "rectangle").add(
        way.element(lambda matrix: matrix @ own), *shining(name, strength / (4 * size), hidden)
    )


makers = {"POINT": point, "SPOT": spot, "SUN": sun, "AREA": area}


def element(thing, way, name, export):
    """Of an evaluated object that is a lamp; None: it is dark."""
    lamp = thing.data
    strength = strength_of(lamp, export.report)
    if not (strength > 0).any():
        return None
    return makers[lamp.type](lamp, way, name, strength, export)
