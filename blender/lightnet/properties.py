"""Settings of a scene, and of the add-on."""

import shutil

import bpy

lightings = [
    ("path", "Paths", "All light, by paths from the eye"),
    ("guided", "Guided paths", "Paths that learn where light comes from: for light through narrow ways"),
    ("progressive", "Progressive photons", "Photons of each sample's own: for caustics"),
    ("figure5", "Photons and cache", "Caustics from a photon map, and an irradiance cache for light of other surfaces"),
    ("direct", "Direct light", "Light of lamps alone"),
    ("ao", "Ambient occlusion", "How open each place is"),
    ("file", "Graph file", "A graph of one's own, whose scene this one replaces"),
]


class Settings(bpy.types.PropertyGroup):
    """What a scene says about its rendering: `scene.lightnet`."""

    lighting: bpy.props.EnumProperty(name="Lighting", items=lightings, default="path")
    graph: bpy.props.StringProperty(name="Graph", subtype="FILE_PATH", description="A graph file (Lua)")
    samples: bpy.props.IntProperty(name="Samples", default=64, min=1, max=1 << 20, description="Samples per pixel")
    noise: bpy.props.FloatProperty(
        name="Noise threshold", default=0, min=0, max=1, precision=3,
        description="Parts of the picture end when their noise is below this, as in Cycles; 0: all get all samples",
    )
    seed: bpy.props.IntProperty(name="Seed", default=0, min=0)
    clean: bpy.props.BoolProperty(
        name="Clean", description="Take most of the noise out; the picture as it was is the pass Noisy Image"
    )
    layers: bpy.props.BoolProperty(
        name="Layers", description="A pass for what each operator of the graph adds to the picture"
    )
    viewport_samples: bpy.props.IntProperty(
        name="Samples", default=64, min=1, max=1 << 20, description="Samples per pixel of the viewport, where it stands still"
    )
    viewport_pixel: bpy.props.IntProperty(
        name="Pixel size", default=2, min=1, max=16, description="One pixel of the picture for so many of the viewport, across"
    )
    threads: bpy.props.IntProperty(name="Threads", default=0, min=0, description="Of this machine; 0: one per core")
    hosts: bpy.props.StringProperty(
        name="Hosts", description="A hosts file, or addresses with commas between them; empty: this machine alone"
    )
    key: bpy.props.StringProperty(
        name="Key", subtype="FILE_PATH", description="File with the secret key; empty: the usual one"
    )
    preview: bpy.props.FloatProperty(
        name="Show every", default=2, min=0, subtype="TIME_ABSOLUTE",
        description="Seconds between two pictures while it renders; 0: the finished one only",
    )


class Preferences(bpy.types.AddonPreferences):
    """What the add-on knows of this machine."""

    bl_idname = __package__

    program: bpy.props.StringProperty(
        name="Program", subtype="FILE_PATH", description="The program lightnet; empty: the one in the PATH"
    )

    def draw(self, _):
        self.layout.prop(self, "program")
        if not self.program and not shutil.which("lightnet"):
            self.layout.label(text="There is no program lightnet in the PATH", icon="ERROR")


def register():
    bpy.utils.register_class(Settings)
    bpy.utils.register_class(Preferences)
    bpy.types.Scene.lightnet = bpy.props.PointerProperty(type=Settings)


def unregister():
    del bpy.types.Scene.lightnet
    bpy.utils.unregister_class(Preferences)
    bpy.utils.unregister_class(Settings)
