"""Blender's door to lightnet: a render engine that writes scenes, runs the program, and brings pictures back."""

bl_info = {
    "name": "lightnet",
    "description": "Renders by networks of light operators, on this machine and on others",
    "author": "lightnet",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Render Properties > Render Engine",
    "category": "Render",
}


def register():
    """Called by Blender when the add-on is switched on."""
    from . import engine, panels, properties

    properties.register()
    engine.register()
    panels.register()


def unregister():
    """Called by Blender when the add-on is switched off."""
    from . import engine, panels, properties

    panels.unregister()
    engine.unregister()
    properties.unregister()
