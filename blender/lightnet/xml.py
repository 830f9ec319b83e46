"""Elements of Mitsuba's scene format, as text."""

from xml.sax.saxutils import quoteattr


def numbers(values):
    """Numbers with all of their digits, and commas between them."""
    return ", ".join(repr(float(value)) for value in values)


def element(tag, name, inside, **attributes):
    """An element around others."""
    words = {"name": name, **attributes} if name else attributes
    return f"<{tag} {' '.join(f'{key}={quoteattr(str(value))}' for key, value in words.items())}>\n{''.join(inside)}</{tag}>\n"


def single(tag, name, value):
    """An element with a value."""
    return f"<{tag} name={quoteattr(name)} value={quoteattr(str(value))}/>\n"


def rgb(name, colour):
    """A colour, linear."""
    return single("rgb", name, numbers(colour[:3]))


def number(name, value):
    """A number."""
    return single("float", name, repr(float(value)))


def matrix(name, rows):
    """A transform by the rows of a 4x4 matrix."""
    values = " ".join(repr(float(value)) for row in rows for value in row)
    return f'<transform name={quoteattr(name)}>\n<matrix value="{values}"/>\n</transform>\n'
