"""The boundary as a graph: sums against ``measure``, topology against the dual complex, and what lies in what."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.geometry.boundary_graph import BoundaryGraph, boundary_graph
from molviz.geometry.measure import measure_spheres
from molviz.geometry.shells import Shells, lining, shells_of
from molviz.geometry.spherical_faces import face_at, loop_counts
from molviz.model.spheres import Spheres
from tests.dual_complex import topology
from tests.oracle import random_spheres

TETRAHEDRON = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / 3**0.5


def scene(seed: int) -> Spheres:
    """Six to sixty balls, from scattered to a lump, radii over a factor of up to four."""
    random = np.random.default_rng(seed)
    count = int(random.integers(6, 61))
    return random_spheres(seed, count, random.uniform(1.5, 3.5) * count ** (1 / 3), random.uniform(1.1, 4.0))


def graph_and_shells(spheres: Spheres) -> tuple[BoundaryGraph, Shells]:
    graph = boundary_graph(spheres)
    return graph, shells_of(graph)


def check(spheres: Spheres) -> None:
    graph, shells = graph_and_shells(spheres)
    expected = topology(spheres)
    found = (int(shells.outer.sum()), int((~shells.outer).sum()), int((1 - shells.genus).sum()))
    assert found == expected
    assert (shells.genus >= 0).all() and (shells.volume[shells.outer] > 0).all() and not graph.displaced.any()
    measure = measure_spheres(spheres)
    by_sphere = np.bincount(graph.faces.sphere, graph.face_area(), len(spheres.radius))
    total = measure.area.sum()
    assert np.allclose(by_sphere, measure.area, rtol=0, atol=1e-10 * total)
    assert abs(shells.area.sum() - total) < 1e-10 * total
    assert abs(shells.volume.sum() - measure.volume) < 1e-10 * measure.volume
    assert np.linalg.norm(graph.face_flux().sum(axis=0)) < 1e-12 * total
    assert (shells.faces.sum(), shells.vertices.sum()) == (len(graph.faces.sphere), len(graph.vertex))


@given(st.integers(0, 10**9))
@settings(max_examples=60)
def test_random_balls_against_measure_and_the_dual_complex(seed: int) -> None:
    check(scene(seed))


@given(st.integers(0, 10**6))
@settings(max_examples=25)
def test_the_face_of_a_point_is_the_one_whose_inside_it_is_on(seed: int) -> None:
    """Just beside an arc it is the arc's face, and on the other side of it, under a ball, there is none."""
    spheres = scene(seed)
    graph, _ = graph_and_shells(spheres)
    rims, edges = graph.faces.rims, graph.faces.edges
    long = np.flatnonzero((rims.half > 1e-3) & (rims.sine > 1e-3))
    middle = (rims.cosine[:, None] * rims.axis + rims.sine[:, None] * rims.middle)[long]
    for away, expected in ((-1e-9, edges.face[long]), (1e-9, np.full(len(long), -1))):
        point = middle + away * rims.axis[long]
        direction = point / np.linalg.norm(point, axis=1)[:, None]
        assert np.array_equal(face_at(graph.faces, rims.sphere[long], direction), expected)


def wall(radius: float, size: float) -> Spheres:
    """A closed wall of 200 balls about a sphere, in general position."""
    random = np.random.default_rng(3)
    turn, z = np.arange(200) * np.pi * (3 - 5**0.5), 1 - (2 * np.arange(200) + 1) / 200
    across = np.sqrt(1 - z**2)
    points = np.column_stack([across * np.cos(turn), across * np.sin(turn), z]) * radius
    return Spheres(points + random.uniform(-0.01, 0.01, points.shape), np.full(200, size))


def together(*parts: Spheres) -> Spheres:
    return Spheres(np.concatenate([part.center for part in parts]), np.concatenate([part.radius for part in parts]))


def test_islands_in_cavities_in_islands_and_what_is_beside() -> None:
    pair = Spheres(np.array([[0.3, 0, 0], [0, 0, 1.2]]), np.array([0.5, 0.4]))
    around = Spheres(np.array([[0.0, 0, 40], [0, 0, -40]]), np.array([2.0, 1.0]))
    _, shells = graph_and_shells(together(pair, wall(5, 1.2), wall(12, 2.8), around))
    outer = np.flatnonzero(shells.outer)
    assert len(outer) == 6 and (~shells.outer).sum() == 2
    big, small, above, below, one, other = outer.tolist()
    of = {int(shells.parent[cavity]): cavity for cavity in np.flatnonzero(~shells.outer).tolist()}
    assert shells.parent[[big, above, below]].tolist() == [-1, -1, -1]
    assert shells.parent[small] == of[big] and shells.parent[[one, other]].tolist() == [of[small]] * 2
    assert (shells.volume[list(of.values())] < 0).all()


def test_the_lining_of_a_cavity() -> None:
    """Four balls about a hole: all line the cavity; a fifth on the outside of one does not."""
    inner = Spheres(np.vstack([TETRAHEDRON, 2.2 * TETRAHEDRON[:1]]), np.array([0.95, 0.95, 0.95, 0.95, 0.5]))
    graph, shells = graph_and_shells(inner)
    assert shells.outer.tolist() == [True, False] and shells.genus.tolist() == [0, 0]
    shell, ball = lining(graph, shells)
    assert ball[shell == 0].tolist() == [0, 1, 2, 3, 4] and ball[shell == 1].tolist() == [0, 1, 2, 3]


def test_whole_circles_and_whole_spheres() -> None:
    row = Spheres(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [9, 9, 9]]), np.full(4, 0.6))
    graph, shells = graph_and_shells(row)
    assert (len(graph.vertex), len(graph.faces.sphere), loop_counts(graph.faces).tolist()) == (0, 4, [1, 2, 1, 0])
    assert shells.whole_circles.tolist() == [2, 0] and shells.genus.tolist() == [0, 0]
    assert len(graph_and_shells(Spheres(np.empty((0, 3)), np.empty(0)))[1].outer) == 0


RING = np.array([[np.cos(k * np.pi / 3), np.sin(k * np.pi / 3), 0] for k in range(6)])
SPECIAL = {
    "a ring that meets in its middle": (RING, 1.0, 0),
    "a ring that is wider": (RING, 0.7, 1),
    "eight through one point": (np.array(list(np.ndindex(2, 2, 2)), dtype=float), 3**0.5 / 2, 0),
    "a lattice": (np.array(list(np.ndindex(3, 3, 3)), dtype=float), 0.72, 0),
    "an octahedron": (np.vstack([np.eye(3), -np.eye(3)]), 1.05, 0),
    "a dense lattice with balls between": (np.array(list(np.ndindex(4, 4, 4)), dtype=float) / 2, 0.71, 0),
}


@pytest.mark.parametrize("factor", [1.0, 1e-30, 1e30])
@pytest.mark.parametrize("name", SPECIAL)
def test_special_position(name: str, factor: float) -> None:
    center, radius, genus = SPECIAL[name]
    spheres = Spheres(factor * center, np.full(len(center), factor * radius))
    graph, shells = graph_and_shells(spheres)
    measure = measure_spheres(spheres)
    assert abs(shells.area.sum() / measure.area.sum() - 1) < 1e-6
    assert abs(shells.volume.sum() / measure.volume - 1) < 1e-6
    assert shells.genus[0] == genus and shells.outer.sum() == 1
    moved = np.linalg.norm(graph.boundary.spheres.center - spheres.center, axis=1) / factor
    assert moved.max() < 1e-7 and (moved[~graph.displaced] == 0).all()
