"""Meshes of surfaces, and the files that hold them."""

import numpy as np

from molviz.geometry.boundary_graph import boundary_graph
from molviz.geometry.mesh import Mesh, boundary_mesh
from molviz.geometry.shells import reached_from_outside, shells_of
from molviz.geometry.smooth_mesh import smooth_mesh
from molviz.picture.style import load_style
from molviz.pipeline.surface import Surface
from molviz.write.mesh import write_mesh

COLORS = "flat"  # the style whose colours of elements meshes have


def mesh_of(surface: Surface, kind: str, longest: float) -> Mesh:
    """Return the mesh of a surface; kinds are those of ``Surface.mesh``."""
    graph, shells = surface.graph, surface.shells
    if kind == "smooth":
        return smooth_mesh(graph, surface.probe, surface.kept, longest)
    if kind == "vdw" and surface.probe > 0:
        graph = boundary_graph(surface.spheres)
        shells = shells_of(graph)
    chosen = reached_from_outside(shells) if surface.outer_only else np.ones(len(shells.of_face), dtype=bool)
    return boundary_mesh(graph, chosen, longest)


def encoded_mesh(surface: Surface, mesh: Mesh, suffix: str) -> bytes:
    """Return a mesh in the format of a suffix, each vertex in the colour of its atom's element."""
    colors = load_style(COLORS).colors
    table = [colors.element.get(element, colors.unknown) for element in surface.molecule.element.tolist()]
    return write_mesh(mesh.vertex, mesh.triangle, np.array(table)[mesh.ball], suffix)
