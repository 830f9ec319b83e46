// The mix of a picture's layers, as other programs rebuild it: scripts that add up what the file holds.
import type { Rgb } from "./picture";
import { short_float } from "./mixing";

/// A layer of the file, and what it counts.
export interface Mixed {
    name: string;
    gain: Rgb;
}

const file_name = (path: string) => (path.split("/").pop() ?? path).replace(/\.exr$/, "");
const word = (name: string) => name.replace(/\W/g, "_");

/// A script for Nuke, to be pasted into a node graph or opened. Nuke has `_` for dots in names of layers.
export function nuke_script(path: string, layers: Mixed[]): string {
    const nodes = [`Read {\n inputs 0\n file ${JSON.stringify(path)}\n raw true\n name Read_${word(file_name(path))}\n}`, "set picture [stack 0]"];
    layers.forEach(({ name, gain }, k) => {
        if (k > 0) nodes.push("push $picture");
        nodes.push(
            `Shuffle {\n in ${word(name)}\n name layer_${word(name)}\n}`,
            `Multiply {\n channels rgb\n value {${gain.map(short_float).join(" ")} 1}\n name gain_${word(name)}\n}`,
        );
        if (k > 0) nodes.push(`Merge2 {\n inputs 2\n operation plus\n name with_${word(name)}\n}`);
    });
    return nodes.join("\n") + "\n";
}

/// A script for Blender's text editor or --python: makes a group of compositor nodes whose output is the picture.
export function blender_script(path: string, layers: Mixed[]): string {
    const text = JSON.stringify;
    const gain = (values: Rgb) => `(${values.map(short_float).join(", ")}, 1)`;
    return `# The picture of ${file_name(path)}, made anew from its layers.
import bpy

group = bpy.data.node_groups.new(${text(`mix of ${file_name(path)}`)}, "CompositorNodeTree")
if hasattr(group, "interface"):
    group.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
else:
    group.outputs.new("NodeSocketColor", "Image")
nodes, links = group.nodes, group.links
image = bpy.data.images.load(${text(path)}, check_existing=True)

total = None
for operator, output, gain in (
${layers.map(({ name, gain: values }) => {
    const dot = name.indexOf(".");
    return `    (${dot < 0 ? "None" : text(name.slice(0, dot))}, ${text(name.slice(dot + 1))}, ${gain(values)}),`;
}).join("\n")}
):
    read = nodes.new("CompositorNodeImage")
    read.image = image
    if operator:
        read.layer = operator
    scaled = nodes.new("CompositorNodeMixRGB")
    scaled.blend_type = "MULTIPLY"
    links.new(read.outputs[output], scaled.inputs[1])
    scaled.inputs[2].default_value = gain
    if total:
        added = nodes.new("CompositorNodeMixRGB")
        added.blend_type = "ADD"
        links.new(total, added.inputs[1])
        links.new(scaled.outputs[0], added.inputs[2])
        scaled = added
    total = scaled.outputs[0]
links.new(total, nodes.new("NodeGroupOutput").inputs[0])

scene = bpy.context.scene
scene.use_nodes = True
if getattr(scene, "node_tree", None):
    scene.node_tree.nodes.new("CompositorNodeGroup").node_tree = group
`;
}
