"""The render engine: it writes the scene to a folder, has the program render it, and shows the picture."""

import json
import os
import shutil
import subprocess
import tempfile

import bpy
import numpy as np

from . import scene as scenes


def program():
    """Path of the program: that of the preferences, else $LIGHTNET, else the one in the PATH; None without any."""
    addon = bpy.context.preferences.addons.get(__package__)
    chosen = addon.preferences.program if addon and addon.preferences else ""
    for path in (bpy.path.abspath(chosen), os.environ.get("LIGHTNET"), shutil.which("lightnet")):
        if path and os.access(path, os.X_OK):
            return path
    return None


def graph(settings, width, height):
    """Text of the graph, in Lua. A guide learns from a path for every 14 samples, as graphs/guided.lua has it."""
    paths = width * height * settings.samples // 14 + 64
    guide = f'guide = Guide {{ paths = {paths}, when = "worthwhile" }}\n' if settings.lighting == "GUIDED" else ""
    return (
        'scene = Scene { "scene.xml", two_sided = true }\n'
        f'{guide}light = PathTracing {{ paths = "all"{", guide = guide" if guide else ""} }}\n'
        f"image = RayTracer {{ light, scene = scene, samples = {settings.samples}, film = {{ {width}, {height} }} }}\n"
    )


def share(line):
    """How much of the picture is there by a line that the program said, 0 to 1; None when it doesn't say."""
    try:
        told = json.loads(line)
        return told["done"] / told["total"] if told["event"] == "progress" else None
    except (ValueError, KeyError, TypeError, ZeroDivisionError):
        return None


class LightnetEngine(bpy.types.RenderEngine):
    """What Blender calls for stills and for each frame of an animation."""

    bl_idname = "LIGHTNET"
    bl_label = "lightnet"
    bl_use_preview = False
    bl_use_shading_nodes_custom = False

    def render(self, depsgraph):
        """Renders the frame of `depsgraph`. Mistakes are reported; the folder and the process are gone afterwards."""
        path = program()
        if path is None:
            self.report({"ERROR"}, "there is no program lightnet in the PATH; the add-on's preferences may name it")
            return
        with tempfile.TemporaryDirectory(prefix="lightnet-blender-") as folder:
            try:
                self._render(path, folder, depsgraph)
            except (OSError, ValueError, subprocess.SubprocessError) as error:
                self.report({"ERROR"}, str(error))

    def _render(self, path, folder, depsgraph):
        scene = depsgraph.scene
        scale = scene.render.resolution_percentage / 100
        size = int(scene.render.resolution_x * scale), int(scene.render.resolution_y * scale)
        self.update_stats("", "writing the scene")
        for warning in scenes.write(folder, depsgraph, size):
            self.report({"WARNING"}, warning)
        with open(os.path.join(folder, "graph.lua"), "w", encoding="utf-8") as file:
            file.write(graph(scene.lightnet, *size))
        if self._ran(self._words(path, scene), folder):
            self._show(folder, size, scene)

    def _words(self, path, scene):
        own = scene.lightnet
        words = [path, "run", "graph.lua", "-o", "x.exr", "--npz", "x.npz", "--forget", "--progress", "json"]
        words += ["--seed", str(own.seed)]
        if own.threads:
            words += ["--threads", str(own.threads)]
        if own.hosts:
            words += ["--hosts", bpy.path.abspath(own.hosts)]
        if own.key:
            words += ["--key", bpy.path.abspath(own.key)]
        if scene.render.film_transparent:
            words.append("--alpha")
        return words + (["--clean"] if own.clean else [])

    def _ran(self, words, folder):
        """Whether the program made a picture; False when the user cancelled it, or after an error, which is reported."""
        with open(os.path.join(folder, "said"), "w+", encoding="utf-8") as said:
            with subprocess.Popen(words, cwd=folder, stdout=said, stderr=subprocess.STDOUT, start_new_session=True) as run:
                try:
                    cancelled = self._wait(run, folder)
                finally:
                    if run.poll() is None:
                        run.terminate()
            said.seek(0)
            text = said.read()
        if run.returncode != 0 and not cancelled:
            self.report({"ERROR"}, text.strip()[-2000:] or f"lightnet ended with {run.returncode}")
        return run.returncode == 0

    def _wait(self, run, folder):
        """Waits for the process, and shows how far it is. True: the user cancelled it."""
        while True:
            try:
                run.wait(0.1)
                return False
            except subprocess.TimeoutExpired:
                if self.test_break():
                    run.terminate()
                    return True
                self._tell(folder)

    def _tell(self, folder):
        with open(os.path.join(folder, "said"), encoding="utf-8", errors="replace") as file:
            lines = file.read().splitlines()
        done = [part for part in map(share, lines) if part is not None]
        if done:
            self.update_progress(done[-1])
            self.update_stats("", f"{100 * done[-1]:.0f} %")

    def _show(self, folder, size, scene):
        if scene.lightnet.clean:
            words = [program(), "remix", "x.clean.exr", "-o", "y.exr", "--npz", "x.npz"]
            subprocess.run(words, cwd=folder, check=True, capture_output=True)
        with np.load(os.path.join(folder, "x.npz")) as arrays:
            pixels = np.ones((size[1], size[0], 4), np.float32)
            pixels[..., :3] = arrays["beauty"]
            if scene.render.film_transparent and "alpha" in arrays:
                pixels[..., 3] = arrays["alpha"]
        result = self.begin_result(0, 0, *size)
        result.layers[0].passes["Combined"].rect = pixels[::-1].reshape(-1, 4)
        self.end_result(result)


kinds = (LightnetEngine,)
