"""Chemical symbols, and what element an atom is when a file does not say."""

import re

from molviz.model.residues import AMINO_ACIDS, NUCLEOTIDES, WATERS

_PERIODS = (
    "H He Li Be B C N O F Ne Na Mg Al Si P S Cl Ar K Ca Sc Ti V Cr Mn Fe Co Ni Cu Zn Ga Ge As Se Br Kr "
    "Rb Sr Y Zr Nb Mo Tc Ru Rh Pd Ag Cd In Sn Sb Te I Xe Cs Ba La Ce Pr Nd Pm Sm Eu Gd Tb Dy Ho Er Tm Yb Lu "
    "Hf Ta W Re Os Ir Pt Au Hg Tl Pb Bi Po At Rn Fr Ra Ac Th Pa U Np Pu Am Cm Bk Cf Es Fm Md No Lr "
    "Rf Db Sg Bh Hs Mt Ds Rg Cn Nh Fl Mc Lv Ts Og"
)
SYMBOLS = tuple(_PERIODS.split())
UNKNOWN = "X"

_SYMBOL = {symbol.upper(): symbol for symbol in (*SYMBOLS, "D")} | {"T": "H"}
# Symbols that no atom name of columns 13-14 means: prefixes of old ligand names (AC5, NP, NO2 of NAP, HO5', CO ...).
_NEVER_GUESSED = frozenset(("AC", "NP", "NO", "HE", "HF", "HO", "HS"))
# Ions whose residue and atom name is not the symbol (CHARMM and AMBER topologies).
_ION_NAMES = {"SOD": "Na", "CLA": "Cl", "POT": "K", "CAL": "Ca", "CES": "Cs", "LIT": "Li", "RUB": "Rb"}
# Symbols of two letters that begin no name of an atom of another element.
_CLEAR_PAIRS = frozenset(("CL", "BR", "FE", "ZN", "MG", "MN", "CU", "SE", "SI", "LI", "AL", "NI", "PT", "AU", "AG"))
_WATER_SITE = "Wat"
_MARTINI_BEAD = re.compile(r"(BB|SC)\d?$")


def symbol_of(text: str) -> str:
    """Return the symbol as usually written (``"FE"`` → ``"Fe"``; tritium is H), ``""`` where the text is none."""
    return _SYMBOL.get(text.strip().upper(), "")


def symbol_of_label(label: str) -> str:
    """Return the element that a label of an XYZ or CIF file begins with (``"C1"``, ``"H2a"``, ``"Fe2+"``, ``"26"``).

    All its leading letters are the symbol, digits alone an atomic number; ``"X"`` where that is none.
    """
    if re.fullmatch(r"[0-9]+", label):
        number = float(label)  # of any number of digits
        return SYMBOLS[int(number) - 1] if 1 <= number <= len(SYMBOLS) else UNKNOWN
    letters = re.match(r"[A-Za-z]*", label)
    return symbol_of(letters[0] if letters else "") or UNKNOWN


def symbol_of_site_label(label: str) -> str:
    """Return the element of a site of a crystal whose label alone names it: as ``symbol_of_label`` where this knows it.

    Else the symbol, as it is usually written, that the label begins with (``"CaX1"``, ``"OW1"``); ``"Wat"`` is the
    oxygen of water in the American Mineralogist Crystal Structure Database.
    """
    symbol = symbol_of_label(label)
    if symbol != UNKNOWN:
        return symbol
    written = re.match(r"[A-Z][a-z]?", "O" if label.startswith(_WATER_SITE) else label)
    return next(filter(None, map(symbol_of, (written[0], written[0][0]))), UNKNOWN) if written else UNKNOWN


def symbol_of_atom_name(name: str, residue_name: str) -> str:
    """Return the element of a PDB atom name (columns 13-16, four characters with their blanks), ``"X"`` if unclear.

    The PDB format, "Coordinate Section": the symbol stands right-justified in columns 13-14, so ``" CA "`` is an
    α-carbon and ``"CA  "`` calcium; hydrogens with names of four letters begin in column 13. Standard residues hold no
    metals, whatever the alignment; an ion is named as its residue.
    """
    bare, residue = name.strip().upper(), residue_name.strip().upper()
    if _MARTINI_BEAD.match(bare):
        return UNKNOWN
    if bare == residue and (bare in _ION_NAMES or symbol_of(bare)):
        return _ION_NAMES.get(bare) or symbol_of(bare)
    if residue in AMINO_ACIDS or residue in NUCLEOTIDES or residue in WATERS:
        return _symbol_in_polymer(bare)
    return _symbol_by_alignment(name.upper().ljust(4), bare)


def symbol_of_free_name(name: str, residue_name: str) -> str:
    """Return the element of an atom name as ``symbol_of_atom_name`` does, where no column shows how long its symbol is.

    In ligands, ``CL1`` is chlorine and ``FE`` iron, but ``CA``, ``CD`` and ``HG`` are C, C and H.
    """
    letters = re.match(r"[A-Za-z]*", name)
    pair = letters[0].upper() if letters else ""
    standard = residue_name.upper() in AMINO_ACIDS | NUCLEOTIDES | WATERS
    if pair in _CLEAR_PAIRS and not standard:
        return symbol_of(pair)
    return symbol_of_atom_name(name if len(name) == 4 else f" {name}", residue_name)


def _symbol_in_polymer(bare: str) -> str:
    """Return the element of an atom of a standard residue or water: C, N, O, P, S, H, D or selenium."""
    letters = bare.lstrip("0123456789")
    if letters in ("SE", "SED"):
        return "Se"
    return symbol_of(letters[:1]) if letters[:1] in tuple("CNOPSHD") else UNKNOWN


def _symbol_by_alignment(name: str, bare: str) -> str:
    """Return the element by the columns that the name stands in."""
    letters = bare.lstrip("0123456789'\"*")
    single, double = symbol_of(letters[:1]), "" if letters[:2] in _NEVER_GUESSED else symbol_of(letters[:2])
    starts_in_column_13 = name[0].isalpha()
    if not starts_in_column_13:
        return single or double or UNKNOWN
    if len(bare) == 4 and single in ("H", "D", "C", "N", "O") and letters[:2] != "CL":
        return single
    if double:
        return double
    return _symbol_behind_prefix(letters) or single or UNKNOWN


def _symbol_behind_prefix(letters: str) -> str:
    """Return the element of an old dinucleotide name, whose first letter names the part (``"AC5"``, ``"NO2"``)."""
    return symbol_of(letters[1:2]) if letters[:1] in ("A", "N") and letters[1:2] in ("C", "N", "O", "P") else ""
