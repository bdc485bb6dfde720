"""Residue and atom names whose meaning is fixed: the polymers of the Protein Data Bank and water."""


def _names(text: str) -> frozenset[str]:
    return frozenset(text.split())


WATERS = _names("HOH WAT H2O DOD D2O TIP TIP2 TIP3 TIP4 TIP5 TP3 T3P T4P SOL SPC SPCE OH2 HHO MTO")
AMINO_ACIDS = _names(
    "ALA ARG ASN ASP CYS GLN GLU GLY HIS ILE LEU LYS MET PHE PRO SER THR TRP TYR VAL ASX GLX SEC PYL MSE UNK "
    "HID HIE HIP HSD HSE HSP CYX CYM ASH GLH LYN ACE NME NH2 SEP TPO PTR HYP"
)
NUCLEOTIDES = _names("A C G U T I N DA DC DG DT DU DI DN DA5 DA3 DC5 DC3 DG5 DG3 DT5 DT3 ADE CYT GUA THY URA PSU")
PROTEIN_BACKBONE = _names("N CA C O OXT")
NUCLEIC_BACKBONE = _names(
    "P OP1 OP2 OP3 O1P O2P O3P O5' C5' C4' O4' C3' O3' C2' O2' C1' O5* C5* C4* O4* C3* O3* C2* O2* C1*"
)
