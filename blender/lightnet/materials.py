"""Materials of Blender's nodes as those of Mitsuba's format."""

import os

import bpy

from . import xml

grey = '<bsdf type="diffuse"/>\n'


class Materials:
    """What materials become in the file; `warnings` names what can't be said, once."""

    def __init__(self, folder, warnings):
        self.folder, self.warnings = folder, warnings
        self._said = set()  # sockets that the file says something of

    def of(self, material):
        """(text of the bsdf, emitted radiance or None) of a material, or of none."""
        if material is None:
            return xml.element("bsdf", "", [xml.rgb("reflectance", (0.8,) * 3)], type="diffuse"), None
        if not material.use_nodes:
            return xml.element("bsdf", "", [xml.rgb("reflectance", material.diffuse_color)], type="diffuse"), None
        output = material.node_tree.get_output_node("CYCLES") or material.node_tree.get_output_node("ALL")
        if output is None:
            return black(), None
        if output.inputs["Displacement"].is_linked:
            self.warn(material.name, output, "is without its displacement")
        return self.shader(self.feeds(output.inputs["Surface"]), material.name)

    def shader(self, node, where):
        """(bsdf, radiance or None) of a node; None is black, as in Blender."""
        if node is None:
            return black(), None
        known = getattr(self, "_" + node.type.lower(), None)
        if known is None:
            self.warn(where, node, "is not known, and grey")
            return grey, None
        said = known(node, where)
        for socket in node.inputs:
            if socket.is_linked and (node.name, socket.identifier) not in self._said:
                self.warn(where, node, f"is without what feeds its '{socket.name}'")
        return said

    def feeds(self, socket):
        """What a socket is fed by, of which the file says something."""
        self._said.add((socket.node.name, socket.identifier))
        return behind(socket)

    def warn(self, where, node, what):
        """Says once what of a node can't be said."""
        self.warnings[f"{where}: node '{node.name}' {what}"] = None

    def _bsdf_diffuse(self, node, where):
        if self.value(node.inputs["Roughness"], where) > 0:
            self.warn(where, node, "is without its roughness")
        return xml.element("bsdf", "", [self.colour("reflectance", node.inputs["Color"], where)], type="diffuse"), None

    def _bsdf_glossy(self, node, where):
        return self._metal(node, where), None

    def _bsdf_anisotropic(self, node, where):
        return self._metal(node, where), None

    def _metal(self, node, where):
        alpha = self.value(node.inputs["Roughness"], where) ** 2
        inside = [xml.single("string", "material", "none"), self.colour("specular_reflectance", node.inputs["Color"], where)]
        if node.distribution == "SHARP" or alpha < 1e-4:
            return xml.element("bsdf", "", inside, type="conductor")
        inside += [xml.single("string", "distribution", "ggx"), xml.number("alpha", alpha)]
        return xml.element("bsdf", "", inside, type="roughconductor")

    def _bsdf_glass(self, node, where):
        alpha = self.value(node.inputs["Roughness"], where) ** 2
        inside = [xml.number("int_ior", self.value(node.inputs["IOR"], where)), xml.number("ext_ior", 1)]
        inside += [self.colour(name, node.inputs["Color"], where) for name in ("specular_reflectance", "specular_transmittance")]
        if node.distribution == "SHARP" or alpha < 1e-4:
            return xml.element("bsdf", "", inside, type="dielectric"), None
        inside += [xml.single("string", "distribution", "ggx"), xml.number("alpha", alpha)]
        return xml.element("bsdf", "", inside, type="roughdielectric"), None

    def _bsdf_transparent(self, node, where):
        if min(self.flat(node.inputs["Color"], where)) < 0.999:
            self.warn(where, node, "lets all light through, without its colour")
        return '<bsdf type="null"/>\n', None

    def _bsdf_principled(self, node, where):
        inputs = node.inputs
        inside = [self.colour("base_color", inputs["Base Color"], where)]
        names = {"roughness": ("Roughness",), "metallic": ("Metallic",), "specular": ("Specular", "Specular IOR Level")}
        names |= {"clearcoat": ("Clearcoat", "Coat Weight"), "spec_trans": ("Transmission", "Transmission Weight")}
        for theirs, ours in names.items():
            socket = next(inputs[one] for one in ours if one in inputs)
            value = self.value(socket, where)
            if theirs not in ("clearcoat", "spec_trans") or value > 0:
                inside.append(xml.number(theirs, value))
        for unsaid in ("Subsurface", "Subsurface Weight", "Sheen", "Sheen Weight", "Anisotropic"):
            if unsaid in inputs and self.value(inputs[unsaid], where) > 0:
                self.warn(where, node, f"is without its {unsaid.lower()}")
        bsdf = xml.element("bsdf", "", inside, type="principled")
        alpha = self.value(inputs["Alpha"], where)
        if alpha < 1:
            bsdf = xml.element("bsdf", "", [xml.number("opacity", alpha), bsdf], type="mask")
        glow = inputs["Emission"] if "Emission" in inputs else inputs["Emission Color"]
        strength = self.value(inputs["Emission Strength"], where)
        radiance = [strength * part for part in self.flat(glow, where)] if strength else [0]
        return bsdf, radiance if max(radiance) > 0 else None

    def _emission(self, node, where):
        strength = self.value(node.inputs["Strength"], where)
        self.warn(where, node, "shines where faces point, not behind them")
        return black(), [strength * part for part in self.flat(node.inputs["Color"], where)]

    def _mix_shader(self, node, where):
        part = self.value(node.inputs[0], where)
        first, second = (self.shader(self.feeds(node.inputs[slot]), where) for slot in (1, 2))
        bsdf = xml.element("bsdf", "", [xml.number("weight", part), first[0], second[0]], type="blendbsdf")
        glow = [(1 - part) * a + part * b for a, b in zip(first[1] or (0,) * 3, second[1] or (0,) * 3)]
        return bsdf, glow if max(glow) > 0 else None

    def flat(self, socket, where):
        """Colour of a socket, where it may not vary."""
        node = self.feeds(socket)
        if node is not None and node.type == "RGB":
            return tuple(node.outputs[0].default_value)[:3]
        if node is not None:
            self.warn(where, node, f"can't vary '{socket.name}', which is what the socket says")
        return tuple(socket.default_value)[:3]

    def value(self, socket, where):
        """Number of a socket."""
        node = self.feeds(socket)
        if node is not None and node.type == "VALUE":
            return node.outputs[0].default_value
        if node is not None:
            self.warn(where, node, f"can't vary '{socket.name}', which is what the socket says")
        return socket.default_value

    def colour(self, name, socket, where):
        """Colour of a socket, or the picture that it comes from."""
        node = self.feeds(socket)
        if node is None or node.type != "TEX_IMAGE" or node.image is None:
            return xml.rgb(name, self.flat(socket, where))
        way = self.feeds(node.inputs["Vector"])
        if way is not None and way.type not in ("TEX_COORD", "UVMAP"):
            self.warn(where, node, f"lies by the active texture coordinates, whatever '{way.name}' says")
        return picture(name, node, self.folder)


def black():
    """A surface that throws no light back."""
    return xml.element("bsdf", "", [xml.rgb("reflectance", (0, 0, 0))], type="diffuse")


def picture(name, node, folder):
    """Texture of an image node, by the mesh's coordinates."""
    inside = [xml.single("string", "filename", image_file(node.image, folder))]
    if node.image.colorspace_settings.name in ("Non-Color", "Raw", "Linear"):
        inside.append(xml.single("boolean", "raw", "true"))
    if node.interpolation == "Closest":
        inside.append(xml.single("string", "filter_type", "nearest"))
    if node.extension != "REPEAT":
        inside.append(xml.single("string", "wrap_mode", "clamp"))
    return xml.element("texture", name, inside, type="bitmap")


def image_file(image, folder):
    """Path of an image; one that is packed or was made in Blender is written to the folder."""
    path = bpy.path.abspath(image.filepath, library=image.library)
    if not image.packed_file and image.source == "FILE" and os.path.exists(path):
        return path
    kept, ending = image.copy(), ".exr" if image.is_float else ".png"
    path = os.path.join(folder, f"image-{abs(hash(image.name_full))}{ending}")
    try:
        kept.file_format = "OPEN_EXR" if image.is_float else "PNG"
        kept.filepath_raw = path
        kept.save()
    finally:
        bpy.data.images.remove(kept)
    return path


def behind(socket):
    """Node that a socket is fed by, beyond reroutes; None without any."""
    while socket.is_linked:
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None
