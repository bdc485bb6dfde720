"""Tables 1, 2 and 3 of Franklin's "An exact hidden sphere algorithm that operates in linear time" (1980), run again.

    python benchmarks/franklin_tables.py

His figures (seconds on a Prime 500) stand beside ours.
"""

import math
import time

import numpy as np

from molviz.discs.grid import UNIT_SQUARE, depth_complexity
from molviz.model.scenes import random_scene
from molviz.model.spheres import Spheres
from molviz.pipeline.hidden_discs import hide_discs

TABLE_1 = [  # N, R, best L, T, Tn
    (300, 0.01, 0.0625, 2.6, 2.6), (300, 0.03, 0.167, 5.5, 5.5), (300, 0.05, 0.25, 11.6, 11.6),
    (300, 0.07, 0.033, 13.4, 13.4), (300, 0.1, 0.04, 9.0, 9.0), (500, 0.1, 0.04, 15.0, 9.0),
    (1000, 0.1, 0.033, 27.8, 8.3),
]  # fmt: skip
TABLE_2 = [  # N, R, G, T
    (30, 0.326, 7, 4.1), (100, 0.178, 13, 5.6), (300, 0.103, 23, 10.3), (1000, 0.0564, 42, 31.1),
    (3000, 0.0326, 72, 97.5), (10000, 0.0178, 142, 383.0),
]  # fmt: skip
TABLE_3 = [("Fixed R", 0.0564, False, 0.024, 31.1), ("Variable R", 0.135, True, 0.025, 19.3)]  # max R, shrink, L, T
MORE = 25  # spheres to one of his in Table 1, a tenth the radius: his scenes take us too little time to compare
SHARES = np.geomspace(0.15, 8.0, 16)  # L / R that are tried


def seconds(scene: Spheres, across: int, repeats: int = 3) -> float:
    """The shortest of some runs."""
    return min(hide_discs(scene, UNIT_SQUARE, across).seconds for _ in range(repeats))


def best(scene: Spheres, radius: float) -> tuple[float, float]:
    """L / R of the fastest grid, and its time."""
    tried = [(seconds(scene, max(1, round(1 / (share * radius))), 2), share) for share in SHARES]
    fastest, share = min(tried)
    return float(share), fastest


def table_1() -> None:
    """The fastest grid at each depth, and its time."""
    print(f"Table 1. How time and optimal grid depend on depth (ours: {MORE} N spheres of R / {math.isqrt(MORE)})\n")
    print(f"{'':32}{'his':>24}{'ours':>27}")
    print(f"{'N':>8}{'R':>8}{'D':>8}{'L/R':>16}{'T':>8}{'Tn':>8}{'L/R':>11}{'T':>10}{'Tn':>10}")
    for count, radius, cell, spent, normal in TABLE_1:
        scene = random_scene(MORE * count, radius=radius / math.sqrt(MORE))
        share, ours = best(scene, radius / math.sqrt(MORE))
        depth = math.pi * count * radius**2
        print(
            f"{count:>8}{radius:>8}{depth:>8.2f}{cell / radius:>16.2f}{spent:>8}{normal:>8}"
            f"{share:>11.2f}{ours:>10.4f}{ours * 300 / count:>10.4f}"
        )


def table_2() -> None:
    """Time with his grids."""
    print("\nTable 2. Time against N with depth fixed at 10\n")
    print(f"{'N':>8}{'R':>8}{'G':>6}{'his T':>10}{'ms a sphere':>13}{'our T':>12}{'ms a sphere':>13}")
    for count, radius, across, spent in TABLE_2:
        ours = seconds(random_scene(count, radius=radius), across, 5)
        print(
            f"{count:>8}{radius:>8}{across:>6}{spent:>10}{1000 * spent / count:>13.1f}"
            f"{ours:>12.5f}{1000 * ours / count:>13.5f}"
        )


def table_3() -> None:
    """Time with his grids, all spheres alike and shrinking to the back."""
    print("\nTable 3. Fixed and variable radius, N = 1000\n")
    print(f"{'':12}{'max R':>8}{'D':>8}{'L':>8}{'his T':>10}{'our T':>12}")
    for name, radius, shrink, cell, spent in TABLE_3:
        scene = random_scene(1000, radius=radius, shrink=shrink)
        depth = depth_complexity(scene.radius, UNIT_SQUARE)
        ours = seconds(scene, round(1 / cell), 20)
        print(f"{name:12}{radius:>8}{depth:>8.2f}{cell:>8}{spent:>10}{ours:>12.5f}")


if __name__ == "__main__":
    begin = time.perf_counter()
    table_1()
    table_2()
    table_3()
    print(f"\n{time.perf_counter() - begin:.0f} s in all")
