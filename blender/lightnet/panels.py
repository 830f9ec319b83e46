"""Settings of the engine, and where Blender shows them."""

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty


class LightnetPreferences(bpy.types.AddonPreferences):
    """Where the program is."""

    bl_idname = __package__
    program: StringProperty(name="Program", subtype="FILE_PATH", description="lightnet; empty: $LIGHTNET, else the one in the PATH")

    def draw(self, context):
        self.layout.prop(self, "program")


class LightnetSettings(bpy.types.PropertyGroup):
    """Settings that a scene keeps."""

    samples: IntProperty(name="Samples", default=64, min=1, description="Samples per pixel")
    lighting: EnumProperty(
        name="Lighting",
        items=[
            ("PATH", "Paths", "Light by paths from the camera"),
            ("GUIDED", "Guided paths", "Paths that learn where light comes from"),
        ],
    )
    threads: IntProperty(name="Threads", default=0, min=0, description="Threads of this machine; 0: one per core")
    hosts: StringProperty(name="Hosts", description="A hosts file, or addresses with commas between them; empty: this machine")
    key: StringProperty(name="Key", subtype="FILE_PATH", description="File with the secret key for the hosts")
    clean: BoolProperty(name="Clean", description="Take the noise out of the finished picture")
    seed: IntProperty(name="Seed", default=0, min=0)


class LIGHTNET_PT_render(bpy.types.Panel):
    """Panel of the settings, among Blender's of rendering."""

    bl_label = "lightnet"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    @classmethod
    def poll(cls, context):
        return context.engine == "LIGHTNET"

    def draw(self, context):
        self.layout.use_property_split = True
        for name in LightnetSettings.__annotations__:
            self.layout.prop(context.scene.lightnet, name)
        self.layout.prop(context.scene.render, "film_transparent")


kinds = (LightnetPreferences, LightnetSettings, LIGHTNET_PT_render)
unfit = {"VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "RENDER_PT_eevee_film"}


def share(wanted):
    """Shows Blender's own panels for this engine, too, or no longer: those that any engine may show."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is None or panel.__name__ in unfit or "BLENDER_RENDER" not in engines:
            continue
        (engines.add if wanted else engines.discard)("LIGHTNET")
