"""Script for Blender with a window, in which the add-on is installed from its zip: the viewport.

blender --factory-startup --python viewport_test.py -- LIGHTNET.zip [SCREENSHOT.png]
"""

import glob
import os
import sys
import time
import traceback

import bpy
import mathutils

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scenes  # noqa: E402

patience = 120  # seconds for each picture


def folders():
    return glob.glob(f"/dev/shm/lightnet-{os.getpid()}-*")


def area():
    return next(one for one in bpy.context.window_manager.windows[0].screen.areas if one.type == "VIEW_3D")


def view():
    return area().spaces[0].region_3d


def viewport():
    from lightnet import viewport

    return next(iter(viewport._open), None)


def wait_for(condition, what):
    """Yields, so that Blender goes on, until it holds."""
    begin = time.monotonic()
    while not condition():
        if time.monotonic() - begin > patience:
            raise AssertionError(f"waited for {what}" + (f": {viewport().mistake}" if viewport() else ""))
        yield


def finished(what):
    """Until there is a picture of what is shown now."""
    yield from wait_for(lambda: viewport() and not viewport().finished, f"the beginning: {what}")
    yield from wait_for(lambda: viewport().finished and viewport().picture is not None, what)


def brightness():
    return viewport().picture.beauty.mean(axis=(0, 1))


def steps(screenshot):
    scenes.empty()
    scenes.usual()
    scene = bpy.context.scene
    scene.render.engine = "LIGHTNET"
    scene.lightnet.viewport_samples, scene.lightnet.viewport_pixel, scene.lightnet.threads = 4, 4, 2
    view().view_perspective = "PERSP"
    view().view_distance, view().view_rotation = 6, mathutils.Euler((1.1, 0, 0.7)).to_quaternion()
    area().spaces[0].shading.type = "RENDERED"
    yield from wait_for(lambda: viewport() is not None and viewport().picture is not None, "the first picture")
    yield from wait_for(lambda: viewport().finished, "the finished picture")
    first = brightness()
    assert first.min() > 0, first
    picture = viewport().picture.beauty
    ratio = picture.shape[1] / picture.shape[0]
    region = next(one for one in area().regions if one.type == "WINDOW")
    assert abs(ratio - region.width / region.height) < 0.05 * ratio, picture.shape

    view().view_rotation = mathutils.Euler((1.1, 0, 2.2)).to_quaternion()
    yield from finished("another view")
    assert abs(viewport().picture.beauty - picture).max() > 0.01
    if screenshot:
        bpy.ops.object.select_all(action="DESELECT")
        yield from wait_for(lambda: viewport().finished and not viewport().waits(), "what is to be shown")
        for _ in range(5):
            yield
        bpy.ops.screen.screenshot(filepath=screenshot)

    for lamp in bpy.data.lights:
        lamp.energy *= 4
    yield from finished("brighter lamps")
    brighter = brightness()
    view().view_rotation = mathutils.Euler((1.1, 0, 0.7)).to_quaternion()
    yield from finished("the first view again")
    assert brightness().mean() > 2 * first.mean(), (first, brightness(), brighter)

    view().view_perspective = "ORTHO"
    yield from finished("an orthographic view")
    view().view_perspective = "CAMERA"
    yield from finished("what the camera sees")
    assert len(folders()) == 1, folders()
    area().spaces[0].shading.type = "SOLID"
    yield from wait_for(lambda: viewport() is None, "its end")
    yield from wait_for(lambda: not folders(), "the end of its folder")


def main():
    words = sys.argv[sys.argv.index("--") + 1 :]
    bpy.context.preferences.view.show_splash = False
    bpy.ops.preferences.addon_install(filepath=words[0])
    bpy.ops.preferences.addon_enable(module="lightnet")
    running = steps(words[1] if len(words) > 1 else None)

    def go_on():
        try:
            next(running)
            return 0.05
        except StopIteration:
            print("PASSED", flush=True)
            os._exit(0)
        except BaseException:
            traceback.print_exc()
            sys.stdout.flush()
            os._exit(1)

    bpy.app.timers.register(go_on, first_interval=0.5)


main()
