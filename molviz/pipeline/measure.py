"""``molviz measure``: spheres → union boundary → area and volume → sums over atoms, residues or chains."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints, Strings
from molviz.errors import InputError
from molviz.geometry.measure import measure_spheres
from molviz.model.molecule import Molecule
from molviz.model.selection import select
from molviz.pipeline.inputs import Loaded
from molviz.rounding import SUM_DIGITS, shares, significant, total

PER = ("atom", "residue", "chain")


class Part(NamedTuple):
    """The share of an atom, a residue or a chain in the area."""

    id: str
    area: float  # Å²
    exposed: float | None  # Å², None without a selection


@dataclass(frozen=True)
class Measurement:
    """Area and volume of the union of the balls of one model, or of its selected atoms.

    Of a selection, ``area`` and ``volume`` are what it has alone, and ``exposed`` is the part of its area that the
    rest of the model leaves free; the difference is buried.
    """

    file: str
    model: int  # from 1
    atoms: int
    area: float  # Å²
    volume: float  # Å³
    exposed: float | None  # Å², None without a selection
    parts: tuple[Part, ...]


def measurement(loaded: Loaded, selection: str | None = None, per: str | None = None) -> Measurement:
    """Measure one model, or the selected atoms of it, and add up ``per`` atom, residue or chain.

    Raises InputError for a selection that cannot be understood or means no atom.
    """
    chosen = _chosen(loaded, selection)
    alone = measure_spheres(loaded.spheres.take(chosen))
    area = shares(alone.area)
    exposed = None if selection is None else shares(measure_spheres(loaded.spheres).area)[chosen]
    return Measurement(
        file=loaded.source,
        model=loaded.model,
        atoms=len(chosen),
        area=total(area),
        volume=significant(alone.volume),
        exposed=None if exposed is None else total(exposed),
        parts=() if per is None else _parts(loaded.molecule.take(chosen), per, area, exposed),
    )


def _chosen(loaded: Loaded, selection: str | None) -> Ints:
    if selection is None:
        return np.arange(len(loaded.molecule))
    chosen = np.flatnonzero(select(loaded.molecule, selection, loaded.model))
    if len(chosen) == 0:
        raise InputError(f"selection {selection!r} means no atom; expected one at least", loaded.source)
    return chosen


def _parts(molecule: Molecule, per: str, area: Floats, exposed: Floats | None) -> tuple[Part, ...]:
    """One row per atom, residue or chain, in the order of the file."""
    labels = ids(molecule, per)
    names, first, group = np.unique(labels, return_index=True, return_inverse=True)
    if per == "atom":
        names, first, group = labels, np.arange(len(labels)), np.arange(len(labels))
    order = np.argsort(first)
    alone = _told(np.bincount(group, area)[order].tolist())
    free = [None] * len(order) if exposed is None else _told(np.bincount(group, exposed)[order].tolist())
    return tuple(Part(*row) for row in zip(names[order].tolist(), alone, free, strict=True))


def _told(areas: Sequence[float]) -> list[float]:
    return [significant(area, SUM_DIGITS) for area in areas]


def ids(molecule: Molecule, per: str) -> Strings:
    """Return names (n,) of the atoms, or of the residue or chain of each: ``A/CYS56A/SG``, ``A/CYS56A`` or ``A``.

    A chain without a name is ``-``, an atom without residue ``C1``.
    """
    chain = np.where(molecule.chain == "", "-", molecule.chain)
    if per == "chain":
        return chain
    residue = np.char.add(np.char.add(chain, "/"), np.char.add(molecule.residue_name, molecule.residue))
    if per == "residue":
        return residue
    named = np.char.add(np.char.add(residue, "/"), molecule.atom_name)
    numbered = np.char.add(molecule.element, (molecule.row + 1).astype(str))
    return np.where((molecule.residue == "") & (molecule.residue_name == ""), numbered, named)
