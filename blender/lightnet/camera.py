"""Cameras and views of a scene as Mitsuba has cameras."""

import dataclasses
import math

from mathutils import Matrix, Vector

from . import xml
from .motion import Way


@dataclasses.dataclass
class View:
    """From where a picture is seen, and how much."""

    matrix: Matrix  # of what stands before the eye into the world; the eye looks along -z
    half: tuple  # width and height of what is seen, at distance 1 (orthographic: anywhere)
    middle: tuple  # of it
    orthographic: bool
    clip: tuple  # nearest and farthest, scene units
    lens: tuple | None  # radius of the aperture and distance of what is sharp; None: all is sharp
    size: tuple  # pixels
    name: str
    way: Way | None = None  # of the matrix, if it moves while the shutter is open

    def looks_along(self):
        """What `camera` of a graph's scene says of it: where from, where to, what is up, degrees across the shorter side.
        None: no such words say it."""
        if self.orthographic or self.lens or max(map(abs, self.middle)) > 1e-5:
            return None
        eye, turn = self.matrix.translation, self.matrix.to_3x3()
        to, up = eye + turn @ Vector((0, 0, -1)), turn @ Vector((0, 1, 0))
        wide, high = self.half
        shorter = wide if self.size[0] <= self.size[1] else high
        return {"from": list(eye), "to": list(to), "up": list(up), "fov": math.degrees(2 * math.atan(shorter))}


def size_of(scene):
    """Pixels of the picture."""
    render = scene.render
    share = render.resolution_percentage / 100
    return max(1, int(render.resolution_x * share)), max(1, int(render.resolution_y * share))


def frame_of(data, scene):
    """Half the width and height of what is seen, at distance 1 (of orthographic cameras: anywhere), and its middle."""
    corners = data.view_frame(scene=scene)
    depth = 1 if data.type == "ORTHO" else -corners[0].z
    xs, ys = [c.x / depth for c in corners], [c.y / depth for c in corners]
    half = (max(xs) - min(xs)) / 2, (max(ys) - min(ys)) / 2
    return half, ((max(xs) + min(xs)) / 2, (max(ys) + min(ys)) / 2)


def lens_of(camera):
    """Radius of the aperture and distance of what is sharp; None: all is sharp."""
    data = camera.data
    if not data.dof.use_dof:
        return None
    length = data.lens * 1e-3 if data.type == "PERSP" else 1.0
    distance = data.dof.focus_distance
    if data.dof.focus_object:
        place = camera.matrix_world.normalized().inverted() @ data.dof.focus_object.matrix_world.translation
        distance = abs(place.z)
    return length / (2 * max(data.dof.aperture_fstop, 1e-5)), max(distance, 1e-5)


def view_of(camera, scene, report, motion):
    """What an evaluated camera object sees."""
    data = camera.data
    if data.type == "PANO":
        report.missing("panoramic cameras", camera.name)
    if scene.render.pixel_aspect_x != scene.render.pixel_aspect_y:
        report.missing("pixels that are not square", scene.name)
    half, middle = frame_of(data, scene)
    matrix = camera.matrix_world.normalized()
    return View(
        matrix, half, middle, data.type == "ORTHO", (data.clip_start, data.clip_end), lens_of(camera), size_of(scene),
        camera.name, motion.way("camera", matrix),
    )


def view_of_region(context, size):
    """What is seen in a region of Blender's window, in so many pixels."""
    seen, space = context.region_data, context.space_data
    projection = seen.window_matrix
    orthographic = projection[3][3] != 0
    half = 1 / projection[0][0], 1 / projection[1][1]
    along = 3 if orthographic else 2
    sign = -1 if orthographic else 1
    middle = sign * projection[0][along] * half[0], sign * projection[1][along] * half[1]
    camera = context.scene.camera if seen.view_perspective == "CAMERA" else None
    lens = lens_of(camera) if camera and camera.type == "CAMERA" else None
    clip = (space.clip_start, space.clip_end)
    return View(seen.view_matrix.inverted().normalized(), half, middle, orthographic, clip, lens, size, "the viewport")


def sensor(view, report, blurred=False):
    """The element of a view. blurred: what moves is seen from time 0 to time 1."""
    (wide, high), (x, y) = view.half, view.middle
    kind = "orthographic" if view.orthographic else "thinlens" if view.lens else "perspective"
    turned = Matrix(((-1, 0, 0, 0), (0, 1, 0, 0), (0, 0, -1, 0), (0, 0, 0, 1)))
    if view.orthographic:
        turned = turned @ Matrix.Diagonal((wide, wide, 1, 1))
        if view.lens:
            report.missing("depth of field of orthographic cameras", view.name)
    element = xml.Element("sensor", type=kind).add((view.way or Way(view.matrix)).element(lambda m: m @ turned))
    if not view.orthographic:
        element.add(xml.number("fov", math.degrees(2 * math.atan(wide))), xml.word("fov_axis", "x"))
    if view.lens and not view.orthographic:
        element.add(xml.number("aperture_radius", view.lens[0]), xml.number("focus_distance", view.lens[1]))
    if x or y:
        element.add(xml.number("principal_point_offset_x", x / (2 * wide)))
        element.add(xml.number("principal_point_offset_y", -y / (2 * high)))
    element.add(xml.number("near_clip", view.clip[0]), xml.number("far_clip", view.clip[1]))
    if blurred:
        element.add(xml.number("shutter_open", 0), xml.number("shutter_close", 1))
    width, height = view.size
    return element.add(xml.Element("film", type="hdrfilm").add(xml.integer("width", width), xml.integer("height", height)))
