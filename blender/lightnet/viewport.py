"""The viewport: a session of the program, which every change of the scene and of the view edits."""

import math
import os
import shutil
import weakref

import bpy
import gpu
from gpu_extras.presets import draw_texture_2d

from . import graph, program
from .camera import view_of_region
from .export import Export
from .picture import Picture

look_every = 0.05  # seconds: is there a new picture?

_open = weakref.WeakSet()


class Viewport:
    """One view that is rendered. Made, fed and drawn by Blender's main thread."""

    def __init__(self):
        self._folder = program.new_folder()
        self._session, self._asked, self._number = None, None, 0
        self._stale, self._edited = True, None
        self.picture, self.samples, self.finished, self.mistake = None, 0, False, ""
        self._texture = None
        _open.add(self)
        if not bpy.app.timers.is_registered(_look):
            bpy.app.timers.register(_look, first_interval=look_every)

    def change(self):
        """Something of the scene is another."""
        self._stale = True

    def draw(self, engine, context, depsgraph):
        """Sends what is new, and draws the last picture that there is."""
        self._follow(engine, context, depsgraph)
        self._hear()
        if self._texture is not None:
            gpu.state.blend_set("ALPHA_PREMULT")
            engine.bind_display_space_shader(context.scene)
            draw_texture_2d(self._texture, (0, 0), context.region.width, context.region.height)
            engine.unbind_display_space_shader()
            gpu.state.blend_set("NONE")
        done = f"{self.samples} samples" + ("" if self.finished else " …") if self.samples else "begins"
        engine.update_stats("", self.mistake or done)

    def waits(self):
        """Is there something to be drawn that has not been?"""
        session = self._session
        return session is not None and (session.has_news() or self._stale or (session.ended() and not self.mistake))

    def close(self):
        """Ends the session, and removes its files."""
        _open.discard(self)
        if self._session:
            self._session.end()
            self._session = None
        shutil.rmtree(self._folder, ignore_errors=True)

    def _follow(self, engine, context, depsgraph):
        settings, region = context.scene.lightnet, context.region
        each = max(1, settings.viewport_pixel)
        size = math.ceil(region.width / each), math.ceil(region.height / each)
        view = view_of_region(context, size)
        transparent = context.scene.render.film_transparent
        asked = size, settings.lighting, settings.viewport_samples, transparent, *options_of(settings)
        ended = self._session is not None and self._session.ended()
        if self._session is None or asked != self._asked or (ended and self._stale):
            self._restart(engine, context, depsgraph, settings, view)
            self._asked = asked
        elif ended:  # it would end again, until something is another
            self.mistake = next(iter(self._session.said()[-1:]), "the session has ended")
        elif self._stale:
            self._number += 1
            name = f"scene-{self._number}.xml"
            self._write(engine, context, depsgraph, view, name)
            self._send(scene=name, camera=view.looks_along())
        elif _words(view) != self._edited:
            camera = view.looks_along()
            if camera is None:  # its words are those of files alone
                self._stale = True
                return self._follow(engine, context, depsgraph)
            self._send(camera=camera)
        self._edited = _words(view)

    def _restart(self, engine, context, depsgraph, settings, view):
        if self._session:
            self._session.end()
            self._session = None
        self._write(engine, context, depsgraph, view, "scene.xml")
        lighting = "path" if settings.lighting == "file" else settings.lighting
        with open(os.path.join(self._folder, "graph.lua"), "w", encoding="utf-8") as file:
            file.write(graph.text_of(lighting, view.size, settings.viewport_samples, transparent=context.scene.render.film_transparent))
        where = program.path_of(chosen_program())
        self._session = program.Session([where, "session", "graph.lua", "--json", *options_of(settings)], self._folder)
        self.samples, self.finished, self.mistake = 0, False, ""

    def _write(self, engine, context, depsgraph, view, name):
        export = Export(self._folder, context.scene, depsgraph, context.view_layer, view)
        export.write(name)
        self._stale = False
        if name == "scene.xml":
            for line in export.report.lines():
                engine.report({"WARNING"}, line)

    def _send(self, **edit):
        self._session.edit(**edit)
        self.finished = False

    def _hear(self):
        for event in self._session.events() if self._session else ():
            if event["event"] == "error":
                self.mistake = "; ".join(problem["what"] for problem in event["problems"])
            elif event["event"] == "picture":
                self.mistake, self.samples, self.finished = "", event["samples"], event["finished"]
                self._show()

    def _show(self):
        try:
            self.picture = Picture(os.path.join(self._folder, "picture.npz"))
        except (OSError, KeyError, ValueError):
            return  # the next one has replaced it
        pixels = self.picture.combined()[::-1]
        height, width = pixels.shape[:2]
        data = gpu.types.Buffer("FLOAT", width * height * 4, pixels.ravel())
        self._texture = gpu.types.GPUTexture((width, height), format="RGBA16F", data=data)


def _words(view):
    """What tells one view from another."""
    return [tuple(row) for row in view.matrix], view.half, view.middle, view.orthographic, view.lens


def _look():
    """A timer of Blender's: has views drawn that have news. None: there are no more."""
    if any(one.waits() for one in _open):
        for window in bpy.context.window_manager.windows:
            for area in window.screen.areas:
                if area.type == "VIEW_3D":
                    area.tag_redraw()
    return look_every if _open else None


def chosen_program():
    """What the preferences name; "": nothing."""
    preferences = bpy.context.preferences.addons.get(__package__)
    return bpy.path.abspath(preferences.preferences.program) if preferences else ""


def options_of(settings):
    """Words of the command line that say how, not what, of runs and of sessions."""
    words = ["-o", "picture.exr", "--npz", "picture.npz", "--compression", "none", "--seed", str(settings.seed)]
    if settings.threads:
        words += ["--threads", str(settings.threads)]
    if settings.hosts:
        words += ["--hosts", bpy.path.abspath(settings.hosts) if settings.hosts.startswith("//") else settings.hosts]
    if settings.key:
        words += ["--key", bpy.path.abspath(settings.key)]
    return words


def close_all():
    for one in list(_open):
        one.close()
