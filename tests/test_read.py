"""Which reader gets a file, and that nothing but a reading or an InputError comes out."""

import gzip
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.errors import InputError
from molviz.readers import read
from tests.pdb_lines import atom

CIF = "data_x\nloop_\n_atom_site.type_symbol\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\nC 1 2 3\n"
TEXTS = {
    "pdb": "\n".join([atom(), atom(" CB ", alternate="A"), atom(" CB ", alternate="B")]),
    "mmcif": CIF,
    "xyz": "1\ncomment\nC 1 2 3\n",
    "extxyz": "1\nProperties=species:S:1:pos:R:3\nC 1 2 3\n",
    "xyzr": "1 2 3 1.7\n",
}


@pytest.mark.parametrize("format", TEXTS)
def test_the_content_tells_the_format(format: str) -> None:
    for data in (TEXTS[format].encode(), gzip.compress(TEXTS[format].encode())):
        reading = read("-", data)
        assert reading.format == format and reading.models[0].position[0].tolist() == [1, 2, 3]


def test_an_atom_behind_lines_of_no_meaning_tells_the_format() -> None:
    assert read("-", ("TITEL misspelt\n" + TEXTS["pdb"]).encode()).format == "pdb"


def test_a_suffix_that_lies_is_told() -> None:
    reading = read("t.cif", TEXTS["xyz"].encode())
    assert reading.format == "xyz"
    assert reading.warnings == ("t.cif: the suffix .cif says mmcif, but the content is xyz; read as xyz",)


def test_a_given_format_goes_first() -> None:
    with pytest.raises(InputError, match=r"^-: no ATOM"):
        read("-", TEXTS["xyz"].encode(), "pdb")


def test_a_format_that_nothing_tells_is_refused() -> None:
    with pytest.raises(InputError, match=r"^t\.txt: neither content nor suffix"):
        read("t.txt", b"once upon a time\n")


def test_files(tmp_path: Path) -> None:
    path = tmp_path / "t.xyz.gz"
    path.write_bytes(gzip.compress(TEXTS["xyz"].encode()))
    assert read(str(path)).models[0].name == "t"
    path.write_bytes(TEXTS["xyz"].encode())
    assert "not compressed" in read(str(path)).warnings[0]
    for missing in (tmp_path / "missing.pdb", tmp_path):
        with pytest.raises(InputError, match="cannot be read"):
            read(str(missing))


def test_an_archive_cut_short_is_refused() -> None:
    whole = gzip.compress(TEXTS["pdb"].encode())
    for end in (5, len(whole) // 2, len(whole) - 1):
        with pytest.raises(InputError, match=r"^t\.pdb\.gz: broken gzip archive"):
            read("t.pdb.gz", whole[:end])


def test_an_empty_file_is_refused() -> None:
    with pytest.raises(InputError, match=r"^t\.pdb: the file is empty"):
        read("t.pdb", b"")


@settings(max_examples=300)
@given(st.sampled_from(sorted(TEXTS)), st.integers(0, 400), st.integers(0, 8), st.binary(max_size=8))
def test_damage_is_read_or_refused(format: str, place: int, length: int, damage: bytes) -> None:
    text = TEXTS[format].encode()
    place = min(place, len(text))
    try:
        reading = read("t.pdb", text[:place] + damage + text[place + length :], format)
    except InputError as error:
        assert str(error).startswith("t.pdb:")
    else:
        assert all(abs(model.position).max() < float("inf") for model in reading.models)


def test_xyz_is_read_without_the_parser_of_cif() -> None:
    code = "import sys; from molviz.readers import read; read('-', b'1\\n\\nC 0 0 0'); sys.exit('gemmi' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
