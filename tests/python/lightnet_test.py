#!/usr/bin/env python3
"""The Python module, as its users call it. Environment: LIGHTNET, PYTHONPATH. 77: NumPy is not here."""

import ast
import glob
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

try:
    import numpy
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

import lightnet as ln

ROOT = pathlib.Path(__file__).resolve().parents[2]
GRAPHS = ROOT / "graphs"
SMALL = {"size": (24, 18), "samples": 4}


def folders(process=None):
    """Those that the module makes in a process, this one if none is named."""
    name = f"lightnet-{process or os.getpid()}-*"
    return glob.glob(os.path.join("/dev/shm", name)) + glob.glob(os.path.join(tempfile.gettempdir(), name))


def children():
    """Processes that were started here and are still there."""
    with open(f"/proc/self/task/{os.getpid()}/children", encoding="ascii") as file:
        return file.read().split()


def run(*words):
    subprocess.run([os.environ["LIGHTNET"], *map(str, words)], check=True, capture_output=True)


def cornell(**film):
    """graphs/cornell.lua, in Python."""
    direct = ln.DirectLighting(name="direct")
    bounce = ln.PathTracing(name="bounce")
    both = ln.Combine(direct, bounce, name="lighting")
    scene = ln.Scene(GRAPHS / "cornell_box.pbrt", name="scene")
    return ln.RayTracer(both, scene=scene, samples=4, film={"size": (24, 18), **film}, name="image")


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def tearDown(self):
        self.assertEqual(folders(), [], "a folder was left")
        self.assertEqual(children(), [], "a process was left")


class Pictures(InFolder):
    def exr(self, file):
        try:
            import OpenImageIO
        except ImportError as missing:
            self.skipTest(str(missing))
        picture = OpenImageIO.ImageInput.open(str(file))
        spec = picture.spec()
        pixels = numpy.asarray(picture.read_image(0, spec.nchannels, OpenImageIO.FLOAT))
        return {name: pixels[..., number] for number, name in enumerate(spec.channelnames)}

    def test_have_the_numbers_of_the_exr(self):
        run("run", GRAPHS / "cornell.lua", "--size", "24x18", "--samples", 4, "-o", self.folder / "x.exr")
        picture, channels = ln.render(ln.load(GRAPHS / "cornell.lua"), **SMALL), self.exr(self.folder / "x.exr")
        self.assertEqual(list(picture.layers), ["emission", "direct", "bounce"])
        for name, pixels in {"": picture.beauty, **picture.layers}.items():
            self.assertEqual((pixels.shape, pixels.dtype), ((18, 24, 3), numpy.float32))
            for number, letter in enumerate("RGB"):
                channel = f"{name}.{letter}" if name else letter
                self.assertTrue(numpy.array_equal(pixels[..., number], channels[channel]), channel)

    def test_have_what_is_shown_and_mattes_and_alpha_as_the_exr_has_them(self):
        run("run", GRAPHS / "compositing.lua", "--size", "24x18", "--samples", 4, "-o", self.folder / "x.exr")
        picture = ln.render(str(GRAPHS / "compositing.lua"), **SMALL)
        channels = self.exr(self.folder / "x.exr")
        self.assertTrue(numpy.array_equal(picture["depth"], channels["depth.Z"]))
        self.assertTrue(numpy.array_equal(picture["normal"][..., 1], channels["normal.Y"]))
        self.assertTrue(numpy.array_equal(picture.alpha, channels["A"]))
        matte = picture.mattes["CryptoObject"]
        self.assertTrue(numpy.array_equal(matte[..., 1, 1], channels["CryptoObject00.A"]))
        masks = sum(picture.mask(name) for name in picture.manifests["CryptoObject"])
        self.assertTrue(numpy.allclose(masks, picture.alpha, atol=1e-6))

    def test_can_be_read_without_this_module(self):
        file = self.folder / "x.npz"
        run("run", GRAPHS / "compositing.lua", "--size", "24x18", "--samples", 4, "-o", self.folder / "x.exr", "--npz", file)
        picture = ln.render(str(GRAPHS / "compositing.lua"), **SMALL)
        with numpy.load(file) as arrays:
            self.assertEqual(arrays["shown/depth"].shape, (18, 24, 3))
            for name, pixels in picture.layers.items():
                self.assertTrue(numpy.array_equal(arrays["layers/" + name], pixels), name)
            self.assertTrue(numpy.array_equal(arrays["mattes/CryptoLamp"], picture.mattes["CryptoLamp"]))

    def test_are_no_copies(self):
        picture = ln.render(cornell())
        for pixels in (picture.beauty, *picture.layers.values()):
            self.assertFalse(pixels.flags.owndata)
            self.assertTrue(pixels.flags.c_contiguous and pixels.flags.aligned and pixels.flags.writeable)
            self.assertEqual(pixels.ctypes.data % 64, 0)
        direct = picture.layers["direct"]
        first = direct.copy()
        del picture
        self.assertTrue(numpy.array_equal(direct, first), "its memory lives as long as it does")

    def test_are_saved_with_the_bytes_of_a_run(self):
        run("run", GRAPHS / "cornell.lua", "--size", "24x18", "--samples", 4, "--gain", "bounce=0.3", "-o", self.folder / "x.exr")
        ln.render(ln.load(GRAPHS / "cornell.lua"), self.folder / "y.exr", gain={"bounce": 0.3}, **SMALL)
        self.assertEqual((self.folder / "x.exr").read_bytes(), (self.folder / "y.exr").read_bytes())
        self.assertEqual((self.folder / "x.png").read_bytes(), (self.folder / "y.png").read_bytes())
        again = ln.read(self.folder / "x.exr")
        self.assertEqual(again.gains["bounce"], (numpy.float32(0.3).item(),) * 3)
        self.assertTrue(numpy.array_equal(again.beauty, ln.render(ln.load(GRAPHS / "cornell.lua"), gain={"bounce": 0.3}, **SMALL)))

    def test_are_mixed_with_the_bits_of_remix(self):
        picture = ln.render(cornell(), self.folder / "x.exr")
        run("remix", self.folder / "x.exr", "direct=0.5", "-o", self.folder / "y.exr")
        self.assertTrue(numpy.array_equal(picture.mixed(direct=0.5), ln.read(self.folder / "y.exr").beauty))
        with self.assertRaisesRegex(KeyError, "no layer is called lamp"):
            picture.mixed(lamp=2)

    def test_are_shown_by_notebooks(self):
        picture = ln.render(cornell())
        self.assertTrue(picture._repr_png_().startswith(b"\x89PNG"))
        self.assertEqual(repr(picture), "<Picture 24x18, layers: emission, direct, bounce>")
        self.assertEqual(picture.report["outcome"], "done")


class Graphs(InFolder):
    def test_of_values_give_the_bits_of_the_same_graph_in_lua(self):
        graph = (GRAPHS / "cornell.lua").read_text()
        self.assertIn("direct", graph)
        ours, theirs = ln.render(cornell()), ln.render(ln.load(GRAPHS / "cornell.lua"), **SMALL)
        self.assertTrue(numpy.array_equal(ours.beauty, theirs.beauty))

    def test_give_the_same_bits_on_daemons_and_threads(self):
        alone = ln.render(cornell(), threads=1)
        for how in ({"threads": 3}, {"local_workers": 2}):
            self.assertTrue(numpy.array_equal(ln.render(cornell(), **how).beauty, alone.beauty), how)

    def test_take_constants(self):
        file = self.folder / "graph.lua"
        box = GRAPHS / "cornell_box.pbrt"
        file.write_text(f"rays = 1 light = DirectLighting {{ samples = rays }} scene = Scene {{ '{box}' }}\n"
                        "image = RayTracer { light, scene = scene, samples = 1, film = { 8, 8 } }")  # fmt: skip
        one, two = ln.render(ln.load(file)), ln.render(ln.load(file, rays=2))
        self.assertFalse(numpy.array_equal(one.beauty, two.beauty))

    def test_name_nodes_after_their_kinds(self):
        one, two = ln.DirectLighting(), ln.DirectLighting(samples=2)
        scene = ln.Scene(GRAPHS / "cornell_box.pbrt")
        picture = ln.render(ln.RayTracer(ln.Combine(one, two), scene=scene), **SMALL)
        self.assertEqual(list(picture.layers), ["emission", "direct_lighting", "direct_lighting_2"])

    def test_are_checked_and_drawn(self):
        self.assertIn("sound: 5 nodes, 24x18", ln.check(cornell()))
        self.assertIn("digraph", ln.dot(cornell()))

    def test_have_constructors_with_the_help_of_describe(self):
        self.assertIn("samples per pixel", ln.RayTracer.__doc__)
        self.assertIn("alpha", str(ln.RayTracer.__signature__))
        self.assertIn("PhotonMap", dir(ln))
        with self.assertRaisesRegex(AttributeError, "did you mean 'PhotonMap'"):
            ln.PhotonMapp

    def test_are_of_the_version_of_the_program(self):
        said = subprocess.run([os.environ["LIGHTNET"], "--version"], check=True, capture_output=True, text=True).stdout
        self.assertEqual(said.split()[1], self.version())

    def test_come_as_a_wheel(self):
        made = [sys.executable, ROOT / "python/wheel.py"]
        names = [subprocess.run([*made, self.folder], check=True, capture_output=True, text=True).stdout.strip() for _ in "ab"]
        self.assertEqual(names[0], f"lightnet-{self.version()}-py3-none-any.whl")
        wheel = self.folder / names[0]
        environment = {**os.environ, "PYTHONPATH": str(wheel)}  # a wheel of Python alone can be imported as it is
        command = "import lightnet; print(lightnet.__file__, lightnet.RayTracer.kind)"
        said = subprocess.run(
            [sys.executable, "-c", command], check=True, capture_output=True, text=True, env=environment
        ).stdout  # fmt: skip
        self.assertEqual(said.split(), [str(wheel / "lightnet/__init__.py"), "RayTracer"])

    @staticmethod
    def version():
        return re.search(r'^version = "(.*)"', (ROOT / "python/pyproject.toml").read_text(), re.MULTILINE)[1]

    def test_have_types(self):
        written = subprocess.run([sys.executable, ROOT / "python/stubs.py"], check=True, capture_output=True, text=True).stdout
        there = (ROOT / "python/lightnet/__init__.pyi").read_text()
        self.assertEqual(written, there, "python/stubs.py writes it")
        classes = {node.name for node in ast.parse(there).body if isinstance(node, ast.ClassDef)}
        self.assertIn("RayTracer", classes)


class Sessions(InFolder):
    def test_give_each_edit_the_bits_of_a_run(self):
        with ln.Session(cornell(), threads=2) as session:
            self.assertTrue(numpy.array_equal(session.picture().beauty, ln.render(cornell()).beauty))
            there = {"from": (400, 300, -700), "to": (278, 250, 280), "fov": 50}
            pictures = list(session.edits(set={"image.samples": 40}, camera=there))
            self.assertGreater(len(pictures), 1)
            scene = ln.Scene(GRAPHS / "cornell_box.pbrt", camera=there, name="scene")
            both = ln.Combine(ln.DirectLighting(name="direct"), ln.PathTracing(name="bounce"), name="lighting")
            fresh = ln.RayTracer(both, scene=scene, samples=40, film={"size": (24, 18)}, name="image")
            self.assertTrue(numpy.array_equal(pictures[-1].beauty, ln.render(fresh).beauty))
            with self.assertRaisesRegex(ln.UserError, "did you mean 'direct'"):
                session.edit(set={"dirct.samples": 4})
            back = session.edit(set={"image.samples": None}, camera=None)
            self.assertTrue(numpy.array_equal(back.beauty, ln.render(cornell()).beauty))

    def test_say_what_is_wrong_with_their_graph(self):
        with ln.Session(ln.RayTracer(ln.DirectLighting(sampels=1), scene=ln.Scene("none.pbrt"))) as session:
            with self.assertRaisesRegex(ln.UserError, "did you mean 'samples'"):
                session.picture()


class Races(InFolder):
    def test_a_race_is_one_of_nodes(self):
        with self.assertRaisesRegex(ln.UserError, "'file' must be a node"):
            ln.race({"file": str(GRAPHS / "cornell.lua")}, "no.exr")

    def test_hold_graphs_against_a_reference(self):
        truth = ln.render(cornell(), samples=256)
        scene = ln.Scene(GRAPHS / "cornell_box.pbrt")
        direct = ln.RayTracer(ln.DirectLighting(), scene=scene, film={"size": (24, 18)})
        held = ln.race({"all": cornell(), "direct": direct}, truth, seconds=0.4, seeds=2, threads=1, size=(24, 18))
        self.assertEqual([(row["name"], row["seed"]) for row in held.ends], [("all", 1), ("direct", 1), ("all", 2), ("direct", 2)])
        errors = {row["name"]: row["relmse"] for row in held.ends}
        self.assertLess(errors["all"], errors["direct"])
        self.assertIn("<polyline", held._repr_html_())
        self.assertIn("relMSE", repr(held))


class Errors(InFolder):
    def test_name_the_line_of_python_and_what_was_meant(self):
        with self.assertRaises(ln.UserError) as caught:
            light = ln.DirectLighting(sampels=3)  # this line
            scene = ln.Scene("nowhere.pbrt")
            ln.render(ln.RayTracer(light, scene=scene))
        line = pathlib.Path(__file__).read_text().splitlines().index(
            "            light = ln.DirectLighting(sampels=3)  # this line") + 1  # fmt: skip
        self.assertRegex(caught.exception.problems[0], rf"lightnet_test.py:{line}: DirectLighting 'direct_lighting': .*sampels")
        self.assertIn("did you mean 'samples'", caught.exception.problems[0])
        self.assertIn("can't read 'nowhere.pbrt'", caught.exception.problems[1])

    def test_are_of_kinds(self):
        with self.assertRaisesRegex(ln.UserError, "--sampels"):
            ln.render(cornell(), sampels=3)
        with self.assertRaises(ln.NoWorker):
            ln.render(cornell(), hosts="tcp://127.0.0.1:1", insecure=True, wait=0)
        self.assertTrue(issubclass(ln.NoWorker, ln.Error) and issubclass(ln.UserError, ln.Error))


class Running(InFolder):
    LONG = {"size": (64, 64), "samples": 1 << 20, "threads": 1}

    def test_shows_the_picture_while_it_grows(self):
        done = []
        for picture in ln.progress(cornell(), every=0.05, size=(96, 96), samples=512):
            done.append(picture.done)
        self.assertGreater(len(done), 1)
        self.assertEqual(done, sorted(done))
        self.assertEqual(done[-1], 1)

    def test_leaves_nothing_when_its_loop_is_left(self):
        for picture in ln.progress(cornell(), every=0.05, **self.LONG):
            self.assertLess(picture.done, 1)
            with self.assertRaises(ValueError):
                picture.save(self.folder / "x.exr")
            break

    def test_is_cancelled_with_the_picture_that_there_is(self):
        going = ln.progress(cornell(), every=0.05, **self.LONG)
        last = None
        for last in going:
            going.cancel()
        self.assertTrue(0 < last.done < 1)
        self.assertIn("cancelled", last.message)

    def test_lets_other_threads_go_on(self):
        counted, end = [0], threading.Event()

        def count():
            while not end.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count, daemon=True)
        thread.start()
        ln.render(cornell(), size=(64, 64), samples=128, threads=1)
        end.set()
        thread.join()
        self.assertGreater(counted[0], 20)

    def test_ends_at_an_interrupt_and_leaves_neither_a_process_nor_a_file(self):
        script = f"import sys; sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})\nfrom lightnet_test import *\n"
        script += "print('begun', flush=True)\ntry:\n    ln.render(cornell(), **Running.LONG)\n"
        script += "except KeyboardInterrupt:\n    print('interrupted', children(), flush=True)\n"
        process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
        self.assertEqual(process.stdout.readline(), "begun\n")
        wait_until(lambda: folders(process.pid))
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.stdout.read(), "interrupted []\n")
        process.stdout.close()
        self.assertEqual(process.wait(), 0)
        self.assertEqual(folders(process.pid), [])


def wait_until(truth, seconds=30):
    end = time.monotonic() + seconds
    while not truth():
        if time.monotonic() > end:
            raise AssertionError("it never came")
        time.sleep(0.01)


class Arrays(InFolder):
    FLOOR = {"vertices": [[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]], "indices": [[0, 2, 1], [0, 3, 2]]}
    DOWN = {"from": (0, 3, 0.01), "to": (0, 0, 0), "fov": 40}

    def rendered(self, mesh, lamps=(), **options):
        scene = ln.Scene(ln.World([mesh], lamps), camera=self.DOWN)
        return ln.render(ln.RayTracer(ln.DirectLighting(), scene=scene, **options), size=(8, 8), samples=16)

    # Light from straight above, of irradiance E: a matt surface of albedo a sends out a E / pi.
    def test_make_scenes_that_reflect_what_they_should(self):
        floor = ln.Mesh(**self.FLOOR, material={"type": "diffuse", "reflectance": (0.5, 0.25, 0.125)})
        lamp = ln.Lamp("distant", L=(math.pi, math.pi, math.pi), to=(0, -1, 0), **{"from": (0, 0, 0)})
        picture = self.rendered(floor, [lamp])
        self.assertTrue(numpy.allclose(picture.beauty, (0.5, 0.25, 0.125), rtol=1e-4), picture.beauty[0, 0])

    def test_shine(self):
        picture = self.rendered(ln.Mesh(**self.FLOOR, emission=(1, 2, 3)))
        self.assertTrue(numpy.allclose(picture.beauty, (1, 2, 3), rtol=1e-6))

    def test_have_names_and_textures(self):
        grey = self.folder / "grey.png"
        grey.write_bytes(self.rendered(ln.Mesh(**self.FLOOR, emission=(0.25, 0.25, 0.25)))._repr_png_())
        uv = numpy.array([[0, 0], [1, 0], [1, 1], [0, 1]])
        shown = [ln.SurfaceFact(of=what, name=name) for what, name in (("uv", "st"), ("albedo", "albedo"))]
        shown.append(ln.Cryptomatte(of="object", name="Objects"))
        floor = ln.Mesh(**self.FLOOR, uv=uv, material={"type": "diffuse", "reflectance": grey}, name="floor")
        picture = self.rendered(floor, [ln.Lamp("infinite", L=1.0)], show=shown)
        self.assertTrue(numpy.allclose(picture["albedo"], 0.25, atol=0.01), picture["albedo"][0, 0])
        self.assertEqual(list(picture.manifests["Objects"]), ["floor"])
        self.assertTrue(numpy.allclose(picture.mask("floor"), 1))
        self.assertEqual(picture["st"].shape, (8, 8, 2))
        self.assertTrue(numpy.allclose(picture["st"].mean((0, 1)), 0.5, atol=0.01))

    def test_say_what_does_not_fit(self):
        for wrong, words in (
            ({"vertices": [[0, 0]]}, r"vertices must be of shape \(n, 3\)"),
            ({"indices": [[0, 1, 4]]}, "indices must be from 0 to 3"),
            ({"indices": [[0.0, 1.0, 2.0]]}, "whole numbers"),
            ({"normals": [[0, 1, 0]]}, "1 normals for 4 vertices"),
        ):
            with self.assertRaisesRegex(ln.UserError, words):
                ln.Mesh(**{**self.FLOOR, **wrong})
        with self.assertRaisesRegex(ln.UserError, "2 meshes are called 'mesh'"):
            ln.World([ln.Mesh(**self.FLOOR), ln.Mesh(**self.FLOOR)])


class Operators(InFolder):
    """Functions of this interpreter as operators."""

    SCENE = GRAPHS / "cornell_box.pbrt"

    def picture(self, light, **options):
        scene = ln.Scene(self.SCENE)
        image = ln.RayTracer(light, scene=scene, samples=4, name="image")
        return ln.render(image, **{"size": (24, 18), "threads": 1, **options})

    def lua(self, text, **options):
        """The picture of the same function, written in Lua."""
        file = self.folder / "g.lua"
        file.write_text(
            f"direct = DirectLighting {{}}\nit = Custom {{ direct, light = {text} }}\n"
            f"scene = Scene {{ '{self.SCENE}' }}\n"
            "image = RayTracer { it, scene = scene, samples = 4, film = { 24, 18 } }\n"
        )
        return ln.render(ln.load(file), size=(24, 18), threads=1, **options)

    def assert_same(self, one, other):
        self.assertTrue(numpy.array_equal(one.beauty, other.beauty))
        self.assertGreater(one.beauty.max(), 0)

    def test_answers_with_the_bits_of_lua(self):
        @ln.operator
        def it(q, ask):
            bounced = ask(0, q.hemisphere(q.n, q.random()))
            free = q.open(q.hemisphere(q.n, q.random(1, 4)), 300).astype("f4")[:, None]
            return ask(0) + q.albedo * bounced + free * numpy.float32(0.25)

        direct = ln.DirectLighting(name="direct")
        python = self.picture(it(direct, name="it"))
        lua = self.lua(
            "function(q, ask) local bounced = ask(1, hemisphere(q.n, q:random())) "
            "local free = q:open(hemisphere(q.n, q:random(2, 4)), 300) "
            "return ask(1) + q.albedo * bounced + free * 0.25 end"
        )
        self.assert_same(python, lua)
        self.assert_same(self.picture(it(direct, name="it"), threads=3), python)

    def test_has_constants_and_a_name(self):
        @ln.operator
        def facing(q, ask, power=1):
            "How much a surface faces us."
            return numpy.abs((q.n * q.out).sum(axis=1)) ** power

        one, two = facing(), facing(power=2)
        self.assertEqual(facing.__doc__, "How much a surface faces us.")
        first, second = self.picture(one), self.picture(two)
        self.assertEqual(list(first.layers), ["emission", "facing"])
        bright = first.layers["facing"]
        self.assertTrue((bright[..., 0] == bright[..., 1]).all())
        self.assertLess(second.layers["facing"].mean(), bright.mean())
        both = self.picture(ln.Combine(one, two))
        self.assertEqual(list(both.layers), ["emission", "facing", "facing_2"])
        self.assertTrue(numpy.array_equal(both.layers["facing"], bright))

    def test_may_return_one_number(self):
        grey = self.picture(ln.operator(lambda q, ask: 0.5)(name="grey")).layers["grey"]
        self.assertEqual(grey[9, 12].tolist(), [0.5, 0.5, 0.5])

    def test_raises_what_its_function_raises(self):
        @ln.operator
        def wrong(q, ask):
            raise ArithmeticError("not today")

        with self.assertRaisesRegex(ArithmeticError, "not today"):
            self.picture(wrong())
        for answer, why in ((numpy.zeros(7), "returns one number, or an array of shape"), ("x", "could not convert")):
            with self.assertRaisesRegex(ValueError, why):
                self.picture(ln.operator(lambda q, ask, answer=answer: answer)())
        with self.assertRaisesRegex(IndexError, "no input 1"):
            self.picture(ln.operator(lambda q, ask: ask(1))(ln.DirectLighting()))
        self.assertEqual(children(), [])
        self.assertEqual(folders(), [])

    def test_ends_while_a_function_thinks(self):
        thinks, go = threading.Event(), threading.Event()

        @ln.operator
        def slow(q, ask):
            thinks.set()
            go.wait(60)
            return 0

        going = ln.progress(ln.RayTracer(slow(), scene=ln.Scene(self.SCENE), samples=4), every=0.1, size=(24, 18), threads=1)
        threading.Thread(target=lambda: (thinks.wait(60), going.cancel())).start()
        began = time.monotonic()
        with self.assertRaises(ln.Error):
            list(going)
        self.assertLess(time.monotonic() - began, 50, "the run waited for the function")
        go.set()
        self.assertEqual(folders(), [])

    def test_leaves_nothing_in_the_cache(self):
        cache = self.folder / "cache"
        for light, kept in ((ln.operator(lambda q, ask: 0.5)(), False), (ln.DirectLighting(), True)):
            self.picture(ln.IrradianceCache(light, rays=16, error=0.5), cache=cache)
            self.assertEqual(cache.exists(), kept)

    def test_stays_in_this_process(self):
        for options in ({"local_workers": 1}, {"hosts": "a,b"}, {"ssh": "a"}):
            with self.assertRaisesRegex(ln.UserError, "which other processes can't ask"):
                self.picture(ln.operator(lambda q, ask: 0.5)(), **options)

    def test_is_checked_and_edited_as_others_are(self):
        @ln.operator
        def grey(q, ask):
            return ask(0) * 0.5

        direct = ln.DirectLighting(name="direct")
        image = ln.RayTracer(grey(direct), scene=ln.Scene(self.SCENE), samples=4, film={"size": (24, 18)}, name="image")
        ln.check(image)
        self.assertIn("grey", ln.dot(image))
        with ln.Session(image, size=(24, 18), threads=1) as session:
            first = session.picture()
            second = session.edit(set={"direct.samples": 4})
        self.assertTrue(numpy.array_equal(first.beauty, self.picture(grey(direct)).beauty))
        self.assertFalse(numpy.array_equal(first.beauty, second.beauty))
        with self.assertRaisesRegex(ln.Error, "LIGHTNET_OUTSIDE"):
            ln.render(ln.RayTracer(ln.Outside(function="x"), scene=ln.Scene(self.SCENE)), size=(8, 8), threads=1)


if __name__ == "__main__":
    unittest.main()
