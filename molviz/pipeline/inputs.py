"""From a file to the atoms that the user wants of it, and their spheres."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import PurePath

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.errors import InputError, OptionError, listed
from molviz.geometry.boundary_graph import boundary_graph
from molviz.geometry.shells import lining, shells_of
from molviz.model.assembled import Assembled, BallsOfCopies
from molviz.model.elements import UNKNOWN
from molviz.model.molecule import Molecule
from molviz.model.radii import DEFAULT, OWN, is_known, radii
from molviz.model.selection import is_hydrogen, is_water, select
from molviz.model.spheres import Balls, Spheres, box_of
from molviz.readers import FORMATS as READERS
from molviz.readers import Reading, read

FAR_APART = 4000.0  # radii: wider pictures have more pixels than a screen, if each atom is to have two
SHORTEST, LONGEST = 1e-60, 1e60  # ångström: fourth powers, and quotients of them, are numbers
RESOLVED = 64  # steps of the rounding in a radius, at least, for a ball to be told from its neighbours
WATER_RADIUS = 1.4  # ångström, of a probe: Lee & Richards 1971
FORMATS = tuple(READERS)
DUMMIES = ("X", "XX", "DU", "LP", "Q", "*")  # symbols of no element
WITH_CHARGES = ("pqr",)  # whose radii are a force field's, for electrostatics: used where they are asked for


@dataclass(frozen=True)
class InputOptions:
    """Which part of a file is wanted, and how large its atoms are."""

    model: str = "1"  # number from 1, "all", or the first and the last of several: "2-4"
    assembly: str | None = None
    select: str | None = None
    water: bool | None = True  # None: left out where there is anything else
    hydrogens: bool = True
    chains: tuple[str, ...] = ()
    radii: str = DEFAULT
    scale_radii: float = 1.0
    probe: float = 0.0
    cavities: float | None = None  # only atoms that line a cavity of the balls, this much larger in ångström
    format: str | None = None
    unpack_all: bool = False  # archives however much they hold


@dataclass(frozen=True, repr=False)
class Loaded:
    """One model of one file, ready for geometry; ``read`` counts its atoms before any were left out."""

    source: str
    format: str
    model: int  # from 1
    models: int  # that the file holds
    read: int
    molecule: Molecule
    radius: Floats  # (n,) ångström, of the balls
    bare_radius: Floats  # (n,) of the table, neither scaled nor with a probe
    warnings: tuple[str, ...]

    @cached_property
    def spheres(self) -> Spheres:
        """The balls of the atoms (n,)."""
        return Spheres(self.molecule.position, self.radius)

    @property
    def bare(self) -> Spheres:
        """The same of their bare radii."""
        return Spheres(self.spheres.center, self.bare_radius)

    @property
    def balls(self) -> Balls:
        """The balls of the atoms (n,), of copies of a molecule part by part."""
        return BallsOfCopies(self.molecule, self.radius) if isinstance(self.molecule, Assembled) else self.spheres

    def filtered(self, keep: Bools) -> "Loaded":
        """Return the model of the atoms to keep (n,)."""
        molecule = self.molecule.filtered(keep)
        return replace(self, molecule=molecule, radius=self.radius[keep], bare_radius=self.bare_radius[keep])


def load(source: str, wanted: InputOptions, data: bytes | None = None) -> list[Loaded]:
    """Return the wanted models of a file (``data``: its content where it was read already).

    Raises InputError for what cannot be read, for a model or assembly that is not there, and where nothing is left.
    """
    return loaded_from(read(source, data, wanted.format, wanted.unpack_all), wanted)


def loaded_from(reading: Reading, wanted: InputOptions) -> list[Loaded]:
    """Return the wanted models of what was read; raises InputError as ``load`` does."""
    return [_loaded(reading, number, wanted) for number in _model_numbers(reading, wanted.model)]


def only_model(loaded: list[Loaded]) -> Loaded:
    """Return the one model that a picture shows; raises InputError where there are more."""
    if len(loaded) > 1:
        count = len(loaded)
        raise OptionError(f"has {count} models, and a picture shows one; expected --model NUMBER", loaded[0].source)
    return loaded[0]


def _model_numbers(reading: Reading, model: str) -> list[int]:
    count = len(reading.models)
    if model == "all":
        return list(range(1, count + 1))
    first, dash, last = model.partition("-")
    last = last if dash else first
    if first.isdecimal() and last.isdecimal() and 1 <= int(first) <= int(last) <= count:
        return list(range(int(first), int(last) + 1))
    raise OptionError(f"no model or frame {model!r}; the file has {count}, numbered from 1", reading.source)


def means_several(model: str) -> bool:
    """Return whether a choice of models may mean more than one: ``all`` or ``2-4``."""
    return model == "all" or "-" in model


def _loaded(reading: Reading, number: int, wanted: InputOptions) -> Loaded:
    whole = reading.models[number - 1]
    if wanted.assembly is not None:
        whole = reading.assembly(wanted.assembly, number - 1)
    _refuse_unheld("a coordinate", _farthest(whole), 0.0, reading.source)
    molecule = _named(_kept(whole, wanted, reading.source, number), reading.source)
    if reading.format in WITH_CHARGES and wanted.radii != OWN:
        molecule = replace(molecule, radius=np.where(molecule.element == UNKNOWN, molecule.radius, np.nan))
    _refuse_beads(whole, molecule, wanted.radii, reading.source)
    bare, warnings = radii(molecule, wanted.radii)
    _refuse_unheld("a radius", bare, SHORTEST, reading.source)
    if wanted.cavities is not None:
        enlarged = Spheres(molecule.position, bare).enlarged(wanted.scale_radii, wanted.cavities)
        rows = _lining(enlarged, wanted.cavities, reading.source)
        molecule, bare = molecule.take(rows), bare[rows]
    loaded = Loaded(
        reading.source, reading.format, number, len(reading.models), len(whole), molecule,
        wanted.scale_radii * bare + wanted.probe, bare, reading.warnings,
    )  # fmt: skip
    warnings += _far_apart(loaded.balls) + _without_water(whole, molecule, wanted) + _without_radius(whole, wanted)
    return replace(loaded, warnings=reading.warnings + tuple(f"{reading.source}: {warning}" for warning in warnings))


def _farthest(molecule: Molecule) -> Floats:
    """The largest coordinate (n,) of each atom."""
    parts = [np.abs(position).max(axis=1) for _, position in molecule.places()]
    return np.concatenate([np.empty(0), *parts])


def _refuse_beads(whole: Molecule, molecule: Molecule, table: str, source: str) -> None:
    """Raise InputError for a model of which no element is known, unless radii of its own or of the table are.

    Atoms that are called dummies are known to have none.
    """
    known = np.any(whole.by_atom(lambda one: one.element != UNKNOWN)) or np.any(whole.by_atom(_is_dummy))
    if known or table == OWN or np.any(is_known(molecule, table)):
        return
    names = listed(list(dict.fromkeys(whole.atom_name.tolist())))
    message = f"no atom's element is known, as in coarse-grained models; the names are {names}"
    raise InputError(f"{message}; expected --radii FILE with [names] that gives their radii", source)


def _is_dummy(molecule: Molecule) -> Bools:
    return np.isin(np.char.upper(molecule.atom_name), DUMMIES)


def _refuse_unheld(what: str, size: Floats, least: float, source: str) -> None:
    """Raise InputError for the first atom whose size (n,) is not from ``least`` to ``LONGEST``."""
    wrong = np.flatnonzero(~((size >= least) & (size <= LONGEST)))
    if len(wrong):
        message = f"atom {wrong[0] + 1} has {what} of {size[wrong[0]]:g} Å; expected {least:g} to {LONGEST:g}"
        raise InputError(message, source)


def refuse_unresolved(balls: Balls, source: str) -> None:
    """Raise InputError where the smallest ball is lost in the rounding of a scene as large as this."""
    low, high = box_of(balls)
    extent, least = float(np.max(high - low)), float(balls.radius.min())
    if np.spacing(extent) * RESOLVED > least:
        message = f"an atom of {least:.3g} Å is lost in the rounding of atoms that extend over {extent:.3g} Å"
        raise InputError(f"{message}; expected nearer ones", source)


def _kept(molecule: Molecule, wanted: InputOptions, source: str, model: int) -> Molecule:
    keep: Bools = np.ones(len(molecule), dtype=bool)
    if wanted.select is not None:
        keep &= select(molecule, wanted.select, model)
    water = is_water(molecule)
    if wanted.water is False or (wanted.water is None and np.any(keep & ~water)):
        keep &= ~water
    if not wanted.hydrogens:
        keep &= ~is_hydrogen(molecule)
    if wanted.chains:
        keep &= np.isin(molecule.chain, wanted.chains)
    if wanted.radii == OWN and not np.isnan(molecule.radius).all():
        keep &= ~np.isnan(molecule.radius)
    if not keep.any():
        chains = listed([name for name in dict.fromkeys(molecule.chain.tolist()) if name])
        raise InputError(f"no atoms are left by the selection; the chains are {chains or 'not named'}", source)
    return molecule.filtered(keep)


def _lining(spheres: Spheres, probe: float, source: str) -> Ints:
    """The rows of balls that line a cavity; raises InputError where there is none."""
    graph = boundary_graph(spheres)
    shells = shells_of(graph)
    shell, ball = lining(graph, shells)
    rows = np.unique(ball[~shells.outer[shell]])
    if len(rows) == 0:
        raise InputError(f"has no cavity with a probe of {probe:g} Å; molviz surface tells of other probes", source)
    return rows


def _without_water(whole: Molecule, molecule: Molecule, wanted: InputOptions) -> tuple[str, ...]:
    left_out = int(np.sum(is_water(whole))) if wanted.water is None else 0
    if not left_out or np.any(is_water(molecule)):
        return ()
    return (f"{left_out} atoms of water are left out; --water (water=True) draws them",)


def _without_radius(whole: Molecule, wanted: InputOptions) -> tuple[str, ...]:
    missing = int(np.isnan(whole.radius).sum()) if wanted.radii == OWN else 0
    return (f"{missing} atoms of radius 0 in the file are left out",) if missing else ()


def _far_apart(balls: Balls) -> tuple[str, ...]:
    low, high = zip(*((part.center.min(axis=0), part.center.max(axis=0)) for part in balls.parts()), strict=True)
    extent = float(np.max(np.max(high, axis=0) - np.min(low, axis=0)))
    if extent <= FAR_APART * float(balls.radius.max()):
        return ()
    return (f"the atoms extend over {extent:.3g} Å: in a picture of all, each is smaller than a pixel",)


def _named(molecule: Molecule, source: str) -> Molecule:
    return molecule if molecule.name else molecule.named(PurePath(source).name)
