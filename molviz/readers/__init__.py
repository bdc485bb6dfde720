"""Files become molecules: one reader per format, chosen by content and suffix."""

import os
import re
from collections.abc import Callable
from pathlib import PurePath

from molviz.errors import InputError
from molviz.readers.gro import read_gro
from molviz.readers.pdb import read_pdb
from molviz.readers.pqr import read_pqr
from molviz.readers.reading import Reading
from molviz.readers.sdf import read_sdf
from molviz.readers.source import note, text_of
from molviz.readers.xyz import read_xyz
from molviz.readers.xyzr import read_xyzr

__all__ = ["FORMATS", "READERS", "Reading", "read"]


def _read_mmcif(data: bytes, source: str) -> Reading:
    """Import the parser only when an mmCIF file comes: it takes longer to load than a small file to read."""
    from molviz.readers.mmcif import read_mmcif

    return read_mmcif(data, source)


FORMATS: dict[str, Callable[[bytes, str], Reading]] = {
    "pdb": read_pdb,
    "mmcif": _read_mmcif,
    "xyz": read_xyz,
    "extxyz": read_xyz,
    "xyzr": read_xyzr,
    "sdf": read_sdf,
    "gro": read_gro,
    "pqr": read_pqr,
}
READERS = {  # suffix → name of the format
    ".pdb": "pdb",
    ".ent": "pdb",
    ".cif": "mmcif",
    ".mmcif": "mmcif",
    ".xyz": "xyz",
    ".extxyz": "extxyz",
    ".xyzr": "xyzr",
    ".sdf": "sdf",
    ".sd": "sdf",
    ".mol": "sdf",
    ".gro": "gro",
    ".pqr": "pqr",
}
_SCANNED = 65536  # bytes in which the first line that says something is looked for
_PDB_ATOM = re.compile(rb"^(ATOM  |HETATM)[ \d]{5}", re.MULTILINE)
_NUMBER = rb"[+-]?[\d.]+(?:[eE][+-]?\d+)?"
_BEGINNINGS = {  # what the first lines look like where a title, which can be anything, stands before what tells
    "sdf": re.compile(rb"(?:[^\n]*\n){3}[ \d]{6}[^\n]*V[23]000[ \t]*(\n|$)"),
    "gro": re.compile(
        rb"[^\n]*\n[ \t]*\d+[ \t]*\n[ \d]{5}(?=[^\n]{0,9}[A-Za-z])[^\n]{10}[ \d*]{5}( *[+-]?\d+\.\d+){3}"
    ),
}
_SIGNS = {  # what the first line that says something looks like
    "mmcif": re.compile(rb"data_", re.IGNORECASE),
    "xyz": re.compile(rb"\s*[+-]?\d+\s*$"),
    "xyzr": re.compile(rb"\s*" + rb"\s+".join([_NUMBER] * 4) + rb"\s*(#|$)"),
    "pqr": re.compile(rb"REMARK +\d+ +PQR file"),
    "pdb": re.compile(
        rb"(ATOM|HETATM|HEADER|TITLE|COMPND|CRYST1|MODEL|REMARK|OBSLTE|SPLIT|CAVEAT|EXPDTA|AUTHOR|MODRES)(\s|$|\d)"
    ),
}


def read(
    path: str | os.PathLike[str], data: bytes | None = None, format: str | None = None, unpack_all: bool = False
) -> Reading:
    """Return what a file holds; ``data`` is its content where it is not to be opened (standard input).

    The format is the one given (``"pdb"``, ``"mmcif"``, ``"xyz"``, ``"extxyz"``, ``"xyzr"``, ``"sdf"``, ``"gro"``,
    ``"pqr"``), else what the content shows, else what the suffix says; PQR that looks as PDB does goes by its
    suffix. ``unpack_all`` reads archives that hold far more than molecules do. Raises InputError, naming file, line
    and reason, for all that is not clear.
    """
    if not isinstance(path, str | os.PathLike):
        raise InputError(f"path: {type(path).__name__} is no path; expected text or a Path")
    source = os.fspath(path)
    text, warnings = text_of(source, data, unpack_all)
    suffix = PurePath(source.lower().removesuffix(".gz")).suffix
    named = READERS.get(suffix)
    shown = _recognised(text)
    name = format or (named if (named, shown) == ("pqr", "pdb") else shown or named)
    if name not in FORMATS:
        expected = ", ".join(FORMATS)
        raise InputError(f"neither content nor suffix {suffix!r} tell the format; expected one of {expected}", source)
    reading = FORMATS[name](text, source)
    if not format and named and FORMATS[named] is not FORMATS[name]:
        warnings.append(note(f"the suffix {suffix} says {named}, but the content is {name}; read as {name}", source))
    return reading.warned(warnings)


def _recognised(text: bytes) -> str | None:
    """Return the format that the first lines show, that of any line with an atom of a PDB file, or None."""
    begun = next((name for name, sign in _BEGINNINGS.items() if sign.match(text)), None)
    if begun:
        return begun
    said = (line for line in text[:_SCANNED].split(b"\n") if line.strip() and not line.startswith(b"#"))
    first = next(said, b"")
    shown = next((name for name, sign in _SIGNS.items() if sign.match(first)), None)
    return shown or ("pdb" if _PDB_ATOM.search(text) else None)
