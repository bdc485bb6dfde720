"""Random and special scenes at three scales, by both methods and both projections, against all that is known of them.

    python -m tests.soak [--seed 0] [--start 0] [--count 5000]

Scene k of a seed is always the same. Of each: the map's invariants; every pixel of a picking mask against a z-buffer;
areas and volume at another scale, and of small random scenes by the theorem of Gauss and Bonnet; a picture in a style.
"""

import argparse
import re
import sys
import time
import warnings
from itertools import product

import numpy as np

import molviz
from molviz.geometry.measure import measure_spheres
from molviz.model.spheres import Spheres
from molviz.pipeline.draw import DrawRequest, drawing_of
from molviz.pipeline.inputs import InputOptions, Loaded, loaded_from
from molviz.pipeline.subject import reading_of
from molviz.pipeline.views import ViewOptions, view_of
from tests.measure_oracle import all_free_arcs, gauss_bonnet_areas
from tests.render import render_svg
from tests.test_masks import bounds, mask_options
from tests.zbuffer import central_zbuffer, interior, mask_labels, zbuffer

SCALES = (1e-3, 1.0, 1e3)
WAYS = list(product(SCALES, ("visible", "painter"), (False, True)))  # scale, method, central
STYLES = ("flat", "goodsell", "cel", "shaded", "hatch", "line", "print")
SIDE = 160.0  # pixels along the longer side of a mask
LEVEL = 1e-3  # of the largest radius: surfaces nearer to each other are displaced by about as much
ORACLE = 8  # spheres: more take the oracle too long
SECONDS = 5.0


def gas(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    count = int(rng.integers(1, 40))
    return rng.normal(size=(count, 3)) * rng.uniform(0.5, 4), rng.uniform(0.3, 2.5, count)


def few(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    count = int(rng.integers(2, ORACLE))
    return rng.normal(size=(count, 3)) * 1.2, rng.uniform(0.6, 1.8, count)


def lattice(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Tangent, overlapping or apart, on a cube."""
    side = int(rng.integers(1, 4))
    place = np.array(list(product(range(side), repeat=3)), dtype=float)
    return place * rng.choice([1.0, 1.5, 2.0, 2.5]), np.full(len(place), 1.0)


def chain(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """A row of tangent balls, along an axis or the line of sight."""
    radius = rng.choice([0.5, 1.0, 1.0, 2.0], int(rng.integers(2, 15)))
    along = np.cumsum(radius) * 2 - radius
    axis = np.eye(3)[rng.integers(3)]
    return along[:, None] * axis, radius


def nested(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Balls in balls, concentric, or touching from inside."""
    radius = np.sort(rng.uniform(0.2, 3, int(rng.integers(2, 8))))
    shift = (radius[-1] - radius) * rng.choice([0.0, 0.5, 1.0])
    return shift[:, None] * np.eye(3)[rng.integers(3)], radius


def twins(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Balls at the place of others, or next to it."""
    center, radius = few(rng)
    again = rng.integers(len(radius), size=len(radius))
    near = center[again] + rng.choice([0.0, 1e-9, 1e-6, 1e-3]) * rng.normal(size=center.shape)
    return np.vstack([center, near]), np.append(radius, radius[again])


def polyhedron(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """The corners of a cube, an octahedron or an icosahedron, the middle too."""
    golden = (1 + 5**0.5) / 2
    corners = [list(product((-1, 1), repeat=3)), [*np.eye(3), *-np.eye(3)],
               [np.roll((0, a, b * golden), k) for a in (-1, 1) for b in (-1, 1) for k in range(3)]]  # fmt: skip
    center = np.array([*corners[int(rng.integers(3))], (0, 0, 0)], dtype=float)
    return center, np.full(len(center), rng.choice([0.5, 0.7, 1.0, 1.5]))


def decades(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Radii over four decades."""
    radius = 10.0 ** rng.uniform(-4, 0, int(rng.integers(2, 20)))
    return rng.normal(size=(len(radius), 3)), radius


def decimals(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """One decimal each, so that much coincides."""
    center, radius = gas(rng)
    return np.round(center, 1), np.round(radius, 1) + 0.1


KINDS = (gas, few, lattice, chain, nested, twins, polyhedron, decades, decimals)


def scene(seed: int, number: int) -> tuple[str, np.ndarray, np.ndarray]:
    """The kind, the centres and the radii of a scene."""
    rng = np.random.default_rng([seed, number])
    kind = KINDS[number % len(KINDS)]
    center, radius = kind(rng)
    return kind.__name__, center, radius


def soak(seed: int, number: int) -> None:
    """Try one scene in one of the ways, all of which come in turn; raises whatever is wrong."""
    kind, center, radius = scene(seed, number)
    scale, method, central = WAYS[number // len(KINDS) % len(WAYS)]
    loaded = loaded_from(reading_of((center * scale, radius * scale)), InputOptions())[0]
    eye = ViewOptions("file", (("x", 17.0 * (number % 3)),))
    if central:
        seen = view_of(loaded.spheres, eye).of(loaded.spheres)
        front = float(np.max(seen.center[:, 2] + seen.radius))
        eye = ViewOptions("file", eye.rotations, 1.1 * front + 3 * float(radius.max()) * scale)
    check_pixels(loaded, eye, method)
    check_measures(kind, center, radius, scale)
    style = STYLES[number % len(STYLES)]
    drawing = molviz.draw(
        (center * scale, radius * scale), perspective=eye.distance, orient="file", rotate=list(eye.rotations),
        method=method, style=style, check=method != "painter",
    )  # fmt: skip
    assert isinstance(drawing, molviz.Drawing) and drawing.svg() and drawing.to("eps")


def check_pixels(loaded: Loaded, eye: ViewOptions, method: str) -> None:
    seen = view_of(loaded.spheres, eye).of(loaded.spheres)
    low, high = bounds(seen, eye.distance)
    scale = SIDE / float((high - low).max())
    request = DrawRequest(mask_options(scale))
    svg = drawing_of(loaded, request, eye, method, check=method == "visible").to("svg")
    page = np.array([float(x) for x in re.findall(rb'viewBox="0 0 (\S+) ([^"]+)"', svg)[0]])
    label = mask_labels(render_svg(svg, int(page[0])))
    corner = (low + high) / 2 - page / 2 / scale
    wrong = wrong_pixels(label, seen, corner, 1 / scale, eye.distance)
    assert not wrong, f"{wrong} pixels of the mask are wrong"


def wrong_pixels(label: np.ndarray, seen: Spheres, low: np.ndarray, pixel: float, distance: float | None) -> int:
    """How many pixels, a pixel or more from any border, show another ball, unless it is as near as the right one."""
    if distance is None:
        truth = zbuffer(seen, low, pixel, label.shape)
    else:
        truth = central_zbuffer(seen, low, pixel, label.shape, distance)
    rows, columns = np.nonzero(interior(truth) & interior(label) & (label != truth))
    page = low + pixel * np.column_stack([columns + 0.5, label.shape[0] - rows - 0.5])
    level = LEVEL * float(seen.radius.max())
    shown = [heights(seen, page, numbers[rows, columns], distance) for numbers in (label, truth)]
    return int(np.sum(~(np.abs(shown[0] - shown[1]) <= level)))


def heights(seen: Spheres, page: np.ndarray, ball: np.ndarray, distance: float | None) -> np.ndarray:
    """How near the surfaces of balls (k,) are at points of the page (k, 2), −inf where they are not seen there."""
    center, radius = seen.center[ball], np.where(ball >= 0, seen.radius[ball], 0.0)
    eye = np.array([0.0, 0.0, 0.0 if distance is None else distance])
    start = np.column_stack([page, np.zeros(len(page))]) if distance is None else np.tile(eye, (len(page), 1))
    flat = np.column_stack([page, np.zeros(len(page))])
    ray = np.tile([0.0, 0.0, -1.0], (len(page), 1)) if distance is None else flat - eye
    ray = ray / np.linalg.norm(ray, axis=1)[:, None]
    along = ((center - start) * ray).sum(axis=1)
    square = radius**2 - ((center - start - ray * along[:, None]) ** 2).sum(axis=1)
    return np.where(square > 0, -(along - np.sqrt(np.maximum(square, 0))), -np.inf)


def check_measures(kind: str, center: np.ndarray, radius: np.ndarray, scale: float) -> None:
    one, other = measure_spheres(Spheres(center, radius)), measure_spheres(Spheres(center * scale, radius * scale))
    area, volume = float(one.area.sum()), one.volume
    assert 0 < area <= 4.0001 * np.pi * np.sum(radius**2) and 0 < volume <= 4.0001 / 3 * np.pi * np.sum(radius**3)
    assert np.isclose(other.area.sum(), area * scale**2, rtol=1e-6)
    assert np.isclose(other.volume, volume * scale**3, rtol=1e-6)
    if kind == "few":
        spheres = Spheres(center, radius)
        truth = gauss_bonnet_areas(spheres, all_free_arcs(spheres))
        assert np.allclose(one.area, truth, rtol=0, atol=1e-6), "areas miss those of Gauss and Bonnet"


def main() -> None:
    parser = argparse.ArgumentParser(description="Soak molviz in scenes; prints seed and number of each that fails.")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--start", type=int, default=0)
    parser.add_argument("--count", type=int, default=5000)
    parser.add_argument("--seconds", type=float, default=float("inf"), help="stop after so long")
    asked = parser.parse_args()
    print(f"seed {asked.seed}", flush=True)
    warnings.simplefilter("error")
    warnings.filterwarnings("ignore", category=UserWarning)
    failed, began, number = 0, time.monotonic(), asked.start
    for number in range(asked.start, asked.start + asked.count):
        started = time.monotonic()
        try:
            soak(asked.seed, number)
        except Exception as wrong:
            failed += 1
            print(f"--seed {asked.seed} --start {number} --count 1: {scene(asked.seed, number)[0]} "
                  f"{WAYS[number // len(KINDS) % len(WAYS)]}: {type(wrong).__name__}: {wrong}", flush=True)  # fmt: skip
        if time.monotonic() - started > 4 * SECONDS:
            print(f"--seed {asked.seed} --start {number} --count 1: {time.monotonic() - started:.1f} s", flush=True)
        if time.monotonic() - began > asked.seconds:
            break
    print(f"{number + 1 - asked.start} scenes, {failed} failed, {time.monotonic() - began:.0f} s")
    sys.exit(bool(failed))


if __name__ == "__main__":
    main()
