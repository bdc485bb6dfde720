"""``draw --show``: a preview in terminals that answer as those do which can show pictures."""

import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path

import pytest

CAFFEINE = str(Path(__file__).parent.parent / "samples" / "caffeine.xyz")
SIXELS = re.compile(rb"\x1bP[0-9;]*q.*\x1b\\", re.DOTALL)
KITTY = re.compile(rb"\x1b_G[^\x1b]*f=100[^\x1b]*;[A-Za-z0-9+/=]+")
ATTRIBUTES = {"sixels": b"\x1b[?62;4c", "kitty": b"\x1b[?62c", "neither": b"\x1b[?62c"}


def shown_in(kind: str, *words: str) -> bytes:
    """What ``draw --show`` writes to a terminal of 100 by 40 cells that answers what it is asked."""
    child, line = pty.fork()
    if child == 0:
        os.execv(sys.executable, [sys.executable, "-m", "molviz", "draw", CAFFEINE, "--show", *words])
    fcntl.ioctl(line, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 100, 1000, 800))
    written, end = b"", time.monotonic() + 60
    while time.monotonic() < end:
        if not select.select([line], [], [], 1)[0]:
            continue
        try:
            part = os.read(line, 65536)
        except OSError:  # the other side has closed it
            break
        written += part
        if b"\x1b[c" in part:
            os.write(line, ATTRIBUTES[kind])
        asked = re.search(rb"\x1b_G[^;]*i=(\d+)[^;]*a=q", part)
        if asked and kind == "kitty":
            os.write(line, b"\x1b_Gi=%s;OK\x1b\\" % asked[1])
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    os.close(line)
    return written


def test_sixels_and_kittys_pictures() -> None:
    sixels = shown_in("sixels")
    assert SIXELS.search(sixels) and b"-> terminal: 24 atoms read" in sixels
    kitty = shown_in("kitty")
    assert KITTY.search(kitty) and not SIXELS.search(kitty)


def test_a_terminal_that_shows_none_is_told_so() -> None:
    written = shown_in("neither")
    assert b"this terminal shows no pictures" in written and not SIXELS.search(written) and not KITTY.search(written)


def test_a_pipe_is_no_terminal_and_the_file_is_written_all_the_same(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "molviz", "draw", CAFFEINE, "--show"]
    done = subprocess.run([*command, "-o", str(tmp_path / "x.svg")], capture_output=True, check=True)
    assert b"shows no pictures" in done.stderr and not done.stdout
    without = subprocess.run([*command[:-1], "-o", str(tmp_path / "y.svg")], capture_output=True, check=True)
    assert (tmp_path / "x.svg").read_bytes() == (tmp_path / "y.svg").read_bytes() and not without.stdout


@pytest.mark.parametrize(
    ("words", "status", "told"), [(["-o", "-", "--to", "svg"], 2, b"cannot both"), (["--strict"], 1, b"no pictures")]
)
def test_what_cannot_be_shown(words: list[str], status: int, told: bytes) -> None:
    command = [sys.executable, "-m", "molviz", "draw", CAFFEINE, "--show", *words]
    done = subprocess.run(command, capture_output=True, check=False)
    assert done.returncode == status and told in done.stderr and not done.stdout


def test_without_the_packages_it_says_what_to_install() -> None:
    code = "import sys; sys.modules['textual_image'] = None; from molviz.cli import main; main(sys.argv[1:])"
    done = subprocess.run([sys.executable, "-c", code, "draw", CAFFEINE, "--show"], capture_output=True, check=False)
    assert done.returncode == 1 and b"pip install 'molviz[show]'" in done.stderr
