"""Races: graphs that render for the same time, in turns, held against a reference."""

import contextlib
import csv
import os

from . import graph, operators, program
from .errors import UserError


class Race:
    """What became of a race. `rows`: a dict for each point of each curve, and for the end of each run, as `race.csv` has
    them. `ends`: the last ones, which have all measures. `html`: the page with curves and pictures, which notebooks
    show."""

    def __init__(self, rows, html, table):
        self.rows, self.html, self.table = rows, html, table
        self.ends = [row for row in rows if row["flip"] is not None]

    def __repr__(self):
        return self.table

    def _repr_html_(self):
        return self.html

    def save(self, file):
        """Writes the page."""
        with open(file, "w", encoding="utf-8") as out:
            out.write(self.html)


def race(graphs, reference, seconds=60, seeds=3, **options):
    """Lets graphs render for so many seconds each, in turns, once for each seed, and returns a Race. `graphs`: a dict of
    nodes that make an image, by the names that curves get. `reference`: a file, or a Picture. Options are those of
    `lightnet race`. Raises UserError or Error."""
    with program.folder() as folder:
        words = [_written(name, one, folder) for name, one in graphs.items()]
        if hasattr(reference, "save"):
            truth = os.path.join(folder, "reference.exr")
            reference.save(truth)
            reference = truth
        page, table = os.path.join(folder, "race.html"), os.path.join(folder, "race.csv")
        words += ["--reference", os.fspath(reference), "--seconds", repr(float(seconds)), "--seeds", str(seeds)]
        with contextlib.closing(operators.served(list(graphs.values()), folder, options)) as functions:
            words += ["-o", page, "--csv", table, *program.flags({**options, **functions.options})]
            said = program.said("race", *words, environment=functions.environment)
        with open(table, encoding="utf-8", newline="") as file:
            rows = [_numbers(row) for row in csv.DictReader(file)]
        with open(page, encoding="utf-8") as file:
            return Race(rows, file.read(), said)


def _written(name, one, folder):
    """A graph as a file of this name."""
    if not isinstance(one, graph.Node):
        raise UserError(f"race: {name!r} must be a node that makes an image; graph files race by `lightnet race`")
    file = os.path.join(folder, name + ".json")
    with open(file, "w", encoding="utf-8") as out:
        out.write(graph.as_json(one, folder))
    return file


def _numbers(row):
    return {key: value if key == "name" else float(value) if value else None for key, value in row.items()}
