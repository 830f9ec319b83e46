"""What surrounds a scene: a colour, a picture, or whatever its nodes make, baked by Blender itself."""

import json
import os
import subprocess
import tempfile

import bpy
import numpy
from mathutils import Euler, Matrix

from . import fillings, nodes, shaders, values, xml

# Where Mitsuba's directions of an environment are in Blender: its middle, +z, is +x here, and up is +z.
base = Matrix(((0, 0, 1, 0), (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 0, 1)))
name = "environment"


def volume_of(world, report):
    """What fills the space around all; None: nothing."""
    if world is None or not world.use_nodes or world.node_tree is None:
        return None
    return fillings.of_output(shaders.output_of(world.node_tree), world.name, report)


def elements(scene, export):
    """Emitters of a scene's world."""
    world = scene.world
    if world is None:
        return []
    if not world.use_nodes or world.node_tree is None:
        return constant(world.color)
    output = shaders.output_of(world.node_tree)
    if output is None or not output.inputs["Surface"].is_linked:
        return []
    evaluator = nodes.Evaluator(world.name, export.report)
    found = evaluator.source(output.inputs["Surface"])
    node = found.node
    if node.type == "BACKGROUND":
        strength, colour = node.inputs["Strength"], node.inputs["Color"]
        if not strength.is_linked and not colour.is_linked:
            return constant(numpy.array(colour.default_value[:3]) * strength.default_value)
        source = evaluator.source(colour)
        if not strength.is_linked and source.is_output and source.node.type == "TEX_ENVIRONMENT":
            told = picture(evaluator, source.node, strength.default_value, export)
            if told is not None:
                return told
    return baked(world, export)


def constant(colour):
    if not any(c > 0 for c in colour[:3]):
        return []
    return [xml.Element("emitter", type="constant").add(xml.colour("radiance", colour))]


def map_element(file, strength, turn=None):
    return xml.Element("emitter", type="envmap").add(
        xml.word("filename", file), xml.number("scale", strength), xml.transform((turn or Matrix.Identity(4)) @ base)
    )


def picture(evaluator, node, strength, export):
    """Of a node with a picture of all directions, maybe turned; None: it is more than that."""
    found = nodes.picture_of(node.image)
    if found is None or node.projection != "EQUIRECTANGULAR":
        return None
    turn = Matrix.Identity(4)
    source = evaluator.source(node.inputs["Vector"])
    if source.is_output and source.node.type == "MAPPING":
        mapping = source.node
        if mapping.vector_type != "POINT" or any(socket.is_linked for socket in list(mapping.inputs)[1:]):
            return None
        if tuple(mapping.inputs["Scale"].default_value) != (1, 1, 1) or any(mapping.inputs["Location"].default_value):
            return None
        turn = Euler(mapping.inputs["Rotation"].default_value).to_matrix().inverted().to_4x4()
        source = evaluator.source(mapping.inputs["Vector"])
    if source.is_output and not (source.node.type == "TEX_COORD" and source.name == "Generated"):
        return None
    file = found.file or export.write_data(values.pfm(found.pixels), "world", ".pfm")
    return [map_element(file, strength, turn)]


def baked(world, export):
    """A world of any nodes, as a picture that another Blender makes of it by Cycles; suns of skies as lamps."""
    with tempfile.TemporaryDirectory(prefix="lightnet-world-") as folder:
        library, told = os.path.join(folder, "world.blend"), os.path.join(folder, "told.json")
        bpy.data.libraries.write(library, {world.original}, fake_user=True)
        script = os.path.join(os.path.dirname(__file__), "bake_world.py")
        command = [bpy.app.binary_path, "-b", "--factory-startup", "--python", script, "--", library, world.name, told]
        done = subprocess.run(command, capture_output=True, text=True)
        if not os.path.exists(told):
            export.report.missing("worlds that could not be baked", f"{world.name}: {done.stdout[-200:]}")
            return []
        with open(told, encoding="utf-8") as file:
            facts = json.load(file)
        pixels = numpy.load(facts["pixels"])
    emitters = [map_element(export.write_data(values.pfm(pixels), "world", ".pfm"), 1)]
    for index, sun in enumerate(facts["suns"]):
        x, y, z = sun["direction"]
        emitters.append(
            xml.Element("emitter", type="directional", id=f"{name}_sun{index}").add(
                xml.Element("vector", name="direction", x=x, y=y, z=z),
                xml.colour("irradiance", sun["irradiance"]), xml.number("angle", sun["angle"]),
            )
        )
    return emitters
