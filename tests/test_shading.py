"""Contact shade of a style's own steps where the definition says, bands of light, and gradients that are shared."""

from pathlib import Path

import numpy as np
import pytest

from molviz.curves import Paths
from molviz.model.spheres import Spheres
from molviz.model.sticks import Sticks
from molviz.picture import shading
from molviz.picture.page import Placement
from molviz.picture.regions import shape_of
from molviz.picture.shading import ball_gradients, contact_steps, deepest_jumps, light_bands
from molviz.picture.style import Shade, ShadeStep, load_style
from molviz.pipeline.inputs import InputOptions, load
from molviz.visibility.horizon_runs import horizon_runs
from molviz.visibility.map import VisibilityMap
from molviz.visibility.overlay import drop_at_edge, seen_spheres, skirts
from molviz.visibility.scene import Scene
from molviz.visibility.view import View, principal_axes
from tests.oracle import heights, winding

SAMPLES = Path(__file__).parent.parent / "samples"
AS_IS = Placement(1.0, np.zeros(2), 0.0, 0.0)
STEP = 0.06  # ångström between points of an arc; what lies nearer to it is not asked


def seen(name: str) -> tuple[VisibilityMap, View]:
    loaded = load(str(SAMPLES / name), InputOptions(water=None))[0]
    view = principal_axes(loaded.spheres)
    return Scene(loaded.spheres, only=view).map(view)[0], view


def inside(paths: Paths, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which points lie inside a shape, and which are clear of its boundary."""
    total, clear = np.zeros(len(points), dtype=int), np.ones(len(points), dtype=bool)
    for begin, end in zip(paths.loop_start[:-1].tolist(), paths.loop_start[1:].tolist(), strict=True):
        rows = paths.arcs.take(np.arange(begin, end))
        count = np.ceil(np.abs(rows.sweep) * rows.major() / STEP).astype(int) + 1
        owner = np.repeat(np.arange(len(count)), count)
        place = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
        x, y = rows.take(owner).at(rows.start[owner] + rows.sweep[owner] * place / count[owner]).T
        total += winding(x, y, points)
        clear &= np.hypot(points[:, [0]] - x, points[:, [1]] - y).min(axis=1) > STEP
    return total > 0, clear


def test_contact_shade_is_where_some_skirt_is_above_all_spheres() -> None:
    view_map, view = seen("1a8o.pdb")
    runs, shade = horizon_runs(view_map, view), load_style("goodsell").shade
    steps, opacity = contact_steps(view_map, view, runs, shade, AS_IS)
    spheres = view_map.spheres.take(seen_spheres(view_map))
    jumps = deepest_jumps(runs, len(view_map.spheres.radius))[seen_spheres(view_map)]
    low, high = (corner[:2] for corner in spheres.box())
    points = np.random.default_rng(1).uniform(low, high, (2_000, 2))
    hung = [(step, shading._hung_from(spheres, jumps, len(jumps), view, step)) for step in shade.steps]
    hung = [(step, rows) for step, rows in hung if len(rows)]
    assert opacity == [step.opacity for step, _ in hung] and len(hung) > 2
    surface = heights(view_map.spheres, points).max(axis=1)
    for number, (step, rows) in enumerate(hung):
        assert np.all(jumps[rows] > drop_at_edge(spheres.radius[rows], step.reach, step.low))
        skirt = heights(skirts(spheres, rows, step.reach, step.low, view), points).max(axis=1)
        found, clear = inside(shape_of(steps, number), points)
        assert clear.mean() > 0.7 and np.any(found[clear])
        assert np.array_equal(found[clear], (skirt > surface)[clear])


def capsule(spheres: Spheres, first: int, second: int, wider: float = 0.0, lower: float = 0.0) -> Spheres:
    """Balls so close that nobody can tell them from the stick between two balls of one size."""
    share = np.linspace(0.0, 1.0, 300)[:, None]
    center = spheres.center[first] + share * (spheres.center[second] - spheres.center[first]) - [0.0, 0.0, lower]
    return Spheres(center, np.full(len(center), spheres.radius[first] + wider))


@pytest.mark.parametrize("tilt", [0.0, 0.8])
def test_contact_shade_falls_on_sticks_and_from_them(tilt: float) -> None:
    """A stick over a large ball, and under a middling one; the same by balls without number."""
    center = np.array([[-2.0, 0.0, tilt], [2.0, 0.3, -tilt], [0.5, 0.2, -7.5], [-1.2, 0.1, 5.0]])
    spheres = Spheres(center, np.array([0.3, 0.3, 3.0, 0.7]))
    view = View(np.eye(3), np.zeros(3), None)
    sticks = Sticks(np.array([0]), np.array([1]), np.array([0.3]), np.zeros((1, 3)))
    view_map = Scene(spheres, view, sticks).map(view)[0]
    step = ShadeStep(0.65, 2.65, 0.2)
    shade = Shade([step], [step], 1000)
    steps, _ = contact_steps(view_map, view, horizon_runs(view_map, view), shade, AS_IS)
    points = np.random.default_rng(3).uniform([-3.5, -3.5], [3.5, 3.5], (6_000, 2))
    surface = np.maximum(heights(spheres, points).max(axis=1), heights(capsule(spheres, 0, 1), points).max(axis=1))
    skirts_of = Spheres(center - [0.0, 0.0, step.low], spheres.radius + step.reach)
    balls = heights(skirts_of.take(np.array([0, 1, 3])), points).max(axis=1)  # nothing lies behind the large one
    below_stick = heights(capsule(spheres, 0, 1, step.reach, step.low), points).max(axis=1)
    skirt = np.maximum(balls, below_stick)
    found, clear = inside(steps, points)
    with np.errstate(invalid="ignore"):  # neither above the page: not a number
        sure = clear & (np.abs(skirt - surface) >= 0.1)
    assert np.array_equal(found[sure], (skirt > surface)[sure])
    shaded = found & sure
    assert (shaded & (np.abs(surface) < 1.2)).sum() > 20  # on the stick
    assert (shaded & (surface < -3.0) & (below_stick > balls)).sum() > 200  # from it


def test_large_scenes_have_their_own_steps_and_impossible_skirts_none() -> None:
    view_map, view = seen("1a8o.pdb")
    runs = horizon_runs(view_map, view)
    few, many = (ShadeStep(0.7, 2.8, 0.1),), (ShadeStep(0.7, 2.8, 0.2), ShadeStep(1.6, 6.0, 0.3))
    count = len(seen_spheres(view_map))
    for large_from, expected in ((count, [0.1]), (count + 1, [0.2, 0.3])):
        assert contact_steps(view_map, view, runs, Shade(many, few, large_from), AS_IS)[1] == expected
    above = Shade((ShadeStep(8.0, 1.0, 0.5),), (), 10**9)  # not low enough: each atom would shade itself
    steps, opacity = contact_steps(view_map, view, runs, above, AS_IS)
    assert opacity == [] and len(steps.arcs.c) == 0


def test_deepest_jumps_are_finite() -> None:
    view_map, view = seen("caffeine.xyz")
    runs = horizon_runs(view_map, view)
    deepest = deepest_jumps(runs, len(view_map.spheres.radius))
    for sphere in range(len(deepest)):
        jump = runs.jump[(runs.sphere[runs.owner()] == sphere) & np.isfinite(runs.jump)]
        assert deepest[sphere] == (jump.max() if len(jump) else 0.0)


def test_bands_of_light_divide_a_ball() -> None:
    """Seen from the light, the band n·l < c of a unit ball is a ring outside of the radius √(1 − c²)."""
    ball = Spheres(np.zeros((1, 3)), np.ones(1))
    view = View(np.eye(3), np.zeros(3))
    view_map = Scene(ball, only=view).map(view)[0]
    cel = load_style("cel").light
    light = type(cel)((0.0, 0.0, 1.0), cel.dark, ((0.6, 0.25),), cel.bright, ((0.8, 0.5),))
    (dark, dark_opacity), (bright, bright_opacity) = light_bands(view_map, view, light, AS_IS)
    assert (dark_opacity, bright_opacity) == ([0.25], [0.5])
    assert dark.arcs.signed_area().sum() == pytest.approx(np.pi * (1 - 0.64), abs=0.01)
    assert bright.arcs.signed_area().sum() == pytest.approx(np.pi * 0.36, abs=0.01)


def test_like_balls_share_a_gradient() -> None:
    style = load_style("shaded")
    color, radius = np.array([[200, 30, 40]] * 3 + [[1, 2, 3]]), np.array([10.0, 10.05, 14.0, 10.0])
    one, same, larger, other = ball_gradients(color, radius, style)
    assert one == same and len({one, larger, other}) == 3
    for gradient, size in ((one, 10.0), (larger, 14.0)):
        assert gradient.radius == pytest.approx(size, rel=0.02)
        assert np.hypot(*gradient.focus) < gradient.radius
        offsets = [offset for offset, _ in gradient.stops]
        assert offsets == sorted(offsets) and (offsets[0], offsets[-1]) == (0.0, 1.0)
        brightness = [sum(color) for _, color in gradient.stops]
        assert brightness == sorted(brightness, reverse=True)
