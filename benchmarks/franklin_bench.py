"""Hidden lines of Franklin's scene: molviz beside what people would use instead, and its scaling.

    python benchmarks/franklin_bench.py [peers] [scaling] [statistics]

``peers`` needs shapely, and vpype with vpype-occult for the second comparison; without them it says so.
"""

import math
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from franklin_figures import overlaid

from molviz.discs.grid import UNIT_SQUARE
from molviz.model.scenes import random_scene
from molviz.model.spheres import Spheres
from molviz.picture.disc_picture import WIDTH, DiscLook
from molviz.pipeline.hidden_discs import HiddenDiscs, hide_discs, picture_of
from molviz.write import pieces

COUNT = 10000
CORNERS = 64
PUBLISHED = {  # his Fig. 8
    "cell_entries": 39560, "cells_blocked": 19337, "pairs_tested": 71136, "pairs_intersecting": 32115,
    "visible_whole": 250, "hidden": 6635, "arcs": 4356, "length_circumferences": 1037.48,
}  # fmt: skip
VPYPE = shutil.which("vpype", path=os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")]))


def timed(work: Callable[[], object], repeats: int = 1) -> float:
    """The shortest of some runs, in seconds."""
    best = math.inf
    for _ in range(repeats):
        begin = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - begin)
    return best


def peers() -> None:
    """Time and size of the file beside polygon differences and vpype's plug-in."""
    scene = random_scene(COUNT)
    folder = Path(tempfile.mkdtemp())
    result: dict[str, bytes] = {}

    def ours() -> None:
        result["svg"] = b"".join(pieces(picture_of(hide_discs(scene, UNIT_SQUARE), DiscLook()), ".svg"))

    seconds = timed(ours, 3)
    print(f"N = {COUNT}, depth 10, scene in memory to SVG in memory")
    print(f"{'molviz':<28}{seconds:9.2f} s {len(result['svg']):12,} bytes")
    compare("shapely, 64-gons, STRtree", *shapely_lines(scene), seconds, len(result["svg"]))
    if VPYPE:
        compare("vpype occult", *occult_lines(scene, folder), seconds, len(result["svg"]))
    else:
        print("vpype is not installed: pip install vpype vpype-occult")
    shutil.rmtree(folder)


def compare(name: str, seconds: float, size: int, ours: float, our_size: int) -> None:
    """Print one peer's row."""
    times, sizes = seconds / ours, size / our_size
    print(f"{name:<28}{seconds:9.2f} s {size:12,} bytes   {times:7.1f} × the time, {sizes:5.1f} × the bytes")


def shapely_lines(scene: Spheres) -> tuple[float, int]:
    """Every ring minus the union of the nearer polygons that it meets; seconds and the size of the SVG paths."""
    import shapely

    begin = time.perf_counter()
    angle = np.linspace(0, 2 * math.pi, CORNERS, endpoint=False)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    polygons = shapely.polygons(scene.center[:, None, :2] + scene.radius[:, None, None] * circle)
    rings = shapely.get_exterior_ring(polygons)
    far, near = shapely.STRtree(polygons).query(rings, predicate="intersects")
    ahead = scene.center[near, 2] < scene.center[far, 2]
    far, near = far[ahead], near[ahead]
    order = np.argsort(far, kind="stable")
    start = np.searchsorted(far[order], np.arange(len(rings) + 1))
    visible = [
        shapely.difference(ring, shapely.union_all(polygons[near[order[start[k] : start[k + 1]]]]))
        for k, ring in enumerate(rings)
    ]
    lines = shapely.get_parts(shapely.line_merge(np.array([line for line in visible if not line.is_empty])))
    paths = []
    for line in lines:
        points = shapely.get_coordinates(line) * WIDTH
        paths.append(f'<path d="M{"L".join(f"{x:.2f} {y:.2f}" for x, y in points.tolist())}"/>')
    text = '<svg xmlns="http://www.w3.org/2000/svg">' + "".join(paths) + "</svg>"
    return time.perf_counter() - begin, len(text)


def occult_lines(scene: Spheres, folder: Path) -> tuple[float, int]:
    """``vpype read, occult, write`` on whole circles, the farthest first; seconds and the size of its SVG."""
    order = np.argsort(-scene.center[:, 2], kind="stable")
    back_to_front = Spheres(scene.center[order], scene.radius[order])
    before, after = folder / "before.svg", folder / "after.svg"
    before.write_bytes(b"".join(pieces(overlaid(back_to_front, DiscLook()), ".svg")))
    command = [VPYPE or "vpype", "read", str(before), "occult", "write", str(after)]
    seconds = timed(lambda: subprocess.run(command, check=True))
    return seconds, after.stat().st_size


def hidden(count: int, depth: float) -> HiddenDiscs:
    """A random scene without its hidden lines."""
    return hide_discs(random_scene(count, depth=depth, seed=0), UNIT_SQUARE)


def scaling() -> None:
    """Time against the number of spheres and against depth."""
    counts = [1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000]
    seconds = []
    for count in counts:
        scene = random_scene(count, seed=0)
        seconds.append(timed(lambda scene=scene: hide_discs(scene, UNIT_SQUARE), 5 if count < 200_000 else 2))
        print(f"N = {count:>9,}   depth 10   {seconds[-1]:9.4f} s   {1e6 * seconds[-1] / count:6.2f} µs a sphere")
    slope = np.polyfit(np.log(counts), np.log(seconds), 1)[0]
    print(f"slope of log time over log N: {slope:.3f}")
    by_depth = {depth: timed(lambda depth=depth: hidden(300_000, depth), 2) for depth in (1, 2, 5, 10, 20, 30)}
    for depth, spent in by_depth.items():
        print(f"N =   300,000   depth {depth:>2}   {spent:9.4f} s")
    print(f"time at depth 30 over time at depth 5: {by_depth[30] / by_depth[5]:.2f}")


def statistics() -> None:
    """His run, with his generator and over 20 seeds."""
    runs = [None, *range(20)]
    rows = [hide_discs(random_scene(COUNT, radius=0.0178, seed=seed), UNIT_SQUARE, 142).statistics() for seed in runs]
    print(f"{'':24}{'published':>12}{'his scene':>12}{'off':>8}{'20 seeds':>12}{'spread':>9}{'off':>8}")
    for name, published in PUBLISHED.items():
        mine, values = rows[0][name], np.array([row[name] for row in rows[1:]], dtype=float)
        off, off_mean = mine / published - 1, values.mean() / published - 1
        print(f"{name:24}{published:12.7g}{mine:12.7g}{off:8.1%}{values.mean():12.7g}{values.std():9.3g}{off_mean:8.1%}")


if __name__ == "__main__":
    parts = {"peers": peers, "scaling": scaling, "statistics": statistics}
    for part in sys.argv[1:] or parts:
        parts[part]()
