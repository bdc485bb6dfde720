"""What Python users see of the map."""

import numpy as np
import pytest

from molviz.errors import InputError
from molviz.model.molecule import Molecule
from molviz.pipeline.door import visible
from molviz.visibility.view import View
from tests.zbuffer import entry


def balls(*rows: tuple[float, float, float, float]) -> Molecule:
    table = np.array(rows)
    return Molecule.of("balls", table[:, :3], np.full(len(rows), "C"), radius=table[:, 3])


def straight(distance: float | None = None) -> View:
    return View(np.eye(3), np.zeros(3), distance)


def test_a_ball_in_front_hides_its_disc_of_a_larger_one() -> None:
    seen = visible(balls((0, 0, 5, 1), (0, 0, 0, 2)), straight())
    assert np.allclose(seen.area, [np.pi, 3 * np.pi], rtol=1e-3)
    assert np.allclose(seen.fraction, [1, 0.75], rtol=1e-3)
    assert sorted(zip(seen.left.tolist(), seen.right.tolist(), strict=True)) == [(0, 1), (1, -1)]
    assert seen.silhouette.tolist() == (seen.right == -1).tolist()
    jump = seen.depth_jump[seen.right == 1]
    assert np.allclose(jump, 5 - np.sqrt(3), atol=1e-3)
    seen.check()


def test_a_hidden_atom_has_no_area() -> None:
    seen = visible(balls((0, 0, 5, 2), (0, 0, 0, 1)), straight())
    assert seen.area[1] == 0 and seen.fraction[1] == 0


def test_two_equal_fused_balls_share_a_crease_without_a_jump() -> None:
    seen = visible(balls((-0.5, 0, 0, 1), (0.5, 0, 0, 1)), straight())
    crease = seen.map.is_crease()
    assert crease.sum() == 1 and seen.depth_jump[crease].tolist() == [0.0]
    assert np.isclose(seen.area[0], seen.area[1], rtol=1e-3)


def test_perspective_shows_nearer_balls_larger() -> None:
    seen = visible(balls((-3, 0, 4, 1), (3, 0, -4, 1)), straight(20.0))
    assert seen.area[0] > 1.5 * seen.area[1]
    assert np.allclose(seen.fraction, 1)
    seen.check()


def test_a_depth_jump_in_perspective_is_measured_along_the_line_of_sight() -> None:
    """From 20 Å the ball at 15 Å is touched at √(15² − 1) along lines of sight with sin α = 1/15.

    These enter the ball of radius R at D = 20 Å after ``D cos α − √(R² − D² sin² α)``.
    """
    seen = visible(balls((0, 0, 5, 1), (0, 0, 0, 3)), straight(20.0))
    jump = seen.depth_jump[seen.right == 1]
    cosine = np.sqrt(1 - 1 / 15**2)
    assert np.allclose(jump, 20 * cosine - np.sqrt(9 - (20 / 15) ** 2) - np.sqrt(15**2 - 1), atol=1e-3)
    assert seen.depth_jump[seen.right == -1].tolist() == [np.inf]


def test_depth_jumps_in_perspective_are_those_of_rays_through_the_page() -> None:
    """Horizons are as far as tangents are long, √(D² − r²); what lies behind is met along the ray."""
    table = np.array([(3, 1, 5, 1), (3.5, 0, 0, 2), (-4, 2, 1, 1.5), (-4.5, 3.5, -6, 2.5), (2, -1.5, -5, 3)])
    seen = visible(balls(*map(tuple, table)), straight(20.0))
    rows = np.flatnonzero(~seen.map.is_crease() & (seen.right >= 0))
    assert len(rows) >= 3
    arcs = seen.map.arcs.take(rows)
    own, other, center = table[seen.left[rows]], table[seen.right[rows]], table[:, :3] - [0, 0, 20]
    ray = np.column_stack([arcs.at(arcs.start + arcs.sweep / 2), np.full(len(rows), -20.0)])
    tangent = np.sqrt((center[seen.left[rows]] ** 2).sum(axis=1) - own[:, 3] ** 2)
    far = entry(center[seen.right[rows]], other[:, 3], ray)
    assert np.allclose(seen.depth_jump[rows], far - tangent, atol=5e-3) and (seen.depth_jump[rows] > 0.1).all()


def test_an_eye_among_the_atoms_is_refused() -> None:
    with pytest.raises(InputError, match="in front of all atoms"):
        visible(balls((0, 0, 0, 1), (0, 0, 3, 1)), straight(3.5))
