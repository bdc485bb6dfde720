"""Painter's pieces of balls and sticks: what is painted last is what is seen, and every piece is closed."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

import molviz
from molviz.cli import main
from molviz.geometry.planar_map import UNUSED, loop_areas
from molviz.model.entities import entities_of
from molviz.model.molecule import Molecule
from molviz.model.spheres import Spheres
from molviz.model.sticks import Sticks
from molviz.picture.compose import picture_of_pieces
from molviz.picture.options import DrawOptions, Subject
from molviz.picture.page import Page
from molviz.picture.palette import load_palette
from molviz.picture.picture import Picture, StackedLayer
from molviz.visibility.curves import LINE
from molviz.visibility.eye import eye_coordinates, projection_of
from molviz.visibility.painter import Pieces
from molviz.visibility.scene import Scene, extent
from molviz.visibility.view import View
from tests.render import render_svg, write
from tests.scenes import pieces_of
from tests.stick_scenes import ball_and_stick, licorice, parallel_bonds, plain_sticks, seen_solids
from tests.test_map import safe_points, sampled_face
from tests.test_sticks import SPECIAL, WAYS, looking_along, random_view
from tests.zbuffer import interior, mask_labels

SAMPLES = Path(__file__).parent.parent / "samples"
Maker: TypeAlias = Callable[[int, int], tuple[Spheres, Sticks]]
SIDE = np.eye(3), np.zeros(3)
PIXELS = 300  # along the longer side


def owners(spheres: Spheres, sticks: Sticks) -> np.ndarray:
    """The sphere of each solid that a ray meets; the last row is that of none."""
    halves = np.stack([sticks.first, sticks.second], axis=1).ravel()
    return np.concatenate([np.arange(len(spheres.radius)), halves, [-1]])


def met(spheres: Spheres, sticks: Sticks, view: View, page: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The sphere whose ball or stick half is seen at page points (m, 2), and how much nearer it is than the next."""
    eye, turned = eye_coordinates(spheres, view), sticks._replace(offset=sticks.offset @ view.rotation.T)
    seen, margin = [], []
    for origin, ray in zip(*projection_of(view).rays(page), strict=True):
        one, much = seen_solids(eye, turned, origin[None], ray[None])
        seen.append(one[0])
        margin.append(much[0])
    return owners(spheres, sticks)[np.array(seen, dtype=int)], np.array(margin)


def assert_painted(spheres: Spheres, sticks: Sticks, view: View, seed: int, apart: float = 0.0) -> None:
    """Painted one after the other, the pieces leave at points what lines of sight meet, where that is clear."""
    found = pieces_of(spheres, view, sticks)
    points = safe_points(seed, found.arcs, 4.0)
    painted = np.full(len(points), -1)
    for piece in found.order.tolist():
        inside = sampled_face(found.arcs, found.loops, piece, points)
        assert set(inside.tolist()) <= {0, 1}
        painted[inside > 0] = found.owner[piece]
    seen, margin = met(spheres, sticks, view, points)
    assert np.array_equal(painted[margin > apart], seen[margin > apart])


@given(st.integers(0, 10**6), st.integers(1, 10), st.sampled_from([None, 20.0, 300.0]))
@settings(max_examples=20, deadline=None)
def test_painted_balls_and_sticks_are_what_is_seen(seed: int, count: int, distance: float | None) -> None:
    spheres, sticks = ball_and_stick(seed, count)
    assert_painted(spheres, sticks, random_view(seed, spheres.center, distance), seed)


@given(st.integers(0, 10**6), st.integers(1, 10), st.sampled_from([None, 20.0, 300.0]))
@settings(max_examples=20, deadline=None)
def test_painted_licorice_is_what_is_seen(seed: int, count: int, distance: float | None) -> None:
    spheres, sticks = licorice(seed, count)
    assert_painted(spheres, sticks, random_view(seed, spheres.center, distance), seed)


@given(st.integers(0, 10**6), st.integers(2, 8), st.sampled_from([None, 30.0]))
@settings(max_examples=20, deadline=None)
def test_painted_double_and_triple_bonds_are_what_is_seen(seed: int, count: int, distance: float | None) -> None:
    spheres, sticks = parallel_bonds(seed, count)
    assert_painted(spheres, sticks, random_view(seed, spheres.center, distance), seed, 1e-3)


@pytest.mark.parametrize("distance", [None, 30.0, 3000.0])
@pytest.mark.parametrize("thick", [0.2, 0.36], ids=["licorice", "balls"])
@pytest.mark.parametrize("name", SPECIAL)
def test_pieces_close_along_bonds_planes_and_axes(name: str, thick: float, distance: float | None) -> None:
    center, bonds = SPECIAL[name]
    spheres = Spheres(center.astype(float), np.full(len(center), thick))
    sticks = plain_sticks(np.array(bonds), np.full(len(bonds), 0.2 if thick == 0.2 else 0.12))
    scene = Scene(spheres, None, sticks)
    for way in WAYS:
        found, _ = scene.pieces(looking_along(way, center, distance))
        assert_closed(found)


def assert_closed(found: Pieces) -> None:
    """Every half-edge of a piece has the next one where it ends, and no piece has less than nothing."""
    used = np.flatnonzero(found.edges.face != UNUSED)
    assert np.array_equal(found.edges.origin[found.edges.next[used]], found.edges.origin[used ^ 1])
    area = np.bincount(np.searchsorted(np.sort(found.order), found.loops.face), loop_areas(found.arcs, found.loops))
    assert (area > -1e-9).all()


# ---- masks


def mask_of(spheres: Spheres, sticks: Sticks, view: View) -> tuple[np.ndarray, np.ndarray]:
    """A picking mask of painter's pieces, and what rays through its pixels meet."""
    low, high = extent(spheres, view)
    scale = PIXELS / float((high - low).max())
    picture = painted_picture(spheres, sticks, view, color_by="index", outline=0.0, crease=0.0, page=Page(scale=scale))
    svg = write(picture, ".svg")
    label = mask_labels(render_svg(svg, round(picture.width)))
    size = np.array([picture.width, picture.height]) / scale
    height, width = label.shape
    x = ((np.arange(width) + 0.5) / width - 0.5) * size[0] + (low + high)[0] / 2
    y = (0.5 - (np.arange(height) + 0.5) / height) * size[1] + (low + high)[1] / 2
    page = np.stack(np.meshgrid(x, y), axis=2).reshape(-1, 2)
    return label, rays_meet(spheres, sticks, view, page).reshape(label.shape)


def rays_meet(spheres: Spheres, sticks: Sticks, view: View, page: np.ndarray) -> np.ndarray:
    """The same as ``met`` tells first, of many points."""
    eye, turned = eye_coordinates(spheres, view), sticks._replace(offset=sticks.offset @ view.rotation.T)
    origin, ray = projection_of(view).rays(page)
    return np.concatenate([
        owners(spheres, sticks)[seen_solids(eye, turned, origin[part], ray[part])[0]]
        for part in np.array_split(np.arange(len(page)), len(page) // 20_000 + 1)
    ])  # fmt: skip


def painted_picture(spheres: Spheres, sticks: Sticks, view: View, **look: object) -> Picture:
    molecule = Molecule.of("x", spheres.center, np.full(len(spheres.radius), "C"))
    options = DrawOptions(load_palette("tide"), **look).settled(entities_of(molecule), painted=True)
    pieces, row = Scene(spheres, None, sticks).pieces(view)
    subject = Subject(molecule, entities_of(molecule), row, *extent(spheres, view), np.full(len(molecule), np.nan))
    return picture_of_pieces(pieces, subject, options)


def wrong_pixels(spheres: Spheres, sticks: Sticks, view: View) -> int:
    label, truth = mask_of(spheres, sticks, view)
    inside = interior(truth)
    assert inside.sum() > 10_000
    return int(np.sum(inside & (label != truth)))


@pytest.mark.parametrize("distance", [None, 30.0])
@pytest.mark.parametrize("rep", ["ball-and-stick", "sticks"])
@pytest.mark.parametrize("name", ["caffeine.xyz", "c60.xyz"])
def test_masks_of_samples_are_what_rays_meet(name: str, rep: str, distance: float | None) -> None:
    scene = molviz.Scene(str(SAMPLES / name), rep=rep)
    view = scene.view.rotated("x", 40.0).rotated("y", 65.0)
    assert wrong_pixels(scene.spheres, scene.sticks, View(view.rotation, view.center, distance)) == 0


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("make", [ball_and_stick, licorice])
def test_masks_of_random_scenes_are_what_rays_meet(make: Maker, seed: int) -> None:
    spheres, sticks = make(seed, 4 + 2 * seed)
    assert wrong_pixels(spheres, sticks, random_view(seed, spheres.center)) == 0


def test_the_order_is_a_rule_and_can_fail() -> None:
    """A long stick rises past a small ball: over it where they overlap, but its third's middle lies lower."""
    spheres = Spheres(np.array([[0.0, 0, 0], [12, 0, 12], [3.2, 0, 2.7]]), np.array([0.4, 0.4, 0.1]))
    sticks = plain_sticks(np.array([[0, 1]]), np.array([0.2]))
    label, truth = mask_of(spheres, sticks, View(*SIDE))
    assert np.sum(interior(truth) & (label != truth)) > 0


# ---- what the pieces are


def test_a_stick_is_four_pieces_in_the_order_of_its_axis_with_the_colours_of_its_balls() -> None:
    """It rises by 3 from a ball at height 0: thirds at 0.5, 1.5, 2.5; of the middle one the farther half comes last."""
    spheres = Spheres(np.array([[0.0, 0, 0], [3, 0, 3]]), np.array([0.4, 0.3]))
    found = pieces_of(spheres, View(*SIDE), plain_sticks(np.array([[0, 1]]), np.array([0.2])))
    assert found.order.tolist() == [0, 2, 4, 3, 5, 1]
    assert found.owner.tolist() == [0, 1, 0, 0, 1, 1] and found.spheres().tolist() == [0, 1]
    assert repr(found).startswith("<Pieces: 6 of 2 spheres")


@pytest.mark.parametrize(("radius", "parts"), [(0.4, [0, 1, 2, 3]), (0.6, [1, 2, 3]), (0.9, [2, 3]), (1.1, [3])])
def test_parts_inside_a_ball_belong_to_the_next(radius: float, parts: list[int]) -> None:
    spheres = Spheres(np.array([[0.0, 0, 0], [1.5, 0, 0.3]]), np.array([radius, 0.2]))
    found = pieces_of(spheres, View(*SIDE), plain_sticks(np.array([[0, 1]]), np.array([0.1])))
    assert sorted(found.order.tolist()) == [0, 1, *(2 + part for part in parts)]


def test_lines_and_rims_are_drawn_but_no_borders_and_seams() -> None:
    spheres = Spheres(np.array([[0.0, 0, 0], [3, 0, 1]]), np.array([0.4, 0.4]))
    sticks = plain_sticks(np.array([[0, 1]]), np.array([0.2]))
    (stack,) = painted_picture(spheres, sticks, View(*SIDE), outline=1.0, crease=1.0).layers
    assert isinstance(stack, StackedLayer)
    crease, outline = stack.strokes
    assert np.diff(crease.paths.shape_start).tolist() == [0, 1, 0, 0, 1, 1]  # both rims of the stick, one of a ball
    assert np.diff(outline.paths.shape_start).tolist() == [1, 2, 2, 2, 2, 1]
    (stack,) = painted_picture(Spheres(spheres.center, np.full(2, 0.2)), sticks, View(*SIDE), crease=1.0).layers
    assert isinstance(stack, StackedLayer) and len(stack.strokes[0].paths.arcs.start) == 0


def test_strokes_of_lines_run_on_over_the_borders_of_parts() -> None:
    spheres = Spheres(np.array([[0.0, 0, 0], [3, 0, 1]]), np.array([0.4, 0.4]))
    found = pieces_of(spheres, View(*SIDE), plain_sticks(np.array([[0, 1]]), np.array([0.2])))
    line = found.curves.kind[found.curve_arcs.curve] == LINE
    more = found.strokes.sweep - found.arcs.sweep
    assert line.sum() == 8 and (more[line] > 0.09).all() and not more[~line].any()


def test_spheres_alone_are_their_own_pieces() -> None:
    found, _ = molviz.Scene(str(SAMPLES / "caffeine.xyz")).pieces()
    assert np.array_equal(found.owner, np.arange(24)) and np.array_equal(np.sort(found.order), found.spheres())


# ---- the command line


@pytest.mark.parametrize("suffix", [".svg", ".ps", ".eps", ".pdf"])
@pytest.mark.parametrize("rep", ["ball-and-stick", "sticks"])
def test_sticks_are_painted_in_every_format(tmp_path: Path, rep: str, suffix: str) -> None:
    target = tmp_path / f"x{suffix}"
    words = ["draw", str(SAMPLES / "caffeine.xyz"), "--method", "painter", "--rep", rep, "-o", str(target)]
    result = CliRunner().invoke(main, [*words, "--perspective", "20"])
    assert result.exit_code == 0, result.output
    assert target.stat().st_size > 1000 and "24 atoms read, 24 drawn, 24 visible" in result.stderr


@pytest.mark.parametrize("suffix", [".svg", ".hpgl", ".pdf"])
def test_hidden_lines_of_sticks_are_lines_of_the_exact_map(tmp_path: Path, suffix: str) -> None:
    target = tmp_path / f"x{suffix}"
    words = ["hidden-lines", str(SAMPLES / "caffeine.xyz"), "--rep", "sticks", "-o", str(target)]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 0, result.output
    assert target.stat().st_size > 500
    if suffix == ".svg":
        text = target.read_text()
        assert 'id="silhouette"' in text and 'id="crease"' not in text and "regions" not in text
        map_lines = molviz.draw(str(SAMPLES / "caffeine.xyz"), rep="sticks", style="flat", fill="none").svg()
        assert re.findall(r' d="[^"]+"', text) == re.findall(r' d="[^"]+"', map_lines)
