"""Pictures with gradients, translucent layers and steps of shade, for the tests of the writers."""

import numpy as np

from molviz.curves import Paths, PlaneArcs
from molviz.picture.picture import (
    SPREAD,
    Color,
    FillLayer,
    Layer,
    LinearGradient,
    Mark,
    Picture,
    RadialGradient,
    ShadeLayer,
    StrokeLayer,
)

TURN = 2 * np.pi
WIDTH, HEIGHT = 300.0, 200.0
DARK, WHITE = (16, 20, 28), (255, 255, 255)
STEPS = (0.14, 0.15, 0.15, 0.16, 0.18)
BALL = RadialGradient(40.0, (-14.0, 16.0), ((0.0, (255, 250, 240)), (0.35, (240, 150, 90)), (1.0, (90, 30, 20))))
SMALL = RadialGradient(22.0, (-8.0, 9.0), ((0.0, (240, 250, 255)), (1.0, (20, 50, 120))))
STICK = LinearGradient((0.0, -12.0), (0.0, 12.0), ((0.0, (40, 60, 30)), (0.6, (200, 230, 180)), (1.0, (60, 90, 40))))


def paths(shapes: list[list[list[tuple]]]) -> Paths:
    """Return shapes of loops of arcs, each arc (c, u, v, start, sweep)."""
    loops = [loop for shape in shapes for loop in shape]
    rows = [arc for loop in loops for arc in loop]
    columns = [np.array([row[k] for row in rows], dtype=float) for k in range(5)]
    loop_start = np.concatenate([[0], np.cumsum([len(loop) for loop in loops])]).astype(int)
    shape_start = np.concatenate([[0], np.cumsum([len(shape) for shape in shapes])]).astype(int)
    return Paths(PlaneArcs(*columns), loop_start, shape_start)


def circle(x: float, y: float, radius: float, turn: float = TURN) -> list[tuple]:
    return [((x, y), (radius, 0), (0, radius), 0.0, turn)]


def side(p: tuple[float, float], q: tuple[float, float]) -> tuple:
    """A straight piece: half of an ellipse without width."""
    (px, py), (qx, qy) = p, q
    return (((px + qx) / 2, (py + qy) / 2), ((qx - px) / 2, (qy - py) / 2), (0, 0), np.pi, np.pi)


def rectangle(x0: float, y0: float, x1: float, y1: float) -> list[tuple]:
    corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    return [side(p, q) for p, q in zip(corners, corners[1:] + corners[:1], strict=True)]


def half_disc(x: float, y: float, radius: float, start: float) -> list[tuple]:
    """Left of the diameter from one end of the arc to the other."""
    p = (x + radius * np.cos(start), y + radius * np.sin(start))
    return [((x, y), (radius, 0), (0, radius), start, np.pi), side((2 * x - p[0], 2 * y - p[1]), p)]


def marks(count: int) -> list[Mark]:
    return [Mark(f"m{k}", f"shape {k}") for k in range(count)]


def balls(spread: float = SPREAD, opacity: float = 1.0) -> FillLayer:
    """Balls and sticks with gradients, a flat shape among them; two half balls side by side."""
    shapes = [
        [circle(70, 120, 40)], [circle(160, 140, 40)], [rectangle(20, 20, 120, 44)], [circle(250, 150, 30)],
        [half_disc(230, 60, 22, 0.4)], [half_disc(230, 60, 22, 0.4 + np.pi)], [circle(160, 60, 30)],
    ]  # fmt: skip
    origin = np.array([(70, 120), (160, 140), (70, 32), (0, 0), (230, 60), (230, 60), (150, 70)], dtype=float)
    paint = [BALL, BALL, STICK, (20, 120, 90), SMALL, SMALL, BALL]
    return FillLayer("balls", paths(shapes), paint, marks(len(shapes)), spread, origin, opacity)


TONES = [
    [half_disc(150, 100, 90, 0.3), circle(100, 120, 30, -TURN)], [circle(100, 120, 30)],
    [half_disc(150, 100, 90, 0.3 + np.pi)], [circle(270, 40, 25)],
]  # fmt: skip
TONE_COLORS: list[Color] = [(127, 173, 192), (226, 69, 47), (243, 220, 174), (156, 195, 209)]
SHADES: list[Color] = [(20, 42, 94), (106, 52, 20)]


def scattered(seed: int, radius: float, count: int = 7) -> list[list[tuple]]:
    """Rings on a grid, apart from each other and from one step to the next in no order."""
    random = np.random.default_rng(seed)
    place = random.permutation(np.array([(x, y) for x in range(40, 300, 70) for y in range(35, 180, 65)]))[:count]
    return [circle(x, y, radius) for x, y in place.tolist()]


def shade(opacity: tuple[float, ...] = STEPS) -> ShadeLayer:
    """Steps that overlap in every way over four tones of two clips."""
    steps = [scattered(seed, 32.0 - 3.0 * seed) for seed in range(len(opacity))]
    clip = [[TONES[0][0]], [*TONES[2], *TONES[3]]]
    return ShadeLayer("shade", paths(steps), opacity, paths(clip), SHADES, paths(TONES), TONE_COLORS, [0, 0, 1, 1])


def regions() -> FillLayer:
    return FillLayer("regions", paths(TONES), TONE_COLORS, marks(len(TONES)), SPREAD)


def ink(opacity: float = 1.0) -> StrokeLayer:
    return StrokeLayer("ink", paths([[circle(110, 100, 80)], [circle(180, 100, 60)]]), 8.0, (10, 10, 90), (), opacity)


def page(*layers: Layer, background: Color = WHITE) -> Picture:
    return Picture(WIDTH, HEIGHT, (0, 0, WIDTH, HEIGHT), layers, "shaded", background)


PICTURES: dict[str, list[Layer]] = {
    "gradients": [balls()],
    "gradients without spread": [balls(spread=0.0)],
    "shade": [regions(), shade()],
    "translucent lines": [ink(0.4)],
    "translucent fills": [balls(opacity=0.5)],
}
