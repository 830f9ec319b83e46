"""Elements of Mitsuba's XML, as far as scenes of Blender need them. Knows nothing of Blender."""

from xml.sax.saxutils import quoteattr


class Element:
    """`<tag key="value">`, with what it holds. Elements that are put into several places are written out in each."""

    def __init__(self, tag, **attributes):
        self.tag, self.attributes, self.children = tag, attributes, []

    def add(self, *children):
        """Puts in what is not None, and returns the element itself."""
        self.children += [child for child in children if child is not None]
        return self

    def named(self, name):
        """A copy under another name, for another property."""
        copy = Element(self.tag, **{**self.attributes, "name": name})
        copy.children = self.children
        return copy

    def lines(self, indent=""):
        words = " ".join(f"{key}={quoteattr(str(value))}" for key, value in self.attributes.items())
        opening = f"{indent}<{self.tag} {words}".rstrip()
        if not self.children:
            yield opening + "/>"
            return
        yield opening + ">"
        for child in self.children:
            yield from child.lines(indent + " ")
        yield f"{indent}</{self.tag}>"


def number(name, value):
    return Element("float", name=name, value=repr(float(value)))


def integer(name, value):
    return Element("integer", name=name, value=int(value))


def word(name, value):
    return Element("string", name=name, value=value)


def flag(name, value=True):
    return Element("boolean", name=name, value="true" if value else "false")


def colour(name, rgb):
    return Element("rgb", name=name, value=" ".join(repr(float(c)) for c in rgb[:3]))


def transform(rows, name="to_world"):
    """Of 4 rows of 4 numbers."""
    return Element("transform", name=name).add(matrix(rows))


def animation(keys, name="to_world"):
    """Of pairs of a time in seconds and 4 rows of 4 numbers."""
    return Element("animation", name=name).add(
        *(Element("transform", time=repr(float(time))).add(matrix(rows)) for time, rows in keys)
    )


def matrix(rows):
    return Element("matrix", value=" ".join(repr(float(x)) for row in rows for x in row))
