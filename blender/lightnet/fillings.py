"""Volumes of Blender's materials and worlds: what each shader of them becomes."""

from . import nodes, values, volumes


class Fillings(nodes.Evaluator):
    """Reads the shaders of a tree's volume."""

    def volume(self, socket):
        """What comes into a socket of shaders. Nothing: empty space."""
        return self.at(socket, self._made, volumes.Volume)

    def _made(self, node):
        place = f"{self.where}: {node.name}"
        maker = makers.get(node.type)
        if maker is None:
            self.report.missing(f"volumes by the shader {node.bl_label}", place)
            return volumes.Volume()
        return maker(self, node, place)

    def colour(self, node, name):
        return values.pixels_of(values.mean(self.value(node.inputs[name])))[:3].astype(float)

    def number(self, node, name):
        return float(values.number(self.value(node.inputs[name])))


def scatter(fillings, node, _):
    return volumes.scatter(fillings.colour(node, "Color"), fillings.number(node, "Density"), fillings.number(node, "Anisotropy"))


def absorb(fillings, node, _):
    return volumes.absorb(fillings.colour(node, "Color"), fillings.number(node, "Density"))


def principled(fillings, node, place):
    if fillings.number(node, "Blackbody Intensity") > 0:
        fillings.report.missing("blackbodies in volumes", place)
    shining = fillings.colour(node, "Emission Color") * fillings.number(node, "Emission Strength")
    return volumes.principled(
        fillings.colour(node, "Color"), fillings.number(node, "Density"), fillings.number(node, "Anisotropy"),
        fillings.colour(node, "Absorption Color"), shining,
    )


def emit(fillings, node, _):
    return volumes.Volume(emission=fillings.colour(node, "Color") * fillings.number(node, "Strength"))


def mix(fillings, node, place):
    share, first, second = node.inputs
    part = float(values.number(fillings.value(share)))
    return joined(fillings, fillings.volume(first).times(1 - part), fillings.volume(second).times(part), place)


def add(fillings, node, place):
    return joined(fillings, fillings.volume(node.inputs[0]), fillings.volume(node.inputs[1]), place)


def joined(fillings, first, second, place):
    if first.scattering.any() and second.scattering.any() and abs(first.cosine() - second.cosine()) > 1e-3:
        fillings.report.approximate("two volumes that scatter otherwise scatter by their mean", place)
    return first + second


makers = {
    "VOLUME_SCATTER": scatter,
    "VOLUME_ABSORPTION": absorb,
    "PRINCIPLED_VOLUME": principled,
    "EMISSION": emit,
    "MIX_SHADER": mix,
    "ADD_SHADER": add,
}


def of_output(output, name, report):
    """Of a tree's output; None: empty space."""
    if output is None or not output.inputs["Volume"].is_linked:
        return None
    found = Fillings(name, report).volume(output.inputs["Volume"])
    return None if found.is_empty() else found
