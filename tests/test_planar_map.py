"""Planar maps of straight-sided figures: loops, areas, Euler's formula, and what is no planar map."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.curves import PlaneArcs
from molviz.geometry.general_position import Degenerate
from molviz.geometry.planar_map import (
    UNUSED,
    PlanarMap,
    cycles,
    directed,
    euler_defect,
    loop_areas,
    loops,
    oriented,
    planar_map,
)

SIDES = ([0, 1, 2, 3], [1, 2, 3, 0])  # of a square, anticlockwise


def columns(*rows: list[int]) -> list[np.ndarray]:
    return [np.array(row, dtype=np.int64) for row in rows]


def built(*rows: list[int]) -> PlanarMap:
    return planar_map(*columns(*rows))


def chords(points: list[tuple[float, float]], origin: list[int], target: list[int]) -> PlaneArcs:
    """Straight sides as arcs of ellipses without width, from −u to u."""
    begin, end = np.array(points)[origin], np.array(points)[target]
    turn = np.full(len(origin), np.pi)
    return PlaneArcs((begin + end) / 2, (end - begin) / 2, np.zeros_like(begin), turn, turn)


def members(edges: PlanarMap) -> dict[int, list[list[int]]]:
    """The loops of each face."""
    found = loops(edges)
    table: dict[int, list[list[int]]] = {}
    for k, label in enumerate(found.face.tolist()):
        table.setdefault(label, []).append(found.half_edge[found.start[k] : found.start[k + 1]].tolist())
    return table


def test_a_square_has_its_sides_forwards_inside_and_backwards_outside() -> None:
    edges = built(*SIDES, [5] * 4, [-1] * 4)
    assert edges.origin.tolist() == [0, 1, 1, 2, 2, 3, 3, 0] and edges.face.tolist() == [5, -1] * 4
    assert edges.next.tolist() == [2, 7, 4, 1, 6, 3, 0, 5]
    assert members(edges) == {-1: [[1, 7, 5, 3]], 5: [[0, 2, 4, 6]]}
    found = loops(edges)
    assert found.face.tolist() == [-1, 5] and euler_defect(edges, found) == 0
    sides = chords([(0, 0), (2, 0), (2, 3), (0, 3)], *SIDES)
    assert loop_areas(sides, found).tolist() == pytest.approx([-6, 6])


def test_two_faces_beside_each_other_share_a_side() -> None:
    """Rectangles 0 1 4 5 and 1 2 3 4; their common side from 1 to 4 has the first on its left."""
    origin, target = [0, 1, 2, 3, 4, 5, 1], [1, 2, 3, 4, 5, 0, 4]
    edges = built(origin, target, [0, 1, 1, 1, 0, 0, 0], [-1, -1, -1, -1, -1, -1, 1])
    assert members(edges) == {-1: [[1, 11, 9, 7, 5, 3]], 0: [[0, 12, 8, 10]], 1: [[2, 4, 6, 13]]}
    sides = chords([(0, 0), (1, 0), (3, 0), (3, 1), (1, 1), (0, 1)], origin, target)
    assert loop_areas(sides, loops(edges)).tolist() == pytest.approx([-3, 1, 2])
    assert euler_defect(edges, loops(edges)) == 0


def test_a_face_with_a_hole_has_two_loops_in_order_of_their_half_edges() -> None:
    """A square in a square: face 3 between them, 7 inside; its loops begin at their smallest half-edges."""
    origin, target = [0, 1, 2, 3, 4, 5, 6, 7], [1, 2, 3, 0, 5, 6, 7, 4]
    edges = built(origin, target, [3] * 4 + [7] * 4, [-1] * 4 + [3] * 4)
    assert members(edges)[3] == [[0, 2, 4, 6], [9, 15, 13, 11]]
    points = [(0, 0), (4, 0), (4, 4), (0, 4), (1, 1), (3, 1), (3, 3), (1, 3)]
    assert loop_areas(chords(points, origin, target), loops(edges)).tolist() == pytest.approx([-16, 16, -4, 4])
    assert euler_defect(edges, loops(edges)) == 0
    assert euler_defect(edges, loops(built(*SIDES, [3] * 4, [-1] * 4))) != 0


def test_sides_that_bound_nothing_are_in_no_loop() -> None:
    edges = built(*SIDES, [5] * 4, [UNUSED] * 4)
    assert edges.next[1::2].tolist() == [-1] * 4 and members(edges) == {5: [[0, 2, 4, 6]]}


def test_a_whole_circle_ends_where_it_starts() -> None:
    edges = built([0], [0], [1], [-1])
    assert members(edges) == {-1: [[1]], 1: [[0]]} and euler_defect(edges, loops(edges)) == 0


def test_nothing_is_a_map_without_loops() -> None:
    edges = built([], [], [], [])
    found = loops(edges)
    assert found.face.tolist() == found.half_edge.tolist() == [] and found.start.tolist() == [0]
    assert loop_areas(chords([(0, 0)], [], []), found).tolist() == [] and euler_defect(edges, found) == 0


@pytest.mark.parametrize(
    ("origin", "target", "left", "right"),
    [
        ([0, 1], [1, 2], [5, 5], [-1, -1]),  # no way on from vertex 2
        (*SIDES, [5, 5, 5, 6], [-1] * 4),  # a side has another face
        (*SIDES, [5, 5, 5, UNUSED], [-1] * 4),
        ([0, 1, 2, 0, 3, 4], [1, 2, 0, 3, 4, 0], [5] * 6, [-1, -1, -1, -2, -2, -2]),  # 5 comes to vertex 0 twice
    ],
)
def test_what_is_entered_and_not_left_or_entered_twice_is_degenerate(
    origin: list[int], target: list[int], left: list[int], right: list[int]
) -> None:
    with pytest.raises(Degenerate):
        built(origin, target, left, right)


def test_two_faces_may_come_to_a_vertex_and_one_face_not_twice() -> None:
    """Two triangles with the corner 0 in common: each its own face, nothing outside."""
    corners = [0, 1, 2, 0, 3, 4], [1, 2, 0, 3, 4, 0]
    assert members(built(*corners, [5] * 3 + [6] * 3, [UNUSED] * 6)) == {5: [[0, 2, 4]], 6: [[6, 8, 10]]}
    with pytest.raises(Degenerate):
        built(*corners, [5] * 6, [UNUSED] * 6)


@given(st.permutations(range(12)), st.sets(st.integers(0, 11)))
def test_cycles_hold_every_member_once_and_begin_with_their_lowest(order: list[int], removed: set[int]) -> None:
    """Members of cycles that lose one are taken out altogether, so that a permutation is left."""
    following = np.array(order)
    for first in removed:
        member = first
        while following[member] >= 0:
            following[member], member = -1, following[member]
    row, start = cycles(following)
    assert sorted(row.tolist()) == np.flatnonzero(following >= 0).tolist()
    assert start[0] == 0 and start[-1] == len(row) and (np.diff(start) > 0).all()
    for begin, end in zip(start[:-1], start[1:], strict=True):
        one = row[begin:end]
        assert one[0] == one.min() and following[one].tolist() == np.roll(one, -1).tolist()
    assert row[start[:-1]].tolist() == sorted(row[start[:-1]].tolist())


def test_half_edges_run_along_their_arcs_or_back() -> None:
    assert directed(*columns([1, 2], [3, 4])).tolist() == [1, 3, 2, 4]
    side = chords([(0, 0), (2, 1)], [0], [1])
    both = oriented(side, np.array([0, 1]))
    assert np.allclose(both.at(both.start), [[0, 0], [2, 1]])
    assert np.allclose(both.at(both.start + both.sweep), [[2, 1], [0, 0]])


@given(st.integers(0, 10_000), st.integers(0, 300))
def test_cycles_longer_than_those_found_all_at_once_are_found_too(seed: int, count: int) -> None:
    following = np.random.default_rng(seed).permutation(count)
    walked: list[list[int]] = []
    left = set(range(count))
    while left:
        walked.append([min(left)])
        while (edge := int(following[walked[-1][-1]])) != walked[-1][0]:
            walked[-1].append(edge)
        left -= set(walked[-1])
    row, start = cycles(following)
    assert [part.tolist() for part in np.split(row, start[1:-1])] == (walked or [[]])
