"""What a scene says and the renderer can't: each thing once, with where it was met first. Knows nothing of Blender."""


class Report:
    """Collects words of what is left out or approximated."""

    def __init__(self):
        self._met = {}

    def missing(self, what, where):
        """Left out: "panoramic cameras", in "Camera"."""
        self._met.setdefault(f"{what} are left out", []).append(where)

    def approximate(self, what, where):
        """A whole sentence's beginning: "hair is taken as matt"."""
        self._met.setdefault(what, []).append(where)

    def lines(self):
        """A line for each: "hair is taken as matt (Fur, and 3 others)"."""
        for what, places in self._met.items():
            places = list(dict.fromkeys(places))
            others = len(places) - 1
            more = f", and {others} other{'s' if others > 1 else ''}" if others else ""
            yield f"{what} ({places[0]}{more})"
