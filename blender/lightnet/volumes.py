"""What fills a space evenly, as a medium of Mitsuba's. Knows nothing of Blender."""

import dataclasses

import numpy

from . import xml


def none():
    return numpy.zeros(3)


@dataclasses.dataclass
class Volume:
    """Per scene unit, red, green, blue. turned: scattering times its mean cosine, so that those of sums add up."""

    scattering: numpy.ndarray = dataclasses.field(default_factory=none)
    absorption: numpy.ndarray = dataclasses.field(default_factory=none)
    emission: numpy.ndarray = dataclasses.field(default_factory=none)
    turned: numpy.ndarray = dataclasses.field(default_factory=none)

    def __add__(self, other):
        return Volume(*(getattr(self, f.name) + getattr(other, f.name) for f in dataclasses.fields(self)))

    def times(self, share):
        return Volume(*(getattr(self, f.name) * share for f in dataclasses.fields(self)))

    def is_empty(self):
        return not (self.scattering + self.absorption + self.emission).any()

    def cosine(self):
        """The mean cosine of all that scatters."""
        whole = self.scattering.sum()
        return float(self.turned.sum() / whole) if whole > 0 else 0.0

    def element(self, name):
        extinction = self.scattering + self.absorption
        most = max(extinction.max(), 1e-9)
        albedo = self.scattering / numpy.maximum(extinction, 1e-30)
        made = xml.Element("medium", type="homogeneous", id=name).add(
            xml.colour("sigma_t", extinction / most), xml.number("scale", most), xml.colour("albedo", albedo)
        )
        if self.emission.any():
            made.add(xml.colour("emission", self.emission))
        if abs(self.cosine()) > 1e-6:
            made.add(xml.Element("phase", type="hg").add(xml.number("g", self.cosine())))
        return made


def scatter(colour, density, cosine):
    scattering = colour * density
    return Volume(scattering, turned=scattering * cosine)


def absorb(colour, density):
    return Volume(absorption=(1 - colour).clip(0, 1) * density)


def principled(colour, density, cosine, absorbing, emission):
    """Cycles': what does not scatter is absorbed, but for the root of a colour."""
    absorption = (1 - colour).clip(0, None) * (1 - numpy.sqrt(absorbing.clip(0, None))).clip(0, None)
    scattering = colour * density
    return Volume(scattering, absorption * density, emission, scattering * cosine)
