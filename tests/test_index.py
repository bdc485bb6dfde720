"""``molviz.Index``: which balls, inside or outside."""

from pathlib import Path

import numpy as np
import pytest

import molviz
from molviz.errors import InputError

SAMPLES = Path(__file__).parent.parent / "samples"
PROTEIN = str(SAMPLES / "1a8o.pdb")


@pytest.fixture(scope="module")
def index() -> molviz.Index:
    return molviz.Index(PROTEIN, probe=0.3)


def points_about(index: molviz.Index, count: int, seed: int = 1) -> np.ndarray:
    low, high = index.spheres.box()
    return np.random.default_rng(seed).uniform(low - 2, high + 2, (count, 3))


def test_answers_equal_all_distances(index: molviz.Index) -> None:
    points = points_about(index, 2000)
    radii = np.random.default_rng(2).uniform(0, 5, 2000)
    gap = np.linalg.norm(points[:, None] - index.spheres.center, axis=2)
    for met, near in [(index.containing(points), gap < index.spheres.radius),
                      (index.meeting(points, radii), gap < index.spheres.radius + radii[:, None]),
                      (index.meeting(points, 1.4), gap < index.spheres.radius + 1.4)]:  # fmt: skip
        assert np.array_equal(np.diff(met.start), near.sum(axis=1))
        assert np.array_equal(met.item, np.nonzero(near)[1])
    inside = index.inside(points)
    assert np.array_equal(inside, (gap < index.spheres.radius).any(axis=1)) and 0 < inside.sum() < 2000


def test_points_inside_are_as_many_as_the_volume_says(index: molviz.Index) -> None:
    """Two independent ways to the volume: points at random, within four standard deviations, and contour integrals."""
    low, high = index.spheres.box()
    points = np.random.default_rng(3).uniform(low, high, (200_000, 3))
    share = molviz.measure(PROTEIN, probe=0.3).volume / np.prod(high - low)
    deviation = np.sqrt(share * (1 - share) / len(points))
    assert index.inside(points).mean() == pytest.approx(share, abs=4 * deviation)


def test_options_are_those_of_the_door() -> None:
    alpha = molviz.Index(PROTEIN, select="name CA", scale_radii=0.5)
    whole = molviz.read(PROTEIN).models[0]
    assert len(alpha.spheres.radius) == len(alpha.molecule) < len(whole)
    assert alpha.containing(alpha.molecule.position).item.tolist() == list(range(len(alpha.molecule)))
    assert (alpha.spheres.radius == 0.85).all()
    assert repr(alpha) == f"<Index of {alpha.molecule.name!r}: {len(alpha.molecule)} balls>"
    with pytest.raises(InputError, match="no atoms are left"):
        molviz.Index(PROTEIN, select="none")
    with pytest.warns(UserWarning, match="guessed"):
        molviz.Index(molviz.Molecule.of("x", [[0, 0, 0]], ["X"]))


def test_single_precision_and_whole_numbers_are_taken_as_they_are() -> None:
    one = molviz.Index(([[0, 0, 0]], [1]))
    nearly = np.float32(0.1)  # a little more than 0.1
    assert one.inside(np.array([[1 - nearly, 0, 0]], dtype=np.float32)).tolist() == [True]
    assert molviz.Index(([[0.1, 0, 0]], [1e-9])).inside(np.full((1, 3), [nearly, 0, 0])).tolist() == [False]
    assert one.inside([[0, 0, 0], [1, 0, 0], [0, 2, 0]]).tolist() == [True, False, False]
    assert one.inside(np.empty((0, 3))).tolist() == [] == one.inside([]).tolist()


@pytest.mark.parametrize(
    ("points", "told"),
    [([0, 0, 0], r"numbers of shape \(3,\); expected \(n, 3\)"), ([[0, 0]], "shape"), ("here", "not a table"),
     ([[0, 0, np.nan]], "row 0 is not finite"), ([[0, 0, 0], [np.inf, 0, 0]], "row 1 is not finite"),
     ([[1e61, 0, 0]], "farther away than 1e"), ([[0, 0, 0], [1, 2]], "not a table"), (None, "shape")],
)  # fmt: skip
def test_what_are_no_points_is_refused(points: object, told: str) -> None:
    one = molviz.Index(([[0, 0, 0]], [1]))
    for ask in (one.containing, one.inside):
        with pytest.raises(InputError, match=f"points: .*{told}"):
            ask(points)
    with pytest.raises(InputError, match=f"centers: .*{told}"):
        one.meeting(points, 1.0)


@pytest.mark.parametrize(
    ("radii", "told"),
    [(-1, "row 0 is -1"), ([1, -2], "row 1 is -2"), (np.nan, "nan; expected"), ([1], "1 for 2 centers"),
     (1e61, "from 0 to 1e"), ("large", "not a table"), (None, "shape")],
)  # fmt: skip
def test_what_are_no_radii_is_refused(radii: object, told: str) -> None:
    with pytest.raises(InputError, match=f"radii: .*{told}"):
        molviz.Index(([[0, 0, 0]], [1])).meeting(np.zeros((2, 3)), radii)
