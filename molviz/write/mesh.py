"""Closed meshes as files, by trimesh: PLY, OBJ, STL (which has no colours) and GLB."""

import trimesh

from molviz.arrays import Floats, Ints


def write_mesh(vertex: Floats, triangle: Ints, color: Ints, suffix: str) -> bytes:
    """Return vertices (v, 3), triangles (t, 3) and a colour (v, 3), 0 to 255, of each vertex in a suffix's format."""
    mesh = trimesh.Trimesh(vertex, triangle, vertex_colors=color.astype("uint8"), process=False)
    data = mesh.export(file_type=suffix.removeprefix("."))
    return data.encode("utf-8") if isinstance(data, str) else bytes(data)
