"""Lines of PDB files for the tests of everything that reads them."""


def atom(
    name: str = " CA ", residue: str = "ALA", number: str = "   1 ", xyz: str = "   1.000   2.000   3.000",
    alternate: str = " ", chain: str = "A", occupancy: str = "  1.00", bfactor: str = " 10.00", element: str = " C",
    record: str = "ATOM      1 ",
) -> str:  # fmt: skip
    return f"{record}{name}{alternate}{residue:>3} {chain}{number}   {xyz}{occupancy}{bfactor}          {element}"
