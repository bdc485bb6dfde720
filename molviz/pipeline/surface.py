"""``molviz surface``: spheres → boundary as a graph → shells → the smooth surface of a probe."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from pathlib import PurePath
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.errors import InputError, InternalError, OptionError
from molviz.geometry.boundary_graph import BoundaryGraph, boundary_graph
from molviz.geometry.rims import sums
from molviz.geometry.shells import Shells, lining, reached_from_outside, shells_of
from molviz.geometry.smooth import Kept, SmoothSurface, part_of_boundary, smooth_surface, whole_boundary
from molviz.model.molecule import Molecule
from molviz.model.spheres import Spheres
from molviz.pipeline.inputs import Loaded, refuse_unresolved
from molviz.pipeline.measure import ids
from molviz.pipeline.outputs import refuse_inputs, save
from molviz.pipeline.values import parse_positive

TYPE_CHECKING = False
if TYPE_CHECKING:
    from molviz.geometry.mesh import Mesh

PER = ("shell", "atom")
MESHES = ("smooth", "accessible", "vdw")
SUFFIXES = (".ply", ".obj", ".stl", ".glb")
EDGE = 0.5  # ångström: a third of an atom's radius
LEAK = 1e-10  # of the area, that ∮ n dA may be off: closed to rounding
STEP, SLOPE = 1e-4, 1e-5  # of the probe's radius; of the area, that dV/dε may be off where steps meet a new cut


class Component(NamedTuple):
    """One shell of the boundary of the balls enlarged by the probe."""

    kind: str  # "outer" or "cavity"
    inside: int | None  # row of what is around it: of a cavity its component, of a component the cavity it lies in
    faces: int
    arcs: int  # with whole circles
    vertices: int
    genus: int
    area: float  # Å²
    volume: float  # Å³, positive
    atoms: Ints  # rows of the atoms whose balls line it, ascending


@dataclass(frozen=True, repr=False, eq=False)
class Surface:
    """The boundary of n balls enlarged by a probe, as a graph, and the smooth surface over which the probe rolls.

    ``graph`` and ``shells`` are tables; ``smooth`` is None for a probe of radius 0, whose smooth surface is the
    boundary itself. Rows are the atoms of ``molecule``.
    """

    source: str
    model: int  # from 1
    molecule: Molecule
    spheres: Spheres  # without the probe
    probe: float  # ångström
    outer_only: bool
    kept: Kept  # the part of the boundary that the probe's centre reaches
    graph: BoundaryGraph
    shells: Shells
    smooth: SmoothSurface | None

    def __repr__(self) -> str:
        rolled = "" if self.smooth is None else f", smooth surface {self.smooth.area():.3f} Å²"
        return (
            f"<Surface of {self.molecule.name!r}, probe {self.probe:g} Å: {self.shells.outer.sum()} components, "
            f"{self.cavities} cavities, area {self.shells.area.sum():.3f} Å²{rolled}>"
        )

    @property
    def cavities(self) -> int:
        """The number of cavities."""
        return int((~self.shells.outer).sum())

    @cached_property
    def components(self) -> tuple[Component, ...]:
        """The outer shells by falling volume, then the cavities by falling volume."""
        shells = self.shells
        shell, atom = lining(self.graph, shells)
        atoms = np.split(atom, np.searchsorted(shell, np.arange(1, len(shells.outer))))
        rows = zip(
            ["outer" if outer else "cavity" for outer in shells.outer.tolist()],
            [None if parent < 0 else parent for parent in shells.parent.tolist()],
            shells.faces.tolist(), shells.arcs.tolist(), shells.vertices.tolist(), shells.genus.tolist(),
            shells.area.tolist(), np.abs(shells.volume).tolist(), atoms, strict=False,
        )  # fmt: skip
        return tuple(Component(*row) for row in rows)

    def mesh(self, kind: str = "smooth", edge: float = EDGE) -> Mesh:
        """Return a closed mesh of the "smooth", "accessible" or "vdw" (van der Waals) surface, vertices exactly on it.

        Edges are about ``edge`` Å long at most, shorter where balls are small. Where voids were left out of the smooth
        surface, they are left out of the others, too. Raises InputError for another kind or edge.
        """
        if kind not in MESHES or (kind == "smooth" and self.smooth is None):
            raise InputError(f"mesh: {kind!r}; expected one of {', '.join(MESHES)}, and a probe for smooth")
        try:
            longest = parse_positive(edge)
        except ValueError as wrong:
            raise InputError(f"edge: {wrong}") from None
        mesh: Mesh = _meshes().mesh_of(self, kind, longest)
        return mesh

    def to(self, format: str, mesh: str = "smooth", edge: float = EDGE) -> bytes:
        """Return a mesh as the content of a file, coloured by atom: "ply", "obj", "stl" (without colours) or "glb".

        Raises InputError as ``mesh`` does, and for a format that nobody knows.
        """
        suffix = suffix_of_mesh(f"mesh.{str(format).removeprefix('.')}")
        data: bytes = _meshes().encoded_mesh(self, self.mesh(mesh, edge), suffix)
        return data

    def save(self, path: str | os.PathLike[str], mesh: str = "smooth", edge: float = EDGE) -> None:
        """Write a mesh in the format that the suffix of the path names; the file appears whole or not at all.

        Raises InputError as ``to`` does, and where the file cannot be written.
        """
        suffix = suffix_of_mesh(os.fspath(path))
        refuse_inputs(os.fspath(path), [self.source])
        save(os.fspath(path), [self.to(suffix, mesh, edge)])

    def accessible(self) -> Floats:
        """Return the area (n,) in Å² of each enlarged ball on the boundary."""
        return sums(self.graph.faces.sphere, self.graph.face_area(), len(self.molecule))

    def spindles(self) -> Ints:
        """Return the rows (m, 2) of the atoms between which the smooth surface's saddles cut themselves."""
        circles, arcs = self.graph.boundary.circles, self.graph.boundary.arcs
        arc = np.empty(0, dtype=np.int64) if self.smooth is None else self.smooth.spindles
        return np.column_stack([circles.first[arcs.circle[arc]], circles.second[arcs.circle[arc]]])

    def cut_triangles(self) -> Ints:
        """Return the rows (m, 3) of the atoms between which other probes cut the smooth surface's triangles."""
        vertex = np.empty(0, dtype=np.int64) if self.smooth is None else self.smooth.cut_triangles
        return self.graph.vertex_spheres[vertex]


def suffix_of_mesh(path: str) -> str:
    """Return the suffix of a path; raises OptionError where no mesh has such a format."""
    suffix = PurePath(path).suffix.lower()
    if suffix not in SUFFIXES:
        raise OptionError(f"no format {PurePath(path).suffix!r} of meshes; expected one of {' '.join(SUFFIXES)}", path)
    return suffix


def _meshes() -> ModuleType:
    """The stage that needs packages which nothing else does."""
    try:
        return import_module("molviz.pipeline.meshes")
    except ModuleNotFoundError as missing:
        raise InputError(f"meshes need the package {missing.name}; expected pip install 'molviz[mesh]'") from None


def surface_of(loaded: Loaded, probe: float, outer_only: bool = False, check: bool = False) -> Surface:
    """Return the surface of a model that was loaded without a probe, for a probe of the given radius in ångström.

    ``outer_only`` leaves out voids: the probe rolls over what it reaches from far away. ``check`` verifies both
    identities of the surface and raises InternalError where one does not hold. Raises InputError where the smallest
    ball is lost in the rounding of the scene.
    """
    refuse_unresolved(loaded.balls, loaded.source)
    graph = boundary_graph(loaded.spheres.enlarged(1.0, probe))
    shells = shells_of(graph)
    kept = part_of_boundary(graph, reached_from_outside(shells)) if outer_only else whole_boundary(graph)
    smooth = smooth_surface(graph, probe, kept) if probe > 0 else None
    if check:
        check_surface(graph, shells, probe, kept, smooth)
    about = (loaded.source, loaded.model, loaded.molecule, loaded.spheres)
    return Surface(*about, probe, outer_only, kept, graph, shells, smooth)


def check_surface(graph: BoundaryGraph, shells: Shells, probe: float, kept: Kept, smooth: SmoothSurface | None) -> None:
    """Raise InternalError unless both surfaces are closed (∮ n dA = 0) and the area is dV/dε of the smooth one."""
    leaks = [(graph.face_flux().sum(axis=0), shells.area.sum())]
    if smooth is not None:
        leaks.append((smooth.leak, smooth.area()))
    if any(np.linalg.norm(leak) > LEAK * area for leak, area in leaks) or (shells.genus < 0).any():
        raise InternalError("the surface is not closed")
    if smooth is None:
        return
    step = STEP * probe
    shrunk, grown = (smooth_surface(graph, probe + sign * step, kept).volume for sign in (1, -1))
    if abs((grown - shrunk) / (2 * step) - smooth.area()) > SLOPE * smooth.area():
        raise InternalError("the smooth surface's area is not the slope of its volume")


def surface_as_data(surface: Surface, radii: str, per: str) -> dict[str, Any]:
    """Return what ``molviz surface --json`` prints; rows of atoms are those of the input."""
    shells, graph, row = surface.shells, surface.graph, surface.molecule.row
    data = {
        "file": surface.source,
        "model": surface.model,
        "radii": radii,
        "probe": surface.probe,
        "components": [one._asdict() | {"atoms": row[one.atoms].tolist()} for one in surface.components],
        "cavities": surface.cavities,
        "smooth": _smooth_as_data(surface),
        "vertices": len(graph.vertex),
        "arcs": len(graph.boundary.arcs.circle),
        "whole_circles": int(shells.whole_circles.sum()),
        "faces": len(graph.faces.sphere),
        "genus": int(shells.genus.sum()),
        "displaced": row[graph.displaced].tolist(),
    }
    return data | ({"per": list(atom_rows(surface))} if per == "atom" else {})


def _smooth_as_data(surface: Surface) -> dict[str, Any] | None:
    smooth, row = surface.smooth, surface.molecule.row
    if smooth is None:
        return None
    pairs, triples = surface.spindles(), surface.cut_triangles()
    kinds = {kind: float(getattr(smooth, kind).sum()) for kind in ("convex", "saddle", "concave")}
    cuts = {"spindles": len(pairs), "cut_triangles": len(triples)}
    atoms = {"spindle_atoms": row[pairs].tolist(), "cut_triangle_atoms": row[triples].tolist()}
    return {"area": kinds, "volume": smooth.volume, "self_intersections": cuts | atoms}


def atom_rows(surface: Surface) -> Iterator[dict[str, Any]]:
    """Return the areas of each atom, and how many self-intersections of the smooth surface it takes part in."""
    count, smooth = len(surface.molecule), surface.smooth
    none = np.zeros(count)
    kinds = (none, none, none) if smooth is None else (smooth.convex, smooth.saddle, smooth.concave)
    cuts = np.concatenate([surface.spindles().ravel(), surface.cut_triangles().ravel()])
    columns = (
        ids(surface.molecule, "atom"), surface.molecule.row, surface.accessible(), *kinds, sum(kinds, none),
        np.bincount(cuts, minlength=count),
    )  # fmt: skip
    names = ("id", "atom", "accessible", "convex", "saddle", "concave", "smooth", "self_intersections")
    for row in zip(*(column.tolist() for column in columns), strict=True):
        yield dict(zip(names, row, strict=True))
