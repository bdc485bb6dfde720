"""Random points of every kind of patch of smooth surfaces against the distance to the probe's free space.

    python -m tests.patches [--seed 0] [--points 100000]

Goes on until there are that many points of each kind. Scene k of a seed is always the same.
"""

import argparse
import sys
from collections import Counter
from itertools import count

import numpy as np

from molviz.geometry.boundary_graph import boundary_graph
from tests.smooth_oracle import KINDS, wrong_points
from tests.test_smooth import scene

EACH = 500  # points of a kind in a scene


def main() -> None:
    parser = argparse.ArgumentParser(description="Try points of every kind of patch; prints scenes with wrong ones.")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--points", type=int, default=100_000)
    asked = parser.parse_args()
    points, wrong, scenes = Counter[str](), Counter[str](), 0
    for number in count(asked.seed * 10**6):
        spheres, probe = scene(number)
        graph = boundary_graph(spheres.enlarged(1.0, probe))
        for kind, (tried, bad) in wrong_points(graph, probe, EACH, np.random.default_rng(number)).items():
            points[kind] += tried
            wrong[kind] += bad
            if bad:
                print(f"scene {number}: {bad} of {tried} {kind} points", flush=True)
        scenes += 1
        if min(points[kind] for kind in KINDS) >= asked.points:
            break
    print(f"{scenes} scenes; " + ", ".join(f"{kind} {points[kind]} points, {wrong[kind]} wrong" for kind in KINDS))
    sys.exit(any(wrong.values()))


if __name__ == "__main__":
    main()
