"""A scene of Blender as a folder with `scene.xml`, files of meshes and pictures beside it."""

import dataclasses
import os
import re

from mathutils import Matrix

from . import camera, hair, lamps, meshes, motion, shaders, values, world, xml
from .report import Report

with_mesh = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


def plain(name):
    """A name of letters, digits and _."""
    return re.sub(r"\W", "_", name, flags=re.ASCII)[:60] or "_"


@dataclasses.dataclass(frozen=True)
class Part:
    """What of a thing has one material."""

    file: str
    bsdf: str  # its id
    light: object = None  # what shines of it
    medium: str | None = None  # the id of what fills it
    kind: str = "ply"
    flat: bool = False  # normals are those of its triangles


class Export:
    """Writes into a folder that may have files of frames before: what is there by the same bytes stays."""

    def __init__(self, folder, scene, depsgraph, view_layer=None, view=None, moving=None, kept=()):
        """view: what the picture is seen from; else the scene's camera. moving: a Motion; None: all stands still.
        kept: files of other exports into the folder, which stay."""
        self.folder, self.scene, self.depsgraph = folder, scene, depsgraph
        self.report, self.motion = Report(), moving or motion.Motion()
        self.view = view or self._view_of_camera()
        self.groups = {}  # names of lamps by group
        self._used, self._surfaces, self._ids = set(kept), {}, set()
        self._known_groups = {group.name for group in view_layer.lightgroups} if view_layer else set()
        self._body, self._materials = [], []

    def _view_of_camera(self):
        if self.scene.camera is None:
            raise ValueError("the scene has no camera")
        return camera.view_of(self.scene.camera.evaluated_get(self.depsgraph), self.scene, self.report, self.motion)

    def write(self, name="scene.xml"):
        """Writes all of it, and removes what is no longer used."""
        root = xml.Element("scene", version="3.0.0")
        sensor = camera.sensor(self.view, self.report, self.motion.moves())
        around = self._medium(world.volume_of(self.depsgraph.scene.world, self.report), "around")
        root.add(sensor.add(around and xml.Element("ref", name="medium", id=around)))
        self._gather()
        for name in self.motion.deforming:
            self.report.approximate("meshes and lenses that change while the shutter is open are as in their frame", name)
        for element in world.elements(self.depsgraph.scene, self):
            self._body.append(element)
        if self.depsgraph.scene.world:
            self._join(world.name, self.depsgraph.scene.world.lightgroup)
        root.add(*self._materials, *self._body)
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write("\n".join(root.lines()) + "\n")
        self._used.add(name)
        for found in os.listdir(self.folder):
            if found.startswith(("mesh-", "map-", "world-", "slide-", "scene-")) and found not in self._used:
                os.remove(os.path.join(self.folder, found))

    def write_data(self, data, kind, ending):
        """The name of a file with these bytes, written unless it is there."""
        name = f"{kind}-{values.name_of(data)}{ending}"
        path = os.path.join(self.folder, name)
        if not os.path.exists(path):
            with open(path + ".part", "wb") as file:
                file.write(data)
            os.replace(path + ".part", path)
        self._used.add(name)
        return name

    def files(self):
        """Names of all that the scene consists of."""
        return self._used

    def may_see(self, middle, radius):
        """Does the camera perhaps see something of this ball?"""
        (wide, high), (x, y) = self.view.half, self.view.middle
        place = self.view.matrix.inverted() @ middle
        depth = -place.z
        if depth + radius <= 0:
            return False
        flat = self.view.orthographic
        far = 1 if flat else depth + radius  # what is seen is widest there
        middle_x, middle_y = (x, y) if flat else (x * depth, y * depth)
        return abs(place.x - middle_x) <= wide * far + radius and abs(place.y - middle_y) <= high * far + radius

    def put(self, name, value):
        """The element of a value as a property."""
        if values.is_constant(value):
            single = name not in colours
            return xml.number(name, value[:3].mean()) if single else xml.colour(name, value.clip(0, None))
        element = xml.Element("texture", type="bitmap", name=name)
        file = value.file or self.write_data(values.pfm(value.pixels), "map", ".pfm")
        element.add(xml.word("filename", file), xml.word("wrap_mode", value.wrap))
        if value.raw or not value.file:
            element.add(xml.flag("raw"))
        if value.channel and value.file:
            element.add(xml.word("channel", value.channel))
        if value.nearest:
            element.add(xml.word("filter_type", "nearest"))
        scale_x, scale_y, turn, x, y = value.mapping
        if value.mapping != (1, 1, 0, 0, 0):
            up = Matrix.Translation((0, 1, 0)) @ Matrix.Diagonal((1, -1, 1, 1))  # v goes down in the file
            own = Matrix.Translation((x, y, 0)) @ Matrix.Rotation(turn, 4, "Z") @ Matrix.Diagonal((scale_x, scale_y, 1, 1))
            element.add(xml.transform(up @ own @ up, "to_uv"))
        return element

    def _id(self, name):
        """A new id, like a name."""
        candidate, count = plain(name), 1
        while candidate in self._ids:
            count += 1
            candidate = f"{plain(name)}_{count}"
        self._ids.add(candidate)
        return candidate

    def _join(self, lamp, group):
        """Puts a lamp into a group of its view layer."""
        if group and group in self._known_groups:
            self.groups.setdefault(plain(group), []).append(lamp)

    def _surface(self, material):
        """The id of a material's bsdf, its light, and the id of what fills it; written once."""
        key = material.name_full if material else None
        if key not in self._surfaces:
            surface = shaders.surface_of(material.original if material else None, self.report)
            element = (surface.bsdf or black)(self.put)
            if not (values.is_constant(surface.opacity) and surface.opacity[0] >= 1):
                element = xml.Element("bsdf", type="mask").add(self.put("opacity", surface.opacity), element)
            element.attributes["id"] = self._id(material.name if material else "no material")
            self._materials.append(element)
            light = None if values.is_black(surface.emission) else surface.emission
            medium = self._medium(shaders.volume_of(material.original if material else None, self.report), "inside")
            self._surfaces[key] = element.attributes["id"], light, medium
        return self._surfaces[key]

    def _medium(self, volume, name):
        """The id of what fills a space; None: nothing."""
        if volume is None:
            return None
        name = self._id(name)
        self._materials.append(volume.element(name))
        return name

    def _gather(self):
        """Things in the order in which Blender has them; those with one mesh and one look become instances."""
        found, order = {}, []
        for instance in self.depsgraph.object_instances:
            thing = instance.object
            way = self.motion.way(motion.key_of(instance), instance.matrix_world.copy())
            for system in hair.systems_of(thing) if instance.show_particles else ():
                key = "HAIR", thing.name_full, system.name
                if key not in found:
                    found[key] = self._hair(thing, system), []
                    order.append(key)
                found[key][1].append((f"{thing.name} {system.name}", way, ""))
            if not instance.show_self:
                continue
            if thing.type == "LIGHT":
                self._lamp(thing, way)
            elif thing.type in with_mesh or thing.type == "CURVES":
                looks = tuple(slot.material.name_full if slot.material else None for slot in thing.material_slots)
                key = thing.type, thing.data.as_pointer(), looks
                if key not in found:
                    found[key] = self._curves(thing) if thing.type == "CURVES" else self._mesh(thing), []
                    order.append(key)
                group = thing.lightgroup
                found[key][1].append((thing.name, way, group))
            elif thing.type not in ("EMPTY", "CAMERA", "ARMATURE", "LATTICE", "LIGHT_PROBE", "SPEAKER"):
                what = "grids of volumes" if thing.type == "VOLUME" else f"objects of type {thing.type.lower()}"
                self.report.missing(what, thing.name)
        for key in order:
            self._stand(*found[key])

    def _lamp(self, thing, way):
        name = self._id(thing.name)
        element = lamps.element(thing, way, name, self)
        if element is not None:
            self._body.append(element)
            self._join(name, thing.lightgroup)

    def _mesh(self, thing):
        """Files of an object's mesh, each with what its material is."""
        mesh = thing.to_mesh()
        if mesh is None or not len(mesh.polygons):
            thing.to_mesh_clear()
            return []
        slots = [slot.material for slot in thing.material_slots]
        parts = []
        flat = meshes.is_flat(mesh)
        for number, data in meshes.parts_of(mesh, flat):
            material = slots[min(number, len(slots) - 1)] if slots else None
            parts.append(Part(self.write_data(data, "mesh", ".ply"), *self._surface(material), flat=flat))
        thing.to_mesh_clear()
        return parts

    def _hair(self, thing, system):
        """Particles of an object that are hair; by the object itself, where it is an instance."""
        slots, rendered = [slot.material for slot in thing.material_slots], self.depsgraph.mode == "RENDER"
        data = hair.of_particles(thing.original.evaluated_get(self.depsgraph), system, rendered)
        return self._strands(data, hair.slot_of_particles(system, slots), thing)

    def _curves(self, thing):
        slots = [slot.material for slot in thing.material_slots]
        return self._strands(hair.of_curves(thing.data), slots[0] if slots else None, thing)

    def _strands(self, data, material, thing):
        """A part, if there is any hair."""
        if not data:
            return []
        bsdf, light, _ = self._surface(material)
        if light is not None:
            self.report.missing("lights of hair", thing.name)
        return [Part(self.write_data(data, "mesh", ".strands"), bsdf, kind="bsplinecurve")]

    def _stand(self, parts, places):
        """Puts a mesh where it stands: once as it is, else by instances of one group. Lamps and volumes stand each by itself."""
        alone = [part for part in parts if part.light is not None or part.medium is not None]
        dark = [part for part in parts if part not in alone]
        for name, way, group in places:
            for part in alone:
                self._shape(part, way, name, group)
        if not dark:
            return
        if len(places) == 1 and not any(part.kind == "bsplinecurve" for part in dark):  # radii are those of the file, but in groups
            for part in dark:
                self._shape(part, places[0][1], places[0][0], "")
            return
        name = self._id(places[0][0])
        body = xml.Element("shape", type="shapegroup", id=name)
        for part in dark:
            body.add(self._element(part, None, None))
        self._body.append(body)
        for _, way, _ in places:
            instance = xml.Element("shape", type="instance")
            self._body.append(instance.add(way.element(), xml.Element("ref", id=name)))

    def _element(self, part, way, name):
        element = xml.Element("shape", type=part.kind, **({"id": name} if name else {}))
        element.add(xml.word("filename", part.file))
        if part.flat:
            element.add(xml.flag("face_normals"))
        if way is not None:
            element.add(way.element())
        element.add(xml.Element("ref", id=part.bsdf))
        return element.add(part.medium and xml.Element("ref", name="interior", id=part.medium))

    def _shape(self, part, way, name, group):
        name = self._id(name)
        element = self._element(part, way, name)
        if part.light is not None:
            lamp = self._id(name + "_light")
            light = xml.Element("emitter", type="area", id=lamp)
            element.add(light.add(self.put("radiance", part.light), xml.flag("two_sided")))
            self._join(lamp, group)
        self._body.append(element)


colours = {
    "reflectance", "transmittance", "specular_reflectance", "specular_transmittance", "base_color", "radiance",
}


def black(_):
    return xml.Element("bsdf", type="diffuse").add(xml.colour("reflectance", (0, 0, 0)))
