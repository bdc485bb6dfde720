"""In which component or cavity points are: scenes whose answer is plain, free segments, and volumes."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import molviz
from molviz.errors import InputError
from molviz.geometry.boundary_graph import boundary_graph
from molviz.geometry.climb import ON_ARC, FacesAbove
from molviz.geometry.shells import lining
from molviz.geometry.whereabouts import Surroundings, Whereabouts
from molviz.model.spheres import Spheres
from tests.oracle import random_spheres
from tests.test_shells import together, wall

SAMPLES = Path(__file__).parent.parent / "samples"
LATTICE = np.array(list(np.ndindex(3, 3, 3)), dtype=float) - 1.0
HOLLOW = LATTICE[np.any(LATTICE != 0, axis=1)]
RADIUS = 0.72  # above √½: the squares between four balls are closed; below √¾: the middle of a cube of eight is free


def free_of(spheres: Spheres, point: np.ndarray) -> np.ndarray:
    gap = np.linalg.norm(point[:, None] - spheres.center, axis=2)
    return (gap >= spheres.radius).all(axis=1)


def segment_is_free(spheres: Spheres, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Whether the segment between two points (m, 3) each stays outside of all balls."""
    way = other - one
    length = np.sum(way**2, axis=1)
    along = np.einsum("mnk,mk->mn", spheres.center - one[:, None], way) / length[:, None]
    foot = one[:, None] + np.clip(along, 0, 1)[:, :, None] * way[:, None]
    return np.asarray((np.linalg.norm(foot - spheres.center, axis=2) > spheres.radius).all(axis=1))


def check_by_segments(spheres: Spheres, point: np.ndarray, pairs: np.ndarray) -> Whereabouts:
    """Free points that see each other are in one place; those in balls are in the component of each of these."""
    places = Surroundings(spheres).at(point)
    free = free_of(spheres, point)
    assert np.array_equal(places.component < 0, free) and (places.cavity[~free] == -1).all()
    pairs = pairs[free[pairs].all(axis=1) & (pairs[:, 0] != pairs[:, 1])]
    seen = pairs[segment_is_free(spheres, point[pairs[:, 0]], point[pairs[:, 1]])]
    assert np.array_equal(places.cavity[seen[:, 0]], places.cavity[seen[:, 1]])
    return places


def check_volumes(spheres: Spheres, count: int, seed: int) -> None:
    """The share of random points in each place is that of its exact volume, within 4.5 standard deviations."""
    surroundings = Surroundings(spheres)
    shells = surroundings.shells
    low, high = spheres.box()
    places = surroundings.at(np.random.default_rng(seed).uniform(low, high, (count, 3)))
    box = np.prod(high - low)
    for row, outer in enumerate(shells.outer.tolist()):
        within = shells.volume[shells.parent == row].sum()  # cavities count negative, islands positive
        share = (shells.volume[row] + within if outer else -shells.volume[row] - within) / box
        found = np.mean((places.component if outer else places.cavity) == row)
        assert found == pytest.approx(share, abs=4.5 * np.sqrt(share / count) + 1 / count), row


def test_islands_in_cavities_in_islands_and_what_is_beside() -> None:
    """Two walls about the middle: free points are within the inner, between the two, or outside, by their distance."""
    parts = [Spheres(np.array([[0.3, 0, 0], [0, 0, 1.2]]), np.array([0.5, 0.4])), wall(5, 1.2), wall(12, 2.8),
             Spheres(np.array([[0.0, 0, 40], [0, 0, -40]]), np.array([2.0, 1.0]))]  # fmt: skip
    surroundings = Surroundings(together(*parts))
    shells, random = surroundings.shells, np.random.default_rng(1)
    direction = random.normal(size=(5000, 3))
    point = direction / np.linalg.norm(direction, axis=1)[:, None] * random.uniform(0, 45, (5000, 1))
    places = surroundings.at(point)
    far = np.linalg.norm(point, axis=1)
    free = [free_of(part, point) for part in parts]
    outside = np.all(free, axis=0)
    big, small = 0, 1  # the outer shells by falling volume, then the cavities by falling volume
    between, inner = np.flatnonzero(~shells.outer).tolist()
    assert shells.parent[[between, inner]].tolist() == [big, small]
    expected = np.where(far > 12, -1, np.where(far > 5, between, inner))
    assert np.array_equal(places.cavity, np.where(outside, expected, -1))
    assert {-1, between, inner} == set(places.cavity[outside].tolist())
    assert (places.component[outside] == -1).all()
    assert (places.component[~free[1]] == small).all() and (places.component[~free[2]] == big).all()
    at = surroundings.at(np.array([[0.0, 0, 40], [0, 0, -40], [0.3, 0, 0], [0, 0, 1.2], [0, 0, 100], [0, 0, -100]]))
    assert at.component.tolist() == [2, 3, 4, 5, -1, -1] and at.cavity.tolist() == [-1] * 6


@pytest.mark.parametrize("factor", [1.0, 1e-30, 1e30])
def test_a_lattice_has_eight_cavities_and_without_its_middle_one(factor: float) -> None:
    """Points on all planes and axes of symmetry, straight below places in which four spheres meet."""
    steps = np.linspace(-2, 2, 33)
    point = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    free = free_of(Spheres(HOLLOW, np.full(26, RADIUS)), point)
    within = np.abs(point).max(axis=1) < 1
    surroundings = Surroundings(Spheres(HOLLOW * factor, np.full(26, RADIUS * factor)))
    assert surroundings.shells.outer.tolist() == [True, False]
    places = surroundings.at(point * factor)
    assert np.array_equal(places.cavity, np.where(free & within, 1, -1)) and np.array_equal(places.component < 0, free)
    free &= free_of(Spheres(LATTICE, np.full(27, RADIUS)), point)
    surroundings = Surroundings(Spheres(LATTICE * factor, np.full(27, RADIUS * factor)))
    assert surroundings.shells.outer.tolist() == [True] + [False] * 8
    cavity = surroundings.at(point * factor).cavity
    octant = (point > 0) @ [4, 2, 1]
    of_octant = [set(cavity[free & within & (octant == number)].tolist()) for number in range(8)]
    assert all(len(one) == 1 for one in of_octant) and set.union(*of_octant) == set(range(1, 9))
    assert (cavity[~(free & within)] == -1).all()


def test_a_way_that_meets_an_arc_is_moved_beside_it() -> None:
    """Exactly below the rims of two balls in a closed wall, where the face that is met is a matter of rounding."""
    spheres = wall(5, 1.2)
    graph = boundary_graph(spheres)
    above = FacesAbove(graph)
    circles, arcs = graph.boundary.circles, graph.boundary.arcs
    middle = circles.at(arcs.circle, arcs.start + arcs.sweep / 2)
    middle = middle[(np.linalg.norm(middle, axis=1) < 5) & (middle[:, 2] > 2)]
    point = np.column_stack([middle[:, :2], np.zeros(len(middle))])
    met, _ = above._met(point)
    assert (met == ON_ARC).sum() > 5 and len(middle) > 100
    assert (Surroundings(spheres).at(point).cavity == 1).all()


@settings(max_examples=30)
@given(st.integers(0, 10**9))
def test_points_that_see_each_other_are_in_one_place(seed: int) -> None:
    random = np.random.default_rng(seed)
    spheres = random_spheres(seed, int(random.integers(1, 150)), 8.0, random.uniform(1.1, 1.8))
    point = random.uniform(-2, 10, (600, 3))
    point[:20] += random.choice([-50.0, 50.0], (20, 1))
    places = check_by_segments(spheres, point, random.integers(0, 600, (6000, 2)))
    assert (places.cavity[:20] == -1).all() and (places.component[:20] == -1).all()


def test_cavities_of_random_balls_are_found_by_their_points() -> None:
    """Scenes with many cavities and with islands; every cavity that is large enough has points."""
    cavities = 0
    for seed in range(6):
        spheres = random_spheres(seed, 330, 10.0, 1.2)
        check_volumes(spheres, 100_000, seed)
        cavities += int((~Surroundings(spheres).shells.outer).sum())
    assert cavities > 10


def test_cavities_of_a_protein() -> None:
    """HIV-1 protease, its balls enlarged: shares of points among the atoms that line a cavity, and free segments."""
    index = molviz.Index(SAMPLES / "1hpv.pdb.gz", no_water=True, probe=1.0)
    graph = boundary_graph(index.spheres)
    shell, ball = lining(graph, index.shells)
    random, hidden = np.random.default_rng(2), []
    cavities = np.flatnonzero(~index.shells.outer)
    assert len(cavities) > 50
    for cavity in cavities[:10].tolist():
        center = index.spheres.center[ball[shell == cavity]]
        low, high = center.min(axis=0), center.max(axis=0)
        point = random.uniform(low, high, (5000, 3))
        found = index.where(point).cavity == cavity
        share = -index.shells.volume[cavity] / np.prod(high - low)
        assert found.mean() == pytest.approx(share, abs=4.5 * np.sqrt(share / 5000))
        hidden.append(point[found][:20])
    point = np.concatenate(hidden)
    pairs = np.argwhere(np.tri(len(point), k=-1) > 0)
    places = check_by_segments(index.spheres, point, pairs)
    assert len(set(places.cavity.tolist())) == 10


def test_balls_in_balls_and_balls_twice() -> None:
    center = np.array([[0.0, 0, 0], [0, 0, 0], [0, 0, 0.5], [0, 0, 5], [0, 0, 5]])
    surroundings = Surroundings(Spheres(center, np.array([1.0, 1.0, 0.5, 0.5, 0.25])))
    places = surroundings.at(np.array([[0, 0, 0.5], [0, 0, 5], [0, 0, 3], [0, 0.0, -3], [0, 0, 1]]))
    assert places.component.tolist() == [0, 1, -1, -1, -1] and places.cavity.tolist() == [-1] * 5


def test_from_python() -> None:
    index = molviz.Index((HOLLOW, np.full(26, RADIUS)))
    places = index.where([[0, 0, 0], [0, 0, 1], [0, 0, 9]])
    assert (places.component.tolist(), places.cavity.tolist()) == ([-1, 0, -1], [1, -1, -1])
    assert index.shells.outer.tolist() == [True, False] and index.shells.parent.tolist() == [-1, 0]
    assert index.where(np.empty((0, 3))).cavity.tolist() == []
    surface = molviz.surface((HOLLOW, np.full(26, RADIUS)), probe=0)
    assert [part.kind for part in surface.components] == ["outer", "cavity"]
    assert np.array_equal(index.shells.volume, surface.shells.volume)
    with pytest.raises(InputError, match="points: row 0 is not finite"):
        index.where([[np.nan, 0, 0]])
    with pytest.raises(InputError, match="lost in the rounding"):
        molviz.Index(([[0, 0, 0], [1e19, 0, 0]], [1, 1])).where([[0, 0, 0]])
