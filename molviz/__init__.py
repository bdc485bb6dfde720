"""Exact vector drawings and exact numbers of anything made of spheres.

A file becomes a ``Molecule`` (``read``), a molecule spheres, spheres a union boundary, the boundary what the eye
sees (``visible``) or what it measures (``measure``), and what the eye sees a picture in one of many formats.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from molviz.errors import InputError
    from molviz.model.molecule import Molecule
    from molviz.pipeline.measure import measure
    from molviz.pipeline.visible import Visible, visible
    from molviz.readers import Reading, read
    from molviz.visibility.view import View

_HOMES = {  # imported when first used: start-up time counts
    "InputError": "molviz.errors",
    "Molecule": "molviz.model.molecule",
    "Reading": "molviz.readers",
    "View": "molviz.visibility.view",
    "Visible": "molviz.pipeline.visible",
    "measure": "molviz.pipeline.measure",
    "read": "molviz.readers",
    "visible": "molviz.pipeline.visible",
}
__all__ = ["InputError", "Molecule", "Reading", "View", "Visible", "measure", "read", "visible"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
