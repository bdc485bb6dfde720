"""Path data of SVG: elliptical arc commands in few bytes that still hit the curve."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Texts
from molviz.curves import Paths, PlaneArcs
from molviz.vectors import cross, dot
from molviz.write.ellipse import (
    AxisArcs,
    closed_loops,
    in_equal_pieces,
    major_vertex,
    on_axes,
    starts_and_ends,
    with_straight_pieces,
)
from molviz.write.text import dictionary

STRAY = 0.01  # points: how far rounding may move the middle of an arc before the arc is cut in two
FLAT = 0.01  # points: an arc that leaves its chord by less is the chord, as rounding moves its ends as far
CUTS = 10  # halvings: by then every arc that fits on a page lies on its chord
HALF_TURN = 1e-9  # radians


class Commands(NamedTuple):
    """k elliptical arc commands, rounded as they will be written (points; y down; degrees)."""

    start: Floats  # (k, 2)
    end: Floats  # (k, 2)
    radius: Floats  # (k, 2) both zero where straight
    rotation: Floats  # (k,)
    large: Bools  # (k,)
    positive: Bools  # (k,) the sweep flag


def y_down(arcs: PlaneArcs, height: float) -> PlaneArcs:
    """Return the arcs in SVG's coordinates, whose y runs down from the top of the page."""
    flip = np.array([1.0, -1.0])
    return arcs._replace(c=arcs.c * flip + [0.0, height], u=arcs.u * flip, v=arcs.v * flip)


def is_half(sweep: Floats) -> Bools:
    """Return which arcs (k,) are half their ellipse."""
    return np.asarray(np.abs(np.abs(sweep) - np.pi) < HALF_TURN)


def rounded_radii(axes: AxisArcs, straight: Bools) -> Floats:
    """Return the half-axes (k, 2) to hundredths, zero where straight.

    A half ellipse rounds down: a viewer enlarges radii that do not reach, but too large ones would flatten the arc.
    """
    exact = 100 * np.column_stack([axes.major, axes.minor])
    steps = np.where(is_half(axes.sweep)[:, None], np.maximum(np.floor(exact + 1e-6), 1.0), np.rint(exact))
    return np.asarray(np.where(straight[:, None], 0.0, steps / 100))


def commands(paths: Paths, straight: Bools) -> Commands:
    """Return the commands for arcs as they are, rounded."""
    axes, (start, end) = on_axes(paths.arcs), starts_and_ends(paths)
    radius = rounded_radii(axes, straight)
    eccentric = radius[:, 0] - radius[:, 1]
    places = np.where(eccentric < 5, 10.0, 100.0)  # 0.05° on 5 points moves nothing by a hundredth
    rotation = np.where(eccentric == 0, 0.0, np.rint(np.degrees(axes.rotation) * places) / places)
    large = np.abs(axes.sweep) > np.pi + HALF_TURN
    return Commands(np.round(start, 2), np.round(end, 2), radius, rotation, large, axes.sweep > 0)


def drawn_middle(command: Commands) -> Floats:
    """Return the middle (k, 2) of the arc that a viewer draws for each command.

    In the frame where the ellipse is the unit circle the half-chord h has |h|² = Λ, and the middle lies beside the
    chord's midpoint at distance ``1 ∓ √(1 − Λ)`` (SVG 1.1, appendix F.6.5); radii that do not reach are enlarged
    by √Λ (F.6.6).
    """
    angle = np.radians(command.rotation)
    cos, sin, radius = np.cos(angle), np.sin(angle), np.where(command.radius > 0, command.radius, 1.0)
    dx, dy = ((command.end - command.start) / 2).T
    hx, hy = (cos * dx + sin * dy) / radius[:, 0], (cos * dy - sin * dx) / radius[:, 1]
    square = hx * hx + hy * hy
    side = np.where(command.large, 1.0, -1.0) * np.sqrt(np.maximum(1.0 - square, 0.0))
    bulge = np.where(command.positive, 1.0, -1.0) * (1.0 + side) * np.maximum(1.0, np.sqrt(square))
    bulge = bulge / np.sqrt(np.where(square > 0, square, np.inf))  # nothing is drawn between equal ends
    x, y = bulge * hy * command.radius[:, 0], -bulge * hx * command.radius[:, 1]
    beside = np.column_stack([cos * x - sin * y, sin * x + cos * y])
    return np.asarray((command.start + command.end) / 2 + beside)


def flat(arcs: PlaneArcs) -> Bools:
    """Return which arcs (k,) run along their chords, never backwards, and hardly leave them."""
    start, middle, end = arcs.starts(), arcs.at(arcs.middle()), arcs.ends()
    chord = end - start
    length = np.hypot(*chord.T)
    with np.errstate(divide="ignore", invalid="ignore"):
        beside = np.abs(cross(chord, middle - start)) / length
    onward = np.ones(len(length), dtype=bool)
    for t in (arcs.start, arcs.stop()):
        onward &= dot(arcs.tangent(t) * np.sign(arcs.sweep)[:, None], chord) > 0
    return np.asarray((beside < FLAT) & onward & (np.abs(arcs.sweep) < np.pi))


def from_vertices(paths: Paths) -> Paths:
    """Return the paths with every loop that is one whole ellipse starting at a major vertex.

    There the chord of each half is the major axis, which leaves the minor one as it was rounded.
    """
    alone = np.diff(paths.loop_start) == 1
    rows = paths.loop_start[:-1][alone]
    rows = rows[np.abs(np.abs(paths.arcs.sweep[rows]) - 2 * np.pi) < HALF_TURN]
    start = paths.arcs.start.copy()
    start[rows] = major_vertex(paths.arcs.take(rows))
    return paths._replace(arcs=paths.arcs._replace(start=start))


def settled(paths: Paths) -> tuple[Paths, Bools, Commands]:
    """Return paths (y down) cut so that their rounded commands draw the arcs, which are straight, and the commands.

    The centre follows from ends and radii, badly so when the ends are opposite, coincide, or the ellipse is thin:
    there a hundredth of a point can move the arc by tenths. Such arcs are cut in two, whose ends then pin them; what is
    as good as straight is written so.
    """
    paths, straight = with_straight_pieces(from_vertices(paths))
    straight |= flat(paths.arcs)
    for _ in range(CUTS):
        command, arcs = commands(paths, straight), paths.arcs
        middle = arcs.at(arcs.middle())
        allowed = np.where(is_half(arcs.sweep), 2 * STRAY, STRAY)  # all that is wrong with a half is its radii
        stray = (np.hypot(*(drawn_middle(command) - middle).T) > allowed) & ~straight
        if not stray.any():
            break
        count = np.where(stray, 2, 1)
        paths, straight = in_equal_pieces(paths, count), np.repeat(straight, count)
        straight |= flat(paths.arcs)
    return paths, straight, commands(paths, straight)


def joined(values: Floats) -> Texts:
    """Return the texts (k,) of rows of numbers (k, m), separated only where the grammar needs it.

    A minus starts a number by itself, and so does a point after a number that had one.
    """
    words, index = dictionary(values, 2)
    pointed = np.array(["." in word for word in words], dtype=bool)[index]
    apart = np.array([not word.startswith(("-", ".")) for word in words], dtype=bool)[index]
    leading = np.array([word.startswith(".") for word in words], dtype=bool)[index]
    apart[:, 1:] |= leading[:, 1:] & ~pointed[:, :-1]
    apart[:, 0] = False
    spaced = np.where(apart, " " + words[index], words[index])
    return np.asarray(spaced.sum(axis=1))


def command_texts(command: Commands) -> Texts:
    """Return one text (k,) per command, empty where start and end are the same."""
    step = np.round(command.end - command.start, 2)
    shape = joined(np.column_stack([command.radius, command.rotation]))
    flags = np.array([" 0 0", " 0 1", " 1 0", " 1 1"], dtype=object)[2 * command.large + command.positive]
    gap = np.where(step[:, 0] < 0, "", " ").astype(object)  # legal without, but not every program reads it
    line = "l" + joined(step)
    arc = "a" + shape + flags + gap + joined(step)
    text = np.where(command.radius[:, 0] > 0, arc, line)
    return np.where((step == 0).all(axis=1), "", text)


def loop_texts(paths: Paths, command: Commands) -> list[str]:
    """Return the path data of each loop, empty where no command is left."""
    words, first, stop = command_texts(command).tolist(), paths.loop_start[:-1], paths.loop_start[1:]
    held, closed = stop > first, closed_loops(paths)
    move = np.full(len(first), "", dtype=object)
    move[held] = "M" + joined(command.start[first[held]])
    bodies = ["".join(words[a:b]) for a, b in zip(first.tolist(), stop.tolist(), strict=True)]
    rows = zip(move.tolist(), bodies, closed.tolist(), strict=True)
    return [f"{start}{body}{'z' if is_closed else ''}" if body else "" for start, body, is_closed in rows]


def path_data(paths: Paths, height: float) -> list[str]:
    """Return the ``d`` attribute of each shape for a page of that height (points), empty where nothing is left."""
    paths, _, command = settled(paths._replace(arcs=y_down(paths.arcs, height)))
    loops, bounds = loop_texts(paths, command), paths.shape_start.tolist()
    return ["".join(loops[first:stop]) for first, stop in zip(bounds, bounds[1:], strict=False)]
