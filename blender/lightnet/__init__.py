"""An add-on for Blender 3.4 and later: the render engine lightnet, which renders stills and animations by the program
`lightnet` in a process of its own."""

import bpy

from . import engine, panels

bl_info = {
    "name": "lightnet",
    "description": "Physically based rendering on one machine or many",
    "author": "lightnet",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "category": "Render",
}


def register():
    """Adds the engine, its settings and its panels."""
    for kind in panels.kinds + engine.kinds:
        bpy.utils.register_class(kind)
    bpy.types.Scene.lightnet = bpy.props.PointerProperty(type=panels.LightnetSettings)
    panels.share(True)


def unregister():
    """Takes away what register() added."""
    panels.share(False)
    del bpy.types.Scene.lightnet
    for kind in reversed(panels.kinds + engine.kinds):
        bpy.utils.unregister_class(kind)
