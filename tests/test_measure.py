"""Area and volume against closed forms, an independent method, sampling, and themselves moved."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from molviz.geometry.boundary import union_boundary
from molviz.geometry.measure import measure_spheres
from molviz.model.spheres import Spheres
from tests.closed_forms import cap_area, lens_volume, union_of_three
from tests.measure_oracle import all_free_arcs, gauss_bonnet_areas, paper_volume, rim
from tests.oracle import random_spheres

BALL = 4 * np.pi / 3


def rotation(seed: int) -> np.ndarray:
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return q * np.linalg.det(q)


def rotated(spheres: Spheres, seed: int) -> Spheres:
    return Spheres(spheres.center @ rotation(seed).T, spheres.radius)


def varied_spheres(seed: int) -> Spheres:
    """Two to twelve balls, radii over a factor of ten, from scattered to one inside the other."""
    random = np.random.default_rng(seed)
    count = random.integers(2, 13)
    extent = random.uniform(1, 6)
    return Spheres(random.uniform(0, extent, (count, 3)), 0.5 * 10 ** random.uniform(0, 1, count))


def far_from_pole(spheres: Spheres) -> Spheres:
    """The best of some rotations for projecting all spheres from their topmost points."""

    def distance(turned: Spheres) -> float:
        rims = [(i, rim(turned, i, j)) for i in range(len(turned.radius)) for j in range(len(turned.radius)) if i != j]
        gaps = [
            abs((found.center - turned.center[i]) @ found.axis / turned.radius[i] - found.axis[2])
            for i, found in rims
            if found is not None
        ]
        return min(gaps, default=1.0)

    return max((rotated(spheres, seed) for seed in range(8)), key=distance)


# ---- closed forms


@given(st.floats(0.3, 3), st.floats(0.3, 3), st.floats(0.01, 0.99), st.integers(0, 10_000))
def test_two_balls(r1: float, r2: float, part: float, seed: int) -> None:
    d = abs(r1 - r2) + part * 2 * min(r1, r2)
    measure = measure_spheres(rotated(Spheres(np.array([[0, 0, 0], [0, 0, d]]), np.array([r1, r2])), seed))
    expected = [4 * np.pi * r1**2 - cap_area(r1, r2, d), 4 * np.pi * r2**2 - cap_area(r2, r1, d)]
    assert np.allclose(measure.area, expected, rtol=0, atol=1e-11)
    assert abs(measure.volume - (BALL * (r1**3 + r2**3) - lens_volume(r1, r2, d))) < 1e-10


@given(st.integers(0, 100_000))
def test_three_balls_and_their_derivatives_by_radius(seed: int) -> None:
    random = np.random.default_rng(seed)
    spheres = Spheres(random.uniform(0, 2, (3, 3)), random.uniform(0.5, 2, 3))
    before = union_boundary(spheres).arcs.before
    assume(len(before) == 3 and before.min() >= 0)
    measure = measure_spheres(spheres)
    volume = union_of_three(spheres.center, spheres.radius.astype(complex)).real
    steps = 1e-30j * np.eye(3)
    area = [union_of_three(spheres.center, spheres.radius + step).imag / 1e-30 for step in steps]
    assert abs(measure.volume - volume) < 1e-8
    assert np.allclose(measure.area, area, rtol=0, atol=1e-7)


def test_no_ball_and_one() -> None:
    nothing = measure_spheres(Spheres(np.empty((0, 3)), np.empty(0)))
    assert (len(nothing.area), nothing.volume) == (0, 0.0)
    one = measure_spheres(Spheres(np.array([[7.0, 8, 9]]), np.array([1.5])))
    assert np.allclose([*one.area, one.volume], [9 * np.pi, BALL * 1.5**3], rtol=1e-15)


# ---- special position


def equal_balls_whose_caps_do_not_overlap(center: np.ndarray, radius: float, side: float) -> tuple[float, float]:
    """Area and volume where every ball meets those ``side`` away, and what it cuts off them is disjoint."""
    gap = np.linalg.norm(center[:, None] - center, axis=2)
    pairs = np.sum(np.triu(np.abs(gap - side) < 1e-9, 1))
    area = len(center) * 4 * np.pi * radius**2 - 2 * pairs * cap_area(radius, radius, side)
    return area, float(len(center) * BALL * radius**3 - pairs * lens_volume(radius, radius, side).real)


def lattice(*counts: int) -> np.ndarray:
    return np.array(list(np.ndindex(*counts)), dtype=float)


RING = np.array([[np.cos(k * np.pi / 3), np.sin(k * np.pi / 3), 0] for k in range(6)])
SPECIAL = {
    "four balls touching in their middle": (lattice(2, 2, 1), 0.5**0.5, 1.0),
    "four spheres through one point of each face": (lattice(2, 2, 2), 0.5**0.5, 1.0),
    "a lattice, every crease tangent to four others": (lattice(4, 4, 4), 0.5**0.5, 1.0),
    "a lattice": (lattice(5, 4, 3), 0.6, 1.0),
    "a ring of six": (RING, 0.7, 1.0),
    "a line": (lattice(6, 1, 1), 0.9, 1.0),
    "balls that touch": (lattice(3, 3, 3), 0.5, 1.0),
}


@pytest.mark.parametrize("move", ["as written", "turned", "far away"])
@pytest.mark.parametrize("name", SPECIAL)
def test_special_position(name: str, move: str) -> None:
    center, radius, side = SPECIAL[name]
    area, volume = equal_balls_whose_caps_do_not_overlap(center, radius, side)
    placed = {"as written": center, "turned": center @ rotation(1).T, "far away": center @ rotation(2).T + 1e4}[move]
    measure = measure_spheres(Spheres(placed, np.full(len(center), radius)))
    assert abs(measure.area.sum() - area) < 1e-6
    assert abs(measure.volume - volume) < 1e-6


@given(st.integers(0, 100_000), st.sampled_from([0.0, 1e4]))
def test_a_pencil_of_spheres_through_one_circle(seed: int, shift: float) -> None:
    """Only the two outermost reach the boundary, each with the part beyond the circle's plane."""
    random = np.random.default_rng(seed)
    count = random.integers(2, 7)
    x = np.sort(random.choice(np.arange(-8, 9), count, replace=False) / 4)
    radius = np.sqrt(x**2 + 1.3**2)
    height = np.array([radius[0] - x[0], radius[-1] + x[-1]])
    outer = radius[[0, -1]]
    order = random.permutation(count)
    spheres = Spheres(np.outer(x, rotation(seed)[0])[order] + shift, radius[order])
    measure = measure_spheres(spheres)
    assert abs(measure.area.sum() - 2 * np.pi * np.sum(outer * height)) < 1e-8
    assert abs(measure.volume - np.pi * np.sum(height**2 * (3 * outer - height)) / 3) < 1e-8


@pytest.mark.parametrize(
    ("center", "radius", "like"),
    [
        ([[0, 0, 0], [0, 0, 0], [1, 0, 0]], [1, 1, 1], [0, 2]),
        ([[0, 0, 0], [0, 0, 0], [1, 0, 0]], [2, 1, 1.5], [0, 2]),
        ([[0, 0, 0], [0.5, 0, 0], [3, 0, 0]], [2, 1, 1.5], [0, 2]),
        ([[0, 0, 0], [1, 0, 0]], [2, 1], [0]),
        ([[0, 0, 0], [1e-13, 0, 0], [1, 1, 1], [1, 1, 1 + 1e-13]], [1, 1, 1, 1 + 1e-14], [0, 2]),
        ([[0, 0, 0], [1, 1, 1]], [1, 1e-7], [0]),
    ],
    ids=["duplicate", "one centre", "enclosed", "tangent inside", "nearly duplicate", "a speck"],
)
def test_balls_that_add_nothing(center: list[list[float]], radius: list[float], like: list[int]) -> None:
    spheres = Spheres(np.array(center, dtype=float), np.array(radius, dtype=float))
    whole, part = measure_spheres(spheres), measure_spheres(Spheres(spheres.center[like], spheres.radius[like]))
    assert abs(whole.area.sum() - part.area.sum()) < 1e-9
    assert abs(whole.volume - part.volume) < 1e-9


def test_a_shell_of_balls_has_two_sides_and_buries_what_it_covers() -> None:
    shell = np.concatenate([RING @ rotation(seed).T for seed in range(40)])
    with_core = Spheres(np.vstack([shell, np.zeros((1, 3))]), np.append(np.full(240, 0.5), 0.3))
    measure = measure_spheres(with_core)
    solid = measure_spheres(Spheres(with_core.center, np.append(np.full(240, 0.5), 0.8)))
    assert abs(measure.area[-1] - 4 * np.pi * 0.09) < 1e-12
    assert solid.area[-1] == 0
    assert measure.area.sum() > solid.area.sum() + 4 * np.pi * 0.5**2
    assert BALL * 1.3**3 < solid.volume < BALL * 1.5**3


@pytest.mark.parametrize("radius", [0.9, 3**0.5 / 2], ids=["meeting in pairs of points", "all through one point"])
def test_a_cube_of_balls_is_the_limit_of_general_position(radius: float) -> None:
    cube = Spheres(lattice(2, 2, 2), np.full(8, radius))
    jittered = Spheres(cube.center + np.random.default_rng(4).uniform(-1e-7, 1e-7, (8, 3)), cube.radius)
    area = gauss_bonnet_areas(jittered, all_free_arcs(jittered))
    assert np.allclose(measure_spheres(cube).area, area, rtol=0, atol=2e-6)


@given(st.integers(0, 10**6), st.sampled_from([1e-10, 1e-9, 1e-8, 1e-6]))
@settings(max_examples=60)
def test_lattice_points_are_the_limit_of_nearly_lattice_points(seed: int, jitter: float) -> None:
    """Tangent, coincident, equal and nearly equal spheres, and pencils, by chance of few coordinates and radii."""
    random = np.random.default_rng(seed)
    count = random.integers(2, 12)
    center = random.integers(0, random.integers(2, 5), (count, 3)) * [1.0, 1.0, seed % 3 > 0]
    radius = np.sqrt(random.choice([0.25, 0.5, 0.75, 1, 1.25, 1.5, 2, 3, 5, 9], count))
    moved = center + random.uniform(-jitter, jitter, center.shape)
    shaken = Spheres(moved, radius * (1 + jitter * random.random(count)))
    exact, near = measure_spheres(Spheres(center, radius)), measure_spheres(shaken)
    assert abs(exact.area.sum() - near.area.sum()) < 1e-5 * exact.area.sum()
    assert abs(exact.volume - near.volume) < 1e-5 * exact.volume


# ---- the independent method


@given(st.integers(0, 10**6))
@settings(max_examples=60)
def test_random_balls_by_gauss_bonnet_and_by_the_printed_integrals(seed: int) -> None:
    spheres = far_from_pole(varied_spheres(seed))
    measure, arcs = measure_spheres(spheres), all_free_arcs(spheres)
    area = gauss_bonnet_areas(spheres, arcs)
    assert np.allclose(measure.area, area, rtol=0, atol=1e-9 * area.sum())
    assert abs(measure.volume - paper_volume(spheres, arcs, area)) < 1e-9 * measure.volume


def test_volume_by_sampling() -> None:
    spheres = random_spheres(5, 30, 5.0)
    points = np.random.default_rng(6).uniform(-2, 7, (200_000, 3))
    inside = np.zeros(len(points), dtype=bool)
    for center, radius in zip(*spheres, strict=True):
        inside |= np.sum((points - center) ** 2, axis=1) < radius**2
    share = inside.mean()
    error = 9**3 * np.sqrt(share * (1 - share) / len(points))
    assert abs(measure_spheres(spheres).volume - 9**3 * share) < 4 * error


# ---- moved, and moving


@given(st.integers(0, 10_000), st.integers(2, 40), st.floats(0.1, 30))
def test_moving_reordering_and_scaling(seed: int, count: int, factor: float) -> None:
    spheres = random_spheres(seed, count, 5.0, 3.0)
    order = np.random.default_rng(seed).permutation(count)
    moved = Spheres(factor * (spheres.center @ rotation(seed).T)[order] + 1e4, factor * spheres.radius[order])
    before, after = measure_spheres(spheres), measure_spheres(moved)
    total = before.area.sum()
    assert np.allclose(after.area, factor**2 * before.area[order], rtol=0, atol=1e-9 * factor**2 * total)
    assert abs(after.volume / factor**3 - before.volume) < 1e-9 * before.volume


@given(st.integers(0, 10_000), st.integers(2, 12))
@settings(max_examples=15)
def test_gradients_are_those_of_finite_differences(seed: int, count: int) -> None:
    spheres = random_spheres(seed, count, 4.0)
    measure = measure_spheres(spheres)
    step = 1e-5 * np.random.default_rng(seed).normal(size=(count, 3))
    ahead = measure_spheres(Spheres(spheres.center + step, spheres.radius))
    behind = measure_spheres(Spheres(spheres.center - step, spheres.radius))
    size = 1e-5 * (1 + np.abs(measure.area_gradient).max())
    assert abs((ahead.area.sum() - behind.area.sum()) / 2 - np.sum(measure.area_gradient * step)) < 1e-4 * size
    assert abs((ahead.volume - behind.volume) / 2 - np.sum(measure.volume_gradient * step)) < 1e-4 * size
