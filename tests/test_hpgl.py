"""HPGL as it is sent, and read back by a plotter of a few lines."""

import math
import re

import numpy as np
import pytest

from molviz.curves import Paths, PlaneArcs
from molviz.errors import InputError
from molviz.picture.picture import Picture, StrokeLayer
from molviz.write.hpgl import Plotter, plotter, write_hpgl

PLAIN = Plotter("plain", 2, 1020, 1020)  # one point is ten units on a page of 100 × 100: 2 % are margin


def whole(page: Picture, device: Plotter) -> bytes:
    return b"".join(write_hpgl(page, device))


def picture(*rows: tuple[tuple[float, float], tuple[float, float], tuple[float, float], float, float]) -> Picture:
    c, u, v = (np.array([row[k] for row in rows], dtype=float).reshape(-1, 2) for k in range(3))
    start, sweep = (np.array([row[k] for row in rows], dtype=float) for k in (3, 4))
    each = np.arange(len(rows) + 1)
    layer = StrokeLayer("lines", Paths(PlaneArcs(c, u, v, start, sweep), each, each), 0.5)
    return Picture(100, 100, (0, 0, 100, 100), [layer])


def drawn(hpgl: bytes) -> list[list[tuple[float, float]]]:
    """Points along every stroke, as a plotter would draw them."""
    strokes: list[list[tuple[float, float]]] = []
    for name, text in re.findall(r"([A-Z]{2})([-\d.,]*);", hpgl.decode("ascii")):
        values = [float(value) for value in text.split(",")] if text else []
        if name == "PU" and values:
            strokes.append([(values[0], values[1])])
        elif name == "PA":
            strokes[-1] += zip(values[::2], values[1::2], strict=True)
        elif name == "AA":
            x, y, sweep = values[:3]
            px, py = strokes[-1][-1]
            start, radius = math.atan2(py - y, px - x), math.hypot(px - x, py - y)
            turn = [start + math.radians(sweep) * k / 50 for k in range(51)]
            strokes[-1] += [(x + radius * math.cos(t), y + radius * math.sin(t)) for t in turn]
    return strokes


def test_a_circle_is_one_command() -> None:
    page = picture(((50, 50), (10, 0), (0, 10), 0.0, 2 * math.pi))
    radius = 10 * 10.2 * 0.98
    assert whole(page, PLAIN) == f"IN;\nSP1;\nPU{510 + radius:.0f},510;PD;AA510,510,360,5;\nPU;SP0;\n".encode()


@pytest.mark.parametrize(
    "row",
    [
        ((50, 50), (10, 0), (0, 10), 0.3, 1.7),
        ((50, 50), (10, 0), (0, 10), 0.3, -1.7),
        ((40, 60), (0, 30), (30, 0), 5.0, 4.0),  # a mirrored circle
        ((50, 50), (30, 5), (-2, 10), 1.0, 4.0),  # an ellipse
        ((50, 50), (30, 10), (0, 0), 0.0, math.pi),  # a straight line
    ],
)
def test_what_is_drawn_follows_the_arc(row: tuple) -> None:
    page = picture(row)
    (stroke,) = drawn(whole(page, PLAIN))
    arcs = page.layers[0].paths.arcs.moved(10.2 * 0.98, np.full(2, 10.2))
    exact = arcs.take(np.zeros(500, dtype=int)).at(row[3] + row[4] * np.linspace(0, 1, 500))
    gap = np.hypot(*(np.array(stroke)[:, None] - exact).transpose(2, 0, 1))
    assert gap.min(axis=1).max() < 2.0  # units: ends and centres are whole numbers
    assert {tuple(np.rint(exact[0]) + 0.0), tuple(np.rint(exact[-1]) + 0.0)} >= {stroke[0]}


def test_layers_take_pens_in_turn() -> None:
    layer = picture(((50, 50), (10, 0), (0, 10), 0.0, 1.0)).layers[0]
    page = Picture(100, 100, (0, 0, 100, 100), [layer, layer, layer])
    assert re.findall(rb"SP\d", whole(page, PLAIN)) == [b"SP1", b"SP2", b"SP1", b"SP0"]


def test_a_page_fits_the_range_of_every_plotter() -> None:
    page = picture(((50, 50), (50, 0), (0, 50), 0.0, 2 * math.pi))
    for model, paper in [("hp7440a", "a4"), ("hp7475a", "a3"), ("hp7550a", "tabloid")]:
        device = plotter(model, paper)
        (stroke,) = drawn(whole(page, device))
        assert np.min(stroke) >= 0 and np.all(np.max(stroke, axis=0) <= (device.width, device.height))


@pytest.mark.parametrize(("model", "paper"), [("hp9999", ""), ("hp7440a", "a3")])
def test_unknown_plotters_and_papers(model: str, paper: str) -> None:
    with pytest.raises(InputError, match="expected one of"):
        plotter(model, paper)
