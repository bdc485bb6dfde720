"""Time of ``molviz.Index`` beside the k-d tree of SciPy, in one run: points, balls, and placements of a ligand.

    pip install .[bench]
    python benchmarks/query_bench.py [4hhb.pdb ...] [--points 1000000] [--placements 200] [--repeat 3]

Without files, a globule as dense as a protein is asked. The points are uniform in its box, the query balls have up to
its largest radius, and the ligand, 600 of its own atoms from the middle, is turned at random about where it was: nearly
all of its atoms clash. Building the index is counted for points and balls, not for placements. Peers answer the same
question: the balls of each point, the pairs that overlap.
"""

import argparse
import time
from collections.abc import Callable

import numpy as np
from globule import globule
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

import molviz
from molviz.model.spheres import Spheres

LIGAND = 600  # atoms


def by_tree(spheres: Spheres, center: np.ndarray, radius: np.ndarray) -> int:
    """Return how many query balls and balls meet, found with a k-d tree of the centres."""
    reach = radius + spheres.radius.max()
    near = cKDTree(spheres.center).query_ball_point(center, reach)
    query = np.repeat(np.arange(len(center)), [len(one) for one in near])
    ball = np.concatenate([np.asarray(one, dtype=int) for one in near])
    gap = np.sum((center[query] - spheres.center[ball]) ** 2, axis=1)
    return int(np.sum(gap < (radius[query] + spheres.radius[ball]) ** 2))


def best(action: Callable[[], int], repeat: int) -> tuple[float, int]:
    """Return the least seconds and the answer."""
    seconds = []
    for _ in range(repeat):
        begin = time.perf_counter()
        answer = action()
        seconds.append(time.perf_counter() - begin)
    return min(seconds), answer


def tell(what: str, seconds: float, answer: int) -> None:
    """Print a row of the table."""
    print(f"  {what:<44} {seconds:10.4f} s  {answer:>10} pairs")


def compare(spheres: Spheres, points: int, placements: int, repeat: int) -> None:
    """Print the times of all questions to one scene."""
    random = np.random.default_rng(0)
    place = random.uniform(*spheres.box(), (points, 3))
    for what, radius in [("points", np.zeros(points)), ("balls", random.uniform(0, spheres.radius.max(), points))]:
        index = lambda radius=radius: len(molviz.Index(spheres).meeting(place, radius).item)  # noqa: E731
        tell(f"{points} {what}, molviz", *best(index, repeat))
        tell(f"{points} {what}, k-d tree", *best(lambda radius=radius: by_tree(spheres, place, radius), 1))
    middle = spheres.center.mean(axis=0)
    ligand = spheres.take(np.argsort(np.linalg.norm(spheres.center - middle, axis=1))[:LIGAND])
    turns = Rotation.random(placements, random_state=0).as_matrix()
    shifts = middle - turns @ middle
    index, other = molviz.Index(spheres), molviz.Index(ligand)
    index.clashes(other)
    for what, poses in [("one placement", (turns[:1], shifts[:1])), (f"{placements} placements", (turns, shifts))]:
        tell(f"{what} of {LIGAND} atoms, molviz", *best(lambda poses=poses: len(index.clashes(other, poses).a), repeat))
    tell(f"one placement of {LIGAND} atoms, k-d tree", *best(
        lambda: by_tree(spheres, ligand.center @ turns[0].T + shifts[0], ligand.radius), repeat
    ))  # fmt: skip


def main() -> None:
    """Read the command line and print a table for each scene."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*")
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--placements", type=int, default=200)
    parser.add_argument("--repeat", type=int, default=3)
    asked = parser.parse_args()
    scenes = {path: molviz.Index(path).spheres for path in asked.files} or {"globule": globule(5000)}
    for name, spheres in scenes.items():
        print(f"{name}: {len(spheres.radius)} balls")
        compare(spheres, asked.points, asked.placements, asked.repeat)


if __name__ == "__main__":
    main()
