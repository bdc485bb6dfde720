"""The smooth surface: closed forms, its two identities, and its points against the distance to the probe's space."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.geometry.boundary_graph import BoundaryGraph, boundary_graph
from molviz.geometry.cap_regions import CapSets, area_and_flux, free_arcs, rims_of_caps
from molviz.geometry.shells import shells_of
from molviz.geometry.smooth import part_of_boundary, probes_of, smooth_surface, triangles, whole_boundary
from molviz.model.spheres import Spheres
from tests.oracle import random_spheres
from tests.smooth_oracle import wrong_points
from tests.test_shells import together, wall


def scene(seed: int) -> tuple[Spheres, float]:
    """Two to fourteen balls in a lump or a few, and a probe from a thirtieth of them to thrice as large."""
    random = np.random.default_rng(seed)
    count = int(random.integers(2, 15))
    probe = 10 ** random.uniform(-1.5, 0.5)
    extent = random.uniform(1.2, 2.5 + probe) * count ** (1 / 3)
    return random_spheres(seed, count, extent, random.uniform(1.05, 3.0)), float(probe)


def prepared(spheres: Spheres, probe: float) -> BoundaryGraph:
    return boundary_graph(spheres.enlarged(1.0, probe))


def check_identities(spheres: Spheres, probe: float, step: float = 1e-4) -> float:
    """|∮ n dA| / A is asserted; returns the error of dV/dε = A."""
    graph = prepared(spheres, probe)
    kept = whole_boundary(graph)
    surface = smooth_surface(graph, probe, kept)
    area = surface.area()
    assert np.linalg.norm(surface.leak) < 1e-12 * area
    assert min(surface.convex.min(), surface.saddle.min(), surface.concave.min()) > -1e-12 * area
    volumes = [smooth_surface(graph, probe - sign * step * h, kept).volume for h in (1, 0.5) for sign in (1, -1)]
    slopes = (volumes[0] - volumes[1]) / (2 * step), (volumes[2] - volumes[3]) / step
    return abs((4 * slopes[1] - slopes[0]) / 3 / area - 1)


@given(st.integers(0, 10**9))
@settings(max_examples=60)
def test_the_surface_is_closed_and_its_area_the_slope_of_its_volume(seed: int) -> None:
    """Where the steps cross a change of topology the slope is off by as much as the area changes between them."""
    assert check_identities(*scene(seed)) < 1e-5


@given(st.integers(0, 10**9))
@settings(max_examples=40)
def test_points_of_patches_are_as_far_from_the_free_space_as_the_probe_is_wide(seed: int) -> None:
    spheres, probe = scene(seed)
    found = wrong_points(prepared(spheres, probe), probe, 300, np.random.default_rng(seed))
    assert not any(wrong for _, wrong in found.values())


@pytest.mark.parametrize("probe", [3.0, 1.0, 0.21], ids=["a wide ring", "a ring", "a spindle"])
def test_two_balls_have_a_surface_of_revolution(probe: float) -> None:
    """Guldin's rules for the profile, by Simpson's rule."""
    radius, half = 1.0, 1.2
    surface = smooth_surface(*of(Spheres(np.array([[0.0, 0, -half], [0, 0, half]]), np.full(2, radius)), probe))
    rho = np.sqrt((radius + probe) ** 2 - half**2)
    limit, waist = np.arctan2(half, rho), np.arccos(min(rho / probe, 1.0))
    theta = np.linspace(waist, limit, 2001)
    out = rho - probe * np.cos(theta)
    height = probe * np.sin(theta)
    weight = np.ones(2001)
    weight[1:-1:2], weight[2:-1:2] = 4, 2
    weight *= (limit - waist) / 2000 / 3
    saddle = 2 * 2 * np.pi * probe * np.sum(weight * out)
    cap = radius - (radius * half / (radius + probe))  # of a ball beyond its contact circle, seen from the other side
    convex = 2 * (4 * np.pi * radius**2 - 2 * np.pi * radius * cap)
    body = 2 * np.pi * np.sum(weight * out**2 * probe * np.cos(theta))
    ends = 2 * (4 / 3 * np.pi * radius**3 - np.pi * cap**2 * (3 * radius - cap) / 3)
    assert height[-1] == pytest.approx(half - radius + cap)
    assert surface.saddle.sum() == pytest.approx(saddle, rel=1e-11)
    assert surface.convex.sum() == pytest.approx(convex, rel=1e-12)
    assert surface.volume == pytest.approx(body + ends, rel=1e-11)
    assert len(surface.spindles) == (rho < probe)


def of(spheres: Spheres, probe: float) -> tuple:
    graph = prepared(spheres, probe)
    return graph, probe, whole_boundary(graph)


@given(st.integers(0, 10**6))
@settings(max_examples=20)
def test_triangles_by_closed_form_and_as_three_hemispheres(seed: int) -> None:
    spheres, probe = scene(seed)
    graph = prepared(spheres, probe)
    probes = probes_of(graph, probe, np.arange(len(graph.vertex)))
    count = len(probes.vertex)
    sphere = np.repeat(np.arange(count), 3)
    caps = CapSets(sphere, np.arange(count + 1) * 3, probes.away.reshape(-1, 3), np.zeros(3 * count))
    area, flux = area_and_flux(caps, rims_of_caps(caps, free_arcs(caps)))
    expected = triangles(probes)
    assert np.allclose(area, expected[0], rtol=0, atol=1e-9) and np.allclose(flux, expected[1], rtol=0, atol=1e-9)


def test_the_outer_surface_leaves_out_voids() -> None:
    hollow = wall(5, 1.2)
    graph = prepared(hollow, 1.0)
    shells = shells_of(graph)
    assert shells.outer.tolist() == [True, False]
    both, outer, inner = (
        smooth_surface(graph, 1.0, part_of_boundary(graph, chosen))
        for chosen in (np.ones(len(shells.of_face), dtype=bool), shells.of_face == 0, shells.of_face == 1)
    )
    filled = together(hollow, Spheres(np.zeros((1, 3)), np.array([4.0])))
    assert both.area() == pytest.approx(outer.area() + inner.area()) and inner.volume < 0 < both.volume
    assert smooth_surface(*of(filled, 1.0)).volume == pytest.approx(outer.volume, rel=1e-12)


CUBE = np.array(list(np.ndindex(2, 2, 2)), dtype=float)


@pytest.mark.parametrize("side", [1.5, 2.0, 3.0])
def test_symmetric_balls_are_the_limit_of_others(side: float) -> None:
    """One probe on four balls: the values change as little as the balls are displaced."""
    exact = Spheres(side * CUBE, np.full(8, 1.2))
    moved = Spheres(exact.center + np.random.default_rng(2).uniform(-1e-5, 1e-5, (8, 3)), exact.radius)
    one, other = smooth_surface(*of(exact, 1.4)), smooth_surface(*of(moved, 1.4))
    assert one.area() == pytest.approx(other.area(), abs=1e-3) and one.volume == pytest.approx(other.volume, abs=1e-3)
    assert np.linalg.norm(one.leak) < 1e-12 * one.area() and check_identities(exact, 1.4) < 1e-7
