"""Planar maps as half-edge columns: arc k forwards is half-edge 2k, backwards 2k + 1, so twin(e) = e XOR 1.

Every half-edge has one face on its left. The region of a face is bounded by the half-edges that carry its label,
chained at the vertices into loops: holes and separate parts come out by themselves. What the arcs are is not known
here, so that the same map serves whatever is drawn in the plane or on a sphere.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints, distinct
from molviz.curves import PlaneArcs
from molviz.geometry.components import components
from molviz.geometry.general_position import Degenerate
from molviz.geometry.rows import lists_taken

UNUSED = -2  # label of a half-edge that bounds nothing
SHORT = 40  # members of cycles that are found all at once: nearly all cycles are shorter


class PlanarMap(NamedTuple):
    """Half-edges of k arcs."""

    origin: Ints  # (2k,) the vertex at which each starts; it ends where its twin starts
    next: Ints  # (2k,) the half-edge that follows it along its face, −1 where it bounds nothing
    face: Ints  # (2k,) the label of the face on its left, or UNUSED


class Loops(NamedTuple):
    """Closed chains of half-edges, ordered by face; CSR in one level."""

    half_edge: Ints  # (m,)
    start: Ints  # (loops + 1,)
    face: Ints  # (loops,) label


def directed(forward: Ints, backward: Ints) -> Ints:
    """Interleave the columns of arcs for their two half-edges."""
    return np.stack([forward, backward], axis=1).ravel()


def planar_map(origin: Ints, target: Ints, left: Ints, right: Ints) -> PlanarMap:
    """Return the map of k arcs between numbered vertices with the faces on their left and right.

    At every vertex a face must be entered exactly as often as it is left, once in general position; raises
    ``Degenerate`` where it is not.
    """
    begin, end, face = directed(origin, target), directed(target, origin), directed(left, right)
    used = np.flatnonzero(face != UNUSED)
    faces = int(face.max(initial=0)) - UNUSED + 1
    leaving, arriving = (used[np.argsort(vertex[used] * faces + face[used])] for vertex in (begin, end))
    balanced = np.array_equal(begin[leaving], end[arriving]) and np.array_equal(face[leaving], face[arriving])
    again = (np.diff(begin[leaving]) == 0) & (np.diff(face[leaving]) == 0)
    if not balanced or again.any():
        raise Degenerate(_unbalanced(begin[used], end[used], face[used]))
    following = np.full(len(face), -1)
    following[arriving] = leaving
    return PlanarMap(begin, following, face)


def _unbalanced(begin: Ints, end: Ints, face: Ints) -> Ints:
    """The vertices at which some face is not entered exactly once and left once, by half-edges (m,)."""
    key = np.stack([np.append(begin, end), np.append(face, face)])
    leaves = np.repeat([True, False], [len(begin), len(end)])
    faces, number = np.unique(key, axis=1, return_inverse=True)
    left, entered = (np.bincount(number.ravel(), which, faces.shape[1]) for which in (leaves, ~leaves))
    wrong: Ints = faces[0, (left != 1) | (entered != 1)]
    return distinct(wrong)


def merged_faces(edges: PlanarMap, label: Ints) -> PlanarMap:
    """Return the map in which neighbouring faces of one label are one face; ``label`` (2k,) is that of each half-edge.

    Arcs with one label on both sides bound nothing any more; what follows a half-edge is found by turning about its end
    past them: ``next'(h)`` is ``n = next(h)``, then ``n = next(twin(n))`` while n and its twin have one label.
    """
    twin = np.arange(len(label)) ^ 1
    inner = label == label[twin]
    following = np.where(inner, -1, edges.next)
    turning = np.flatnonzero(~inner & (edges.next >= 0))
    turning = turning[inner[following[turning]]]
    while len(turning):
        following[turning] = edges.next[twin[following[turning]]]
        turning = turning[inner[following[turning]]]
    return PlanarMap(edges.origin, following, np.where(inner, UNUSED, label))


def taken_arcs(edges: PlanarMap, rows: Ints) -> PlanarMap:
    """Return the map of the given arcs (ascending), which bound all its faces, numbered anew."""
    number = np.full(len(edges.face) + 1, -1)  # row −1 stays −1
    kept = np.stack([2 * rows, 2 * rows + 1], axis=1).ravel()
    number[kept] = np.arange(len(kept))
    return PlanarMap(edges.origin[kept], number[edges.next[kept]], edges.face[kept])


def loops(edges: PlanarMap) -> Loops:
    """Return the boundary loops of all faces, each from its smallest half-edge, ordered by face."""
    half_edge, start = cycles(edges.next)
    label = edges.face[half_edge[start[:-1]]] if len(half_edge) else np.empty(0, dtype=np.int64)
    order = np.argsort(label, kind="stable")
    row, start = lists_taken(start, order)
    return Loops(half_edge[row], start, label[order])


def cycles(following: Ints) -> tuple[Ints, Ints]:
    """Return the cycles of a permutation one after the other, each from its lowest member, and CSR offsets.

    Members followed by −1 are left out.
    """
    first, length, candidate = _short_cycles(following)
    long = _cycles_of(following, candidate)
    lowest = np.append(first, [cycle[0] for cycle in long]).astype(np.int64)
    size = np.append(length, [len(cycle) for cycle in long]).astype(np.int64)
    order = np.argsort(lowest)
    start = np.append(0, np.cumsum(size[order]))
    place = np.empty(len(order), dtype=np.int64)
    place[order] = start[:-1]
    member = np.empty(int(start[-1]), dtype=np.int64)
    for begin, cycle in zip(place[len(first) :].tolist(), long, strict=True):
        member[begin : begin + len(cycle)] = cycle
    edge, place, left = first, place[: len(first)], length
    while len(edge):
        member[place] = edge
        on = left > 1
        edge, place, left = following[edge[on]], place[on] + 1, left[on] - 1
    return member, start


def _short_cycles(following: Ints) -> tuple[Ints, Ints, Ints]:
    """The lowest members of cycles of at most SHORT members and their lengths, and what may be lowest of others.

    All at once: from each member that the next one is not lower than, step by step until one is, or it is back.
    """
    first = np.flatnonzero(following >= np.arange(len(following)))
    edge = following[first]
    found, lengths = [first[:0]], [first[:0]]
    for length in range(1, SHORT + 1):
        back = first[edge == first]
        found.append(back)
        lengths.append(np.full(len(back), length))
        on = edge > first
        first, edge = first[on], following[edge[on]]
    return np.concatenate(found), np.concatenate(lengths), first


def _cycles_of(following: Ints, candidate: Ints) -> list[list[int]]:
    """The cycles of members (ascending) among which are the lowest of all these cycles."""
    successor, cycles_found = following.tolist(), []
    for first in candidate.tolist():
        edge, cycle = first, []
        while successor[edge] >= 0:
            cycle.append(edge)
            successor[edge], edge = -1, successor[edge]
        if cycle:
            cycles_found.append(cycle)
    return cycles_found


def euler_defect(edges: PlanarMap, boundary: Loops) -> int:
    """Return V − E + L − 2 C for V vertices, E arcs, L boundary loops and C components, nought for a planar map.

    Euler's V − E + F = 1 + C in other words: a face with h holes has 1 + h loops.
    """
    vertices, number = np.unique(edges.origin, return_inverse=True)
    arcs = len(number) // 2
    return int(len(vertices) - arcs + len(boundary.face) - 2 * components(number[::2], number[1::2], len(vertices)))


def oriented(arcs: PlaneArcs, half_edge: Ints) -> PlaneArcs:
    """Return the arcs in the direction of the given half-edges."""
    return arcs.take(half_edge >> 1).reversed((half_edge & 1).astype(bool))


def loop_areas(arcs: PlaneArcs, boundary: Loops) -> Floats:
    """Return the signed area of each loop, ``½ ∮ x dy − y dx``; positive where the interior is inside."""
    forward = arcs.signed_area()
    area = np.stack([forward, -forward], axis=1).ravel()[boundary.half_edge]
    return np.add.reduceat(area, boundary.start[:-1]) if len(boundary.half_edge) else np.empty(0)
