"""Hair of Blender's particles, and Curves objects: strands in the space of their object."""

import numpy

from . import strands

usual_radius = 0.005  # Cycles' of Curves that have none


def systems_of(thing):
    """Particle systems of an evaluated object that are shown as hair."""
    for modifier in thing.modifiers:
        if modifier.type == "PARTICLE_SYSTEM" and modifier.show_render:
            system = modifier.particle_system
            if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
                yield system


def of_particles(thing, system, rendered):
    """The bytes of a file; rendered: with as many points as pictures have, else as the viewport."""
    settings = system.settings
    points = 2 ** (settings.render_step if rendered else settings.display_step) + 1
    if settings.kink == "SPIRAL":
        points += settings.kink_extra_steps
    parents, children = len(system.particles), len(system.child_particles)
    first = parents if settings.child_type != "NONE" and children and not settings.use_parent_particles else 0
    found = [
        [system.co_hair(thing, particle_no=number, step=step)[:] for step in range(points)]
        for number in range(first, parents + children)
    ]
    if not found:
        return b""
    back = numpy.array(thing.matrix_world.inverted())
    places = numpy.array(found, numpy.float64) @ back[:3, :3].T + back[:3, 3]
    scale = 0.5 * settings.radius_scale
    radii = strands.radii(
        strands.along(places), settings.root_radius * scale, settings.tip_radius * scale, settings.shape, settings.use_close_tip
    )
    return strands.text([numpy.concatenate((places, radii[..., None]), axis=2)])


def of_curves(data):
    """The bytes of a file, of an evaluated Curves."""
    count = len(data.points)
    if not count:
        return b""
    places, radii = numpy.empty(3 * count, numpy.float32), numpy.full(count, usual_radius, numpy.float32)
    data.points.foreach_get("position", places)
    if "radius" in data.attributes:
        data.attributes["radius"].data.foreach_get("value", radii)
    points = numpy.concatenate((places.reshape(-1, 3), radii[:, None]), axis=1).astype(numpy.float64)
    by_length = {}
    for curve in data.curves:
        first, length = curve.first_point_index, curve.points_length
        if length > 1:
            by_length.setdefault(length, []).append(points[first : first + length])
    return strands.text([numpy.stack(group) for _, group in sorted(by_length.items())])


def slot_of_particles(system, slots):
    """The material of a particle system."""
    return slots[min(max(system.settings.material, 1), len(slots)) - 1] if slots else None
