"""Where labels go: in slots around a convex outline of the molecule, each near what it names, leaders uncrossed.

A leader ends where its label's slot touches the outline. It runs inside a convex curve and slots lie outside, so no
leader runs through a text. All slots are equally large, so any two labels can exchange theirs; when no exchange makes
the leaders shorter, none cross: of a quadrilateral the two diagonals are longer than two opposite sides.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.vectors import transformed

AWAY = 5.0  # points between molecule and labels
DIRECTIONS = 120  # sides of the outline
STRIDE = 1.0  # points from one place on the outline to the next
ROOMY, TIGHT = 1.5, 1.0  # heights from one slot to the next
SPARE = 1.5  # slots for each label that make the roomy ones worth while
SHORTER = 1e-9  # points that an exchange must save, so that rounding does not exchange for ever
QUADRANTS = ((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0))


class Slots(NamedTuple):
    """k places for labels, each of the same size."""

    end: Floats  # (k, 2) where the leader ends
    corner: Floats  # (k, 2) of the slot, on the outline
    side: Floats  # (k, 2) ±1, to where the slot extends from its corner

    def boxes(self, size: Floats) -> Floats:
        """Return the boxes (k, 4) of labels of some size (k, 2) or (2,) in these slots."""
        other = self.corner + self.side * size
        return np.hstack([np.minimum(self.corner, other), np.maximum(self.corner, other)])

    def take(self, rows: Ints) -> "Slots":
        """Return the given rows."""
        return Slots(*(column[rows] for column in self))


def label_places(anchor: Floats, size: Floats, discs: Floats) -> Slots:
    """Return a slot for each label (k) with that anchor (k, 2), outside of discs (n, 3) and anchors, all in points.

    ``size`` (2,) is that of the widest label. Where there are too many the outline is higher than it must be: labels
    are wide, so that most find room one above the other.
    """
    points = np.vstack([discs, np.column_stack([anchor, np.zeros(len(anchor))])])
    higher, slots = 0.0, _slots(points, 0.0, size, ROOMY)
    if len(slots.end) < SPARE * len(anchor):
        slots = _slots(points, 0.0, size, TIGHT)
    while len(slots.end) < len(anchor):
        higher += size[1]
        slots = _slots(points, higher, size, TIGHT)
    cost = np.hypot(*(anchor[:, None] - slots.end).transpose(2, 0, 1))
    return slots.take(_exchanged(cost, _shortest_first(cost)))


def _slots(points: Floats, higher: float, size: Floats, pitch: float) -> Slots:
    """As many slots as there is room for, a quadrant after the other, each from the side to the top or bottom."""
    outline = outline_around(points, AWAY, higher)
    rows = []
    for side in QUADRANTS:
        part = _quadrant(outline, np.array(side))
        for first, end in _corners(part, size * [1.0, pitch], size[1]):
            rows.append((part[first, 0], part[end, 1], *part[first], *side))
    table = np.array(rows)
    return Slots(table[:, :2], table[:, 2:4], table[:, 4:])


def outline_around(points: Floats, away: float, higher: float = 0.0) -> Floats:
    """Return corners (k, 2), anticlockwise, of a convex polygon around discs (n, 3), x y r, at least so far away.

    Its sides touch the discs: side k is ``d · p = max (d · c + r) + away + higher |d_y|`` for one of many directions d;
    the last term widens the polygon by a line of that length upwards and downwards.
    """
    angle = 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    d = np.column_stack([np.cos(angle), np.sin(angle)])
    reach = [(transformed(points[:, :2], row[None])[:, 0] + points[:, 2]).max() for row in d]
    h = np.array(reach) + away + higher * np.abs(d[:, 1])
    after, h_after = np.roll(d, -1, axis=0), np.roll(h, -1)
    area = d[:, 0] * after[:, 1] - d[:, 1] * after[:, 0]
    x = h * after[:, 1] - h_after * d[:, 1]
    y = h_after * d[:, 0] - h * after[:, 0]
    return np.asarray(np.column_stack([x, y]) / area[:, None])


def _quadrant(outline: Floats, side: Floats) -> Floats:
    """Places (k, 2) in close steps along the outline, from its extreme in x to that in y, on the given sides."""
    corners = np.concatenate([outline, outline[:1]])
    length = np.append(0.0, np.hypot(*np.diff(corners, axis=0).T).cumsum())
    steps = np.linspace(0.0, length[-1], int(length[-1] / STRIDE) + DIRECTIONS)
    places = np.column_stack([np.interp(steps, length, corners[:, axis]) for axis in (0, 1)]) * side
    widest, highest = places.argmax(axis=0)
    if side[0] * side[1] < 0:
        widest, highest, places = len(places) - 1 - widest, len(places) - 1 - highest, places[::-1]
    part = np.roll(places, -widest, axis=0)[: (highest - widest) % len(places) + 1]
    return np.asarray(part * side)


def _corners(part: Floats, step: Floats, height: float) -> Iterator[tuple[int, int]]:
    """The rows of a quadrant where slots have their corners, and up to where their leaders may end.

    A slot follows when it is clear of the one before, in height or in width. A leader ends half way up the slot where
    the outline is steep there, near the corner where it is flat.
    """
    x, y = np.abs(part - part[0]).T
    row = 0
    while row < len(part):
        steep = (x < x[row] + AWAY / 2) & (y <= y[row] + height / 2)
        yield row, int(np.flatnonzero(steep)[-1])
        clear = np.flatnonzero((y >= y[row] + step[1]) | (x >= x[row] + step[0]))
        row = int(clear[0]) if len(clear) else len(part)


def _shortest_first(cost: Floats) -> Ints:
    """A slot for each label: of all pairs the cheapest whose label and slot are both left, and so on."""
    slot = np.full(len(cost), -1)
    taken: Bools = np.zeros(cost.shape[1], dtype=bool)
    for pair in np.argsort(cost, axis=None, kind="stable").tolist():
        label, place = divmod(pair, cost.shape[1])
        if slot[label] < 0 and not taken[place]:
            slot[label], taken[place] = place, True
    return slot


def _exchanged(cost: Floats, slot: Ints) -> Ints:
    """The slots after the best move to an empty slot or exchange of two, again and again while one saves anything."""
    labels = np.arange(len(cost))
    slot = slot.copy()
    while True:
        own = cost[labels, slot]
        saved = own[:, None] - cost  # by moving label i to slot s
        among = saved[:, slot]
        saved[:, slot] = among + among.T
        label, place = divmod(int(saved.argmax()), cost.shape[1])
        if saved[label, place] < SHORTER:
            return slot
        slot[slot == place] = slot[label]
        slot[label] = place
