"""Names of atoms for ids, tooltips, classes and layers."""

import numpy as np

from molviz.arrays import Ints
from molviz.model.molecule import Molecule
from molviz.picture.picture import Mark


def marks(molecule: Molecule, grouped: bool) -> list[Mark]:
    """Return a mark per atom: in groups by chain and residue, or else with their names as classes."""
    columns = (molecule.chain, molecule.residue_name, molecule.residue, molecule.atom_name, molecule.element)
    rows = zip(*(column.tolist() for column in columns), molecule.row.tolist(), strict=True)
    return [_mark(*row, grouped=grouped) for row in rows]


def _mark(chain: str, name: str, residue: str, atom: str, element: str, row: int, *, grouped: bool) -> Mark:
    if not name:
        return Mark(id=f"{element}{row + 1}", title=f"{atom} {row + 1}", classes=(element,))
    place = f"{name} {residue}"
    mark_id, title = "_".join(filter(None, (chain, name, residue, atom))), f"{place} {atom}"
    if grouped:
        return Mark(mark_id, title, (element,), ((chain or "-", f"chain chain-{chain}"), (place, f"residue {name}")))
    return Mark(mark_id, title, (element, name, f"chain-{chain}" if chain else "chain"))


def bond_marks(molecule: Molecule, ends: Ints) -> list[Mark]:
    """Return a mark for each bond between atoms (k, 2): ``bond C1–N2``, with chain and residue where there are any."""
    ids, short, has_residues = [], [], bool(np.any(molecule.residue_name != ""))
    for mark, atom, row in zip(marks(molecule, False), molecule.atom_name.tolist(), molecule.row.tolist(), strict=True):
        ids.append(mark.id)
        short.append(f"{mark.title.rpartition(' ')[0]} {atom}" if has_residues else f"{atom}{row + 1}")
    return [
        Mark(f"bond_{ids[one]}-{ids[other]}", f"bond {short[one]}–{short[other]}", ("bond",))
        for one, other in ends.tolist()
    ]


def region_mark(chain: str, tone: str) -> Mark:
    """Return the mark of a region of one chain and one tone; either may be empty."""
    title = ", ".join(filter(None, (f"chain {chain}" if chain else "", tone)))
    groups = ((chain, f"chain chain-{chain}"),) if chain else ()
    return Mark("_".join(filter(None, (chain, tone))) or "region", title, (tone,) if tone else (), groups)
