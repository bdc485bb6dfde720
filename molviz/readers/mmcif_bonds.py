"""The bonds that an mmCIF file states: struct_conn between residues, chem_comp_bond inside them.

PDBx/mmCIF dictionary, categories struct_conn and chem_comp_bond.
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from molviz.arrays import Strings
from molviz.model.bonds import AROMATIC, Bonds, Template, bonds_in_residues, joined_lists, run_of_atom
from molviz.readers.atoms import AtomTable
from molviz.readers.connections import Connection, connected

if TYPE_CHECKING:
    from molviz.readers.mmcif import Site

_BONDS = ("covale", "covale_base", "covale_phosphate", "covale_sugar", "disulf", "metalc")  # not hydrog, saltbr
_ORDERS = {"doub": 2.0, "trip": 3.0, "arom": AROMATIC, "delo": AROMATIC}


def bonds_stated_in(site: "Site", table: AtomTable) -> Bonds:
    """Return the bonds between rows of the table of atoms; those to an atom of another cell are left out."""
    return joined_lists([*_inside(site, table), connected(table, list(_connections(site)))])


# ---- inside residues


def _inside(site: "Site", table: AtomTable) -> Iterator[Bonds]:
    """Yield the bonds of chem_comp_bond, once for each letter of alternate locations."""
    templates = _templates(site)
    if not templates:
        return
    run = run_of_atom(table.model, table.chain, table.residue, table.residue_name)
    for letter in np.unique(table.alternate).tolist():
        rows = np.flatnonzero((table.alternate == "") | (table.alternate == letter))
        bonds = bonds_in_residues(run[rows], table.residue_name[rows], table.atom_name[rows], templates).bonds
        yield bonds._replace(atoms=rows[bonds.atoms])


def _templates(site: "Site") -> Mapping[str, Template]:
    columns = [site.texts(f"_chem_comp_bond.{tag}") for tag in ("comp_id", "atom_id_1", "atom_id_2", "value_order")]
    if any(column is None for column in columns):
        return {}
    templates: dict[str, Template] = defaultdict(tuple)
    for name, first, second, order in zip(*(column.tolist() for column in columns if column is not None), strict=True):
        templates[name.upper()] += ((first, second, _ORDERS.get(order.lower(), 1.0)),)
    return templates


# ---- between residues


def _connections(site: "Site") -> Iterator[Connection]:
    """Yield the two atoms and the order of the connections that are bonds within the listed atoms."""
    kinds = site.texts("_struct_conn.conn_type_id")
    if kinds is None:
        return
    blank = np.full(len(kinds), "")

    def column(*tags: str) -> Strings:
        filled = blank
        for texts in (site.texts(f"_struct_conn.{tag}") for tag in tags):
            filled = filled if texts is None else np.where(filled == "", texts, filled)
        return filled

    orders, partners, symmetry = column("pdbx_value_order").tolist(), [], []
    for k in (1, 2):
        chain = column(f"ptnr{k}_auth_asym_id", f"ptnr{k}_label_asym_id")
        number = column(f"ptnr{k}_auth_seq_id", f"ptnr{k}_label_seq_id")
        residue = np.char.add(number, column(f"pdbx_ptnr{k}_PDB_ins_code"))
        name = column(f"ptnr{k}_label_atom_id", f"ptnr{k}_auth_atom_id")
        partners.append(list(zip(chain.tolist(), residue.tolist(), name.tolist(), strict=True)))
        symmetry.append(column(f"ptnr{k}_symmetry"))
    here = np.isin(np.char.lower(kinds), _BONDS) & (symmetry[0] == symmetry[1])
    for row in np.flatnonzero(here).tolist():
        yield partners[0][row], partners[1][row], _ORDERS.get(orders[row].lower(), 1.0)
