"""Radii of atoms: one file per publication beside this module, or the user's own."""

import os
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from molviz import toml
from molviz.arrays import Bools, Floats, Strings
from molviz.errors import InputError, OptionError, expected_instead, listed
from molviz.model.elements import symbol_of
from molviz.model.molecule import Molecule

TABLES = {
    "bondi": "van der Waals radii: Bondi 1964, then Mantina et al. 2009, metals Batsanov 2001",
    "mantina": "van der Waals radii of the main group, Mantina et al. 2009",
    "alvarez": "van der Waals radii, Alvarez 2013",
    "covalent": "covalent radii, Cordero et al. 2008",
    "protor": "united atoms of proteins, Tsai et al. 1999 (ProtOr); all else as bondi",
    "chothia": "united atoms of proteins, Chothia 1976; all else as bondi",
}
COMPLETING = (*TABLES, "batsanov")  # what a table may be completed by
DEFAULT = "bondi"
OWN = "file"  # no table, but the radii that the file itself has
OWN_SOURCE = "PQR and .xyzr files (a radius for each atom)"
GUESS = 2.0  # ångström, where the table has nothing: about the mean of all metals that it has


@dataclass(frozen=True)
class RadiiTable:
    """Radii in ångström by element, by the name of an atom or bead, and by (residue name, atom name)."""

    title: str
    source: str
    elements: Mapping[str, float]
    names: Mapping[str, float]
    atoms: Mapping[tuple[str, str], float]
    implicit_hydrogens: bool


def load_table(name: str) -> RadiiTable:
    """Return a published table by its name in ``TABLES``, or the one in the user's file.

    A user's file is TOML as the published ones are (``[elements]``; ``[names]`` of atoms that are none, such as
    coarse-grained beads; ``[types]`` and ``[residues]`` for united atoms), or text of two columns, element and radius
    in ångström, with ``#`` for comments. Raises OptionError where there is no such file, or it holds a name that is no
    element or a radius that is not positive and finite.
    """
    if name in TABLES:
        return _published(name)
    path = Path(name)
    if not os.path.isfile(name):  # noqa: PTH113 (Path.is_file raises for names too long)
        expected = expected_instead(name, (*TABLES, OWN), f"one of {', '.join(TABLES)}, {OWN} or a table's path")
        raise OptionError(f"no radii table {name!r}; {expected}")
    return _table(_toml(path) if path.suffix == ".toml" else _two_columns(path), path.name, name)


def radii(molecule: Molecule, table: str = DEFAULT) -> tuple[Floats, tuple[str, ...]]:
    """Return the radius (n,) of every atom in ångström, and warnings, one of a kind.

    The molecule's own radius goes first, then the table's for residue and atom name, for the name alone, and for the
    element (D being H), and ``GUESS``, with a warning, where there is none. The name ``file`` is no table but the
    molecule's own radii; raises InputError where an atom has none.
    """
    if table == OWN:
        return _own(molecule), ()
    loaded = load_table(table)
    tabulated, own = molecule.by_atom(lambda one: _tabulated(one, loaded)), molecule.radius
    needed = np.isnan(own)
    guessed = needed & np.isnan(tabulated)
    radius = np.where(needed, np.where(guessed, GUESS, tabulated), own)
    warnings = _guess_notes(molecule.by_atom(_elements)[guessed], table)
    if loaded.implicit_hydrogens and (needed & molecule.by_atom(lambda one: _elements(one) == "H")).any():
        warnings.append(f"table {table} counts hydrogens within the heavy atoms, yet the molecule has its own as well")
    return radius, tuple(warnings)


def is_known(molecule: Molecule, table: str) -> Bools:
    """Return which atoms (n,) have a radius of their own or in the table, so that none is guessed."""
    if table == OWN:
        return ~np.isnan(molecule.radius)
    loaded = load_table(table)
    return molecule.by_atom(lambda one: ~np.isnan(one.radius) | ~np.isnan(_tabulated(one, loaded)))


def _elements(molecule: Molecule) -> Strings:
    return np.where(molecule.element == "D", "H", molecule.element)


def _tabulated(molecule: Molecule, table: RadiiTable) -> Floats:
    """The radii (n,) of the table, NaN where it has none."""
    radius = _by_text(_elements(molecule), table.elements)
    if table.names:
        by_name = _by_text(np.char.upper(molecule.atom_name), table.names)
        radius = np.where(np.isnan(by_name), radius, by_name)
    if table.atoms:
        by_atom = _by_atom(molecule, table.atoms)
        radius = np.where(np.isnan(by_atom), radius, by_atom)
    return radius


def _own(molecule: Molecule) -> Floats:
    missing = np.flatnonzero(np.isnan(molecule.radius))
    if len(missing):
        what = f"{len(missing)} of {len(molecule)} atoms have no radius of their own in {molecule.name!r}"
        raise InputError(f"radii {OWN!r}: {what}; expected PQR or xyzr with one for each, or {', '.join(TABLES)}")
    return molecule.radius


def _guess_notes(element: Strings, table: str) -> list[str]:
    if not len(element):
        return []
    counts = listed([f"{symbol} ({count})" for symbol, count in sorted(Counter(element.tolist()).items())])
    return [f"radius guessed as {GUESS:.2f} Å, for table {table} has none: {counts}"]


def _by_text(column: Strings, known: Mapping[str, float]) -> Floats:
    texts, which = np.unique(column, return_inverse=True)
    return np.array([known.get(text, np.nan) for text in texts.tolist()])[which]


def _by_atom(molecule: Molecule, atoms: Mapping[tuple[str, str], float]) -> Floats:
    keys = zip(molecule.residue_name.tolist(), molecule.atom_name.tolist(), strict=True)
    return np.array([atoms.get(key, np.nan) for key in keys])


# ---- files


def _toml(path: Path) -> dict[str, Any]:
    try:
        return toml.read(path)
    except ValueError as error:
        raise OptionError(f"no radii table: {error}; expected TOML with [elements]", str(path)) from error
    except OSError as error:
        raise OptionError(f"cannot be read: {error.strerror}; expected a table of radii", str(path)) from error


def _two_columns(path: Path) -> dict[str, Any]:
    elements = {}
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        raise OptionError(f"cannot be read: {error.strerror}; expected a table of radii", str(path)) from error
    for number, line in enumerate(lines, start=1):
        words = line.partition("#")[0].split()
        if not words:
            continue
        if len(words) != 2:
            raise OptionError(f"{len(words)} words; expected an element and a radius", str(path), number)
        elements[words[0]] = _radius(words[1], words[0], str(path), number)
    return {"elements": elements}


def _table(content: Mapping[str, Any], title: str, name: str) -> RadiiTable:
    elements = {
        _symbol(text, name): _radius(value, text, name) for text, value in _section(content, "elements", name).items()
    }
    names = {text.upper(): _radius(value, text, name) for text, value in _section(content, "names", name).items()}
    types = {text: _radius(value, text, name) for text, value in _section(content, "types", name).items()}
    atoms = _atoms(_section(content, "residues", name), types, name)
    source = str(content.get("source", name))
    if "completed_by" in content:
        for rest in _completing(content["completed_by"], name):
            elements, source = {**rest.elements, **elements}, f"{source}; completed by {rest.source}"
    if not elements and not atoms and not names:
        raise OptionError("the radii table is empty; expected [elements]", name)
    return RadiiTable(title, source, elements, names, atoms, bool(content.get("implicit_hydrogens", False)))


def _completing(tables: object, name: str) -> list[RadiiTable]:
    """Return the published tables that one name or a list of names means."""
    names = tables if isinstance(tables, list) else [tables]
    for one in names:
        if one not in COMPLETING:
            raise OptionError(f"completed_by is {one!r}; expected one of {', '.join(COMPLETING)}", name)
    return [_published(str(one)) for one in names]


def _published(name: str) -> RadiiTable:
    return _table(_toml(Path(__file__).with_name(f"{name}.toml")), TABLES.get(name, name), name)


def _section(content: Mapping[str, Any], key: str, name: str, title: str = "") -> Mapping[str, Any]:
    """Return a table of the file, empty where it is missing."""
    section = content.get(key, {})
    if not isinstance(section, Mapping):
        raise OptionError(f"{title}{key} is {section!r}; expected a table of names and values", name)
    return section


def _atoms(residues: Mapping[str, Any], types: Mapping[str, float], name: str) -> dict[tuple[str, str], float]:
    atoms = {}
    for residue in residues:
        for kind, names in _section(residues, residue, name, "residue ").items():
            if kind not in types:
                raise OptionError(f"residue {residue} has atoms of type {kind}; expected one of [types]", name)
            atoms.update({(residue, atom): types[kind] for atom in str(names).split()})
    return atoms


def _symbol(text: str, name: str) -> str:
    symbol = symbol_of(text)
    if not symbol:
        raise OptionError(f"{text!r} is no element; expected a chemical symbol", name)
    return "H" if symbol == "D" else symbol


def _radius(value: object, what: str, name: str, line: int | None = None) -> float:
    try:
        radius = np.nan if isinstance(value, bool) else float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        radius = np.nan
    if not 0 < radius < np.inf:
        raise OptionError(f"radius of {what} is {value!r}; expected a number above 0, in ångström", name, line)
    return radius
