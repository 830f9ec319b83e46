"""Scenes made in Blender itself, of spaces that are filled with what scatters, absorbs and shines."""

import bpy
from scenes import add_node, background, cube, floor, lamp, link, material, shader_of, usual


def filled(shader, surface=None, **inputs):
    """A material whose volume is one shader; without a surface, or with one of another material's."""
    made = surface or material()
    tree = made.node_tree
    output, node = tree.get_output_node("ALL"), tree.nodes.new(shader)
    if surface is None:
        tree.nodes.remove(next(one for one in tree.nodes if one.type == "BSDF_DIFFUSE"))
    for name, value in inputs.items():
        socket = node.inputs[name.replace("_", " ")]
        socket.default_value = (*value, 1) if isinstance(value, tuple) else value
    tree.links.new(node.outputs[0], output.inputs["Volume"])
    return made


def scattering_cube():
    usual(filled("ShaderNodeVolumeScatter", Color=(0.9, 0.5, 0.2), Density=1.5, Anisotropy=0.3), cube)


def absorbing_cube():
    usual(filled("ShaderNodeVolumeAbsorption", Color=(0.2, 0.6, 0.9), Density=1.0), cube)


def principled_smoke():
    usual(filled("ShaderNodeVolumePrincipled", Color=(0.6, 0.6, 0.7), Density=2.0, Emission_Strength=2.0, Emission_Color=(1.0, 0.4, 0.1)), cube)


def two_volumes():
    made = filled("ShaderNodeVolumeScatter", Color=(0.2, 0.8, 0.3), Density=0.8)
    first = shader_of(made)
    second, both = add_node(made, "ShaderNodeVolumeAbsorption"), add_node(made, "ShaderNodeAddShader")
    second.inputs["Color"].default_value = (0.9, 0.9, 0.3, 1)
    link(made, first, 0, both, 0), link(made, second, 0, both, 1)
    made.node_tree.links.new(both.outputs[0], made.node_tree.get_output_node("ALL").inputs["Volume"])
    usual(made, cube)


def filled_glass():
    usual(filled("ShaderNodeVolumeScatter", material("ShaderNodeBsdfGlass", Roughness=0.0, IOR=1.3), Color=(0.8, 0.9, 0.8), Density=0.7))


def fog():
    floor(), cube(), lamp("AREA", 900, size=2)
    tree = bpy.context.scene.world.node_tree
    background(0)
    node = tree.nodes.new("ShaderNodeVolumeScatter")
    node.inputs["Density"].default_value = 0.06
    tree.links.new(node.outputs[0], tree.get_output_node("ALL").inputs["Volume"])


all_scenes = [scattering_cube, absorbing_cube, principled_smoke, two_volumes, filled_glass, fog]
