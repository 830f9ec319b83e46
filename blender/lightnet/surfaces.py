"""What shaders become: a bsdf of Mitsuba's, how much of it is there, and the light that it gives of itself.

Knows nothing of Blender.
"""

import dataclasses

from . import values, xml


@dataclasses.dataclass
class Surface:
    """bsdf: called with what turns values into elements, makes the element; None: black, reflects nothing.
    opacity: a value; where it is 0 light goes straight through. emission: a value, radiance."""

    bsdf: object = None
    opacity: object = dataclasses.field(default_factory=lambda: values.constant(1))
    emission: object = dataclasses.field(default_factory=lambda: values.constant(0))


black = lambda _: xml.Element("bsdf", type="diffuse").add(xml.colour("reflectance", (0, 0, 0)))


def both_sides(make):
    return lambda put: xml.Element("bsdf", type="twosided").add(make(put))


def blend(a, b, share):
    """Of two makers of bsdfs; b where the share is 1."""
    if values.is_constant(share) and share[0] <= 0:
        return a
    if values.is_constant(share) and share[0] >= 1:
        return b
    if a is None and b is None:
        return None
    return lambda put: xml.Element("bsdf", type="blendbsdf").add(
        put("weight", share), (a or black)(put), (b or black)(put)
    )


def mix(a, b, share):
    """The first where the share is 0, the second where it is 1, as Blender's Mix Shader.

    What is there of the whole is that of both; of what is there, the second has a part that follows.
    """
    share = values.combined(lambda x: x.clip(0, 1), share)
    opacity = values.mixed(a.opacity, b.opacity, share)
    part = share
    emission = values.mixed(a.emission, b.emission, share)
    for hole, other in ((a, b), (b, a)):
        if hole.bsdf is None and values.is_constant(hole.opacity) and hole.opacity[0] <= 0:
            return Surface(other.bsdf, opacity, emission)
    if not (values.is_constant(a.opacity) and values.is_constant(b.opacity) and (a.opacity == b.opacity).all()):
        part = values.combined(
            lambda x, y, t: (y * t) / (x + (y - x) * t + 1e-9), a.opacity, b.opacity, share
        )
    return Surface(blend(a.bsdf, b.bsdf, part), opacity, emission)


def add(a, b, report, where):
    """Blender's Add Shader: exact where one of them reflects nothing."""
    emission = values.combined(lambda x, y: x + y, a.emission, b.emission)
    if a.bsdf and b.bsdf:
        report.approximate("the sum of two reflections is taken as their even mixture", where)
        return Surface(blend(a.bsdf, b.bsdf, values.constant(0.5)), a.opacity, emission)
    with_bsdf = a if a.bsdf else b
    return Surface(with_bsdf.bsdf, with_bsdf.opacity, emission)


def diffuse(reflectance):
    return both_sides(lambda put: xml.Element("bsdf", type="diffuse").add(put("reflectance", reflectance)))


def rough_diffuse(reflectance, sigma):
    """Oren and Nayar's, of a standard deviation sigma of slopes."""
    return both_sides(
        lambda put: xml.Element("bsdf", type="roughdiffuse").add(
            put("reflectance", reflectance), xml.number("alpha", min(1, sigma * 2**0.5))
        )
    )


def translucent(transmittance):
    return lambda put: xml.Element("bsdf", type="difftrans").add(put("transmittance", transmittance))


def alpha_of(roughness):
    """GGX's α of Blender's roughness."""
    return values.combined(lambda r: r * r, roughness)


def is_smooth(roughness):
    return values.is_constant(roughness) and roughness[0] < 0.01


def glossy(colour, roughness, law="ggx"):
    def make(put):
        if is_smooth(roughness):
            return xml.Element("bsdf", type="conductor").add(
                xml.word("material", "none"), put("specular_reflectance", colour)
            )
        return xml.Element("bsdf", type="roughconductor").add(
            xml.word("material", "none"), xml.word("distribution", law), put("alpha", alpha_of(roughness)),
            put("specular_reflectance", colour),
        )

    return both_sides(make)


def glass(reflected, passed, roughness, ior, law="ggx"):
    def make(put):
        kind = "dielectric" if is_smooth(roughness) else "roughdielectric"
        element = xml.Element("bsdf", type=kind).add(xml.number("int_ior", ior), xml.number("ext_ior", 1))
        if kind == "roughdielectric":
            element.add(xml.word("distribution", law), put("alpha", alpha_of(roughness)))
        return element.add(put("specular_reflectance", reflected), put("specular_transmittance", passed))

    return make


def coloured_window(colour):
    """Light goes straight through, and is coloured."""
    return lambda put: xml.Element("bsdf", type="thindielectric").add(
        xml.number("int_ior", 1), xml.number("ext_ior", 1), put("specular_transmittance", colour)
    )


def hair(absorption, along, around, ior, tilt):
    """absorption: by radius; roughness along and around the hair; tilt of its scales, degrees."""
    most = max(*absorption, 1e-6)
    return lambda _: xml.Element("bsdf", type="hair").add(
        xml.colour("sigma_a", [part / most for part in absorption]), xml.number("scale", most),
        xml.number("longitudinal_roughness", along), xml.number("azimuthal_roughness", around),
        xml.number("scale_tilt", tilt), xml.number("int_ior", ior), xml.number("ext_ior", 1),
    )


def principled(parts):
    """Of values by the names that Mitsuba gives them; those that are None stay as they are there."""

    def make(put):
        element = xml.Element("bsdf", type="principled")
        return element.add(*(put(name, value) for name, value in parts.items() if value is not None))

    return both_sides(make)


def bumped(make, height):
    if make is None:
        return None
    return lambda put: xml.Element("bsdf", type="bumpmap").add(put("texture", height), make(put))


def turned(make, normals):
    if make is None:
        return None
    return lambda put: xml.Element("bsdf", type="normalmap").add(put("normalmap", normals), make(put))
