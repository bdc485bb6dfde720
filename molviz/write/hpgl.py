"""HPGL for pen plotters: circles as true arcs (``AA``), strokes in an order that saves pen-up travel.

A plotter has no fill and no line width: only stroke layers are drawn, each with its own pen.
"""

import math
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from molviz import toml
from molviz.arrays import Bools, Floats
from molviz.curves import Paths, PlaneArcs
from molviz.errors import InputError
from molviz.picture.picture import Picture, StrokeLayer
from molviz.vectors import cross
from molviz.write.pen_travel import drawing_order

CHORD_ERROR = 0.5  # plotter units between a curve and its chords: no plotter resolves less
ROUND = 1e-9  # relative difference of an ellipse's half-diameters that still counts as a circle
MARGIN = 0.01  # of the plotting range, on every side


@dataclass(frozen=True)
class Plotter:
    """A model with one paper loaded."""

    name: str
    pens: int
    width: int  # plotter units
    height: int


def plotter(model: str = "", paper: str = "") -> Plotter:
    """Return a plotter of the table by model and paper, the table's own choice where empty.

    Raises ``InputError`` for a model or paper that the table does not have.
    """
    table = _table()
    row = _entry(table["plotter"], model or table["default_plotter"], "plotter")
    width, height = _entry(row["paper"], paper or table["default_paper"], f"paper for the {row['name']}")
    return Plotter(row["name"], row["pens"], width, height)


def write_hpgl(picture: Picture, device: Plotter | None = None) -> bytes:
    """Return the picture's strokes as HPGL, as large as fits the plotter's range."""
    device = device or plotter()
    layers = [layer for layer in picture.layers if isinstance(layer, StrokeLayer)]
    commands = ["IN;"]
    for number, layer in enumerate(layers):
        commands.append(f"SP{number % device.pens + 1};")
        commands += _strokes(_on_paper(layer.paths, picture, device))
    return "\n".join([*commands, "PU;SP0;", ""]).encode("ascii")


@cache
def _table() -> dict[str, Any]:
    return toml.loads(resources.files("molviz.write").joinpath("plotters.toml").read_text(encoding="utf-8"))


def _entry(table: dict[str, Any], key: str, kind: str) -> Any:
    if key not in table:
        raise InputError(f"no {kind} is called {key!r}, expected one of {', '.join(table)}")
    return table[key]


def _on_paper(paths: Paths, picture: Picture, device: Plotter) -> Paths:
    """The paths in plotter units, the page centred in the range."""
    scale = (1.0 - 2.0 * MARGIN) * min(device.width / picture.width, device.height / picture.height)
    shift = np.array([device.width - scale * picture.width, device.height - scale * picture.height]) / 2.0
    return paths._replace(arcs=paths.arcs.moved(scale, shift))


def _strokes(paths: Paths) -> list[str]:
    """One line of commands for every loop, drawn from whichever end is nearer."""
    arcs, (first, last) = paths.arcs, (paths.loop_start[:-1], paths.loop_start[1:] - 1)
    begin, end = arcs.starts(), arcs.ends()
    forward, backward = _commands(arcs, 1.0), _commands(arcs, -1.0)
    lines = []
    for loop, reverse in drawing_order(begin[first], end[last]):
        rows = range(paths.loop_start[loop], paths.loop_start[loop + 1])
        start = end[last[loop]] if reverse else begin[first[loop]]
        drawn = [backward[row] for row in reversed(rows)] if reverse else [forward[row] for row in rows]
        lines.append(f"PU{_point(start)};PD;{''.join(drawn)}")
    return lines


def _commands(arcs: PlaneArcs, direction: float) -> list[str]:
    """What draws each arc, the pen down at its begin (end, if the direction is negative).

    Circles are drawn by ``AA`` about their centre, other ellipses by ``PA`` through chords.
    """
    turn = np.sign(cross(arcs.u, arcs.v))
    sweep = np.degrees(arcs.sweep) * turn * direction
    center = np.rint(arcs.c).astype(int).tolist()
    step = _step(arcs.major())
    chord = np.clip(np.degrees(step), 1.0, 5.0).astype(int)
    commands = [
        f"AA{x},{y},{_number(angle)},{size};"
        for (x, y), angle, size in zip(center, sweep.tolist(), chord.tolist(), strict=True)
    ]
    for row in np.flatnonzero(~_circular(arcs)).tolist():
        commands[row] = _chords(arcs, row, float(step[row]), direction)
    return commands


def _circular(arcs: PlaneArcs) -> Bools:
    """Tell which ellipses are circles: u ⊥ v and |u| = |v|."""
    size = np.sum(arcs.u**2, axis=1)
    skew = np.abs(np.sum(arcs.u * arcs.v, axis=1)) + np.abs(np.sum(arcs.v**2, axis=1) - size)
    return np.asarray(skew <= ROUND * size)


def _step(radius: Floats) -> Floats:
    """The angle whose chord stays within the error: r (1 − cos(step / 2)) = error."""
    return np.asarray(2.0 * np.arccos(np.clip(1.0 - CHORD_ERROR / np.maximum(radius, CHORD_ERROR), -1.0, 1.0)))


def _chords(arcs: PlaneArcs, row: int, step: float, direction: float) -> str:
    count = max(1, math.ceil(abs(float(arcs.sweep[row])) / step))
    share = np.arange(1, count + 1) / count if direction > 0 else np.arange(count - 1, -1, -1) / count
    points = arcs.take(np.full(count, row)).at(arcs.start[row] + arcs.sweep[row] * share)
    return f"PA{','.join(_point(point) for point in points)};"


def _point(point: Floats) -> str:
    return f"{round(float(point[0]))},{round(float(point[1]))}"


def _number(value: float) -> str:
    return f"{value:.3f}".rstrip("0").rstrip(".")
