"""Ellipse numerics against sampling and an independent reading of the SVG arc rules."""

import re

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from molviz.curves import Paths, PlaneArcs
from molviz.write.ellipse import (
    BEZIER_ERROR,
    bezier_handles,
    bezier_pieces,
    in_equal_pieces,
    on_axes,
    with_straight_pieces,
)
from molviz.write.postscript_path import loop_texts
from molviz.write.svg_path import path_data
from tests.write_pictures import TURN

vector = st.tuples(st.floats(-40, 40), st.floats(-40, 40))
sweep = st.one_of(st.floats(-TURN, TURN).filter(lambda s: abs(s) > 1e-3), st.sampled_from([np.pi, -np.pi, TURN, -TURN]))
arc = st.tuples(vector, vector, vector, st.floats(-7, 7), sweep)
FRACTION = np.linspace(0, 1, 201)


def one(row: tuple) -> Paths:
    columns = [np.array([column], dtype=float) for column in row]
    return Paths(PlaneArcs(*columns), np.array([0, 1]), np.array([0, 1]))


def sampled(arcs: PlaneArcs, fraction: np.ndarray = FRACTION) -> np.ndarray:
    """Return points (k, m, 2) along each arc."""
    t = arcs.start[:, None] + arcs.sweep[:, None] * fraction
    u, v = arcs.u[:, None], arcs.v[:, None]
    return arcs.c[:, None] + u * np.cos(t)[..., None] + v * np.sin(t)[..., None]


def apart(points: np.ndarray, line: np.ndarray) -> float:
    """Return the largest distance from points (m, 2) to a polyline (n, 2)."""
    p, q = (np.ascontiguousarray(rows, dtype=float).view(complex).ravel() for rows in (points, line))
    d = np.diff(q)
    unit = np.conj(d) / np.maximum(np.abs(d) ** 2, 1e-30)
    along = (p[:, None] - q[:-1]) * unit  # from 0 to 1 on the segment, beside it in units of its length
    along.real -= np.clip(along.real, 0, 1)
    gap = np.abs(along) * np.abs(d)
    alone = np.abs(d) < 1e-12
    gap[:, alone] = np.abs(p[:, None] - q[:-1][alone])
    return float(gap.min(axis=1).max())


@given(arc)
def test_axes_describe_the_same_points(row: tuple) -> None:
    arcs = one(row).arcs
    axes = on_axes(arcs)
    t = axes.start[0] + axes.sweep[0] * FRACTION
    x, y = axes.major[0] * np.cos(t), axes.minor[0] * np.sin(t)
    cos, sin = np.cos(axes.rotation[0]), np.sin(axes.rotation[0])
    assert np.allclose(arcs.c[0] + np.column_stack([cos * x - sin * y, sin * x + cos * y]), sampled(arcs)[0], atol=1e-6)
    assert axes.major[0] >= axes.minor[0] - 1e-9


def cubic(pieces: PlaneArcs, s: np.ndarray) -> np.ndarray:
    """Return the points (k, m, 2) of the cubics at the parameters s (m,)."""
    begin, end = pieces.at(pieces.start), pieces.at(pieces.start + pieces.sweep)
    weights = np.stack([(1 - s) ** 3, 3 * s * (1 - s) ** 2, 3 * s**2 * (1 - s), s**3])
    return np.einsum("qm,qkd->kmd", weights, np.stack([begin, *bezier_handles(pieces), end]))


def off_circle(point: np.ndarray) -> np.ndarray:
    """Return the vectors from the unit circle to points (…, 2), towards its centre."""
    return np.asarray(point * (1 - 1 / np.linalg.norm(point, axis=-1))[..., None])


def test_no_more_cubics_than_the_bound_asks_for() -> None:
    """Of 600 sweeps some are hardly shorter than their cubics may be: these stray a good part of what they may."""
    radius, sweep = 1000.0, np.linspace(0.01, TURN, 600)
    count = bezier_pieces(np.full(600, radius), sweep)
    zero = np.zeros((600, 2))
    point = cubic(PlaneArcs(zero, zero + [1.0, 0.0], zero + [0.0, 1.0], np.zeros(600), sweep / count), FRACTION)
    most = radius * np.linalg.norm(off_circle(point), axis=2).max()
    assert 0.4 * BEZIER_ERROR < most < BEZIER_ERROR


@given(arc)
def test_cubics_stay_within_the_bound(row: tuple) -> None:
    """Where the ellipse is the unit circle, its point at the cubic's angle bounds the cubic's distance from above."""
    paths = one(row)
    pieces = in_equal_pieces(paths, bezier_pieces(on_axes(paths.arcs).major, paths.arcs.sweep)).arcs
    count, s = len(pieces.start), np.linspace(0, 1, 101)
    unit = pieces._replace(c=np.zeros((count, 2)), u=np.tile([1.0, 0.0], (count, 1)), v=np.tile([0.0, 1.0], (count, 1)))
    point, frame = cubic(unit, s), np.stack([pieces.u[0], pieces.v[0]])
    assert np.allclose(cubic(pieces, s), pieces.c[0] + point @ frame, atol=1e-9)  # the cubic of an image is the image
    assert np.linalg.norm(off_circle(point) @ frame, axis=2).max() < (1 + 1e-6) * BEZIER_ERROR
    middle = (pieces.start + pieces.sweep / 2)[:, None]
    turned = np.angle((point[..., 0] + 1j * point[..., 1]) * np.exp(-1j * middle))
    assert (np.abs(turned) < np.abs(pieces.sweep)[:, None] / 2 + 1e-9).all()
    assert (np.diff(turned * np.sign(pieces.sweep)[:, None], axis=1) > 0).all()  # and it runs along the arc once
    ends = pieces.at(pieces.start), pieces.at(pieces.start + pieces.sweep)
    assert np.allclose(ends[0][1:], ends[1][:-1]) and np.isclose(pieces.sweep.sum(), paths.arcs.sweep[0])


@given(vector, st.floats(-3, 3), st.floats(-7, 7), sweep)
def test_a_flat_arc_becomes_the_pieces_between_its_turns(u: tuple, slope: float, start: float, swept: float) -> None:
    paths = one(((1, 2), u, (slope * u[0], slope * u[1]), start, swept))
    cut, straight = with_straight_pieces(paths)
    assert straight.all()
    ends = np.vstack([cut.arcs.at(cut.arcs.start), cut.arcs.at(cut.arcs.start + cut.arcs.sweep)[-1:]])
    assert apart(sampled(paths.arcs)[0], ends) < 1e-6
    middles = sampled(cut.arcs)
    along = np.diff(middles @ np.array(u), axis=1)
    assert ((along >= -1e-6).all(axis=1) | (along <= 1e-6).all(axis=1)).all()  # each piece runs one way


def arc_centre(p: complex, q: complex, rx: float, ry: float, turn: complex, large: bool, positive: bool) -> tuple:
    """Return centre and radii of an SVG arc, by trying both circles through the ends in the unit-circle frame."""
    a, b = ((z / turn).real / rx + 1j * (z / turn).imag / ry for z in (p, q))
    grow = max(1.0, abs(b - a) / 2)
    a, b = a / grow, b / grow
    foot, half = (a + b) / 2, abs(b - a) / 2
    reach = 1j * (b - a) / abs(b - a) * np.sqrt(max(0.0, 1 - half * half))
    for centre in (foot + reach, foot - reach):
        swept = np.angle((b - centre) / (a - centre)) % TURN
        swept = swept if positive else swept - TURN
        if (abs(swept) > np.pi) == large or half > 1 - 1e-9:
            break
    return centre, a, swept, grow


def drawn(d: str) -> np.ndarray:
    """Return points (m, 2) of path data, y down."""
    number = r"(-?(?:\d+\.?\d*|\.\d+))"
    here, there, begun, points = 0j, 0j, 0j, []
    for command in re.findall("[Malz][^Malz]*", d):
        if command[0] == "a":
            head, tail = re.fullmatch(rf"a((?:[ ]?{number}){{3}}) (.*)", command).group(1, 3)
            rx, ry, degrees = map(float, re.findall(number, head))
            large, positive = tail[0] == "1", tail[2] == "1"
            there = here + complex(*map(float, re.findall(number, tail[3:])))
            turn = np.exp(1j * np.radians(degrees))
            centre, a, swept, grow = arc_centre(here, there, rx, ry, turn, large, positive)
            unit = grow * (centre + (a - centre) * np.exp(1j * swept * np.linspace(0, 1, 301)))
            points += ((unit.real * rx + 1j * unit.imag * ry) * turn).tolist()
        elif command[0] == "z":
            points += [here, begun]
        else:
            values = [float(text) for text in re.findall(number, command)]
            for step in map(complex, values[::2], values[1::2]):
                there = step if command[0] == "M" else here + step
                points += [here, there] if command[0] == "l" else [there]
                here = there
        here, begun = there, there if command[0] == "M" else begun
    return np.array([[point.real, point.imag] for point in points])


@given(arc)
@example(((0.0, 0.0), (2.3828125, 4.0), (0.0, -40.0), 5.125, 4.0))  # thin: rounding turns its long axis
def test_svg_commands_draw_the_arc(row: tuple) -> None:
    paths = one(row)
    (data,) = path_data(paths, 100.0)
    want = sampled(paths.arcs, np.linspace(0, 1, 301))[0] * [1, -1] + [0, 100]
    if not data:  # nothing left but a point
        assert np.ptp(want, axis=0).max() < 0.03
        return
    have = drawn(data)
    assert apart(have, want) < 0.06 and apart(want, have) < 0.06


def test_whole_ellipses_are_two_arcs_and_circles_have_no_rotation() -> None:
    (data,) = path_data(one(((50, 50), (30, 0), (0, 30), 0.7, TURN)), 100.0)
    assert data.count("a") == 2 and re.findall("a30 30 0 ", data) == ["a30 30 0 "] * 2 and data.endswith("z")
    (data,) = path_data(one(((50, 50), (30, 10), (-5, 4), 0.7, -TURN)), 100.0)
    assert data.count("a") == 2


def test_relative_steps_do_not_drift() -> None:
    t = np.linspace(0, TURN, 1001)[:-1]
    k, zero = len(t), np.zeros((len(t), 2))
    arcs = PlaneArcs(zero + 50, zero + [33.333, 0], zero + [0, 33.333], t, np.full(k, TURN / k))
    (data,) = path_data(Paths(arcs, np.array([0, k]), np.array([0, 1])), 100.0)
    assert np.abs(np.hypot(*(drawn(data) - 50).T) - 33.333).max() < 0.02


def test_lines_after_lines_need_no_letter_and_the_last_of_a_loop_is_its_end() -> None:
    corners = np.array([[10.0, 10], [30, 12], [28, 40], [9, 38]])
    step, zero = np.roll(corners, -1, axis=0) - corners, np.zeros(4)
    middle = corners + step / 2
    arcs = PlaneArcs(middle, step / 2, np.zeros((4, 2)), zero - np.pi, zero + np.pi)
    (data,) = path_data(Paths(arcs, np.array([0, 4]), np.array([0, 1])), 100.0)
    assert data == "M10 90l20-2-2-28-19 2z"
    assert drawn(data)[-1].tolist() == [10, 90]


def by_postscript(text: str) -> np.ndarray:
    """Points along the commands of one loop, by what PostScript's operators mean."""
    points: list[np.ndarray] = []
    for line in text.splitlines():
        *numbers, letter = line.removesuffix(" h").split()
        x = np.array(numbers, dtype=float)
        if letter in "ml":
            points.append(x[None])
        elif letter == "q":
            s, (p, q, r, last) = FRACTION[:, None], np.vstack([points[-1][-1], x.reshape(3, 2)])
            points.append((1 - s) ** 3 * p + 3 * (1 - s) ** 2 * s * q + 3 * (1 - s) * s**2 * r + s**3 * last)
        else:
            (first, stop), (major, minor, turn, *center) = (
                (x[3:], (x[2], x[2], 0.0, x[0], x[1])) if letter in "AN" else (x[:2], x[2:])
            )
            t = np.radians(first + FRACTION * (stop - first))
            on = np.exp(1j * np.radians(turn)) * (major * np.cos(t) + 1j * minor * np.sin(t))
            points.append(np.column_stack([on.real + center[0], on.imag + center[1]]))
    return np.vstack(points)


@given(st.floats(1.0, 7.0), st.floats(0.0, TURN), st.floats(1.0, 300.0), st.sampled_from([-1, 1]))
@example(4.77, 1.0, 2.0, 1)  # nearly a straight line, of a stick's ink
def test_postscript_commands_draw_arcs_however_large(size: float, angle: float, chord: float, way: int) -> None:
    """A hundredth of a degree of a large circle is many points: its ends would lie far beyond those of the arc."""
    radius = 10.0**size
    sweep = way * min(chord / radius, 3.0)
    u = radius * np.array([np.cos(angle), np.sin(angle)])
    v = radius * np.array([-np.sin(angle), np.cos(angle)])
    paths = one((tuple(-u), tuple(u), tuple(v), 0.0, sweep))
    true, drawn_points = sampled(paths.arcs)[0], by_postscript(loop_texts(paths, True).pieces(np.array([0, 1]))[0])
    assert apart(drawn_points, true) < 0.06 and apart(true, drawn_points) < 0.06
