"""The render engine: F12, Ctrl-F12, and the viewport."""

import os
import shutil
import time

import bpy
import numpy

from . import graph, motion, program, viewport
from .camera import size_of
from .export import Export, plain
from .picture import Picture

cancelled = 130
later_file, earlier_file = "scene-later.xml", "scene-earlier.xml"  # beside scene.xml, for vectors


class Workplace:
    """The folder of one animation (or still): files that frames have in common stay in it until all is done."""

    folder = None

    @classmethod
    def path(cls):
        if cls.folder is None:
            cls.folder = program.new_folder()
        return cls.folder

    @classmethod
    def remove(cls, *_):
        if cls.folder is not None:
            shutil.rmtree(cls.folder, ignore_errors=True)
            cls.folder = None


def facts_of(scene, layer):
    """Names of passes that a view layer asks for and that are facts of surfaces or mattes."""
    wanted = {
        "Depth": layer.use_pass_z, "Normal": layer.use_pass_normal, "Position": layer.use_pass_position,
        "UV": layer.use_pass_uv, "DiffCol": layer.use_pass_diffuse_color,
        "Vector": layer.use_pass_vector and not scene.render.use_motion_blur,
        "CryptoObject": layer.use_pass_cryptomatte_object, "CryptoMaterial": layer.use_pass_cryptomatte_material,
    }
    return [name for name, on in wanted.items() if on]


class LightnetEngine(bpy.types.RenderEngine):
    bl_idname = "LIGHTNET"
    bl_label = "lightnet"
    bl_use_preview = False
    bl_use_postprocess = True
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    def update_render_passes(self, scene, layer):
        """Tells the compositor which passes there will be."""
        self.register_pass(scene, layer, "Combined", 4, "RGBA", "COLOR")
        for name, channels, letters, kind in passes_of(scene, layer):
            self.register_pass(scene, layer, name, channels, letters, kind)

    def __del__(self):
        if "_view" in self.__dict__:
            self._view.close()

    def view_update(self, context, depsgraph):
        """Called when something in the scene of a rendered viewport is another, and first of all."""
        if "_view" not in self.__dict__:
            self._view = viewport.Viewport()
        self._view.change()

    def view_draw(self, context, depsgraph):
        """Called whenever a rendered viewport is drawn."""
        if "_view" not in self.__dict__:
            self._view = viewport.Viewport()
        try:
            self._view.draw(self, context, depsgraph)
        except (OSError, ValueError) as mistake:
            self._view.mistake = str(mistake)
            self.update_stats("", str(mistake))

    def render(self, depsgraph):
        """Called in a thread of Blender's, for each frame and view layer."""
        layer, (width, height) = depsgraph.view_layer.name, size_of(depsgraph.scene)
        for name, channels, letters, _ in own_passes_of(depsgraph.scene, depsgraph.view_layer):
            self.add_pass(name, channels, letters, layer=layer)
        self.end_result(self.begin_result(0, 0, width, height, layer=layer))  # Blender can't write a picture without
        try:
            self._render(depsgraph)
        except (OSError, ValueError) as mistake:
            self.report({"ERROR"}, str(mistake))
            self.error_set(str(mistake))
        finally:
            if not self.is_animation:
                Workplace.remove()

    def _render(self, depsgraph):
        scene, folder = depsgraph.scene, Workplace.path()
        settings, layer = scene.lightnet, depsgraph.view_layer
        began = time.monotonic()
        self.update_stats("", "exporting")
        where = program.path_of(viewport.chosen_program())
        moving = motion.look(self, depsgraph)
        kept = self._write_frames_beside(depsgraph, folder) if has_vectors(scene, layer) else ()
        scene, layer = depsgraph.scene, depsgraph.view_layer
        settings = scene.lightnet
        export = Export(folder, scene, depsgraph, layer, moving=moving, kept=kept)
        export.write()
        for line in export.report.lines():
            self.report({"WARNING"}, line)
        command = [where, *self._words(scene, layer, export, folder), *options_of(settings)]
        self._groups, self._backwards, self._seen = sorted(export.groups), None, None
        print(f"lightnet: exported in {time.monotonic() - began:.2f} s")
        for name in ("picture.npz", "picture.clean.npz", "back.npz"):
            if os.path.exists(os.path.join(folder, name)):
                os.remove(os.path.join(folder, name))
        if has_vectors(scene, layer):
            self._look_back(scene, where, folder)
        self._run(scene, layer, command, folder)

    def _write_frames_beside(self, depsgraph, folder):
        """The scene a frame later and a frame earlier. Names of their files."""
        frame, kept = depsgraph.scene.frame_current + depsgraph.scene.frame_subframe, set()
        try:
            for by, name in ((1, later_file), (-1, earlier_file)):
                motion.go_to(self, frame + by)
                beside = Export(folder, depsgraph.scene, depsgraph, depsgraph.view_layer, kept=kept)
                beside.write(name)
                kept |= beside.files()
        finally:
            motion.go_to(self, frame)
        return kept

    def _look_back(self, scene, where, folder):
        """How far things are from where they were a frame earlier: one more run."""
        with open(os.path.join(folder, "back.lua"), "w", encoding="utf-8") as file:
            file.write(graph.backwards_of(size_of(scene), scene.lightnet.samples, earlier_file))
        other = {"picture.exr": "back.exr", "picture.npz": "back.npz"}
        options = [other.get(word, word) for word in options_of(scene.lightnet)]
        self._finish([where, "run", "back.lua", *options], folder, lambda: None)
        if os.path.exists(os.path.join(folder, "back.npz")):  # else it was told to stop
            self._backwards = Picture(os.path.join(folder, "back.npz")).shown["Vector"]

    def _words(self, scene, layer, export, folder):
        """The verb, and what it renders."""
        settings, size = scene.lightnet, size_of(scene)
        if settings.lighting == "file":
            file = bpy.path.abspath(settings.graph)
            words = ["render", "scene.xml", "--lighting", file, "--samples", str(settings.samples)]
            return words + (["--clean"] if settings.clean else []) + (["--alpha"] if scene.render.film_transparent else [])
        text = graph.text_of(
            settings.lighting, size, settings.samples, round(settings.noise, 6), export.groups, facts_of(scene, layer),
            2 * max(1, layer.pass_cryptomatte_depth // 2), scene.render.film_transparent, settings.clean,
            later_file if has_vectors(scene, layer) else None,
        )
        with open(os.path.join(folder, "graph.lua"), "w", encoding="utf-8") as file:
            file.write(text)
        return ["run", "graph.lua"]

    def _run(self, scene, layer, command, folder):
        self._finish(command, folder, lambda: self._show(scene, layer, folder))
        self._show(scene, layer, folder, True)

    def _finish(self, command, folder, show):
        """Runs to the end, or until it is told to stop; calls show() meanwhile."""
        with program.Run(command, folder) as run:
            stopped = False
            while run.hear(0.1):
                left = f", {run.left:.0f} s left" if run.left else ""
                self.update_stats("", f"{run.phase} {100 * run.share:.0f} %{left}")
                self.update_progress(run.share)
                if self.test_break() and not stopped:
                    stopped = True
                    run.cancel()
                show()
            code = run.code()
        if code != 0 and not (code == cancelled and stopped):
            raise ValueError("\n".join(run.said[-12:]) or f"lightnet ended with code {code}")

    def _show(self, scene, layer, folder, last=False):
        """Hands the picture that there is to Blender, if it is a new one."""
        file = os.path.join(folder, "picture.npz")
        try:
            facts = os.stat(file)
        except FileNotFoundError:
            return
        if (facts.st_ino, facts.st_mtime_ns) == self._seen and not last:
            return
        self._seen = facts.st_ino, facts.st_mtime_ns
        found = Picture(file)
        pixels = found.passes(self._groups)
        clean = os.path.join(folder, "picture.clean.npz")
        if last and scene.lightnet.clean and os.path.exists(clean):
            pixels["Noisy Image"] = pixels["Combined"]
            pixels["Combined"] = Picture(clean).combined()
        if "Vector" in pixels:
            pixels["Vector"] = vectors(pixels["Vector"], self._backwards)
        height, width = found.beauty.shape[:2]
        result = self.begin_result(0, 0, width, height, layer=layer.name)
        passes = result.layers[0].passes
        passes.foreach_set("rect", numpy.concatenate([filled(one, pixels, height, width) for one in passes]))
        if last:
            self._tell_mattes(found)
        self.end_result(result)

    def _tell_mattes(self, found):
        """What Blender's Cryptomatte node looks for."""
        result = self.get_result()
        for name, manifest in found.manifests.items():
            full = f"ViewLayer.{name}"
            key = f"cryptomatte/{abs(hash(full)) & 0xFFFFFFF:07x}"
            for word, value in (("name", full), ("hash", "MurmurHash3_32"), ("conversion", "uint32_to_float32")):
                result.stamp_data_add_field(f"{key}/{word}", value)
            result.stamp_data_add_field(f"{key}/manifest", manifest)


def has_vectors(scene, layer):
    return scene.lightnet.lighting != "file" and "Vector" in facts_of(scene, layer)


def vectors(later, earlier):
    """Blender's, of how far things are on the picture later and earlier, in pixels to the right and upwards: to where they
    were a frame earlier, and from where they are a frame later."""
    if earlier is None:
        earlier = numpy.zeros_like(later)
    return numpy.concatenate((earlier[..., :2], -later[..., :2]), axis=-1)


def filled(one, pixels, height, width):
    """The numbers of a pass of Blender's, whose row 0 is at the bottom; what there is no array of is 0."""
    whole = numpy.zeros((height, width, one.channels), numpy.float32)
    there = pixels.get(one.name)
    if there is not None:
        count = min(one.channels, there.shape[2])
        whole[..., :count] = there[::-1, :, :count]
    return whole.ravel()


def passes_of(scene, layer):
    """Name, channels, letters and kind of each pass beside the picture itself."""
    settings = scene.lightnet
    letters = {"Depth": "Z", "Normal": "XYZ", "Position": "XYZ", "UV": "UVA", "DiffCol": "RGB", "Vector": "XYZW"}
    kinds = {"Depth": "VALUE", "Normal": "VECTOR", "Position": "VECTOR", "UV": "VECTOR", "DiffCol": "COLOR", "Vector": "VECTOR"}
    yield from own_passes_of(scene, layer)
    for name in facts_of(scene, layer) if settings.lighting != "file" else ():
        if name in letters:
            yield name, len(letters[name]), letters[name], kinds[name]
        else:
            for index in range(max(1, layer.pass_cryptomatte_depth // 2)):
                yield f"{name}{index:02d}", 4, "RGBA", "COLOR"
    if layer.use_pass_emit:
        yield "Emit", 3, "RGB", "COLOR"
    for group in sorted(plain(group.name) for group in layer.lightgroups):
        yield f"Combined_{group}", 3, "RGB", "COLOR"


def own_passes_of(scene, layer):
    """Those of them that Blender knows nothing of, and has to be told of before each render as well."""
    settings = scene.lightnet
    if settings.clean:
        yield "Noisy Image", 4, "RGBA", "COLOR"
    if settings.layers:
        groups = sorted(plain(group.name) for group in layer.lightgroups)
        operators = {"path": ["direct", "bounce"], "direct": ["direct"], "progressive": ["direct", "indirect"],
                     "figure5": ["direct", "caustics", "soft"]}.get(settings.lighting, [])
        for operator in ["emission", *operators]:
            for group in [*groups, "rest"] if groups and settings.lighting in graph.by_groups else [""]:
                yield "Layer " + operator + (f".{group}" if group else ""), 3, "RGB", "COLOR"


def options_of(settings):
    """Words of the command line that say how, not what."""
    words = [*viewport.options_of(settings), "--forget", "--progress", "json"]
    if settings.preview > 0:
        words += ["--preview", repr(settings.preview)]
    return words


def register():
    bpy.utils.register_class(LightnetEngine)
    bpy.app.handlers.render_complete.append(Workplace.remove)
    bpy.app.handlers.render_cancel.append(Workplace.remove)


def unregister():
    bpy.app.handlers.render_cancel.remove(Workplace.remove)
    bpy.app.handlers.render_complete.remove(Workplace.remove)
    Workplace.remove()
    viewport.close_all()
    bpy.utils.unregister_class(LightnetEngine)
