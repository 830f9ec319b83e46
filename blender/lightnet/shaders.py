"""Materials of Blender: what each shader of a node tree becomes."""

import math

import numpy

from . import fillings, nodes, strands, surfaces, values
from .surfaces import Surface


class Shaders(nodes.Evaluator):
    """Reads the shaders of one tree."""

    def shader(self, socket):
        """What comes into a socket of shaders. Nothing: black."""
        return self.at(socket, self._made, Surface)

    def _made(self, node):
        place = f"{self.where}: {node.name}"
        maker = makers.get(node.type)
        if maker is None:
            self.report.approximate(f"the shader {node.bl_label} is taken as matt grey", place)
            return Surface(surfaces.diffuse(values.constant(0.5)))
        return maker(self, node, place)

    def input(self, node, name):
        return self.value(node.inputs[name])

    def dressed(self, node, bsdf, name="Normal"):
        """With the bumps that a shader's Normal says."""
        socket = node.inputs.get(name)
        if bsdf is None or socket is None or not socket.is_linked:
            return bsdf
        return self.at(socket, lambda bumps: self._bumps(bumps, bsdf), lambda: bsdf)

    def _bumps(self, node, bsdf):
        place = f"{self.where}: {node.name}"
        if node.type == "BUMP":
            inner = self.dressed(node, bsdf)
            height = self.input(node, "Height")
            strength = values.number(self.input(node, "Strength")) * values.number(self.input(node, "Distance"))
            if values.is_constant(height) or strength == 0:
                return inner
            factor = -strength if node.invert else strength
            return surfaces.bumped(inner, values.combined(lambda h: h * factor, height))
        if node.type == "NORMAL_MAP" and node.space == "TANGENT":
            normals = self.input(node, "Color")
            strength = values.number(self.input(node, "Strength"))
            if values.is_constant(normals):
                return bsdf
            if strength != 1:
                normals = values.combined(lambda n: weakened(n, strength), normals)
            return surfaces.turned(bsdf, normals)
        self.report.missing(f"normals by the node {node.bl_label}", place)
        return bsdf


def weakened(colours, strength):
    """Normals, as colours, so much nearer to (or further from) the surface's own."""
    normal = 2 * colours[..., :3] - 1
    normal = normal * strength + numpy.array((0, 0, 1 - strength), numpy.float32)
    normal /= numpy.maximum(numpy.linalg.norm(normal, axis=-1, keepdims=True), 1e-6)
    return numpy.concatenate((normal * 0.5 + 0.5, colours[..., 3:4]), axis=-1)


def law_of(node, report, place):
    """The distribution of facets; those that Blender has besides are taken as GGX."""
    if node.distribution == "BECKMANN":
        return "beckmann"
    if node.distribution not in ("GGX", "SHARP"):
        name = node.distribution.replace("_", " ").lower()
        report.approximate(f"facets of the distribution {name} are taken as GGX, without further bounces", place)
    return "ggx"


def roughness_of(shaders, node):
    if getattr(node, "distribution", "") == "SHARP":
        return values.constant(0)
    return shaders.input(node, "Roughness")


def diffuse(shaders, node, _):
    colour, rough = shaders.input(node, "Color"), values.number(shaders.input(node, "Roughness"))
    bsdf = surfaces.rough_diffuse(colour, rough) if rough > 0 else surfaces.diffuse(colour)
    return Surface(shaders.dressed(node, bsdf))


def glossy(shaders, node, place):
    if node.type == "BSDF_ANISOTROPIC":
        shaders.report.approximate("anisotropic gloss is taken as even", place)
    law = law_of(node, shaders.report, place)
    return Surface(shaders.dressed(node, surfaces.glossy(shaders.input(node, "Color"), roughness_of(shaders, node), law)))


def glass(shaders, node, place):
    colour, rough = shaders.input(node, "Color"), roughness_of(shaders, node)
    ior = values.number(shaders.input(node, "IOR"))
    law = law_of(node, shaders.report, place)
    return Surface(shaders.dressed(node, surfaces.glass(colour, colour, rough, ior, law)))


def refraction(shaders, node, place):
    shaders.report.approximate("refraction without reflection loses what glass reflects", place)
    colour, rough = shaders.input(node, "Color"), roughness_of(shaders, node)
    ior = values.number(shaders.input(node, "IOR"))
    law = law_of(node, shaders.report, place)
    return Surface(shaders.dressed(node, surfaces.glass(values.constant(0), colour, rough, ior, law)))


def transparent(shaders, node, _):
    colour = shaders.input(node, "Color")
    if values.is_constant(colour) and (colour[:3] >= 0.999).all():
        return Surface(None, values.constant(0))
    return Surface(surfaces.coloured_window(colour))


def translucent(shaders, node, _):
    return Surface(shaders.dressed(node, surfaces.translucent(shaders.input(node, "Color"))))


def scattering(shaders, node, place):
    shaders.report.approximate("light below surfaces is taken as matt", place)
    return Surface(shaders.dressed(node, surfaces.diffuse(shaders.input(node, "Color"))))


def emission(shaders, node, _):
    light = values.scaled(shaders.input(node, "Color"), values.grey(shaders.input(node, "Strength")))
    return Surface(None, emission=light)


def mix(shaders, node, _):
    share, first, second = node.inputs
    return surfaces.mix(shaders.shader(first), shaders.shader(second), shaders.value(share))


def add(shaders, node, place):
    return surfaces.add(shaders.shader(node.inputs[0]), shaders.shader(node.inputs[1]), shaders.report, place)


def emission_of(shaders, node):
    name = "Emission" if "Emission" in node.inputs else "Emission Color"
    return values.scaled(shaders.input(node, name), values.grey(shaders.input(node, "Emission Strength")))


def names(node, *candidates):
    """The name of an input in this version of Blender."""
    return next(name for name in candidates if name in node.inputs)


def base_of(shaders, node, place):
    base = shaders.input(node, "Base Color")
    below = names(node, "Subsurface", "Subsurface Weight")
    share = shaders.input(node, below)
    if values.is_black(share):
        return base
    shaders.report.approximate("light below surfaces is taken as matt", place)
    return values.mixed(base, shaders.input(node, "Subsurface Color"), share) if "Subsurface Color" in node.inputs else base


def principled(shaders, node, place):
    """Blender's principled shader and Mitsuba's are both Disney's, whose parts add up; its glass is a part by itself."""
    take = lambda *candidates: shaders.input(node, names(node, *candidates))
    one = lambda *candidates: values.number(take(*candidates))
    base, rough = base_of(shaders, node, place), take("Roughness")
    ior, through = one("IOR"), take("Transmission", "Transmission Weight")
    gloss_alpha = one("Clearcoat Roughness", "Coat Roughness") ** 2
    parts = {
        "base_color": base,
        "roughness": rough,
        "metallic": take("Metallic"),
        "specular": values.constant(one("Specular", "Specular IOR Level")),
        "clearcoat": take("Clearcoat", "Coat Weight"),
        "clearcoat_gloss": values.constant(min(1, max(0, (0.1 - gloss_alpha) / 0.099))),
        "sheen": take("Sheen", "Sheen Weight"),
    }
    if "Sheen Tint" in node.inputs and node.inputs["Sheen Tint"].type == "VALUE":
        parts["sheen_tint"], parts["spec_tint"] = take("Sheen Tint"), take("Specular Tint")
    if one("Anisotropic") > 0:
        parts["anisotropic"] = values.constant(one("Anisotropic"))
        shaders.report.approximate("anisotropic gloss lies along the texture coordinates", place)
    bsdf = surfaces.principled(parts)
    if not values.is_black(through):
        clear = surfaces.glass(values.constant(1), base, rough, ior)
        metal = values.combined(lambda t, m: t * (1 - m), through, parts["metallic"])
        bsdf = surfaces.blend(bsdf, clear, metal)
    return Surface(shaders.dressed(node, bsdf), values.combined(lambda a: a.clip(0, 1), take("Alpha")), emission_of(shaders, node))


def absorption_of(shaders, node, around):
    take = lambda name: values.pixels_of(values.mean(shaders.input(node, name)))[:3]
    one = lambda name: values.number(shaders.input(node, name))
    if node.parametrization == "ABSORPTION":
        return take("Absorption Coefficient")
    if node.parametrization == "COLOR":
        return strands.absorption_of_colour(take("Color"), around)
    tint = strands.absorption_of_colour(take("Tint"), around)
    return strands.absorption_of_melanin(one("Melanin"), one("Melanin Redness")) + tint


def hair(shaders, node, place):
    """Chiang et al. 2016, as in Cycles. Its numbers are the same along each strand."""
    one = lambda name: values.number(shaders.input(node, name))
    for name, what in (("Coat", "the coat of hair is left out"), ("Random Color", "all strands of hair have the same colour"),
                       ("Random Roughness", "all strands of hair are as rough")):
        if node.inputs[name].is_linked or node.inputs[name].default_value > 0:
            shaders.report.approximate(what, place)
    around = one("Radial Roughness")
    return Surface(surfaces.hair(
        [float(part) for part in absorption_of(shaders, node, around)], one("Roughness"), around, max(one("IOR"), 1.001),
        math.degrees(one("Offset")),
    ))


def matt_hair(shaders, node, place):
    shaders.report.approximate("the shader Hair BSDF is taken as matt", place)
    return Surface(surfaces.diffuse(shaders.input(node, "Color")))


makers = {
    "BSDF_HAIR_PRINCIPLED": hair,
    "BSDF_HAIR": matt_hair,
    "BSDF_PRINCIPLED": principled,
    "BSDF_DIFFUSE": diffuse,
    "BSDF_GLOSSY": glossy,
    "BSDF_ANISOTROPIC": glossy,
    "BSDF_GLASS": glass,
    "BSDF_REFRACTION": refraction,
    "BSDF_TRANSPARENT": transparent,
    "BSDF_TRANSLUCENT": translucent,
    "SUBSURFACE_SCATTERING": scattering,
    "EMISSION": emission,
    "MIX_SHADER": mix,
    "ADD_SHADER": add,
}


def output_of(tree):
    """The node of a tree that says what a material or a world looks like; None: there is none."""
    return tree.get_output_node("CYCLES") or tree.get_output_node("ALL")


def volume_of(material, report):
    """What fills meshes of a material; None: nothing."""
    if material is None or not material.use_nodes or material.node_tree is None:
        return None
    return fillings.of_output(output_of(material.node_tree), material.name, report)


def surface_of(material, report):
    """Of a material; None: what surfaces without one look like."""
    if material is None:
        return Surface(surfaces.diffuse(values.constant(0.8)))
    if not material.use_nodes or material.node_tree is None:
        return Surface(surfaces.diffuse(values.constant(*material.diffuse_color[:3])))
    output = output_of(material.node_tree)
    if output is None:
        return Surface()
    shaders = Shaders(material.name, report)
    if output.inputs["Displacement"].is_linked:
        report.missing("displacements", material.name)
    if output.inputs["Volume"].is_linked and not output.inputs["Surface"].is_linked:
        return Surface(None, values.constant(0))
    return shaders.shader(output.inputs["Surface"])
