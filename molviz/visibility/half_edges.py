"""Half-edges: arc k forwards is 2k, backwards 2k + 1, so twin(e) = e XOR 1; each has one face on its left.

The region of a face is bounded by the half-edges that carry its label, chained at the vertices into loops. Holes and
separate parts come out by themselves.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.curves import PlaneArcs
from molviz.geometry.general_position import Degenerate
from molviz.geometry.rows import lists_taken
from molviz.vectors import cross

UNUSED = -2  # label of a half-edge that bounds nothing


class Loops(NamedTuple):
    """Closed chains of half-edges, ordered by face; CSR in one level."""

    half_edge: Ints  # (m,)
    start: Ints  # (loops + 1,)
    face: Ints  # (loops,) label


def directed(forward: Ints, backward: Ints) -> Ints:
    """Interleave the columns of arcs for their two half-edges."""
    return np.stack([forward, backward], axis=1).ravel()


def chained(face: Ints, origin: Ints, target: Ints) -> Ints:
    """Return for each half-edge the next one of the same face, −1 for unused ones.

    At every vertex a face must be entered exactly as often as it is left, once in general position; raises
    ``Degenerate`` where it is not.
    """
    used = np.flatnonzero(face != UNUSED)
    leaving = used[np.lexsort((face[used], origin[used]))]
    arriving = used[np.lexsort((face[used], target[used]))]
    balanced = np.array_equal(origin[leaving], target[arriving]) and np.array_equal(face[leaving], face[arriving])
    again = (np.diff(origin[leaving]) == 0) & (np.diff(face[leaving]) == 0)
    if not balanced or again.any():
        raise Degenerate
    following = np.full(len(face), -1)
    following[arriving] = leaving
    return following


def loops(face: Ints, following: Ints) -> Loops:
    """Return the cycles of ``following``, each from its smallest half-edge, ordered by face."""
    return _by_face(*cycles(following), face)


def cycles(following: Ints) -> tuple[Ints, Ints]:
    """Return the cycles of a permutation one after the other, each from its lowest member, and CSR offsets.

    Members followed by −1 are left out.
    """
    successor = following.tolist()
    order: list[int] = []
    start = [0]
    for first in np.flatnonzero(following >= 0).tolist():
        edge = first
        while successor[edge] >= 0:
            order.append(edge)
            successor[edge], edge = -1, successor[edge]
        if len(order) > start[-1]:
            start.append(len(order))
    return np.array(order, dtype=np.int64), np.array(start, dtype=np.int64)


def _by_face(half_edge: Ints, start: Ints, face: Ints) -> Loops:
    label = face[half_edge[start[:-1]]] if len(half_edge) else np.empty(0, dtype=np.int64)
    order = np.argsort(label, kind="stable")
    row, start = lists_taken(start, order)
    return Loops(half_edge[row], start, label[order])


def oriented(arcs: PlaneArcs, half_edge: Ints) -> PlaneArcs:
    """Return the arcs in the direction of the given half-edges."""
    rows = arcs.take(half_edge >> 1)
    back = (half_edge & 1).astype(bool)
    return rows._replace(
        start=np.where(back, rows.start + rows.sweep, rows.start), sweep=np.where(back, -rows.sweep, rows.sweep)
    )


def loop_areas(arcs: PlaneArcs, found: Loops) -> Floats:
    """Return the signed area of each loop, ``½ ∮ x dy − y dx``; positive where the interior is inside."""
    area = signed_areas(oriented(arcs, found.half_edge))
    return np.add.reduceat(area, found.start[:-1]) if len(found.half_edge) else np.empty(0)


def signed_areas(arcs: PlaneArcs) -> Floats:
    """``½ ∫ x dy − y dx`` over each arc: ``½ (c × (p1 − p0) + (u × v) sweep)``."""
    chord = arcs.at(arcs.start + arcs.sweep) - arcs.at(arcs.start)
    return np.asarray((cross(arcs.c, chord) + cross(arcs.u, arcs.v) * arcs.sweep) / 2)
