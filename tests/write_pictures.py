"""Small pictures for the tests of the writers, and which points are inside their shapes."""

import numpy as np

from molviz.curves import Paths, PlaneArcs
from molviz.picture.picture import FillLayer, Mark, Picture, StrokeLayer

TURN = 2 * np.pi
HOSTILE = "<&>\"' ]]>\x00 é"
COLORS = [(200, 30, 40), (20, 100, 60), (2, 3, 254), (255, 238, 0)]
ARCS = [  # c, u, v, start, sweep
    ((50, 50), (30, 0), (0, 30), 0, TURN),
    ((50, 50), (10, 3), (-2, 12), 1, -TURN),  # a hole
    ((120, 60), (30, 10), (-5, 4), 2, TURN),
    ((120, 30), (20, 0), (0, 20), 0, np.pi),
    ((120, 30), (20, 0), (0, 0), np.pi, np.pi),  # an ellipse seen edge-on
    ((50, 50), (10, 3), (-2, 12), 1, TURN),
]


def paths() -> Paths:
    columns = [np.array(column, dtype=float) for column in zip(*ARCS, strict=True)]
    return Paths(PlaneArcs(*columns), np.array([0, 1, 2, 3, 5, 6]), np.array([0, 2, 3, 4, 5]))


def fills(spread: float = 0.0) -> FillLayer:
    groups = (("A", "chain"), ("CYS 32", "residue"))
    marks = [Mark(f"CYS 32{HOSTILE}", f"CYS 32 {k}{HOSTILE}", ("atom", "C"), groups) for k in range(4)]
    return FillLayer("faces", paths(), COLORS, marks, spread)


def picture(*layers: FillLayer | StrokeLayer) -> Picture:
    return Picture(170, 100, (19.5, 9.5, 152, 80.5), layers, f"tiny{HOSTILE}")


def whole_picture() -> Picture:
    return picture(fills(), StrokeLayer("lines", paths(), 1.0))


def inside_ellipse(
    point: np.ndarray, c: tuple[float, float], u: tuple[float, float], v: tuple[float, float]
) -> np.ndarray:
    """Return which points (..., 2) lie inside the ellipse: |(u v)⁻¹ (p − c)| < 1."""
    return (
        np.asarray((np.linalg.inv(np.array([u, v], dtype=float).T) @ (point - c)[..., None])[..., 0] ** 2).sum(-1) < 1
    )


def expected_colors(point: np.ndarray) -> np.ndarray:
    """Return the colours (..., 3) of the fills at points (..., 2) on white."""
    color = np.full(point.shape[:-1] + (3,), 255, dtype=np.uint8)
    inner = inside_ellipse(point, *ARCS[1][:3])
    lens = inside_ellipse(point, *ARCS[3][:3]) & (point[..., 1] > 30)
    masks = [inside_ellipse(point, *ARCS[0][:3]) & ~inner, inside_ellipse(point, *ARCS[2][:3]), lens, inner]
    for mask, value in zip(masks, COLORS, strict=True):
        color[mask] = value
    return color
