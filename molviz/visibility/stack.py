"""What is painted over what: the order of the pieces of spheres and sticks, and curves as the sides of pieces."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Ints
from molviz.geometry.rows import expand, offsets
from molviz.model.spheres import Spheres
from molviz.visibility.eye import occluders_of
from molviz.visibility.named_arcs import Hidden, joined
from molviz.visibility.solids import Solids
from molviz.visibility.thirds import PARTS, Thirds, middles, thirds_of
from molviz.visibility.view import View


class Stack(NamedTuple):
    """n spheres and k sticks, and the places of all their pieces from back to front.

    Piece i is that of sphere i; the parts of stick j, in the order of its axis, are n + 4 j onwards.
    """

    solids: Solids
    thirds: Thirds
    rank: Ints  # (n + 4k,)
    piece: Ints  # (n + 2k,) of each sphere, then at each end of a stick

    def later(self, one: Ints, other: Ints) -> Bools:
        """Return which spheres or ends of sticks (m,) are painted after others (m,)."""
        return np.asarray(self.rank[self.piece[one]] > self.rank[self.piece[other]])

    def owner(self) -> Ints:
        """Return the sphere of each piece (n + 4k,): itself, or that at its end of the stick."""
        return np.append(np.arange(self.solids.balls), np.repeat(self.solids.sticks.ends.sphere, PARTS // 2))


def stacked(solids: Solids, view: View) -> Stack:
    """Return spheres in the order of their nearness, and parts of sticks among them in that of their axes' middles.

    There a part is as near as a ball as wide as the stick. Of the two parts of a middle third, whose border bulges
    towards the farther one, the farther is the later: it leaves the outline of the other as it is.
    """
    sticks, count = solids.sticks, solids.balls
    parts = occluders_of(Spheres(middles(sticks), np.repeat(sticks.radius, PARTS)), view)
    nearness = np.append(solids.spheres.nearness(), parts.nearness())
    along = parts.nearness().reshape(-1, PARTS)
    onward = np.where(along[:, :1] > along[:, -1:], 1, -1) * np.arange(PARTS)
    rank = np.empty(len(nearness), dtype=np.int64)
    rank[np.lexsort((np.append(np.zeros(count), onward), nearness))] = np.arange(len(nearness))
    thirds = thirds_of(sticks, rank[count:])
    return Stack(solids, thirds, rank, np.append(np.arange(count), count + thirds.at_ends()))


class Sides(NamedTuple):
    """Curves that bound pieces (m,), several times where they bound several, and the piece that each bounds."""

    curve: Ints  # (m,)
    piece: Ints  # (m,)
    on_right: Bools  # (m,) of the curve, else on its left
    hidden: Hidden  # of their places among the m


def sides_together(parts: list[Sides]) -> Sides:
    """Return the rows of several tables as one."""
    start = np.cumsum([0, *(len(part.curve) for part in parts)])
    hidden = [part.hidden._replace(curve=part.hidden.curve + at) for part, at in zip(parts, start, strict=False)]
    curve, piece, on_right, _ = zip(*parts, strict=True)
    return Sides(np.concatenate(curve), np.concatenate(piece), np.concatenate(on_right), joined(hidden))


def hidden_of(hidden: Hidden, curve: Ints) -> Hidden:
    """Return what is hidden of the given curves (m,), numbered by their places."""
    order = np.argsort(hidden.curve, kind="stable")
    start = offsets(hidden.curve[order], int(curve.max(initial=-1)) + 1)
    place, entry = expand(start[curve], start[curve + 1])
    return hidden.take(order[entry])._replace(curve=place)
