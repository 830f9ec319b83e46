"""Panels of Blender's window: what the engine can be told."""

import bpy


class Panel:
    """Shown while the engine is lightnet."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    @classmethod
    def poll(cls, context):
        return context.engine == "LIGHTNET"

    def draw(self, context):
        self.layout.use_property_split = True
        self.show(self.layout, context.scene.lightnet)


class LIGHTNET_PT_light(Panel, bpy.types.Panel):
    bl_label = "Light"

    def show(self, layout, settings):
        layout.prop(settings, "lighting")
        if settings.lighting == "file":
            layout.prop(settings, "graph")
        for name in ("samples", "noise", "seed", "clean", "layers"):
            layout.prop(settings, name)


class LIGHTNET_PT_viewport(Panel, bpy.types.Panel):
    bl_label = "Viewport"

    def show(self, layout, settings):
        for name in ("viewport_samples", "viewport_pixel"):
            layout.prop(settings, name)


class LIGHTNET_PT_machines(Panel, bpy.types.Panel):
    bl_label = "Machines"

    def show(self, layout, settings):
        for name in ("threads", "hosts", "key", "preview"):
            layout.prop(settings, name)


panels = [LIGHTNET_PT_light, LIGHTNET_PT_viewport, LIGHTNET_PT_machines]
like_eevee = {"EEVEE_MATERIAL_PT_context_material", "EEVEE_MATERIAL_PT_surface", "DATA_PT_EEVEE_light", "EEVEE_WORLD_PT_surface"}


def shared():
    """Panels of Blender's own that hold for every engine, and those of Eevee for nodes and lamps."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines and ("BLENDER_RENDER" in engines or panel.__name__ in like_eevee):
            yield panel


def register():
    for panel in panels:
        bpy.utils.register_class(panel)
    for panel in shared():
        panel.COMPAT_ENGINES.add("LIGHTNET")


def unregister():
    for panel in shared():
        panel.COMPAT_ENGINES.discard("LIGHTNET")
    for panel in panels:
        bpy.utils.unregister_class(panel)
