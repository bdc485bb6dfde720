"""Symbols, and elements from names."""

import gemmi
import pytest

from molviz.model.elements import SYMBOLS, symbol_of, symbol_of_atom_name, symbol_of_label, symbol_of_site_label


def test_symbols_are_those_of_the_periodic_table() -> None:
    assert [gemmi.Element(number).name for number in range(1, 119)] == list(SYMBOLS)


@pytest.mark.parametrize("text", ["FE", "fe", " Fe ", "Fe"])
def test_symbols_in_any_case(text: str) -> None:
    assert symbol_of(text) == "Fe"


def test_isotopes() -> None:
    assert (symbol_of("D"), symbol_of("T"), symbol_of("Xx")) == ("D", "H", "")


def test_labels() -> None:
    labels = ["C1", "H2a", "Fe2+", "6", "0", "119", "Si", "OW", "X", "+", "³"]
    assert [symbol_of_label(label) for label in labels] == ["C", "H", "Fe", "C", "X", "X", "Si", "X", "X", "X", "X"]


def test_labels_of_sites() -> None:
    labels = ["CaX1", "NaX16", "WatX1", "OW1", "Ow2", "Si1", "CL1", "Fe2+", "X1", "Q1", "7", ""]
    expected = ["Ca", "Na", "O", "O", "O", "Si", "Cl", "Fe", "X", "X", "N", "X"]
    assert [symbol_of_site_label(label) for label in labels] == expected


@pytest.mark.parametrize(
    ("name", "residue", "element"),
    [
        ("CA  ", "UKN", "Ca"),  # column 13 in a ligand
        (" CA ", "UKN", "C"),
        ("CA  ", "LYS", "C"),  # a protein has no calcium, wherever its names stand
        ("  CA", "MET", "C"),
        ("Hh22", "ARG", "H"),
        ("HG1 ", "ARG", "H"),
        ("AC5 ", "AP5", "C"),
        ("OA22", "NAP", "O"),
        ("NO2 ", "NAP", "O"),
        (" HO ", "LIG", "H"),
        ("CL12", "LIG", "Cl"),
        ("C210", "LIG", "C"),
        ("FE12", "SF4", "Fe"),
        ("SE  ", "MSE", "Se"),
        ("SOD ", "SOD", "Na"),
        ("CLA ", "CLA", "Cl"),
        (" K  ", "K", "K"),
        (" ZN ", "ZN", "Zn"),
        (" OH2", "TIP3", "O"),
        ("1HB*", "LIG", "H"),
        ("BB1 ", "DC", "X"),
        ("Q   ", "LIG", "X"),
        ("", "", "X"),
    ],
)
def test_atom_names(name: str, residue: str, element: str) -> None:
    assert symbol_of_atom_name(name, residue) == element
