"""Franklin's algorithm against brute force, on random and on degenerate scenes, whatever the grid."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.discs import bands
from molviz.discs.bands import visible_perimeters
from molviz.discs.grid import UNIT_SQUARE, Grid, bounding_square, franklin_count
from molviz.geometry.circles import CircleArcs
from molviz.model.scenes import random_scene, text_scene
from molviz.model.spheres import Spheres
from tests import disc_oracle
from tests.disc_scenes import discs_of, random_discs, scene_of

EQUAL = 1e-9  # radians


def arcs_on(scene: Spheres, count: int) -> CircleArcs:
    grid = Grid(bounding_square(scene), count)
    return visible_perimeters(scene, grid)[0]


def assert_equal(arcs: CircleArcs, expected: list[list[tuple[float, float]]]) -> None:
    """Compare circle by circle; an arc that starts within rounding of θ = 0 may come first or last."""
    for number, wanted in enumerate(expected):
        mine = arcs.circle == number
        found = sorted(zip(np.mod(arcs.start[mine] + 1e-7, 2 * math.pi), arcs.sweep[mine], strict=True))
        wanted = sorted(((start + 1e-7) % (2 * math.pi), sweep) for start, sweep in wanted)
        assert len(found) == len(wanted), f"circle {number}: {found} instead of {wanted}"
        assert not wanted or np.allclose(found, wanted, rtol=0, atol=EQUAL)


@pytest.mark.parametrize("seed", range(300))
def test_arcs_equal_brute_force_on_every_grid(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scene = random_discs(rng)
    expected = disc_oracle.visible_arcs(discs_of(scene))
    coarse_to_fine = [1, int(rng.integers(2, 40)), 1000 if seed % 25 == 0 else 100]
    for count in [franklin_count(scene.radius, bounding_square(scene)), *coarse_to_fine]:
        assert_equal(arcs_on(scene, count), expected)


@pytest.mark.parametrize(
    ("far", "near", "sweep"),
    [
        ((0, 0, 1, 1), (0, 0, 0, 1), []),  # coincident: the nearer hides the farther
        ((0, 0, 0, 1), (0, 0, 0, 1), []),  # identical: the lower row is nearer
        ((0, 0, 1, 1), (0, 0, 0, 2), []),  # concentric, larger in front
        ((0, 0, 1, 2), (0, 0, 0, 1), [1.0]),  # concentric, smaller in front
        ((0, 0, 1, 1), (2, 0, 0, 1), [1.0]),  # tangent from outside
        ((1, 0, 1, 1), (0, 0, 0, 2), []),  # tangent from inside, larger in front
        ((0, 0, 1, 2), (1, 0, 0, 1), [1.0]),  # tangent from inside, smaller in front
        ((0, 0, 1, 1), (1, 0, 0, 1), [2 / 3]),  # a third hidden
        ((0.1, 0, 1, 0.1), (0.3, 0, 0, 0.1), [1.0]),  # tangent but for rounding
        ((0, 0, 1, 1), (1e-13, 0, 0, 1), [0.5]),  # nearly coincident: half of it peeps out
    ],
)
@pytest.mark.parametrize("count", [1, 4, 37])
def test_two_discs(far: disc_oracle.Disc, near: disc_oracle.Disc, sweep: list[float], count: int) -> None:
    arcs = arcs_on(scene_of([near, far]), count)
    assert np.allclose(arcs.sweep[arcs.circle == 1] / (2 * math.pi), sweep, atol=1e-9)
    assert arcs.sweep[arcs.circle == 0].tolist() == [2 * math.pi]


def test_ends_name_the_discs_that_hide_beyond_them() -> None:
    arcs = arcs_on(scene_of([(1, 0, 0, 1), (-1, 0.5, 0, 1), (0, 0, 1, 1), (9, 0, 0, 1)]), 5)
    mine = arcs.circle == 2
    assert (arcs.before[mine].tolist(), arcs.after[mine].tolist()) == ([0, 1], [1, 0])
    assert arcs.before[arcs.circle == 3].tolist() == [-1]


def test_franklins_own_run() -> None:
    """N = 10,000, R = 0.0178, G = 142: the figures of his Fig. 8, within the spread of random scenes."""
    scene, grid = random_scene(10000, radius=0.0178), Grid(UNIT_SQUARE, 142)
    arcs, work = visible_perimeters(scene, grid)
    pieces = np.bincount(arcs.circle, minlength=10000)
    whole = np.count_nonzero(arcs.before < 0)
    assert work.cells_blocked == pytest.approx(19337, rel=0.05)
    assert np.count_nonzero(pieces == 0) == pytest.approx(6635, rel=0.05)
    assert arcs.sweep.sum() / (2 * math.pi) == pytest.approx(1037.48, rel=0.05)
    assert work.cell_entries == pytest.approx(39560, rel=0.1)
    assert work.pairs_tested == pytest.approx(71136, rel=0.1)
    assert work.pairs_intersecting == pytest.approx(32115, rel=0.1)
    assert whole == pytest.approx(250, rel=0.1)


def test_input_order_does_not_matter() -> None:
    scene = random_scene(500, depth=8, seed=3)
    shuffle = np.random.default_rng(0).permutation(500)
    mixed = Spheres(scene.center[shuffle], scene.radius[shuffle])
    arcs, other = arcs_on(scene, 40), arcs_on(mixed, 40)
    order = np.lexsort((other.start, shuffle[other.circle]))
    assert np.array_equal(arcs.circle, shuffle[other.circle][order])
    assert np.allclose(arcs.sweep, other.sweep[order], atol=EQUAL)


def test_a_word_of_tangent_spheres_equals_brute_force() -> None:
    scene = text_scene("I")
    assert_equal(arcs_on(scene, 30), disc_oracle.visible_arcs(discs_of(scene)))


def test_one_disc_far_from_the_origin() -> None:
    assert arcs_on(scene_of([(1e6, -1e6, 0, 1)]), 8).sweep.tolist() == [2 * math.pi]


@given(st.integers(0, 10**6), st.integers(1, 60), st.integers(1, 9), st.integers(1, 12), st.booleans())
@settings(max_examples=60)
def test_bands_give_the_arcs_and_the_work_of_the_whole(
    seed: int, count: int, band: int, across: int, on_lines: bool
) -> None:
    random = np.random.default_rng(seed)
    center, radius = random.random((count, 3)), random.uniform(0.01, 0.3, count)
    if on_lines:  # discs that touch rows of cells and each other, and lie one on another
        center, radius = np.round(center * across) / across, np.ceil(radius * across) / across
    scene = Spheres(center, radius)
    grid = Grid(bounding_square(scene), across)
    whole = visible_perimeters(scene, grid)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bands, "BAND_DISCS", band)
        parts = visible_perimeters(scene, grid)
    assert whole[1] == parts[1]
    for one, other in zip(whole[0], parts[0], strict=True):
        assert np.array_equal(one, other)
