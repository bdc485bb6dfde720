"""Molecules that were made, not read, as models of an input."""

from molviz.errors import InputError
from molviz.model.molecule import Molecule
from molviz.readers.atoms import Models, coinciding_rows

SOURCE = "x"  # what the argument of all public functions is called, in place of a file


def plain_models(*molecules: Molecule) -> Models:
    """Return molecules as models, with a warning about atoms that coincide; raises InputError where one is empty."""
    for molecule in molecules:
        if not len(molecule):
            raise InputError("no atoms; expected one at least", SOURCE)
    again = coinciding_rows(molecules[0].position).tolist()
    note = f"{SOURCE}: {len(again)} atoms at exactly the place of an earlier atom, the first in row {again[:1]}"
    return Models(molecules, tuple(molecule.chain for molecule in molecules), [note] if again else [])
