"""Exact vector drawings and exact numbers of anything made of spheres.

    import molviz

    drawing = molviz.draw("1abc.pdb", color_by="chain")   # a notebook shows it
    drawing.save("1abc.pdf")                              # .svg .svgz .ps .eps .pdf .hpgl .json
    molviz.measure("1abc.pdb", probe=1.4).area.sum()      # Å²
    molviz.surface("1abc.pdb", probe=1.4).cavities        # and components, faces, the smooth surface

A file becomes a ``Molecule`` (``read``), a molecule spheres, spheres a union boundary, the boundary what the eye
sees (``visible``, ``Scene``) or what is known of it (``measure``, ``surface``), and what the eye sees a picture in one
of many formats (``draw``). Each of them takes a path, a molecule, arrays of centers and radii, or an object of ASE,
gemmi, biotite, MDAnalysis or RDKit, and so does ``view``, a widget for notebooks. What is wrong raises ``InputError``,
a ValueError; what is odd is a warning.
"""

TYPE_CHECKING = False  # as typing's: importing that costs more than all else here
if TYPE_CHECKING:
    from molviz.errors import InputError, InternalError
    from molviz.geometry.measure import Measure
    from molviz.model.molecule import Molecule
    from molviz.pipeline.door import draw, measure, surface, visible
    from molviz.pipeline.draw import Drawing
    from molviz.pipeline.index import Index
    from molviz.pipeline.scene import Scene
    from molviz.pipeline.sets import DrawingSet
    from molviz.pipeline.surface import Surface
    from molviz.pipeline.visible import Visible
    from molviz.readers import Reading, read
    from molviz.viewer.notebook import view
    from molviz.visibility.view import View

_HOMES = {  # imported when first used: start-up time counts
    "Drawing": "molviz.pipeline.draw",
    "DrawingSet": "molviz.pipeline.sets",
    "Index": "molviz.pipeline.index",
    "InputError": "molviz.errors",
    "InternalError": "molviz.errors",
    "Measure": "molviz.geometry.measure",
    "Molecule": "molviz.model.molecule",
    "Reading": "molviz.readers",
    "Scene": "molviz.pipeline.scene",
    "Surface": "molviz.pipeline.surface",
    "View": "molviz.visibility.view",
    "Visible": "molviz.pipeline.visible",
    "draw": "molviz.pipeline.door",
    "measure": "molviz.pipeline.door",
    "read": "molviz.readers",
    "surface": "molviz.pipeline.door",
    "view": "molviz.viewer.notebook",
    "visible": "molviz.pipeline.door",
}
__all__ = [
    "Drawing", "DrawingSet", "Index", "InputError", "InternalError", "Measure", "Molecule", "Reading", "Scene",
    "Surface", "View", "Visible", "draw", "measure", "read", "surface", "view", "visible",
]  # fmt: skip


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value: object = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return list(__all__)
