"""Closed forms for two and three balls."""

import numpy as np

PAIRS = ((0, 1), (1, 2), (0, 2))


def lens_volume(r1: complex, r2: complex, d: complex) -> complex:
    """Two balls that cross: ``π (r1 + r2 − d)² (d² + 2d (r1 + r2) − 3 (r1 − r2)²) / 12d``."""
    return np.pi * (r1 + r2 - d) ** 2 * (d * d + 2 * d * (r1 + r2) - 3 * (r1 - r2) ** 2) / (12 * d)


def cap_area(r1: float, r2: float, d: float) -> float:
    """The part of sphere 1 in ball 2: ``2π r1 h``."""
    return float(2 * np.pi * r1 * (r1 - (d * d + r1 * r1 - r2 * r2) / (2 * d)))


def union_of_three(center: np.ndarray, radius: np.ndarray) -> complex:
    """Volume of three balls whose spheres have two points in common; radii may be complex, to differentiate."""
    lenses = {(i, j): lens_volume(radius[i], radius[j], _distance(center, i, j)) for i, j in PAIRS}
    balls = 4 / 3 * np.pi * radius**3
    return complex(balls.sum() - sum(lenses.values()) + _triple_volume(center, radius, balls, lenses))


def _distance(center: np.ndarray, i: int, j: int) -> float:
    return float(np.linalg.norm(center[i] - center[j]))


def _triple_volume(center: np.ndarray, radius: np.ndarray, balls: np.ndarray, lenses: dict) -> complex:
    """Inclusion and exclusion inside the tetrahedron of the centres and a common point, weighted with its angles.

    The tetrahedron is covered, so its volume is ``Σ Ω_i V_i / 4π − Σ φ_ij V_ij / 2π + V_123 / 2`` with its solid angles
    Ω and dihedral angles φ.
    """
    corners = np.vstack([center.astype(complex), _common_point(center, radius)])
    dihedral = {(i, j): _dihedral(corners, i, j) for i in range(4) for j in range(4) if i != j}
    solid = np.array([sum(dihedral[i, j] for j in range(4) if j != i) - np.pi for i in range(3)])
    edges = corners[1:] - corners[0]
    tetrahedron = edges[0] @ np.cross(edges[1], edges[2]) / 6
    tetrahedron *= np.sign(tetrahedron.real)
    inside = (solid * balls).sum() / (4 * np.pi) - sum(dihedral[pair] * lenses[pair] for pair in PAIRS) / (2 * np.pi)
    return complex(2 * (tetrahedron - inside))


def _common_point(center: np.ndarray, radius: np.ndarray) -> np.ndarray:
    x = (center[1] - center[0]) / _distance(center, 0, 1)
    third = center[2] - center[0]
    y = third - (third @ x) * x
    y /= np.linalg.norm(y)
    d, p, q = _distance(center, 0, 1), third @ x, third @ y
    along = (radius[0] ** 2 - radius[1] ** 2 + d * d) / (2 * d)
    across = (radius[0] ** 2 - radius[2] ** 2 + p * p + q * q - 2 * p * along) / (2 * q)
    return center[0] + along * x + across * y + np.sqrt(radius[0] ** 2 - along**2 - across**2) * np.cross(x, y)


def _dihedral(corners: np.ndarray, i: int, j: int) -> complex:
    k, m = (corner for corner in range(4) if corner not in (i, j))
    one = np.cross(corners[j] - corners[i], corners[k] - corners[i])
    other = np.cross(corners[j] - corners[i], corners[m] - corners[i])
    return complex(np.arccos(one @ other / np.sqrt((one @ one) * (other @ other))))
