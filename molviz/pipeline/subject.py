"""Whatever a Python user has becomes a reading: a path, a molecule, balls, or an object of another library."""

import os
from dataclasses import replace

import numpy as np

from molviz.adapters import EXPECTED, models_of_object
from molviz.adapters.plain import SOURCE, plain_models
from molviz.errors import InputError
from molviz.model.elements import UNKNOWN
from molviz.model.molecule import Molecule, doubles
from molviz.readers import Reading, read
from molviz.readers.atoms import Models


def reading_of(x: object) -> Reading:
    """Return all models of ``x``; raises InputError where it cannot be read or is nothing made of spheres."""
    if isinstance(x, Reading):
        return x
    if isinstance(x, str | os.PathLike):
        return read(x)
    kind = type(x).__name__
    models = plain_models(x) if isinstance(x, Molecule) else models_of_object(x) or _balls(x)
    molecules = tuple(replace(one, name=one.name or kind) for one in models.molecules)
    return Reading(SOURCE, kind, molecules, warnings=tuple(models.warnings), operator_chain=models.operator_chain)


def _balls(x: object) -> Models:
    """Return a pair of centers (n, 3) and radii (n,) as atoms of unknown elements, as a file of balls is read."""
    if not isinstance(x, tuple | list) or len(x) != 2:
        raise InputError(f"{type(x).__name__} is nothing made of spheres; expected {EXPECTED}", SOURCE)
    center, radius = doubles("centers", x[0], (3,)), doubles("radii", x[1])
    if len(center) != len(radius):
        raise InputError(f"radii: {len(radius)} for {len(center)} centers; expected as many")
    if not np.isfinite(center).all():
        raise InputError(f"centers: row {np.flatnonzero(~np.isfinite(center).all(axis=1))[0]} is not finite")
    wrong = np.flatnonzero(~((radius > 0) & (radius < np.inf)))
    if len(wrong):
        raise InputError(f"radii: row {wrong[0]} is {radius[wrong[0]]}; expected a finite number above 0")
    return plain_models(Molecule.of("spheres", center, np.full(len(center), UNKNOWN), radius=radius))
