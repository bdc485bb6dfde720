"""A scene for Python users: anything made of spheres, prepared once for any number of views."""

import os
from collections.abc import Sequence
from typing import Any

from molviz.arrays import Ints
from molviz.pipeline.door import load_one, tell
from molviz.pipeline.solids import shown, solid_options_from, solids_for
from molviz.pipeline.views import checked_view
from molviz.visibility.map import VisibilityMap
from molviz.visibility.painter import Pieces
from molviz.visibility.scene import Scene as SphereScene
from molviz.visibility.view import View, principal_axes


class Scene:
    """The balls and sticks of anything that ``molviz.draw`` takes, for any number of views.

    ``molecule`` is what the options left of ``x``, ``spheres`` are the balls that stand for its atoms, row by row, and
    ``sticks`` join them; ``view`` is the one that ``molviz.draw`` begins with, along the shortest principal axis:
    ``scene.map(scene.view.rotated("y", 30))``.
    The options are those of ``molviz.draw``. Raises InputError for what cannot be used, and warns of what is odd.
    """

    def __init__(
        self,
        x: Any,
        *,
        rep: str | Sequence[str | tuple[str, str]] = (),
        bonds: str = "file",
        ball_scale: float = 0.25,
        stick_radius: float | None = None,
        model: int | str = 1,
        assembly: str | None = None,
        select: str | None = None,
        no_water: bool = False,
        no_hydrogens: bool = False,
        chain: str | Sequence[str] | None = None,
        radii: str | os.PathLike[str] = "bondi",
        scale_radii: float = 1.0,
        probe: float = 0.0,
    ) -> None:
        options = locals()
        wanted = solid_options_from(options)
        loaded, representation = shown(load_one(x, options), wanted)
        solids = solids_for(loaded, representation, wanted)
        tell((*loaded.warnings, *solids.notes), stacklevel=3)
        self.molecule, self.spheres, self.sticks = loaded.molecule, solids.balls.whole(), solids.sticks
        self.view = principal_axes(loaded.balls)
        self._scene = SphereScene(self.spheres, None, self.sticks)

    def __repr__(self) -> str:
        return f"<Scene of {self.molecule.name!r}: {len(self.molecule)} spheres>"

    def map(self, view: View | None = None) -> tuple[VisibilityMap, Ints]:
        """Return what is seen in a view as a planar map, and the row of each of the map's spheres.

        Raises InputError where the eye of a central view is not in front of all spheres.
        """
        return self._scene.map(checked_view(self.view if view is None else view, self.spheres))

    def pieces(self, view: View | None = None) -> tuple[Pieces, Ints]:
        """Return the painter's pieces of a view, and the row of each of their spheres.

        Raises InputError as ``map`` does.
        """
        return self._scene.pieces(checked_view(self.view if view is None else view, self.spheres))
