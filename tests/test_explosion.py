"""Small inputs that mean much: refused, or read within bounds; and no name makes a terminal do anything."""

import gzip
import os
import re
import resource
import subprocess
import sys
import time
from pathlib import Path

import pytest

from molviz import InputError
from molviz.readers import read

SAMPLES = Path(__file__).parent.parent / "samples"
CAFFEINE = str(SAMPLES / "caffeine.xyz")
ATOM = b"ATOM      1  CA  ALA A   1       0.000   0.000   0.000  1.00  0.00           C\n"
CIF = """data_x
loop_
_atom_site.id
_atom_site.type_symbol
_atom_site.label_atom_id
_atom_site.label_comp_id
_atom_site.label_asym_id
_atom_site.auth_seq_id
_atom_site.Cartn_x
_atom_site.Cartn_y
_atom_site.Cartn_z
1 C {name} ALA A 1 0 0 0
2 C C ALA A 1 1.5 0 {z}
_pdbx_struct_assembly_gen.assembly_id 1
_pdbx_struct_assembly_gen.oper_expression '{expression}'
_pdbx_struct_assembly_gen.asym_id_list A
loop_
_pdbx_struct_oper_list.id
""" + "".join(f"_pdbx_struct_oper_list.matrix[{i}][{j}]\n" for i in (1, 2, 3) for j in (1, 2, 3)) + "".join(
    f"_pdbx_struct_oper_list.vector[{i}]\n" for i in (1, 2, 3)) + "".join(
    f"{k} 1 0 0 0 1 0 0 0 1 {k} 0 0\n" for k in range(1, 41))  # fmt: skip
SECONDS, MEMORY = 10, 300 << 20  # for the work alone, on a machine that does other work too


def cif(name: str = "CA", z: str = "0", expression: str = "1") -> bytes:
    return CIF.format(name=name, z=z, expression=expression).encode()


EXPLOSIVE = {
    "range.cif": cif(expression="(1-900000000)"),
    "digits.cif": cif(expression=f"(1-{'9' * 5000})"),
    "product.cif": cif(expression="(1-40)(1-40)(1-40)(1-40)(1-40)(1-40)"),
    "name.cif": cif(name="C" * 200_000),
    "number.cif": cif(z="0" * 200_000),
    "newlines.pdb.gz": gzip.compress(ATOM + b"\n" * 60_000_000, 9),
    "blanks.xyz.gz": gzip.compress(b"1\n\nC 0 0 0" + b" " * 60_000_000, 9),
    "label.xyz": b"20000\n\n" + b"C" * 200_000 + b" 0 0 0\n" + b"C 0 0 0\n" * 19_999,
    "number.xyz": b"20000\n\n" + b"C 0 0 " + b"0" * 200_000 + b"\n" + b"C 0 0 0\n" * 19_999,
    "number.xyzr": b"0 0 0 1\n" * 20_000 + b"0 0 0 1" + b"0" * 200_000,
}


def measured(words: list[str]) -> tuple[subprocess.CompletedProcess[bytes], float]:
    """Run with the memory that importing takes and ``MEMORY`` more; return the result and its seconds."""
    began = time.monotonic()
    limit = (400 << 20) + MEMORY
    done = subprocess.run(
        [sys.executable, "-m", "molviz", *words], capture_output=True, check=False, timeout=60,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_DATA, (limit, limit)),
    )  # fmt: skip
    return done, time.monotonic() - began


@pytest.mark.parametrize("name", EXPLOSIVE)
def test_small_files_that_mean_much_are_answered_within_bounds(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes(EXPLOSIVE[name])
    done, seconds = measured(["info", "--json", str(path)])
    assert done.returncode in (0, 1) and b"memory" not in done.stderr and b"Traceback" not in done.stderr
    assert seconds < SECONDS and len(done.stderr) < 20_000
    assert done.returncode == 0 or done.stderr.startswith(f"molviz: {path}".encode())


def test_a_text_of_thousands_of_letters_is_refused() -> None:
    done, seconds = measured(["hidden-lines", "--text", "A" * 5000])
    assert done.returncode == 2 and b"5000 letters; expected at most" in done.stderr and seconds < SECONDS


def test_an_option_lifts_the_cap_on_archives(tmp_path: Path) -> None:
    path = tmp_path / "x.pdb.gz"
    path.write_bytes(gzip.compress(ATOM + b"\n" * 2_000_000))
    with pytest.raises(InputError, match="expected --unpack-all"):
        read(path)
    assert len(read(path, unpack_all=True).models[0]) == 1
    assert measured(["info", str(path)])[0].returncode == 1
    assert measured(["info", "--unpack-all", str(path)])[0].returncode == 0


def test_products_of_operators_are_made_up_to_the_cap(tmp_path: Path) -> None:
    path = tmp_path / "x.cif"
    path.write_bytes(cif(expression="(1-40)(1-40)"))
    assert len(read(path).assembly("1")) == 2 * 1600
    path.write_bytes(cif(expression="(1-40)(1-40)(1-40)"))
    assert any("left out" in warning for warning in read(path).warnings)


HOSTILE = [
    ["info"], ["measure"], ["measure", "--csv"], ["measure", "--per", "atom"], ["info", "--model", "\x1b[31m"],
    ["info", "--select", "\x1b\x9b"], ["info", "\x1b[31m.xyz"], ["info", "--\x1b[31m"], ["\x1b[31m"],
    ["draw", "-o", "\x1b[31m.svg"], ["draw", "-o", "\x1b.tiff"], ["draw", "--style", "\x1b\x7f", "-o", "x.svg"],
]  # fmt: skip


@pytest.mark.parametrize("words", HOSTILE)
def test_names_leave_a_terminal_alone(words: list[str], tmp_path: Path) -> None:
    name = b"\x1b]0;title\x07\xc2\x9b\x7f\r\xff.cif"
    (tmp_path / os.fsdecode(name)).write_bytes(cif(name='"C\u009b2J"'))
    command = [sys.executable, "-m", "molviz", *words, name]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, check=False)
    told = (done.stdout + done.stderr).decode("utf-8")
    assert told and not re.search(r"[\x00-\x09\x0b-\x1f\x7f-\x9f]", told)
    assert "Traceback" not in told and done.returncode in (0, 1, 2)
