"""HPGL for pen plotters: circles as true arcs (``AA``), strokes in an order that saves pen-up travel.

A plotter has no fill and no line width: only strokes and texts are drawn, each layer with its own pen. Texts are
lettered by the plotter itself (``LB``), in ASCII: accents are dropped, Greek letters spelt out.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from molviz import toml
from molviz.arrays import Bools, Floats
from molviz.curves import Paths, PlaneArcs
from molviz.errors import InputError
from molviz.picture.furniture.metrics import CAPITAL, text_width
from molviz.picture.picture import Picture, StrokeLayer, Text, TextLayer
from molviz.vectors import cross
from molviz.write.font import left
from molviz.write.pen_travel import drawing_order
from molviz.write.text import encoded_lines, plotter_text

CHORD_ERROR = 0.5  # plotter units between a curve and its chords: no plotter resolves less
ROUND = 1e-9  # relative difference of an ellipse's half-diameters that still counts as a circle
MARGIN = 0.01  # of the plotting range, on every side
DECIMALS = 6  # of plotter units, before they are rounded to whole ones: halves are halves on every machine
UNITS_PER_CM = 400.0  # a plotter unit is 0.025 mm
SMALLEST = 0.01  # centimetres, of letters: less than a pen's width, but not zero
PITCH = 1.5  # widths from one letter to the next
END_OF_LABEL = "\x03"  # ETX; nothing else ends a label


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


def write_hpgl(picture: Picture, device: Plotter | None = None) -> Iterator[bytes]:
    """Yield the picture's strokes as HPGL, as large as fits the plotter's range."""
    device = device or plotter()
    layers = [layer for layer in picture.layers if isinstance(layer, StrokeLayer | TextLayer)]
    commands = ["IN;"]
    for number, layer in enumerate(layers):
        commands.append(f"SP{number % device.pens + 1};")
        scale, shift = _on_paper(picture, device)
        if isinstance(layer, TextLayer):
            commands += [_lettered(text, scale, shift) for text in layer.texts]
        else:
            commands += _strokes(layer.paths._replace(arcs=layer.paths.arcs.moved(scale, shift)))
    yield from encoded_lines([*commands, "PU;SP0;"])


@cache
def _table() -> dict[str, Any]:
    return toml.loads(resources.files("molviz.write").joinpath("plotters.toml").read_text(encoding="utf-8"))


def _entry(table: dict[str, Any], key: str, kind: str) -> Any:
    if key not in table:
        raise InputError(f"no {kind} is called {key!r}, expected one of {', '.join(table)}")
    return table[key]


def _on_paper(picture: Picture, device: Plotter) -> tuple[float, Floats]:
    """Plotter units are ``scale × points + shift``, the page centred in the range."""
    scale = (1.0 - 2.0 * MARGIN) * min(device.width / picture.width, device.height / picture.height)
    return scale, np.array([device.width - scale * picture.width, device.height - scale * picture.height]) / 2.0


def _lettered(text: Text, scale: float, shift: Floats) -> str:
    """The commands that letter a line of text, as wide as it is in other formats.

    All letters of a plotter have one width w, and step by 1.5 w; sizes are told in centimetres.
    """
    line = plotter_text(text.text)
    width = max(text_width(text.text, text.size) * scale / UNITS_PER_CM / (PITCH * max(len(line), 1)), SMALLEST)
    height = max(CAPITAL * text.size * scale / UNITS_PER_CM, SMALLEST)
    start = scale * np.array([left(text), text.y]) + shift
    return f"PU{_point(start)};SI{_number(width)},{_number(height)};LB{line}{END_OF_LABEL}"


def _strokes(paths: Paths) -> list[str]:
    """One line of commands for every loop, drawn from whichever end is nearer."""
    arcs, (first, last) = paths.arcs, (paths.loop_start[:-1], paths.loop_start[1:] - 1)
    begin, end = np.round(arcs.starts(), DECIMALS), np.round(arcs.ends(), DECIMALS)
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
    sweep = np.round(np.degrees(arcs.sweep), DECIMALS) * turn * direction
    center = np.rint(np.round(arcs.c, DECIMALS)).astype(int).tolist()
    step = _step(arcs.major())
    chord = np.clip(np.round(np.degrees(step), DECIMALS), 1.0, 5.0).astype(int)
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
    count = max(1, math.ceil(round(abs(float(arcs.sweep[row])) / step, DECIMALS)))
    share = np.arange(1, count + 1) / count if direction > 0 else np.arange(count - 1, -1, -1) / count
    points = np.round(arcs.take(np.full(count, row)).at(arcs.start[row] + arcs.sweep[row] * share), DECIMALS)
    return f"PA{','.join(_point(point) for point in points)};"


def _point(point: Floats) -> str:
    return f"{round(float(point[0]))},{round(float(point[1]))}"


def _number(value: float) -> str:
    return f"{value:.3f}".rstrip("0").rstrip(".")
