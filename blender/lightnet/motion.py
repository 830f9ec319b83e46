"""What moves while the shutter is open: where things, lamps and the camera stand at moments between."""

import math

import numpy

from . import xml

most_turned = math.radians(45)  # from one moment to the next, before there are more of them
most_parts = 32


class Way:
    """Where a thing stands in its frame, and at moments of the shutter, if it moves.

    keys: pairs of time (0: the shutter opens; 1: it closes) and matrix; None: it stands still."""

    def __init__(self, now, keys=None):
        self.now, self.keys = now, keys

    def element(self, stood=lambda matrix: matrix):
        """The transform of what stands so to the thing."""
        if self.keys is None:
            return xml.transform(stood(self.now))
        return xml.animation([(time, stood(matrix)) for time, matrix in self.keys])


class Motion:
    """Of a frame: `keys` by thing. Empty, nothing moves."""

    def __init__(self):
        self.keys, self.deforming = {}, []

    def way(self, key, now):
        return Way(now, self.keys.get(key))

    def moves(self):
        return bool(self.keys)


def span_of(scene):
    """When the shutter opens and closes, in frames after the frame; None: at once."""
    render, cycles = scene.render, getattr(scene, "cycles", None)
    length = render.motion_blur_shutter
    if not render.use_motion_blur or length <= 0:
        return None
    position = getattr(render, "motion_blur_position", None) or getattr(cycles, "motion_blur_position", "CENTER")
    begin = {"START": 0, "END": -length}.get(position, -length / 2)
    return begin, begin + length


def parts_of(scene):
    """Between how many moments at least things are looked at: Cycles' steps."""
    steps = (getattr(getattr(thing, "cycles", None), "motion_steps", 1) for thing in scene.objects)
    return min(2 ** max(steps, default=1), most_parts)


def key_of(instance):
    """What tells a thing, or one of its instances, from all others, at all times."""
    if not instance.is_instance:
        return (instance.object.name_full,)
    return instance.object.name_full, instance.parent.name_full, tuple(instance.persistent_id)


def look(engine, depsgraph):
    """The motion of a frame. Goes to other frames, and comes back."""
    scene, motion = depsgraph.scene, Motion()
    span = span_of(scene)
    if span is None:
        return motion
    frame = scene.frame_current + scene.frame_subframe
    seen = {}  # moments by their time

    def at(time):
        if time not in seen:
            go_to(engine, frame + span[0] + time * (span[1] - span[0]))
            seen[time] = moment_of(depsgraph)
        return seen[time]

    parts = max(2, parts_of(scene))
    try:
        while True:
            times = [i / parts for i in range(parts + 1)]
            moments = [at(time) for time in times]
            if parts >= most_parts or not turns_much([places for places, _ in moments]):
                break
            parts *= 2
    finally:
        go_to(engine, frame)
    motion.keys = keys_of(times, [places for places, _ in moments])
    first = moments[0][1]
    motion.deforming = [name for name, form in first.items() if any(forms.get(name, form) != form for _, forms in moments[1:])]
    return motion


def go_to(engine, frame):
    whole = math.floor(frame + 1e-6)
    engine.frame_set(whole, subframe=min(max(0.0, frame - whole), 0.999999))


def moment_of(depsgraph):
    """Where all things stand, by key (the camera's is "camera"), and what forms meshes and the lens have, by name."""
    places, forms = {}, {}
    for instance in depsgraph.object_instances:
        places[key_of(instance)] = instance.matrix_world.copy()
        thing = instance.object
        if thing.type == "MESH" and thing.name_full not in forms:
            forms[thing.name_full] = form_of(thing.data)
    camera = depsgraph.scene.camera
    if camera is not None:
        places["camera"] = camera.evaluated_get(depsgraph).matrix_world.normalized()
        forms[camera.name_full] = lens_of(camera.evaluated_get(depsgraph).data)
    return places, forms


def form_of(mesh):
    """Tells the places of a mesh's vertices from others."""
    places = numpy.empty(3 * len(mesh.vertices), numpy.float32)
    mesh.vertices.foreach_get("co", places)
    return hash(places.tobytes())


def lens_of(camera):
    return camera.lens, camera.ortho_scale, camera.shift_x, camera.shift_y


def turns_much(moments):
    """Does anything turn so far from one moment to the next that the way between is in doubt?"""
    for before, after in zip(moments, moments[1:]):
        for key, matrix in before.items():
            if key in after and matrix != after[key]:
                turn = matrix.to_quaternion().rotation_difference(after[key].to_quaternion()).angle
                if min(turn, 2 * math.pi - turn) > most_turned:
                    return True
    return False


def keys_of(times, moments):
    """Of what is there at all moments, and does not stand still."""
    found = {}
    for key, first in moments[0].items():
        matrices = [moment.get(key) for moment in moments]
        if all(one is not None for one in matrices) and any(one != first for one in matrices):
            found[key] = list(zip(times, matrices))
    return found
