"""Values of sockets: constants, pictures, and what nodes between them and a shader do."""

import math
import os

import bpy
import numpy

from . import values


def linked(socket):
    """The node and socket from which a value comes, past reroutes and groups are the caller's; None: its own value."""
    return socket.links[0] if socket.is_linked and socket.links and not socket.links[0].is_muted else None


def own(socket):
    """The value that is written in a socket itself."""
    value = socket.default_value
    return values.constant(*value) if hasattr(value, "__len__") else values.constant(value)


class Evaluator:
    """Follows links of one node tree, into groups and out of them again."""

    def __init__(self, where, report):
        self.where, self.report, self.groups = where, report, []

    def source(self, socket):
        """The socket of a node that really says the value: an output, or an input without a link."""
        link = linked(socket)
        while link:
            node, socket = link.from_node, link.from_socket
            if node.type == "REROUTE":
                socket = node.inputs[0]
            elif node.type == "GROUP" and node.node_tree:
                inner = next((n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output), None)
                if inner is None:
                    return socket
                self.groups.append(node)
                socket = inner.inputs[socket.identifier]
            elif node.type == "GROUP_INPUT" and self.groups:
                socket = self.groups.pop().inputs[socket.identifier]
            else:
                return socket
            link = linked(socket)
        return socket

    def value(self, socket):
        """A constant or a picture."""
        before = list(self.groups)
        found = self.source(socket)
        result = own(found) if not found.is_output else self.made(found.node, found)
        self.groups = before
        as_number = socket.type == "VALUE" and found.is_output and found.type != "VALUE"
        return values.grey(result) if as_number else result

    def at(self, socket, make, nothing):
        """make() of the node whose output comes into a socket; nothing() where none does."""
        before = list(self.groups)
        found = self.source(socket)
        result = make(found.node) if found.is_output else nothing()
        self.groups = before
        return result

    def made(self, node, output):
        maker = makers.get(node.type)
        if maker is None:
            self.report.approximate(f"the node {node.bl_label} is taken as a mean", f"{self.where}: {node.name}")
            return values.constant(0.5)
        return maker(self, node, output)


def inputs_of(node, kind=None):
    """Sockets that are in use (Blender hides those of other modes)."""
    return [socket for socket in node.inputs if socket.enabled and (kind is None or socket.type == kind)]


def picture_pixels(image):
    """All pixels, linear, (height, width, 4), row 0 at the bottom."""
    width, height = image.size
    found = numpy.empty(width * height * 4, numpy.float32)
    image.pixels.foreach_get(found)
    found = found.reshape(height, width, 4)
    if image.colorspace_settings.name == "sRGB" and not image.is_float:
        found[..., :3] = values.linear(found[..., :3])
    return found


readable = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".tga", ".bmp", ".exr", ".hdr", ".webp"}


def picture_of(image):
    """An image of Blender; None: it has no pixels."""
    if image is None or image.size[0] == 0 or image.size[1] == 0:
        return None
    file = bpy.path.abspath(image.filepath, library=image.library)
    plain = image.source == "FILE" and not image.packed_file and not image.is_dirty and os.path.isfile(file)
    usual = image.colorspace_settings.name in ("sRGB", "Non-Color", "Raw", "Linear")
    known = plain and usual and os.path.splitext(file)[1].lower() in readable
    return values.Picture(
        lambda: picture_pixels(image), os.path.realpath(file) if known else None, image.colorspace_settings.name != "sRGB"
    )


def mapping_of(evaluator, node):
    """Scale, turn and offset of the texture coordinates that a node of a texture gets."""
    socket = node.inputs["Vector"]
    scale, turn, offset = (1.0, 1.0), 0.0, (0.0, 0.0)
    found = evaluator.source(socket)
    source = found.node if found.is_output else None
    if source and source.type == "MAPPING":
        take = lambda name: tuple(source.inputs[name].default_value) if name in source.inputs else (0, 0, 0)
        place, turned, scaled = take("Location"), take("Rotation"), take("Scale")
        if any(source.inputs[i].is_linked for i in range(1, len(source.inputs))):
            evaluator.report.approximate("a mapping with linked numbers is taken by those it has", evaluator.where)
        if source.vector_type == "TEXTURE":
            scale = (1 / (scaled[0] or 1), 1 / (scaled[1] or 1))
            turn = -turned[2]
            c, s = math.cos(turn), math.sin(turn)
            x, y = -place[0], -place[1]
            offset = (scale[0] * (c * x - s * y), scale[1] * (s * x + c * y))
            if scale[0] != scale[1] and turn:
                evaluator.report.approximate("an uneven mapping of type Texture is turned after its scale", evaluator.where)
        else:
            scale, turn = scaled[:2], turned[2]
            offset = place[:2] if source.vector_type == "POINT" else (0.0, 0.0)
        found = evaluator.source(source.inputs["Vector"])
        source = found.node if found.is_output else None
    flat = source is None or source.type == "UVMAP" or (source.type == "TEX_COORD" and found.name == "UV")
    if not flat:
        evaluator.report.approximate(
            "texture coordinates other than UV are taken as UV", f"{evaluator.where}: {source.name}"
        )
    return (*map(float, scale), float(turn), *map(float, offset))


def image_texture(evaluator, node, output):
    picture = picture_of(node.image)
    if picture is None:
        evaluator.report.missing("image textures without an image", f"{evaluator.where}: {node.name}")
        return values.constant(1, 0, 1)
    if node.image.source in ("TILED", "SEQUENCE", "MOVIE"):
        evaluator.report.approximate("of tiled and moving images one picture is taken", f"{evaluator.where}: {node.name}")
    if node.projection != "FLAT":
        evaluator.report.approximate("projections of images are taken as flat", f"{evaluator.where}: {node.name}")
    picture.mapping = mapping_of(evaluator, node)
    picture.wrap = {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "zero"}.get(node.extension, "mirror")
    picture.nearest = node.interpolation == "Closest"
    picture.channel = "a" if output.name == "Alpha" else None
    return picture


def checker(evaluator, node, output):
    """Squares on texture coordinates. Blender's fill space: where it has no coordinates they lie on UV."""
    if evaluator.source(node.inputs["Vector"]).is_output is False:
        evaluator.report.approximate("generated texture coordinates are taken as UV", f"{evaluator.where}: {node.name}")
    if output.name == "Fac":
        one, other = values.constant(1), values.constant(0)
    else:
        one, other = (values.mean(evaluator.value(node.inputs[name])) for name in ("Color1", "Color2"))
    pixels = numpy.array(((one, other), (other, one)), numpy.float32)
    half = values.number(evaluator.value(node.inputs["Scale"])) / 2
    x, y, turn, right, up = mapping_of(evaluator, node)
    mapping = (x * half, y * half, turn, right * half, up * half)
    return values.Picture(lambda: pixels, None, True, mapping, "repeat", True)


blends = {
    "MIX": lambda a, b: b,
    "ADD": lambda a, b: a + b,
    "MULTIPLY": lambda a, b: a * b,
    "SUBTRACT": lambda a, b: a - b,
    "SCREEN": lambda a, b: 1 - (1 - a) * (1 - b),
    "DIVIDE": lambda a, b: numpy.where(b != 0, a / numpy.where(b != 0, b, 1), a),
    "DIFFERENCE": lambda a, b: numpy.abs(a - b),
    "DARKEN": numpy.minimum,
    "LIGHTEN": numpy.maximum,
    "OVERLAY": lambda a, b: numpy.where(a < 0.5, 2 * a * b, 1 - 2 * (1 - a) * (1 - b)),
}


def mix(evaluator, node, _):
    share, a, b = (evaluator.value(socket) for socket in inputs_of(node)[:3])
    blend = blends.get(getattr(node, "blend_type", "MIX")) or blends["MIX"]
    if getattr(node, "blend_type", "MIX") not in blends:
        evaluator.report.approximate(f"colours mixed by {node.blend_type.lower()} are just mixed", evaluator.where)
    clamp = getattr(node, "use_clamp", False) or getattr(node, "clamp_result", False)

    def function(x, y, t):
        t = numpy.clip(t[..., :1], 0, 1)
        result = x + (blend(x, y) - x) * t
        return numpy.clip(result, 0, 1) if clamp else result

    return values.combined(function, a, b, share)


sums = {
    "ADD": lambda a, b, c: a + b,
    "SUBTRACT": lambda a, b, c: a - b,
    "MULTIPLY": lambda a, b, c: a * b,
    "DIVIDE": lambda a, b, c: numpy.where(b != 0, a / numpy.where(b != 0, b, 1), 0),
    "MULTIPLY_ADD": lambda a, b, c: a * b + c,
    "POWER": lambda a, b, c: numpy.maximum(a, 0) ** b,
    "MINIMUM": lambda a, b, c: numpy.minimum(a, b),
    "MAXIMUM": lambda a, b, c: numpy.maximum(a, b),
    "LESS_THAN": lambda a, b, c: (a < b) * 1.0,
    "GREATER_THAN": lambda a, b, c: (a > b) * 1.0,
    "SQRT": lambda a, b, c: numpy.sqrt(numpy.maximum(a, 0)),
    "ABSOLUTE": lambda a, b, c: numpy.abs(a),
}


def math_node(evaluator, node, _):
    function = sums.get(node.operation)
    if function is None:
        evaluator.report.approximate(f"the operation {node.operation.lower()} does nothing", evaluator.where)
        return evaluator.value(node.inputs[0])
    a, b, c = (evaluator.value(node.inputs[i]) for i in range(3))
    clamp = numpy.clip if node.use_clamp else lambda x, *_: x
    return values.combined(lambda x, y, z: clamp(function(x, y, z), 0, 1), a, b, c)


def ramp(evaluator, node, output):
    """A colour ramp, as a table of 256 colours."""
    table = numpy.array([node.color_ramp.evaluate(i / 255) for i in range(256)], numpy.float32)

    def function(share):
        return table[numpy.clip(numpy.rint(share[..., 0] * 255), 0, 255).astype(int)]

    result = values.combined(function, evaluator.value(node.inputs["Fac"]))
    if output.name == "Alpha":
        return values.combined(lambda x: numpy.repeat(x[..., 3:4], 4, axis=-1), result)
    return result


def separate(evaluator, node, output):
    which = list(node.outputs).index(output)
    if getattr(node, "mode", "RGB") != "RGB":
        evaluator.report.approximate("colours are taken apart as RGB alone", evaluator.where)
    return values.combined(lambda x: numpy.repeat(x[..., which : which + 1], 4, axis=-1), evaluator.value(node.inputs[0]))


def combine(evaluator, node, _):
    parts = [evaluator.value(socket) for socket in inputs_of(node)[:3]]
    return values.combined(
        lambda r, g, b: numpy.stack((r[..., 0], g[..., 0], b[..., 0], numpy.ones_like(r[..., 0])), axis=-1), *parts
    )


def gamma(evaluator, node, _):
    return values.combined(lambda x, g: numpy.maximum(x, 0) ** g[..., :1], *(evaluator.value(s) for s in node.inputs[:2]))


def invert(evaluator, node, _):
    share, colour = evaluator.value(node.inputs["Fac"]), evaluator.value(node.inputs["Color"])
    return values.combined(lambda x, t: x + (1 - 2 * x) * t[..., :1], colour, share)


def bright(evaluator, node, _):
    colour, more, contrast = (evaluator.value(socket) for socket in node.inputs[:3])
    return values.combined(
        lambda x, b, c: numpy.maximum((1 + c[..., :1]) * x + b[..., :1] - c[..., :1] * 0.5, 0), colour, more, contrast
    )


def clamp_node(evaluator, node, _):
    return values.combined(numpy.clip, *(evaluator.value(socket) for socket in node.inputs[:3]))


def black_body(evaluator, node, _):
    return values.constant(*black_body_colour(values.number(evaluator.value(node.inputs["Temperature"]))))


def black_body_colour(kelvin):
    """Linear RGB of luminance 1, by Planck's law and the CIE's curves as Wyman, Sloan and Shirley (2013) fit them."""
    waves = numpy.arange(380.0, 781.0, 5.0)
    light = 1 / (waves**5 * (numpy.exp(1.4388e7 / (waves * max(kelvin, 800.0))) - 1))

    def bell(middle, left, right):
        return numpy.exp(-0.5 * ((waves - middle) * numpy.where(waves < middle, left, right)) ** 2)

    x = 1.056 * bell(599.8, 0.0264, 0.0323) + 0.362 * bell(442, 0.0624, 0.0374) - 0.065 * bell(501.1, 0.049, 0.0382)
    y = 0.821 * bell(568.8, 0.0213, 0.0247) + 0.286 * bell(530.9, 0.0613, 0.0322)
    z = 1.217 * bell(437, 0.0845, 0.0278) + 0.681 * bell(459, 0.0385, 0.0725)
    seen = numpy.array([(light * curve).sum() for curve in (x, y, z)])
    to_rgb = numpy.array(((3.2406, -1.5372, -0.4986), (-0.9689, 1.8758, 0.0415), (0.0557, -0.2040, 1.0570)))
    return numpy.maximum(to_rgb @ (seen / seen[1]), 0)


makers = {
    "RGB": lambda evaluator, node, output: own(output),
    "VALUE": lambda evaluator, node, output: own(output),
    "TEX_IMAGE": image_texture,
    "TEX_CHECKER": checker,
    "MIX_RGB": mix,
    "MIX": mix,
    "MATH": math_node,
    "VALTORGB": ramp,
    "SEPARATE_COLOR": separate,
    "SEPRGB": separate,
    "COMBINE_COLOR": combine,
    "COMBRGB": combine,
    "GAMMA": gamma,
    "INVERT": invert,
    "BRIGHTCONTRAST": bright,
    "CLAMP": clamp_node,
    "RGBTOBW": lambda evaluator, node, output: values.grey(evaluator.value(node.inputs[0])),
    "BLACKBODY": black_body,
}
