"""Where results go: one file, a folder, a pattern or standard output; whole or not at all."""

import errno
import os
import re
import stat
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path, PurePath
from typing import BinaryIO

from molviz.errors import InputError, OptionError
from molviz.picture.picture import Picture
from molviz.write import WRITERS, pieces

STEM, NUMBER = PATTERNS = ("{stem}", "{n}")  # in the name of an output: the input's name, the picture's number
STANDARD = {"stdin": 0, "stdout": 1, "stderr": 2}
STANDARD_OUTPUT = STANDARD["stdout"]
DESCRIPTOR = re.compile(r"(?:/dev/fd|/proc/self/fd)/([0-9]{1,9})|/dev/(stdin|stdout|stderr)")
MOST_LINKS = 40  # of a chain, as in Linux; a longer one is a circle


def pieces_of(picture: Picture, suffix: str, plotter: str = "", paper: str = "") -> Iterable[bytes]:
    """Return the pieces of the picture in the format of a suffix; a plotter and its paper matter to ``".hpgl"`` alone.

    Raises InputError for a suffix, plotter or paper that nobody knows.
    """
    if suffix == ".hpgl":
        from molviz.write import hpgl

        return hpgl.write_hpgl(picture, hpgl.plotter(plotter, paper))
    if suffix not in WRITERS:
        raise InputError(f"no format is called {suffix!r}; expected .json or one of {', '.join(WRITERS)}")
    return pieces(picture, suffix)


def stem_of(source: str) -> str:
    """Return the name of an input without folders and format: ``a/1abc.pdb.gz`` becomes ``1abc``."""
    name = PurePath(source).name
    path = PurePath(name.removesuffix(".gz"))
    return path.stem if source != "-" else "stdin"


def target_of(source: str, output: str, suffix: str) -> str:
    """Return the file an input is written to: ``output`` with ``{stem}`` replaced, or a file in the folder it names."""
    if output.endswith("/") or os.path.isdir(output):  # noqa: PTH112 (Path.is_dir raises for names too long)
        return str(Path(output) / f"{stem_of(source)}{suffix}")
    return output.replace(STEM, stem_of(source))


def refuse_inputs(target: str, inputs: Iterable[str]) -> None:
    """Raise OptionError where a file that would be written is one of those that are read, whatever its names are."""
    written = _identity(target)
    for source in inputs:
        if written and written == _identity(source):
            raise OptionError(f"is the input {source} itself; expected another name for the output", target)


def _identity(path: str) -> tuple[int, int] | None:
    """Device and inode of a regular file, None where there is none: reading from a terminal leaves it to write to."""
    try:
        found = os.stat(path)  # noqa: PTH116 (Path("") is the folder)
    except (OSError, ValueError):
        return None
    return (found.st_dev, found.st_ino) if stat.S_ISREG(found.st_mode) else None


def makes_folder(output: str) -> bool:
    """Return whether folders that an output names are made where they are missing: by ``out/`` and by patterns."""
    return output.endswith("/") or any(part in output for part in PATTERNS)


def save(target: str, data: Iterable[bytes], make_folder: bool = False) -> int:
    """Write a file beside its target and rename it, or write to standard output for ``-``; return how many bytes.

    A symbolic link stays one, and what it names is written; a pipe, a device or a descriptor (``/dev/stdout``) is
    written into. An existing file is untouched when anything fails; raises InputError naming the target then.
    """
    try:
        descriptor = STANDARD_OUTPUT if target == "-" else _descriptor(target)
        if descriptor is not None:
            return _print(data, descriptor)
        path = Path(os.path.realpath(target))
        if path.is_symlink():
            raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
        if path.exists() and not path.is_file() and not path.is_dir():
            with path.open("wb") as file:
                return _written(data, file)
        if make_folder:
            path.parent.mkdir(parents=True, exist_ok=True)
        return _replace(path, data)
    except BrokenPipeError:
        raise  # the reader has enough: no error to tell
    except FileNotFoundError:
        raise InputError("cannot be written: there is no such folder; expected one that exists", target) from None
    except OSError as wrong:
        raise InputError(f"cannot be written: {wrong.strerror}", target) from None


def _descriptor(target: str) -> int | None:
    """Return which open descriptor of this process a name or its links mean, None for a file of its own."""
    for _ in range(MOST_LINKS):
        named = DESCRIPTOR.fullmatch(os.path.abspath(target))  # noqa: PTH100 (links stay)
        if named:
            return STANDARD[named[2]] if named[2] else int(named[1])
        if not os.path.islink(target):  # noqa: PTH114 (Path.is_link raises for names too long)
            break
        target = os.path.join(os.path.dirname(target), os.readlink(target))  # noqa: PTH115, PTH118, PTH120
    return None


def _written(data: Iterable[bytes], file: BinaryIO) -> int:
    return sum(file.write(piece) for piece in data)


def _print(data: Iterable[bytes], descriptor: int) -> int:
    if descriptor != STANDARD_OUTPUT:
        with os.fdopen(os.dup(descriptor), "wb") as file:
            return _written(data, file)
    if sys.stdout is None:
        raise OSError(errno.EBADF, "standard output is closed")
    size = _written(data, sys.stdout.buffer)
    sys.stdout.buffer.flush()
    return size


def _replace(path: Path, data: Iterable[bytes]) -> int:
    handle, beside = tempfile.mkstemp(prefix=f".{path.name[:100]}.", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            size = _written(data, file)
        Path(beside).chmod(path.stat().st_mode if path.exists() else 0o666 & ~_umask())
        Path(beside).replace(path)
    except BaseException:
        Path(beside).unlink(missing_ok=True)
        raise
    return size


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
