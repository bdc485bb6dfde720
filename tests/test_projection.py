"""The formulas of both projections against rays, sampling and the definitions of tangents; T-junctions counted by hand.

Spheres are in view coordinates moved so that a central eye is the origin; for a parallel view it is far up the z axis.
"""

from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.geometry.circles import circles_about
from molviz.model.spheres import Spheres
from molviz.visibility import culling
from molviz.visibility.curves import HORIZON, Curves, creases_of
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.view import file_axes
from tests.oracle import heights, random_spheres
from tests.pages import STRAIGHT, horizons, kept, margins, occluders, projection, shadow_signs, tees
from tests.scenes import map_of
from tests.zbuffer import central_zbuffer, entry, image_boxes, zbuffer

AWAY = 20.0  # ångström of a central eye from the page
EYES = pytest.mark.parametrize("distance", [None, AWAY], ids=["parallel", "central"])
TURN = 2 * np.pi
CLEAR = 1e-6  # ångström: a decision nearer to its border than that is rounding's


def scene(seed: int, distance: float | None, count: int = 12) -> Spheres:
    """Balls about the middle of the page, in eye coordinates."""
    spheres = random_spheres(seed, count, 8.0, 3.0)
    return Spheres(spheres.center - 4.0 - [0.0, 0.0, distance or 0.0], spheres.radius)


def all_pairs(spheres: Spheres) -> tuple[np.ndarray, np.ndarray]:
    own, other = np.divmod(np.arange(len(spheres.radius) ** 2), len(spheres.radius))
    return own[own != other], other[own != other]


def to_eye(points: np.ndarray, distance: float | None) -> np.ndarray:
    """Unit vectors (m, 3) from points to the eye."""
    up = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    return up if distance is None else -points / np.linalg.norm(points, axis=1)[:, None]


def hidden_by(spheres: Spheres, sphere: np.ndarray, points: np.ndarray, distance: float | None) -> np.ndarray:
    """How deep inside the ball or behind it each point lies, in ångström; negative where the eye sees it.

    The line from the point to the eye meets the ball where its nearest point to the centre does; the point is hidden
    if that lies between the point and the eye, or else if the point itself is inside.
    """
    sight, offset = to_eye(points, distance), spheres.center[sphere] - points
    along = np.maximum((offset * sight).sum(axis=1), 0.0)  # the foot may lie behind the point: then it is the point
    return spheres.radius[sphere] - np.linalg.norm(offset - along[:, None] * sight, axis=1)


def random_circles(seed: int, spheres: Spheres, count: int) -> Curves:
    random = np.random.default_rng(seed)
    axis = random.normal(size=(count, 3))
    center = spheres.center.mean(axis=0) + random.uniform(-4, 4, (count, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    first, radius = np.zeros(count, dtype=np.int64), random.uniform(0.1, 3, count)
    return creases_of(circles_about(first, first + 1, center, axis, radius))


@EYES
@given(st.integers(0, 10**6))
@settings(max_examples=10)
def test_lines_of_sight_touch_spheres_on_their_horizons(distance: float | None, seed: int) -> None:
    """(p − c) · (p − eye) = 0 and |p − c| = r, the axis a × b towards the eye."""
    spheres = scene(seed, distance)
    circles, row = horizons(spheres, distance), np.repeat(np.arange(12), 7)
    points = circles.at(row, np.tile(np.linspace(0, 6, 7), 12))
    spoke = points - spheres.center[row]
    assert np.allclose((spoke * to_eye(points, distance)).sum(axis=1), 0, atol=1e-9)
    assert np.allclose(np.linalg.norm(spoke, axis=1), spheres.radius[row])
    normal = np.cross(circles.a, circles.b)
    assert np.allclose((circles.a * circles.b).sum(axis=1), 0, atol=1e-9)
    assert ((normal * to_eye(spheres.center, distance)).sum(axis=1) > 0.999 * np.linalg.norm(normal, axis=1)).all()
    assert circles.first.tolist() == circles.second.tolist() == list(range(12)) and (circles.kind == HORIZON).all()


@EYES
@given(st.integers(0, 10**6))
@settings(max_examples=15)
def test_horizon_margins_are_positive_exactly_where_the_other_sphere_hides(distance: float | None, seed: int) -> None:
    spheres = scene(seed, distance)
    own, other = (np.repeat(column, 9) for column in all_pairs(spheres))
    angle = np.random.default_rng(seed).uniform(0, TURN, len(own))
    depth = hidden_by(spheres, other, horizons(spheres, distance).at(own, angle), distance)
    clear = np.abs(depth) > CLEAR
    assert clear.sum() > 900 and (depth > CLEAR).sum() > 10
    assert ((margins(spheres, distance, own, other, angle) > 0) == (depth > 0))[clear].all()


@EYES
@given(st.integers(0, 10**6))
@settings(max_examples=15)
def test_shadows_begin_at_the_plane_of_the_horizon_and_end_at_the_cone(distance: float | None, seed: int) -> None:
    """Behind the plane a point is hidden exactly inside the cone; the plane is that of three horizon points."""
    spheres = scene(seed, distance)
    circles, random = random_circles(seed, spheres, 400), np.random.default_rng(seed)
    sphere, angle = random.integers(0, 12, 400), random.uniform(0, TURN, 400)
    plane, cone = shadow_signs(spheres, distance, circles, sphere, angle)
    points, rims = circles.at(np.arange(400), angle), horizons(spheres, distance)
    base = rims.at(sphere, np.zeros(400))
    normal = np.cross(rims.at(sphere, np.ones(400)) - base, rims.at(sphere, np.full(400, 2.0)) - base)
    normal *= np.sign((normal * to_eye(spheres.center[sphere], distance)).sum(axis=1))[:, None]
    beyond = -((points - base) * normal).sum(axis=1) / np.linalg.norm(normal, axis=1)
    clear = np.abs(beyond) > CLEAR
    assert ((plane > 0) == (beyond > 0))[clear].all()
    depth = hidden_by(spheres, sphere, points, distance)
    clear &= (plane > 0) & (np.abs(depth) > CLEAR)
    assert clear.sum() > 100 and ((cone < 0) == (depth > 0))[clear].all() and (cone[clear] < 0).any()


def ray_through(page: np.ndarray) -> np.ndarray:
    return np.column_stack([page, np.full(len(page), -AWAY)])


def surfaces(spheres: Spheres, page: np.ndarray, distance: float | None) -> np.ndarray:
    """How near every surface lies at page points: (points, n), −∞ beside it."""
    if distance is None:
        return heights(spheres, page)
    ray = ray_through(page)
    return np.stack([-entry(*ball, ray) for ball in zip(spheres.center, spheres.radius, strict=True)], axis=1)


@EYES
@given(st.integers(0, 10**6))
@settings(max_examples=15)
def test_surfaces_are_where_lines_of_sight_enter(distance: float | None, seed: int) -> None:
    spheres, page = scene(seed, distance), np.random.default_rng(seed).uniform(-6, 6, (60, 2))
    point, sphere = np.divmod(np.arange(60 * 12), 12)
    found = occluders(spheres, distance).surface(sphere, page[point])
    truth = surfaces(spheres, page, distance).ravel()
    assert np.isfinite(truth).sum() > 20
    assert np.array_equal(found > -np.inf, truth > -np.inf) and np.allclose(found, truth, atol=1e-9)


@EYES
@given(st.integers(0, 10**6), st.floats(0.05, 2.0))
@settings(max_examples=15)
def test_bounds_of_surfaces_bracket_what_a_cell_holds(distance: float | None, seed: int, side: float) -> None:
    random, spheres = np.random.default_rng(seed), scene(seed, distance)
    cells = random.uniform(-6, 6, (40, 2))
    corners = [(x, y) for x in (0.0, 1.0) for y in (0.0, 1.0)]
    inside = np.concatenate([corners, random.uniform(0, 1, (30, 2))]) * side
    truth = surfaces(spheres, (cells[:, None] + inside).reshape(-1, 2), distance).reshape(40, len(inside), 12)
    cell, sphere = np.divmod(np.arange(40 * 12), 12)
    least, most = (
        bound.reshape(40, 12) for bound in occluders(spheres, distance).surface_bounds(sphere, cells[cell], side)
    )
    assert (least <= truth.min(axis=1) + 1e-9).all() and (most >= truth.max(axis=1) - 1e-9).all()
    covered = (truth > -np.inf).all(axis=1)
    assert np.array_equal(least > -np.inf, covered)  # balls' images are convex: corners tell
    assert np.allclose(least[covered], truth[:, :4].min(axis=1)[covered])  # and surfaces fall towards the rim


@EYES
@given(st.integers(0, 10**6))
@settings(max_examples=15)
def test_images_of_arcs_hold_the_images_of_their_points(distance: float | None, seed: int) -> None:
    """The same ends, every point of the arc on the image, and in the same order."""
    random, spheres = np.random.default_rng(seed), scene(seed, distance)
    circles, eye = random_circles(seed, spheres, 50), projection(distance)
    start, sweep = random.uniform(-7, 7, 50), random.uniform(0.01, TURN, 50)
    arcs = eye.page_arcs(circles, np.arange(50), start, sweep)
    frame = np.stack([arcs.u, arcs.v], axis=2)
    before = arcs.start
    for share in np.linspace(0, 1, 9):
        page = eye.page_points(circles.at(np.arange(50), start + share * sweep))
        unit = np.linalg.solve(frame, (page - arcs.c)[..., None])[..., 0]
        assert np.allclose(np.linalg.norm(unit, axis=1), 1, atol=1e-7)
        step = np.mod(np.arctan2(unit[:, 1], unit[:, 0]) - before + 1e-6, TURN)
        before = before + step - 1e-6
        assert (step < np.pi * 1.9).all()
    assert np.allclose(before, arcs.start + arcs.sweep, atol=1e-5)


def test_page_points_lie_on_lines_of_sight() -> None:
    points = np.array([[1.0, 2.0, -10.0], [-3.0, 0.5, -40.0]])
    assert projection(None).page_points(points).tolist() == points[:, :2].tolist()
    assert np.allclose(projection(AWAY).page_points(points), [[2, 4], [-1.5, 0.25]])


@EYES
@given(st.integers(0, 10**6))
@settings(max_examples=15)
def test_lines_of_sight_past_a_sphere_touch_it_at_the_horizon_angle(distance: float | None, seed: int) -> None:
    """A point anywhere behind a horizon point, along the line of sight, has its angle."""
    random, spheres = np.random.default_rng(seed), scene(seed, distance)
    circles, sphere, angle = horizons(spheres, distance), np.arange(12), random.uniform(-np.pi, np.pi, 12)
    points = circles.at(sphere, angle)
    behind = points - to_eye(points, distance) * random.uniform(-3, 30, 12)[:, None]
    found = occluders(spheres, distance).horizon_angle(circles, sphere, behind)
    assert np.allclose(np.exp(1j * found), np.exp(1j * angle), atol=1e-7)


@EYES
@given(st.integers(0, 10**6))
@settings(max_examples=15)
def test_nearer_spheres_are_painted_over_the_others(distance: float | None, seed: int) -> None:
    """Halperin & Overmars, Theorem 5.1: on one line of sight the free surface seen first is that of the nearer one.

    Of two balls the one with the greater nearness shows at every point of both at which it is not inside the other.
    """
    spheres, page = scene(seed, distance, 30), np.random.default_rng(seed).uniform(-6, 6, (300, 2))
    first, second = all_pairs(spheres)
    near = occluders(spheres, distance).nearness()
    first, second = first[near[first] > near[second]], second[near[first] > near[second]]
    surface = surfaces(spheres, page, distance)
    both = (surface[:, first] > -np.inf) & (surface[:, second] > -np.inf)
    point, pair = np.nonzero(both & (surface[:, first] < surface[:, second] - 1e-9))
    ray = np.column_stack([page, np.zeros(300)]) if distance is None else ray_through(page)
    unit = ray / np.linalg.norm(ray, axis=1)[:, None]
    high = surface[point, first[pair]][:, None]
    where = ray[point] + high * [0, 0, 1] if distance is None else -high * unit[point]
    inside = np.linalg.norm(where - spheres.center[second[pair]], axis=1) < spheres.radius[second[pair]] + 1e-9
    assert inside.all()


@EYES
@given(st.integers(0, 10**6), st.integers(2, 60), st.floats(1.0, 12.0))
@settings(max_examples=20)
def test_no_sphere_that_shows_is_culled(distance: float | None, seed: int, count: int, extent: float) -> None:
    spheres = random_spheres(seed, count, extent, 4.0)
    spheres = Spheres(spheres.center - extent / 2, spheres.radius)
    reach = extent / 2 + 4.0
    if distance is None:
        label = zbuffer(spheres, np.array([-reach, -reach]), reach / 75, (150, 150))
    else:
        low, high = image_boxes(spheres, AWAY)
        label = central_zbuffer(spheres, low.min(axis=0), float((high.max(axis=0) - low.min(axis=0)).max()) / 150,
                                (150, 150), AWAY)  # fmt: skip
    shown = np.unique(label[label >= 0])
    assert len(shown) and kept(spheres, distance)[shown].all()


@EYES
def test_balls_behind_a_wall_are_culled(distance: float | None) -> None:
    x, y = (column.ravel() for column in np.meshgrid(np.arange(-3, 4), np.arange(-3, 4)))
    wall = np.column_stack([x, y, np.full(49, 6.0)])
    behind = np.column_stack([x / 3, y / 3, np.zeros(49)])
    keep = kept(Spheres(np.concatenate([wall, behind, [[9, 0, 0]]]), np.append(np.ones(98), 1)), distance)
    assert keep[:49].all() and not keep[49:98].any() and keep[98]


@EYES
@pytest.mark.parametrize("seed", range(4))
def test_culling_in_many_groups_keeps_all_that_shows(
    distance: float | None, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Groups of a few spheres each are dropped by what the groups before them cover, or when all is known."""
    spheres = random_spheres(seed, 400, 14.0, 2.0)
    spheres = Spheres(spheres.center - 7.0, spheres.radius)
    at_once = kept(spheres, distance)
    monkeypatch.setattr(culling, "GROUP", 2)
    monkeypatch.setattr(culling, "BLOCK_ROWS", 64)
    monkeypatch.setattr(culling, "CLUSTER", 2)
    assert 100 < at_once.sum() < 400
    assert np.array_equal(kept(spheres, distance), at_once)
    for cuts in ((200,), (0, 7, 7, 130, 131, 300), tuple(range(1, 400))):
        assert np.array_equal(kept(spheres, distance, cuts), at_once)


@EYES
def test_parts_that_are_hidden_are_not_made_again(distance: float | None) -> None:
    x, y = (column.ravel() for column in np.meshgrid(np.arange(-3, 4), np.arange(-3, 4)))
    parts = [np.column_stack([x / 3, y / 3, np.full(49, z)]) for z in (0.0, -2.0)]
    parts.append(np.column_stack([x, y, np.full(49, 6.0)]))
    made = []

    def part(number: int) -> SphereOccluders:
        made.append(number)
        return occluders(Spheres(parts[number] - [0.0, 0.0, distance or 0.0], np.ones(49)), distance)

    rows = culling.possibly_visible([partial(part, number) for number in range(3)], projection(distance))
    assert made == [0, 1, 2, 2] and np.array_equal(rows, np.arange(98, 147))


def spheres_of(*rows: tuple[float, float, float, float]) -> Spheres:
    table = np.array(rows, dtype=float)
    return Spheres(table[:, :3], table[:, 3])


@pytest.mark.parametrize(
    ("rows", "junctions", "arcs"),
    [
        ([(0, 0, 0, 1)], 0, 1),
        ([(0, 0, 5, 1), (3, 0, 0, 1)], 0, 2),  # side by side
        ([(0, 0, 5, 1), (0.1, 0, 0, 2)], 0, 2),  # before the middle of the other
        ([(0, 0, 5, 1), (1.5, 0, 0, 1)], 2, 3),  # over its edge: the rear circle passes under twice
        ([(0, 0, 9, 1), (1.5, 0, 5, 1), (3, 0, 0, 1)], 4, 6),  # a row: two arcs, three and one
        ([(-0.5, 0, 0.1, 1), (0.5, 0, 0, 1)], 2, 5),  # fused: the nearer one's horizon ends at two rims
        ([(0, 0, 5, 0.3), (-0.5, 0, 0.1, 1), (0.5, 0, 0, 1)], 4, 8),  # and one over the crease, which becomes two
        ([(0, 0, 5, 0.3), (1.25, 0, 0, 1), (-1.2, 0.2, 1, 1)], 4, 6),  # over the edges of two that are apart
        ([(-0.8, 0, 3, 1), (0.8, 0, 7, 1), (0, 0, 0, 1.3)], 6, 9),  # a gap
    ],
)
def test_junctions_of_scenes_worked_out_by_hand(
    rows: list[tuple[float, float, float, float]], junctions: int, arcs: int
) -> None:
    """A whole circle with k junctions is k arcs, an arc k + 1; nothing else ends where they are."""
    found = map_of(spheres_of(*rows), STRAIGHT)
    assert (tees(found), len(found.left)) == (junctions, arcs)


@EYES
@given(st.integers(0, 10**6), st.integers(2, 30))
@settings(max_examples=15)
def test_every_arc_of_a_map_has_two_different_faces(distance: float | None, seed: int, count: int) -> None:
    """Nothing ends alone, at most three arcs meet, and every face has a loop."""
    spheres = random_spheres(seed, count, 6.0, 3.0)
    found = map_of(spheres, file_axes(spheres, None if distance is None else 30.0))
    assert (found.left >= 0).all() and (found.right >= -1).all() and (found.left != found.right).all()
    degree = np.bincount(np.append(found.curve_arcs.origin, found.curve_arcs.target))
    assert set(degree.tolist()) <= {0, 2, 3}  # numbers of whole circles that were split are not used
    assert ((found.curve_arcs.sweep > 0) & (found.curve_arcs.sweep <= TURN + 1e-9)).all()
    assert (found.loops.face[np.searchsorted(found.loops.face, found.left)] == found.left).all()
