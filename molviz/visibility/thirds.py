"""Sticks cut in thirds, as the painter draws them one after the other, each with one nearness.

Of four parts of a stick the middle two are one third, cut by the border of its halves, which have colours of their
own. Borders that would meet a rim or an elbow are left out: what lies beyond them then belongs to the next part.

Of two parts that meet, the one painted first runs on a little beneath the other, so that rounding leaves no gap between
them. So does a stick beneath a ball of its own; and at a joint, where both have one colour and no line between, always.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.intervals import TURN
from molviz.geometry.rows import expand
from molviz.visibility.named_arcs import Hidden
from molviz.visibility.names import CUT
from molviz.visibility.occluders.stick import StickOccluders
from molviz.visibility.stick_curves import Cuts, farthest_reach

PARTS = 4
BORDERS = np.array([1 / 3, 1 / 2, 2 / 3])  # of the axis, between the parts
MIDDLES = np.array([1 / 6, 1 / 2, 1 / 2, 5 / 6])  # of the axis, of the third that each part belongs to
BENEATH = 0.25  # of a stick's radius, by which it runs on
AT_JOINTS = 0.04  # the same beyond its joint, out of which it then sticks by 0.0008 radii


class Thirds(NamedTuple):
    """The parts of k sticks between n spheres: n + 4 j + q is part q of stick j, if ``first[j]`` ≤ q ≤ ``last[j]``.

    Parts begin and end on their axes where they do, or run on to, but for those at the ends of a stick.
    """

    first: Ints  # (k,) the part at the first end
    last: Ints  # (k,) the part at the second end
    begin: Floats  # (k, 4) shares of the axis
    end: Floats  # (k, 4)

    def at_ends(self) -> Ints:
        """Return which of all 4k parts lies at each end (2k,)."""
        start = PARTS * np.arange(len(self.first))
        return np.stack([start + self.first, start + self.last], axis=1).ravel()

    def cuts(self, count: int) -> Cuts:
        """Return where parts of sticks between ``count`` spheres meet others: ends of all, then beginnings of all."""
        stick, part = expand(self.first, self.last)
        before = np.tile(count + PARTS * stick + part, 2)
        share = np.append(self.end[stick, part], self.begin[stick, part + 1])
        return Cuts(np.tile(stick, 2), share, before, before + 1)

    def on_lines(self) -> tuple[Ints, Ints]:
        """Return line and part of each line of a part (m,), ordered by line and from its stick's first end."""
        number = np.arange(2 * len(self.first))
        return expand(self.first[number >> 1], self.last[number >> 1] + 1)

    def cut_off(self, line: Ints, part: Ints, count: int) -> Hidden:
        """Return, of the given parts of lines, the intervals of the lines beyond these, numbered by their place.

        A point at a share x of the axis has ``cos θ = 1/2 − x`` on the line on its right, ``cos θ = x − 1/2`` on the
        other. At an end of a stick the interval begins beyond the end of the line.
        """
        stick, left = line >> 1, (line & 1) == 1
        begin = np.where(part == self.first[stick], 0.0, np.arccos(0.5 - self.begin[stick, part]))
        end = np.where(part == self.last[stick], np.pi, np.arccos(0.5 - self.end[stick, part]))
        after = count + PARTS * stick + part
        start, sweep = np.where(left, np.pi - begin, end), TURN - (end - begin)
        leaves, enters = np.where(left, after, after - 1), np.where(left, after - 1, after)
        return Hidden(np.arange(len(line)), start, sweep, np.full(len(line), CUT), leaves, enters)


def thirds_of(sticks: StickOccluders, rank: Ints) -> Thirds:
    """Return the parts of sticks that are painted in the order of their ``rank`` (4k,)."""
    reach = farthest_reach(sticks).reshape(-1, 2) + BENEATH * sticks.radius[:, None]
    length, beneath = sticks.length[:, None], (BENEATH * sticks.radius / sticks.length)[:, None]
    borders = BORDERS * length
    first = np.sum(borders <= reach[:, :1], axis=1)
    last = PARTS - 1 - np.sum(borders >= length - reach[:, 1:], axis=1)
    rank = rank.reshape(-1, PARTS)
    onward = rank[:, 1:] > rank[:, :-1]
    ends = np.zeros((len(length), 1))
    begin = np.hstack([ends, BORDERS - beneath * ~onward])
    end = np.hstack([BORDERS + beneath * onward, ends + 1.0])
    return Thirds(first, np.maximum(first, last), begin, end)


def running_on(sticks: StickOccluders, beneath: Bools) -> StickOccluders:
    """Return the sticks with those of their ends (2k,) that lie beneath balls, or at joints, a little in these."""
    ends, radius = sticks.ends, np.repeat(sticks.radius, 2)
    by = np.where(beneath, np.minimum(BENEATH * radius, ends.reach), 0.0)
    by = np.where(ends.joint, AT_JOINTS * radius, by)
    return sticks._replace(ends=ends._replace(reach=ends.reach - by, t=ends.t - by))


def middles(sticks: StickOccluders) -> Floats:
    """Return the middles (4k, 3) of the thirds that the parts of sticks belong to, on the axes."""
    along = sticks.length[:, None] * MIDDLES
    return np.asarray(sticks.start[:, None] + sticks.direction[:, None] * along[..., None]).reshape(-1, 3)
