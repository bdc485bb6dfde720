"""Meshes: closed and manifold by another library, on the surface, and the nearer to it the finer they are."""

from pathlib import Path

import manifold3d
import numpy as np
import pytest
import trimesh
from click.testing import CliRunner, Result
from hypothesis import example, given, settings
from hypothesis import strategies as st

import molviz
from molviz.cli.main import main
from molviz.geometry.boundary_graph import BoundaryGraph, boundary_graph
from molviz.geometry.mesh import Mesh, boundary_mesh
from molviz.geometry.shells import shells_of
from molviz.geometry.smooth import smooth_surface, whole_boundary
from molviz.geometry.smooth_mesh import smooth_mesh
from molviz.model.spheres import Spheres
from tests.smooth_oracle import distance_to_free_space
from tests.test_smooth import prepared, scene

SAMPLES = Path(__file__).parent.parent / "samples"
CAFFEINE, C60 = str(SAMPLES / "caffeine.xyz"), str(SAMPLES / "c60.xyz")


def is_manifold(mesh: Mesh) -> bool:
    checked = manifold3d.Manifold(manifold3d.Mesh64(mesh.vertex, mesh.triangle.astype(np.uint64)))
    loaded = trimesh.Trimesh(mesh.vertex, mesh.triangle, process=False)
    return bool(checked.status() == manifold3d.Error.NoError and loaded.is_watertight and loaded.is_winding_consistent)


def whole(graph: BoundaryGraph, longest: float) -> Mesh:
    return boundary_mesh(graph, np.ones(len(graph.faces.sphere), dtype=bool), longest)


def rolled(spheres: Spheres, probe: float, longest: float) -> Mesh:
    graph = prepared(spheres, probe)
    return smooth_mesh(graph, probe, whole_boundary(graph), longest)


@given(st.integers(0, 10**9))
@example(744311)  # an edge beside an arc whose middle lay beyond it
@example(3279)  # a spindle without vertices: its cusps are as near to all of a circle
@settings(max_examples=20)
def test_meshes_are_closed_and_manifold_and_on_the_surface(seed: int) -> None:
    spheres, probe = scene(seed)
    graph = prepared(spheres, probe)
    balls, smooth = whole(graph, 0.4), rolled(spheres, probe, 0.4)
    assert is_manifold(balls) and is_manifold(smooth)
    own = graph.boundary.spheres
    gap = np.linalg.norm(balls.vertex[:, None] - own.center, axis=2) - own.radius
    assert np.abs(gap.min(axis=1)).max() < 1e-9
    assert np.abs(distance_to_free_space(own, smooth.vertex) - probe).max() < 1e-9


def test_twice_as_fine_is_four_times_as_near() -> None:
    loaded = molviz.surface(CAFFEINE)
    assert loaded.smooth is not None
    exact = {"smooth": (loaded.smooth.area(), loaded.smooth.volume), "accessible": totals(loaded.graph)}
    exact["vdw"] = totals(boundary_graph(loaded.spheres))
    for kind, (area, volume) in exact.items():
        meshes = [loaded.mesh(kind, edge) for edge in (0.4, 0.1)]
        errors = [(1 - mesh.area() / area, 1 - mesh.volume() / volume) for mesh in meshes]
        for coarse, fine in zip(*errors, strict=True):
            assert abs(coarse) < 0.02 and abs(fine) < abs(coarse) / 10, kind


def totals(graph: BoundaryGraph) -> tuple[float, float]:
    shells = shells_of(graph)
    return float(shells.area.sum()), float(shells.volume.sum())


TRIANGLE = np.array([[0.0, 0, 0], [3.4, 0, 0], [1.7, 2.94, 0]])
CUTTING = {
    "a saddle that cuts itself": (TRIANGLE[:2] * 0.7, 1.0, 0.21),
    "probes on both sides of three balls that cut each other in a whole circle": (TRIANGLE, 1.2, 1.4),
    "a ring of spindles without a vertex": (TRIANGLE * 1.32, 1.2, 1.1),
    "balls apart": (TRIANGLE * 3, 1.2, 1.4),
}


@pytest.mark.parametrize("name", CUTTING)
def test_self_intersections_are_edges(name: str) -> None:
    center, radius, probe = CUTTING[name]
    spheres = Spheres(center, np.full(len(center), radius))
    mesh = rolled(spheres, probe, 0.1)
    graph = prepared(spheres, probe)
    exact = smooth_surface(graph, probe, whole_boundary(graph))
    assert is_manifold(mesh)
    assert mesh.area() == pytest.approx(exact.area(), rel=2e-3) and mesh.volume() == pytest.approx(
        exact.volume, rel=3e-3
    )


def test_a_large_face_around_a_small_hole() -> None:
    """The ends of edges over the far side of the ball are next to each other."""
    pair = boundary_graph(Spheres(np.array([[0.0, 0, 0], [2.998, 0, 0]]), np.array([2.0, 1.0])))
    assert whole(pair, 0.6).area() == pytest.approx(shells_of(pair).area.sum(), rel=0.03)


# ---- files


def run(*words: str) -> Result:
    return CliRunner().invoke(main, ["surface", *words])


@pytest.mark.parametrize("suffix", ["ply", "obj", "stl", "glb"])
def test_files_are_closed_and_coloured_by_atom(suffix: str, tmp_path: Path) -> None:
    for source, kind in ((CAFFEINE, "smooth"), (C60, "vdw")):
        target = tmp_path / f"{Path(source).stem}.{suffix}"
        assert run(source, "-o", str(target), "--mesh", kind, "--edge", "0.6").exit_code == 0
        loaded = trimesh.load(target, force="mesh")
        assert loaded.is_watertight and loaded.is_winding_consistent
    colors = trimesh.load(tmp_path / f"caffeine.{suffix}", force="mesh").visual
    assert suffix == "stl" or len(np.unique(colors.vertex_colors, axis=0)) == 4


def test_the_same_command_writes_the_same_bytes(tmp_path: Path) -> None:
    for name in ("one.ply", "two.ply"):
        run(CAFFEINE, "-o", str(tmp_path / name))
    assert (tmp_path / "one.ply").read_bytes() == (tmp_path / "two.ply").read_bytes()


def test_the_outer_surface_has_no_cavity() -> None:
    both, outer = (molviz.surface(C60, outer_only=only).mesh("vdw", 0.8) for only in (False, True))
    assert outer.volume() > both.volume() and outer.area() < both.area()


def test_many_inputs_are_written_to_a_folder_that_is_made(tmp_path: Path) -> None:
    pattern = str(tmp_path / "new" / "{stem}.ply")
    assert run(CAFFEINE, C60, "-o", pattern, "--edge", "1").exit_code == 0
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == ["c60.ply", "caffeine.ply"]
    frames = tmp_path / "frames.xyz"
    frames.write_text("1\n\nC 0 0 0\n1\n\nC 0 0 0\n", encoding="ascii")
    told = run(str(frames), "--model", "all", "-o", str(tmp_path / "x.ply"))
    assert told.exit_code == 2 and "expected --model NUMBER" in told.stderr and not (tmp_path / "x.ply").exists()


def test_what_cannot_be_is_refused(tmp_path: Path) -> None:
    assert run(CAFFEINE, "-o", str(tmp_path / "x.xyz")).exit_code == 2
    assert run(CAFFEINE, "--probe", "0", "-o", str(tmp_path / "x.ply")).exit_code == 1
    surface = molviz.surface(CAFFEINE, probe=0)
    for kind, edge in (("smooth", 0.5), ("round", 0.5), ("vdw", 0.0), ("vdw", "long")):
        with pytest.raises(molviz.InputError):
            surface.mesh(kind, edge)
    with pytest.raises(molviz.InputError, match="no format"):
        surface.save(tmp_path / "x.svg", "vdw")
    assert not list(tmp_path.iterdir())
