"""The camera of a scene as Mitsuba has cameras."""

import math

from mathutils import Matrix

from . import xml


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


def sensor(camera, scene, report):
    """The element of an evaluated camera object."""
    data = camera.data
    if data.type == "PANO":
        report.missing("panoramic cameras", camera.name)
    if scene.render.pixel_aspect_x != scene.render.pixel_aspect_y:
        report.missing("pixels that are not square", scene.name)
    (wide, high), (x, y) = frame_of(data, scene)
    lens = lens_of(camera)
    orthographic = data.type == "ORTHO"
    kind = "orthographic" if orthographic else "thinlens" if lens else "perspective"
    turned = Matrix(((-1, 0, 0, 0), (0, 1, 0, 0), (0, 0, -1, 0), (0, 0, 0, 1)))
    stood = camera.matrix_world.normalized() @ turned
    if orthographic:
        stood = stood @ Matrix.Diagonal((wide, wide, 1, 1))
        if lens:
            report.missing("depth of field of orthographic cameras", camera.name)
    element = xml.Element("sensor", type=kind).add(xml.transform(stood))
    if not orthographic:
        element.add(xml.number("fov", math.degrees(2 * math.atan(wide))), xml.word("fov_axis", "x"))
    if lens and not orthographic:
        element.add(xml.number("aperture_radius", lens[0]), xml.number("focus_distance", lens[1]))
    if x or y:
        element.add(xml.number("principal_point_offset_x", x / (2 * wide)))
        element.add(xml.number("principal_point_offset_y", -y / (2 * high)))
    element.add(xml.number("near_clip", data.clip_start), xml.number("far_clip", data.clip_end))
    width, height = size_of(scene)
    return element.add(xml.Element("film", type="hdrfilm").add(xml.integer("width", width), xml.integer("height", height)))
