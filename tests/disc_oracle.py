"""Slow and obvious hidden lines of discs: every perimeter against every nearer disc, one at a time.

Decisions are exact (rational arithmetic); only the angles are floating point, by the law of cosines.
"""

import math
from fractions import Fraction

TURN = 2.0 * math.pi
Disc = tuple[float, float, float, float]  # x, y, z, r


def is_nearer(discs: list[Disc], one: int, other: int) -> bool:
    return (discs[one][2], one) < (discs[other][2], other)


def hidden_interval(far: Disc, near: Disc) -> tuple[float, float] | None:
    """Start and sweep of what the nearer disc hides of the farther perimeter."""
    if math.hypot(near[0] - far[0], near[1] - far[1]) > (1 + 1e-9) * (near[3] + far[3]):
        return None  # so far apart that rounding cannot matter
    x, y = Fraction(near[0]) - Fraction(far[0]), Fraction(near[1]) - Fraction(far[1])
    r, n = Fraction(far[3]), Fraction(near[3])
    squared = x * x + y * y
    if n >= r and squared <= (n - r) ** 2:
        return 0.0, TURN
    if squared >= (n + r) ** 2 or squared <= (n - r) ** 2:
        return None
    cosine = float(squared + r * r - n * n) / (2.0 * float(r) * math.sqrt(squared))
    half = math.acos(max(-1.0, min(1.0, cosine)))
    return math.atan2(y, x) - half, 2.0 * half


def complement(hidden: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Start and sweep of what closed intervals leave of a circle; ends closer than 1e-11 are taken to touch."""
    if not hidden:
        return [(0.0, TURN)]
    cuts = sorted((start % TURN, sweep) for start, sweep in hidden)
    free = []
    reached = max(start + sweep - TURN for start, sweep in cuts)
    for start, sweep in cuts:
        if start > reached + 1e-11:
            free.append((reached % TURN, start - reached))
        reached = max(reached, start + sweep)
    return sorted(free)


def visible_arcs(discs: list[Disc]) -> list[list[tuple[float, float]]]:
    """For every disc the visible arcs of its perimeter, ordered by start."""
    arcs = []
    for far in range(len(discs)):
        cuts = [hidden_interval(discs[far], discs[near]) for near in range(len(discs)) if is_nearer(discs, near, far)]
        arcs.append(complement([cut for cut in cuts if cut is not None]))
    return arcs


def top_disc(discs: list[Disc], x: float, y: float) -> int:
    """The foremost disc over a point, −1 for none."""
    over = [k for k, (cx, cy, _, r) in enumerate(discs) if math.hypot(x - cx, y - cy) < r]
    return min(over, key=lambda k: (discs[k][2], k), default=-1)
