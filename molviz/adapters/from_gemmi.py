"""gemmi: ``Structure`` with all its models, and ``Model``."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from molviz.adapters.plain import SOURCE
from molviz.errors import InputError
from molviz.model.bonds import NO_BONDS
from molviz.model.elements import UNKNOWN, symbol_of
from molviz.model.molecule import doubles
from molviz.readers.atoms import AtomTable, Models, models_of
from molviz.readers.connections import Connection, connected

_BONDS = ("Covale", "Disulf", "MetalC")  # not Hydrog
_OTHER_CELL = "Different"


class _Row(NamedTuple):
    """One atom, by the names of the columns of an AtomTable."""

    model: int
    position: list[float]
    element: str
    atom_name: str
    residue_name: str
    residue: str
    chain: str
    bfactor: float
    occupancy: float
    alternate: str
    segment: str
    hetero: bool


def models_of_structure(structure: Any) -> Models:
    """Return the models with the structure's connections as bonds.

    Of alternate locations the one with the highest occupancy stays, the first on a tie.
    """
    return _models(structure, structure.name, list(_connections(structure)))


def models_of_model(model: Any) -> Models:
    """Return one model, alternate locations as above."""
    return _models([model], "", [])


def _connections(structure: Any) -> Iterator[Connection]:
    for one in structure.connections:
        if one.type.name in _BONDS and one.asu.name != _OTHER_CELL:
            partners = [
                (address.chain_name, str(address.res_id.seqid), address.atom_name)
                for address in (one.partner1, one.partner2)
            ]
            yield partners[0], partners[1], 1.0


def _models(models: Iterable[Any], name: str, connections: Sequence[Connection]) -> Models:
    rows = [_row(number, place) for number, model in enumerate(models) for place in model.all()]
    if not rows:
        raise InputError("no atoms; expected one at least", SOURCE)
    columns = {field: np.array(column) for field, column in zip(_Row._fields, zip(*rows, strict=True), strict=True)}
    columns["bfactor"] = doubles("bfactor", columns["bfactor"].astype(np.float32))  # gemmi keeps single precision
    columns |= {"radius": np.full(len(rows), np.nan), "operator_chain": columns["chain"]}
    table = AtomTable(**columns, line_of=lambda row: None, bonds=NO_BONDS)
    return models_of(table._replace(bonds=connected(table, connections)), name, SOURCE)


def _row(number: int, place: Any) -> _Row:
    chain, residue, atom = place.chain, place.residue, place.atom
    return _Row(
        model=number,
        position=atom.pos.tolist(),
        element=symbol_of(atom.element.name) or UNKNOWN,
        atom_name=atom.name,
        residue_name=residue.name,
        residue=str(residue.seqid),
        chain=chain.name,
        bfactor=atom.b_iso,
        occupancy=atom.occ,
        alternate=atom.altloc.strip("\0"),
        segment=residue.segment,
        hetero=residue.het_flag == "H",
    )
