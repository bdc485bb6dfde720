"""The bonds of a molecule: those that its file and its residues have, and elsewhere those that distances show.

The distances: two atoms are bonded where they are not farther apart than their covalent radii and 0.45 Å, and not
closer than half the sum of these radii. E. C. Meng, R. A. Lewis (1991) Determination of molecular topology and
atomic hybridization states from heavy atom coordinates. J. Comput. Chem. 12, 891-898.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Strings, among
from molviz.errors import InputError
from molviz.geometry.grid import intersecting_pairs
from molviz.model.bonds import (
    NO_BONDS,
    SOURCES,
    Bonds,
    bonds_in_residues,
    joined_lists,
    run_of_atom,
    standard_residues,
)
from molviz.model.entities import is_metal
from molviz.model.molecule import Molecule
from molviz.model.radii import load_table
from molviz.model.selection import is_hydrogen, is_water
from molviz.model.spheres import Spheres

TOLERANCE = 0.45  # ångström above the sum of covalent radii
CLASH = 0.5  # of this sum: closer atoms overlap by mistake; true bonds are above 0.65, badly refined ones above this
TORN = 2.5  # of this sum: a longer bond of a residue joins parts that stand in different cells of a crystal
SHORTEST = 1.1  # times the shortest bond of a hydrogen: a longer one is a contact (bridges in boranes are alike)
# Ions that hold lone pairs of others and nothing else: carboxylates and phosphates have C and P within the tolerance.
_IONS = ("Na", "K", "Rb", "Cs", "Mg", "Ca", "Sr", "Ba")
_DONORS = ("N", "O", "F", "S", "Cl", "Se", "Br", "Te", "I")
_LINKS = (("C", "N"), ("O3'", "P"))  # between residues of one chain


class Contacts(NamedTuple):
    """Pairs of atoms at the distance of a bond."""

    first: Ints  # (m,)
    second: Ints  # (m,)
    gap: Floats  # (m,) ångström

    def take(self, rows: Bools) -> "Contacts":
        """Return the given pairs."""
        return Contacts(self.first[rows], self.second[rows], self.gap[rows])


def bonds_of(molecule: Molecule, source: str = "file") -> Bonds:
    """Return the bonds of a molecule of n atoms, in time linear in n; orders are 1 where the file states none.

    ``"file"``: what the file states (CONECT, struct_conn, chem_comp_bond; SDF and MOL state all there are), the bonds
    of amino acids, nucleotides and heme by the names of their atoms, peptide and nucleotide links and disulfides
    between them, and by distance those of all other atoms: ligands, hydrogens, metals. ``"distance"``: all by distance.
    ``"none"``: none. Distances make no bond across the cell of a crystal, of an atom of unknown element, of one at the
    place of an earlier one, between water and anything but a metal, or between two hydrogens unless they are H2. Raises
    InputError for any other source.
    """
    if source not in SOURCES:
        raise InputError(f"bonds: {source!r}; expected one of {', '.join(SOURCES)}")
    if source == "none":
        return NO_BONDS
    if source == "file" and molecule.stated_bonds.complete:
        return molecule.stated_bonds
    radius = covalent_radii(molecule)
    contacts = _chemical(molecule, _contacts(molecule, radius))
    if source == "distance":
        return Bonds.of(np.column_stack([contacts.first, contacts.second]))
    return _with_residues(molecule, contacts, radius)


def covalent_radii(molecule: Molecule) -> Floats:
    """Return the covalent radius (n,) of every atom in ångström, NaN where its element is unknown."""
    radius_of = load_table("covalent").elements
    symbols, which = np.unique(molecule.element, return_inverse=True)
    return np.array([radius_of.get("H" if symbol == "D" else symbol, np.nan) for symbol in symbols.tolist()])[which]


# ---- by distance


def _contacts(molecule: Molecule, radius: Floats) -> Contacts:
    """Return all pairs i < j with (ri + rj) / 2 ≤ |cj − ci| < ri + rj + 0.45 Å.

    Of atoms at one place, elements that share a site of a crystal, the first has the bonds.
    """
    known = np.flatnonzero(np.isfinite(radius))
    reach = Spheres(molecule.position[known], radius[known] + TOLERANCE / 2)
    first, second = (known[rows] for rows in intersecting_pairs(reach))
    gap = np.linalg.norm(molecule.position[first] - molecule.position[second], axis=1)
    contacts = Contacts(first, second, gap)
    again: Bools = np.zeros(len(radius), dtype=bool)
    again[second[gap == 0]] = True
    return contacts.take((gap >= CLASH * (radius[first] + radius[second])) & ~(again[first] | again[second]))


def _chemical(molecule: Molecule, contacts: Contacts) -> Contacts:
    """Return the contacts less those that are no bonds by what the two atoms are."""
    hydrogen, water, metal = is_hydrogen(molecule), is_water(molecule), is_metal(molecule)
    ion, donor = among(molecule.element, _IONS), among(molecule.element, _DONORS)
    first, second, _ = contacts
    held = (~ion[first] | donor[second]) & (~ion[second] | donor[first])
    wet = (water[first] | water[second]) & ~(metal[first] | metal[second])
    own = water[first] & water[second] & (hydrogen[first] | hydrogen[second])
    return _hydrogens(contacts.take(held & (~wet | own)), hydrogen)


def _hydrogens(contacts: Contacts, hydrogen: Bools) -> Contacts:
    """Return the contacts less those of hydrogens that another atom holds: H–H beside a heavy atom, and longer ones."""
    both = hydrogen[contacts.first] & hydrogen[contacts.second]
    single = contacts.take(~both)
    held = np.zeros(len(hydrogen), dtype=bool)
    held[single.first] = held[single.second] = True
    contacts = contacts.take(~both | ~(held[contacts.first] | held[contacts.second]))
    nearest = np.full(len(hydrogen), np.inf)
    for atom in (contacts.first, contacts.second):
        np.minimum.at(nearest, atom, contacts.gap)
    limit = np.where(hydrogen, SHORTEST * nearest, np.inf)
    return contacts.take(contacts.gap <= np.minimum(limit[contacts.first], limit[contacts.second]))


# ---- by file and residues


def _with_residues(molecule: Molecule, contacts: Contacts, radius: Floats) -> Bonds:
    """Return what the file states, what residues have, and the contacts that neither of these rules out.

    Orders are the file's if it states any, else the residues'.
    """
    name = _bare_names(molecule)
    run = run_of_atom(molecule.chain, molecule.residue, molecule.residue_name)
    residues = bonds_in_residues(run, molecule.residue_name, name, standard_residues())
    stated, own = molecule.stated_bonds, residues.bonds
    settled = residues.named.copy()
    inner = stated.atoms[run[stated.atoms[:, 0]] == run[stated.atoms[:, 1]]]
    settled[inner] = True
    settled[is_metal(molecule)] = False
    first, second, _ = contacts
    free = ~(settled[first] & settled[second]) | _is_link(molecule, name, run, contacts)
    whole = _length(molecule, own.atoms) < TORN * radius[own.atoms].sum(axis=1)
    found = np.column_stack([first[free], second[free]])
    lists = [stated, Bonds(own.atoms[whole], own.order[whole]), Bonds(found, np.ones(len(found)))]
    if stated.order.max(initial=1.0) == 1.0:  # connections without orders: the residues know more
        lists.insert(0, lists.pop(1))
    return joined_lists(lists)


def _bare_names(molecule: Molecule) -> Strings:
    """Return the names of the atoms with primes where files before 2007 have stars (``C1*``)."""
    names, which = np.unique(molecule.atom_name, return_inverse=True)
    return np.array([name.replace("*", "'") for name in names.tolist()], dtype=str)[which]


def _length(molecule: Molecule, atoms: Ints) -> Floats:
    length: Floats = np.linalg.norm(molecule.position[atoms[:, 0]] - molecule.position[atoms[:, 1]], axis=1)
    return length


def _is_link(molecule: Molecule, name: Strings, run: Ints, contacts: Contacts) -> Bools:
    """Return which contacts (m,) are links of a chain or disulfides."""
    first, second, _ = contacts
    one, other = name[first], name[second]
    link: Bools = np.zeros(len(first), dtype=bool)
    for begin, end in _LINKS:
        link |= ((one == begin) & (other == end)) | ((one == end) & (other == begin))
    link &= molecule.chain[first] == molecule.chain[second]
    link |= (one == "SG") & (other == "SG")
    link &= run[first] != run[second]
    return link
