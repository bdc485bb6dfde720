"""Path data of SVG: elliptical arc commands in few bytes that still hit the curve."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Words
from molviz.curves import Paths, PlaneArcs
from molviz.write.columns import (
    Formatted,
    beside_each_other,
    in_loops,
    number_words,
    steps_of,
    texts_of_shapes,
    word,
    words,
)
from molviz.write.ellipse import (
    AxisArcs,
    closed_loops,
    flat,
    in_equal_pieces,
    major_vertex,
    on_axes,
    starts_and_ends,
    with_straight_pieces,
)

STRAY = 0.01  # points: how far rounding may move the middle of an arc before the arc is cut in two
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

    def take(self, rows: Ints) -> "Commands":
        """Return the given rows, in that order."""
        return Commands(*(column[rows] for column in self))  # type: ignore[arg-type]


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


def commands(paths: Paths, straight: Bools, known: Commands | None = None, fresh: Ints | None = None) -> Commands:
    """Return the commands for arcs as they are, rounded; of all but the ``fresh`` arcs they are ``known`` already."""
    start, end = (np.round(points, 2) for points in starts_and_ends(paths))
    if known is None or fresh is None:
        return Commands(start, end, *_ellipses(paths.arcs, straight))
    for column, values in zip(known[2:], _ellipses(paths.arcs.take(fresh), straight[fresh]), strict=True):
        column[fresh] = values
    return known._replace(start=start, end=end)


def _ellipses(arcs: PlaneArcs, straight: Bools) -> tuple[Floats, Floats, Bools, Bools]:
    """The commands less their ends: radii, rotations and both flags."""
    axes = on_axes(arcs)
    radius = rounded_radii(axes, straight)
    eccentric = radius[:, 0] - radius[:, 1]
    places = np.where(eccentric < 5, 10.0, 100.0)  # 0.05° on 5 points moves nothing by a hundredth
    rotation = np.where(eccentric == 0, 0.0, np.rint(np.degrees(axes.rotation) * places) / places)
    return radius, rotation, np.abs(axes.sweep) > np.pi + HALF_TURN, axes.sweep > 0


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
    command, fresh = commands(paths, straight), np.arange(len(straight))
    for _ in range(CUTS):
        astray = fresh[_strays(command.take(fresh), paths.arcs.take(fresh)) & ~straight[fresh]]
        if not len(astray):
            break
        count = np.ones(len(straight), dtype=np.int64)
        count[astray] = 2
        paths, owner = in_equal_pieces(paths, count), np.repeat(np.arange(len(count)), count)
        fresh, straight = np.flatnonzero(count[owner] == 2), straight[owner]
        straight[fresh] |= flat(paths.arcs.take(fresh))
        command = commands(paths, straight, command.take(owner), fresh)
    return paths, straight, command


def _strays(command: Commands, arcs: PlaneArcs) -> Bools:
    """Whether the middles of arcs (k,) are drawn too far from where they are."""
    allowed = np.where(is_half(arcs.sweep), 2 * STRAY, STRAY)  # all that is wrong with a half is its radii
    return np.asarray(np.hypot(*(drawn_middle(command) - arcs.at(arcs.middle())).T) > allowed)


def joined(steps: Ints, first: bool | Bools) -> Words:
    """Return rows of numbers in hundredths (k, m) as words, separated only where the grammar needs it.

    A minus starts a number by itself, and so does a point after a number that had one. A blank before the ``first``
    is wanted or not, for each row; in no case before a minus.
    """
    leading, pointed = (steps > 0) & (steps < 100), steps % 100 != 0
    spaced = (steps >= 0) & ~leading
    spaced[:, 1:] |= leading[:, 1:] & ~pointed[:, :-1]
    spaced[:, 0] = first & (steps[:, 0] >= 0)
    return beside_each_other(number_words(steps, 2, spaced))


def command_words(command: Commands, begins: Bools) -> tuple[Words, Bools]:
    """Return one row of words (k, w) per command, and which commands (k,) go anywhere: the others have no letters.

    A line after a line needs none either, where a minus parts their numbers.
    """
    step = steps_of(command.end - command.start, 2)
    going, arc = (step != 0).any(axis=1), command.radius[:, 0] > 0
    line = going & ~arc
    again = line & np.append(False, line[:-1]) & ~begins & (step[:, 0] < 0)
    shape = joined(steps_of(np.column_stack([command.radius, command.rotation]), 2), False)
    flags = words(" 0 0", " 0 1", " 1 0", " 1 1")[2 * command.large + command.positive]
    shape[~arc], flags[~arc] = 0, 0
    letter = words("l", "a")[arc.astype(int)]
    letter[again] = 0
    table = np.column_stack([letter, shape, flags, joined(step, arc)])  # a blank before the step: not all read without
    table[~going] = 0
    return table, going


def loop_texts(paths: Paths, command: Commands) -> Formatted:
    """Return the path data of each loop, empty where no command is left; ``z`` draws the line that closes one."""
    start = paths.loop_start
    begins: Bools = np.zeros(len(command.start) + 1, dtype=bool)
    begins[start] = True  # the last loops may be empty
    commands, going = command_words(command, begins[:-1])
    drawn = np.diff(np.concatenate([[0], np.cumsum(going)])[start]) > 0
    end = np.zeros(len(commands), dtype=np.uint32)
    last = start[1:][drawn & closed_loops(paths)] - 1
    end[last] = word("z")
    commands[last[command.radius[last, 0] == 0]] = 0
    coordinates = joined(steps_of(command.start[start[:-1][drawn]], 2), False)
    move = np.zeros((len(drawn), 1 + coordinates.shape[1]), dtype=np.uint32)
    move[drawn, 0], move[drawn, 1:] = word("M"), coordinates
    return in_loops(start, move, np.column_stack([commands, end]))


def path_data(paths: Paths, height: float) -> list[str]:
    """Return the ``d`` attribute of each shape for a page of that height (points), empty where nothing is left."""

    def write(block: Paths) -> Formatted:
        block, _, command = settled(block._replace(arcs=y_down(block.arcs, height)))
        return loop_texts(block, command)

    return list(texts_of_shapes(paths, write))
