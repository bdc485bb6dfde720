"""Starting orientations and rotations."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.model.spheres import Spheres
from molviz.visibility.view import View, file_axes, principal_axes


def unit(center: object) -> Spheres:
    points = np.array(center, dtype=float)
    return Spheres(points, np.ones(len(points)))


@given(st.integers(0, 10**6))
def test_principal_axes_do_not_depend_on_how_the_molecule_was_turned(seed: int) -> None:
    random = np.random.default_rng(seed)
    points = random.normal(size=(20, 3)) * [5, 3, 1]
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    turn *= np.linalg.det(turn)
    one = principal_axes(unit(points)).of(unit(points)).center
    other = principal_axes(unit(points @ turn.T)).of(unit(points @ turn.T)).center
    assert np.allclose(one - one[0], other - other[0], atol=1e-6)


def test_the_widest_side_lies_across_the_page() -> None:
    seen = principal_axes(unit([[0, 0, 0], [0, 0, 9], [0, 1, 3], [0.1, 0, 4]])).of(unit([[0, 0, 0], [0, 0, 9]])).center
    assert abs(seen[1, 0] - seen[0, 0]) > 8.5


@pytest.mark.parametrize("corner", [1.0, -1.0])
def test_a_cube_keeps_the_axes_of_its_file(corner: float) -> None:
    cube = unit([[x, y, z] for x in (0, corner) for y in (0, corner) for z in (0, corner)])
    assert np.allclose(principal_axes(cube).rotation, np.eye(3))


@given(st.integers(0, 10**6))
def test_frames_are_rotations(seed: int) -> None:
    points = np.random.default_rng(seed).integers(0, 2, (6, 3))
    frame = principal_axes(unit(points)).rotation
    assert np.allclose(frame @ frame.T, np.eye(3)) and np.isclose(np.linalg.det(frame), 1)


def test_rotations_are_right_handed_about_the_axes_of_the_page() -> None:
    view: View = file_axes(unit([[0, 0, 0]])).rotated("z", 90)
    assert np.allclose(view.rotation @ [1, 0, 0], [0, 1, 0])
    assert np.allclose(view.rotated("x", 90).rotation @ [1, 0, 0], [0, 0, 1])
