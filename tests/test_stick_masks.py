"""Pictures of balls and sticks against a z-buffer of the same solids: no pixel inside a region may differ."""

import re
from pathlib import Path

import numpy as np
import pytest

from molviz.model.spheres import Spheres
from molviz.model.sticks import Sticks
from molviz.picture.options import DrawOptions
from molviz.picture.page import Page
from molviz.picture.palette import load_palette
from molviz.pipeline.draw import DrawRequest, drawings_of
from molviz.pipeline.inputs import InputOptions, Loaded, load, loaded_from
from molviz.pipeline.solids import SolidOptions, shown, solids_for
from molviz.readers import read
from molviz.visibility.eye import eye_coordinates
from molviz.visibility.scene import extent
from molviz.visibility.view import View
from tests.render import needs_ghostscript, render_ps, render_svg
from tests.stick_scenes import random_skeleton
from tests.zbuffer import interior, mask_labels

SAMPLES = Path(__file__).parent.parent / "samples"
SIZE = 250.0  # points along the longer side
FINE = 2  # pixels a point


def molfile(seed: int, count: int) -> bytes:
    """A random molecule of carbon, nitrogen and oxygen with single, double and triple bonds, as V2000."""
    centers, bonds = random_skeleton(seed, count)
    rng = np.random.default_rng(seed)
    elements = rng.choice(["C", "N", "O"], len(centers))
    atoms = [f"{x:10.4f}{y:10.4f}{z:10.4f} {e:<3} 0  0" for (x, y, z), e in zip(centers, elements, strict=True)]
    orders = rng.choice([1, 2, 3], len(bonds), p=[0.6, 0.3, 0.1])
    rows = [f"{i + 1:3d}{j + 1:3d}{order:3d}  0" for (i, j), order in zip(bonds, orders, strict=True)]
    head = ["random", "", "", f"{len(atoms):3d}{len(rows):3d}  0  0  0  0  0  0  0  0999 V2000"]
    return "\n".join([*head, *atoms, *rows, "M  END", "$$$$", ""]).encode()


def random_molecule(seed: int, count: int) -> Loaded:
    return loaded_from(read("random.sdf", molfile(seed, count)), InputOptions())[0]


def random_views(seed: int, count: int, center: np.ndarray, far: float) -> list[View]:
    """Every other one from nearby: from 1.2 times as far as all that is drawn reaches."""
    turns = [np.linalg.qr(np.random.default_rng([seed, k]).normal(size=(3, 3)))[0] for k in range(count)]
    return [View(q * np.sign(np.linalg.det(q)), center, 1.2 * far if k % 2 else None) for k, q in enumerate(turns)]


def first_hits(balls: Spheres, sticks: Sticks, view: View, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The solids (h, w) that the lines of sight through page points meet first, −1 for none: half sticks follow balls.

    Ball by ball and stick by stick, each among the pixels of the box around its image.
    """
    eye = eye_coordinates(balls, view)
    depth, label = np.full((len(y), len(x)), np.inf), np.full((len(y), len(x)), -1)
    for row, (center, radius) in enumerate(zip(*eye, strict=True)):
        window, origin, ray = _window(center[None], radius, view, x, y)
        along = ray @ center - np.sum(origin * ray, axis=-1)
        gap = radius**2 - np.sum((origin + along[..., None] * ray - center) ** 2, axis=-1)
        _nearer(depth, label, window, np.where(gap > 0, along - np.sqrt(np.maximum(gap, 0)), np.inf), row)
    for number, (first, second, radius, offset) in enumerate(zip(*sticks, strict=True)):
        ends = eye.center[[first, second]] + view.rotation @ offset
        window, origin, ray = _window(ends, radius, view, x, y)
        far, along = _on_cylinder(ends, radius, origin, ray)
        for half, inside in enumerate(((along >= 0) & (along < 0.5), (along >= 0.5) & (along <= 1))):
            _nearer(depth, label, window, np.where(inside, far, np.inf), len(balls.radius) + 2 * number + half)
    return label


def _window(
    points: np.ndarray, radius: float, view: View, x: np.ndarray, y: np.ndarray
) -> tuple[tuple[np.ndarray, ...], np.ndarray, np.ndarray]:
    """The pixels about the images of balls at points, and the lines of sight through them."""
    scale, reach = 1.0, radius
    if view.distance is not None:
        near = -points[:, 2:] - radius
        scale, reach = view.distance / -points[:, 2:], float(np.max(2 * radius * view.distance / near))
    flat = points[:, :2] * scale
    low, high = flat.min(axis=0) - reach, flat.max(axis=0) + reach
    columns, lines = (np.flatnonzero((a > low[k]) & (a < high[k])) for k, a in enumerate((x, y)))
    page = np.stack(np.meshgrid(x[columns], y[lines]), axis=-1)
    level = np.zeros((*page.shape[:2], 1))
    if view.distance is None:
        down = np.concatenate([0 * page, level - 1.0], axis=-1)
        return np.ix_(lines, columns), np.concatenate([page, level], axis=-1), down
    ray = np.concatenate([page, level - view.distance], axis=-1)
    return np.ix_(lines, columns), 0 * ray, ray / np.linalg.norm(ray, axis=-1, keepdims=True)


def _on_cylinder(
    ends: np.ndarray, radius: float, origin: np.ndarray, ray: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """How far away rays enter a cylinder, inf where they do not, and at which part of its length."""
    axis = ends[1] - ends[0]
    u = axis / np.linalg.norm(axis)
    across = ray - (ray @ u)[..., None] * u
    start = origin - ends[0]
    flat = start - (start @ u)[..., None] * u
    aa, ab = np.sum(across**2, axis=-1), np.sum(across * flat, axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        beside = flat - across * (ab / aa)[..., None]  # where the ray passes the axis
        far = -ab / aa - np.sqrt((radius**2 - np.sum(beside**2, axis=-1)) / aa)
        along = ((start + far[..., None] * ray) @ axis) / (axis @ axis)
    return np.where(np.isfinite(far), far, np.inf), np.where(np.isfinite(far), along, -1.0)


def _nearer(depth: np.ndarray, label: np.ndarray, window: tuple[np.ndarray, ...], far: np.ndarray, row: int) -> None:
    nearer = far < depth[window]
    depth[window] = np.where(nearer, far, depth[window])
    label[window] = np.where(nearer, row, label[window])


def wrong_pixels(loaded: Loaded, options: SolidOptions, views: list[View], suffix: str) -> list[int]:
    """How many pixels of each picking mask farther than one from a boundary are wrong."""
    atoms, representation = shown(loaded, options)
    solids = solids_for(atoms, representation, options)
    halves = np.stack([solids.sticks.first, solids.sticks.second], axis=1).ravel()
    atom, wrong = np.concatenate([np.arange(len(solids.balls.radius)), halves, [-1]]), []
    for view in views:
        low, high = extent(solids.balls, view)
        scale = SIZE / float((high - low).max())
        page = Page(scale=scale)
        look = DrawOptions(load_palette("tide"), color_by="index", outline=0.0, crease=0.0, page=page)
        drawing = drawings_of(loaded, DrawRequest(look, solids=options), [view])[0].to(suffix)
        label, corner, side = _seen(drawing, suffix, low, high, scale)
        height, width = label.shape
        x = corner[0] + (np.arange(width) + 0.5) * side[0]
        y = corner[1] + (height - np.arange(height) - 0.5) * side[1]
        truth = first_hits(solids.balls, solids.sticks, view, x, y)
        inside = interior(truth)
        assert inside.sum() > 1000
        wrong.append(int(np.sum(inside & (label != atom[truth]))))
    return wrong


def _seen(
    drawing: bytes, suffix: str, low: np.ndarray, high: np.ndarray, scale: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The labels of the pixels, the lower left corner of the picture, and the sides of a pixel, in ångström."""
    if suffix != ".svg":
        return mask_labels(render_ps(drawing, 72 * FINE)), low, np.full(2, 1 / scale / FINE)
    page = np.array([float(size) for size in re.findall(rb'viewBox="0 0 (\S+) ([^"]+)"', drawing)[0]]) / scale
    label = mask_labels(render_svg(drawing, round(FINE * page[0] * scale)))
    return label, (low + high - page) / 2, page / label.shape[::-1]


def views_of(loaded: Loaded, seed: int, count: int) -> list[View]:
    center = loaded.spheres.center.mean(axis=0)
    far = float(np.linalg.norm(loaded.spheres.center - center, axis=1).max()) + 2.0
    return random_views(seed, count, center, far)


@pytest.mark.parametrize("suffix", [".svg", pytest.param(".eps", marks=needs_ghostscript)])
@pytest.mark.parametrize("name", ["ball-and-stick", "sticks"])
@pytest.mark.parametrize("sample", ["caffeine.xyz", "c60.xyz", 1, 2, 3])
def test_mask_equals_zbuffer_of_balls_and_sticks(sample: str | int, name: str, suffix: str) -> None:
    loaded = random_molecule(sample, 8) if isinstance(sample, int) else load(str(SAMPLES / sample), InputOptions())[0]
    assert wrong_pixels(loaded, SolidOptions((("all", name),)), views_of(loaded, len(name), 2), suffix) == [0, 0]
