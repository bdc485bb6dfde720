"""mmCIF by gemmi's parser of CIF syntax, and small-molecule CIF by its symmetry; the values are checked here.

S. R. Hall, F. H. Allen, I. D. Brown (1991) The crystallographic information file. Acta Cryst. A47, 655-685;
PDBx/mmCIF dictionary, categories atom_site, pdbx_struct_assembly_gen and pdbx_struct_oper_list.
"""

import itertools
import math
import re
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import PurePath

import gemmi
import numpy as np
from gemmi import cif

from molviz.arrays import Floats, Ints, Strings
from molviz.errors import InputError
from molviz.model.elements import UNKNOWN, symbol_of_atom_name, symbol_of_label, symbol_of_site_label
from molviz.model.molecule import Molecule
from molviz.readers.atoms import AtomTable, coinciding_note, coinciding_rows, models_of
from molviz.readers.mmcif_bonds import bonds_stated_in
from molviz.readers.numbers import LONGEST, SHOWN, number_of, numbers, octets_of, plain_numbers
from molviz.readers.reading import AssemblyPart, Reading
from molviz.readers.source import note
from molviz.vectors import transformed

_AXES = ("x", "y", "z")
_CARTESIAN = tuple(f"_atom_site.Cartn_{axis}" for axis in _AXES)
_FRACTIONAL = tuple(f"_atom_site_fract_{axis}" for axis in _AXES)
_OPERATORS = ("_space_group_symop_operation_xyz", "_symmetry_equiv_pos_as_xyz")
_UNCERTAINTY = re.compile(rb"\(\d+\)$")  # 1.234(5): standard uncertainty in the last digits
MOST_COPIES = 20_000  # of all assemblies of a file; the largest capsids have some thousands
_TOKEN = re.compile(r"""'.*?'(?=\s|$)|".*?"(?=\s|$)|\#.*|\S+""")
_POSITION = re.compile(r"^[^:]*:(\d+):\S* *")


def read_mmcif(data: bytes, source: str) -> Reading:
    """Return the models of an mmCIF file, or all sites in the unit cell of a small-molecule CIF.

    Raises InputError where the syntax is broken, there are no atoms, or a coordinate is not a finite number.
    """
    text = _decoded(data)
    document = _document(text, source)
    for block in document:
        if any(block.find_values(tag) for tag in _CARTESIAN):
            return _macromolecule(Site(block, text, source))
        if any(block.find_values(tag) for tag in _FRACTIONAL):
            return _unit_cell(Site(block, text, source))
    raise InputError("no _atom_site with coordinates; expected a CIF file with atoms", source)


def _decoded(data: bytes) -> str:
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _document(text: str, source: str) -> cif.Document:
    try:
        return cif.read_string(text)
    except (ValueError, RuntimeError) as error:
        lines = text.split("\n")
        match = _POSITION.match(str(error))
        line = int(match[1]) if match else None
        reason = str(error)[match.end() :] if match else str(error)
        if line and reason.startswith("Wrong number of values"):
            reason, line = _incomplete_loop(lines, line, reason)
        elif line and (lines[line - 1].startswith(";") or reason.startswith("unterminated text")):
            reason, line = _open_text(lines, line)
        raise InputError(f"{reason}; expected correct CIF", source, line) from error


def _incomplete_loop(lines: list[str], start: int, reason: str) -> tuple[str, int]:
    """Return a reason with figures, and the last line of the loop that begins at the line."""
    tags = sum(1 for _ in itertools.takewhile(lambda line: line.lstrip().startswith("_"), lines[start:]))
    where = list(_lines_of_values(lines, start))
    return f"{reason} ({len(where)} for the {tags} tags from line {start})", where[-1] if where else start


def _open_text(lines: list[str], end: int) -> tuple[str, int]:
    """Return a reason, and the line where the text field opens that has no proper end at the given line."""
    marks = [number for number, text in enumerate(lines[: end - 1], start=1) if text.startswith(";")]
    return f"the text field that opens here is not closed (syntax breaks at line {end})", marks[-1] if marks else end


def _lines_of_values(lines: list[str], start: int) -> Iterator[int]:
    """Yield the line of every value of the loop that begins at the line, both counted from one."""
    begun = in_text = False
    for number, line in enumerate(lines[start - 1 :], start=start):
        if line.startswith(";"):
            if not in_text:
                yield number
            begun, in_text = True, not in_text
            continue
        for token in [] if in_text else _TOKEN.findall(line):
            if token[0] == "#" or (not begun and (token[0] == "_" or token.lower() == "loop_")):
                continue
            if token[0] == "_" or token.lower().startswith(("loop_", "data_")):
                return
            begun = True
            yield number


class Site:
    """The category atom_site of a block, column by column."""

    def __init__(self, block: cif.Block, text: str, source: str) -> None:
        self.block, self.text, self.source = block, text, source
        self.rows: dict[str, int] = {}  # of other categories, by their names

    def _values(self, tag: str) -> list[str]:
        """Return a column as it is written, empty where it is missing; raises InputError unless all rows have one."""
        return list(self._column(tag))

    def _column(self, tag: str) -> cif.Column:
        """The same without making texts of it."""
        values = self.block.find_values(tag)
        if not values:
            return values
        category = tag.partition(".")[0]
        rows = len(self) if category == "_atom_site" else self.rows.setdefault(category, len(values))
        if len(values) != rows:
            message = f"{tag} has {len(values)} values for {rows} rows; expected as many"
            raise InputError(message, self.source)
        return values

    def texts(self, tag: str) -> Strings | None:
        """Return a column (n,), ``""`` for ``.`` and ``?`` and quotes removed; None where it is missing."""
        values = self._values(tag)
        if not values:
            return None
        different = set(values)
        if max(map(len, different)) > LONGEST:
            wrong = next(row for row, value in enumerate(values) if len(value) > LONGEST)
            message = f"{tag} has {len(values[wrong])} letters, {values[wrong][:SHOWN]!r}…; expected at most {LONGEST}"
            raise InputError(message, self.source, self.line_of(wrong))
        clean = {value: "" if value in (".", "?") else cif.as_string(value) for value in different}
        as_written = all(value == text for value, text in clean.items())
        return np.array(values if as_written else [clean[value] for value in values])

    def first_texts(self, *tags: str) -> Strings:
        """Return a column whose blanks are filled from the later tags; blank where all are missing."""
        filled = np.full(len(self), "")
        for tag in tags:
            blank = filled == ""
            column = self.texts(tag) if blank.any() else None
            if column is not None:
                filled = column if blank.all() else np.where(blank, column, filled)
        return filled

    def coordinates(self, tags: tuple[str, ...]) -> Floats:
        """Return three columns of finite numbers as (n, 3); raises InputError at the first value that is none."""
        return np.column_stack([self._coordinate(tag) for tag in tags])

    def _coordinate(self, tag: str) -> Floats:
        values = self._values(tag)
        if not values:
            raise InputError(f"{tag} is missing; expected all of {', '.join(_AXES)}", self.source, self.line_of(0))

        def error(row: int, text: str) -> InputError:
            return InputError(f"{tag} is {text!r}; expected a finite number", self.source, self.line_of(row))

        plain = plain_numbers(values)
        return plain if plain is not None else numbers(octets_of(_without_uncertainty(values), error), error)

    def optional(self, tag: str, default: float) -> tuple[Floats, list[str]]:
        """Return a column of numbers, the default for ``.`` and ``?``, and a warning where one is something else."""
        values = self._values(tag) or ["."] * len(self)
        plain = plain_numbers(values)
        if plain is not None:
            return plain, []
        octets = {value: _UNCERTAINTY.sub(b"", value.encode()) for value in set(values)}
        known = {value: number_of(octet) for value, octet in octets.items()}
        wrong = {value for value, number in known.items() if value not in (".", "?") and number is None}
        column = np.array([known[value] for value in values], dtype=float)
        column[np.isnan(column)] = default
        if not wrong:
            return column, []
        row = next(row for row, value in enumerate(values) if value in wrong)
        message = f"{tag} {values[row]!r} is no number; taken as {default:g}"
        return column, [note(message, self.source, self.line_of(row))]

    def __len__(self) -> int:
        tags = (*_CARTESIAN, *_FRACTIONAL)
        return max(len(self.block.find_values(tag)) for tag in tags)

    @cached_property
    def _line_of_row(self) -> list[int]:
        column = next(column for tag in (*_CARTESIAN, *_FRACTIONAL) if (column := self.block.find_values(tag)))
        loop = column.get_loop()
        item = self.block.find_loop_item(column.tag.lower())  # compared in lower case
        if loop is None or item is None:
            return []
        return list(_lines_of_values(self.text.split("\n"), item.line_number))[:: loop.width()]

    def line_of(self, row: int) -> int | None:
        """Return the line at which a row begins, None where the atom is not in a loop."""
        return self._line_of_row[row] if row < len(self._line_of_row) else None


def _without_uncertainty(values: list[str]) -> list[bytes]:
    octets = [value.encode() for value in values]
    if any(octet.endswith(b")") for octet in octets):
        octets = [_UNCERTAINTY.sub(b"", octet) for octet in octets]
    return octets


# ---- macromolecules


def _macromolecule(site: Site) -> Reading:
    position = site.coordinates(_CARTESIAN)
    occupancy, warnings = site.optional("_atom_site.occupancy", 1.0)
    bfactor, more = site.optional("_atom_site.B_iso_or_equiv", np.nan)
    number = site.first_texts("_atom_site.auth_seq_id", "_atom_site.label_seq_id")
    atom_name = site.first_texts("_atom_site.label_atom_id", "_atom_site.auth_atom_id")
    residue_name = site.first_texts("_atom_site.label_comp_id", "_atom_site.auth_comp_id")
    element, still_more = _elements(site, atom_name, residue_name)
    table = AtomTable(
        position=position, element=element, atom_name=atom_name, residue_name=residue_name,
        residue=np.char.add(number, site.first_texts("_atom_site.pdbx_PDB_ins_code")),
        chain=site.first_texts("_atom_site.auth_asym_id", "_atom_site.label_asym_id"),
        operator_chain=site.first_texts("_atom_site.label_asym_id", "_atom_site.auth_asym_id"),
        bfactor=bfactor, radius=np.full(len(site), np.nan), occupancy=occupancy,
        alternate=site.first_texts("_atom_site.label_alt_id"),
        model=_order_of_first(site.first_texts("_atom_site.pdbx_PDB_model_num")), line_of=site.line_of,
        segment=site.first_texts("_atom_site.label_asym_id"),
        hetero=site.first_texts("_atom_site.group_PDB") == "HETATM",
    )  # fmt: skip
    models = models_of(table._replace(bonds=bonds_stated_in(site, table)), _name(site), site.source)
    assemblies, last = _assemblies(site)
    told = (*warnings, *more, *still_more, *models.warnings, *last)
    return Reading(site.source, "mmcif", models.molecules, assemblies, told, models.operator_chain)


def _order_of_first(texts: Strings) -> Ints:
    """Return for every text (n,) how many different ones came before its first appearance."""
    if (texts == texts[0]).all():
        return np.zeros(len(texts), dtype=np.int64)
    order: dict[str, int] = {}
    return np.array([order.setdefault(text, len(order)) for text in texts.tolist()])


def _elements(site: Site, atom_name: Strings, residue_name: Strings) -> tuple[Strings, list[str]]:
    """Return symbols of the type symbols, else of the atom names, and a warning where neither holds one."""
    symbols = site.first_texts("_atom_site.type_symbol").tolist()
    keys = list(zip(symbols, atom_name.tolist(), residue_name.tolist(), strict=True))
    element_of = {key: _element(*key) for key in set(keys)}
    element = np.array([element_of[key] for key in keys])
    unknown = np.flatnonzero(element == UNKNOWN)
    if not len(unknown):
        return element, []
    message = f"{len(unknown)} atoms whose element is unknown, the first is {atom_name[unknown[0]]!r}"
    return element, [note(message, site.source, site.line_of(int(unknown[0])))]


def _element(symbol: str, atom_name: str, residue_name: str) -> str:
    if symbol and symbol_of_label(symbol) != UNKNOWN:
        return symbol_of_label(symbol)
    return symbol_of_atom_name(atom_name if len(atom_name) >= 4 else f" {atom_name}", residue_name)


def _name(site: Site) -> str:
    for tag in ("_struct.title", "_entry.id"):
        value = site.block.find_value(tag)
        if value and value not in (".", "?"):
            return " ".join(cif.as_string(value).split())
    return site.block.name or PurePath(site.source.removesuffix(".gz")).stem


# ---- assemblies


def _assemblies(site: Site) -> tuple[Mapping[str, tuple[AssemblyPart, ...]], list[str]]:
    """Return the assemblies whose operators are complete, and a warning where one is not."""
    operators, warnings, copies = _operators(site), [], 0
    assemblies: dict[str, tuple[AssemblyPart, ...]] = {}
    tags = ["assembly_id", "oper_expression", "asym_id_list"]
    for row in site.block.find("_pdbx_struct_assembly_gen.", tags):
        name, expression, chains = (row.str(column) for column in range(3))
        factors = _factors(expression)
        if not all(factor in operators for several in factors for factor in several):
            message = f"assembly {name!r} has an operator {expression!r} that the file does not define; left out"
            warnings.append(note(message, site.source))
            continue
        copies += math.prod(map(len, factors))
        if copies > MOST_COPIES:
            warnings.append(note(f"assembly {name!r} has over {MOST_COPIES} copies; left out", site.source))
            break
        products = itertools.product(*factors)
        moves = np.array([_product([operators[factor] for factor in product]) for product in products])
        part = AssemblyPart(frozenset(chains.replace(" ", "").split(",")), moves)
        assemblies[name] = (*assemblies.get(name, ()), part)
    return assemblies, warnings[:1]


def _factors(expression: str) -> list[list[str]]:
    """Return the operators of every factor of an expression such as ``1,3``, ``(1-60)`` or ``(X0)(1-5,P)``."""
    groups = re.findall(r"\(([^()]*)\)", expression) or [expression]
    return [[name for item in group.replace(" ", "").split(",") for name in _range(item)] for group in groups]


def _range(item: str) -> list[str]:
    """Return the operators of a range such as ``1-60``; a longer one than any assembly has stays one name."""
    match = re.fullmatch(r"(\d{1,9})-(\d{1,9})", item)
    if not match or int(match[2]) - int(match[1]) >= MOST_COPIES:
        return [item]
    return [str(number) for number in range(int(match[1]), int(match[2]) + 1)]


def _operators(site: Site) -> dict[str, Floats]:
    """Return the operators (4, 4) of the list, those with a value that is no number left out."""
    cells = [f"matrix[{i}][{j}]" if j < 4 else f"vector[{i}]" for i in (1, 2, 3) for j in (1, 2, 3, 4)]
    operators = {}
    for row in site.block.find("_pdbx_struct_oper_list.", ["id", *cells]):
        values = np.array([number_of(row.str(column).encode()) for column in range(1, 13)], dtype=float)
        if not np.isnan(values).any():
            operators[row.str(0)] = np.vstack([values.reshape(3, 4), [0, 0, 0, 1]])
    return operators


def _product(factors: list[Floats]) -> Floats:
    """Return (3, 4) of the operators applied one after the other, the last first."""
    product = np.eye(4)
    for factor in factors:
        product = transformed(product, factor.T)
    return product[:3]


# ---- small molecules


def _unit_cell(site: Site) -> Reading:
    """Return all atoms of one unit cell, fractional coordinates in [0, 1); at one place the most occupied first."""
    listed = site.coordinates(_FRACTIONAL)
    try:
        small = gemmi.make_small_structure_from_block(site.block)
    except (ValueError, RuntimeError) as error:
        raise InputError(f"{error}; expected a unit cell and symmetry operators", site.source) from error
    _check_cell(small.cell, site.source)
    if len(small.sites) != len(listed):
        raise InputError(f"{len(listed)} sites, {len(small.sites)} with label; expected _atom_site_label", site.source)
    for atom, coordinates in zip(small.sites, listed.tolist(), strict=True):
        atom.fract = gemmi.Fractional(*coordinates)  # as checked here, not as the parser took them
    sites = small.get_all_unit_cell_sites()
    fraction = np.array([atom.fract.tolist() for atom in sites])
    fraction -= np.floor(fraction + 1e-6)  # operators in double precision leave 0 as −1e−17
    position = transformed(fraction, np.array(small.cell.orth.mat.tolist()))
    order = _most_occupied_first(position, np.array([atom.occ for atom in sites]))
    position, ordered = position[order], [sites[row] for row in order.tolist()]
    label = np.array([atom.label for atom in ordered])
    element = np.array([symbol_of_site_label(atom.type_symbol or atom.label) for atom in ordered])
    molecule = Molecule.of(_name(site), position, element, atom_name=label)
    again = coinciding_rows(position)
    warnings = [coinciding_note(len(again), site.source, None)] if len(again) else []
    if not small.cell.images and not _states_no_symmetry(site, small.spacegroup_hm):
        warnings.append(note("no symmetry that is understood; only the listed sites are drawn", site.source))
    return Reading(site.source, "mmcif", (molecule,), {}, tuple(warnings), (molecule.chain,))


def _most_occupied_first(position: Floats, occupancy: Floats) -> Ints:
    """Return all rows (n,): those that share one place (n, 3) follow its first, the highest occupancy before others."""
    _, first, place = np.unique(position, axis=0, return_index=True, return_inverse=True)
    return np.lexsort((-occupancy, first[place.ravel()]))


def _states_no_symmetry(site: Site, space_group: str) -> bool:
    """Tell whether the file says that the listed sites are the whole cell."""
    operators = [text for tag in _OPERATORS for text in site.block.find_values(tag)]
    return bool(operators) or space_group.replace(" ", "") == "P1"


def _check_cell(cell: gemmi.UnitCell, source: str) -> None:
    lengths = (cell.a, cell.b, cell.c, cell.volume)
    if not cell.is_crystal() or not all(0 < length < np.inf for length in lengths):
        raise InputError("fractional coordinates without a unit cell; expected _cell_length_a and the like", source)
