"""Where results go: one file, a folder, a pattern or standard output; whole or not at all."""

import errno
import os
import sys
import tempfile
from pathlib import Path, PurePath

from molviz.errors import InputError
from molviz.picture.picture import Picture
from molviz.write import WRITERS, write


def encoded(picture: Picture, suffix: str, plotter: str = "", paper: str = "") -> bytes:
    """Return the picture in the format of a suffix; a plotter and its paper matter to ``".hpgl"`` alone.

    Raises InputError for a suffix, plotter or paper that nobody knows.
    """
    if suffix == ".hpgl":
        from molviz.write import hpgl

        return hpgl.write_hpgl(picture, hpgl.plotter(plotter, paper))
    if suffix not in WRITERS:
        raise InputError(f"no format is called {suffix!r}; expected .json or one of {', '.join(WRITERS)}")
    return write(picture, suffix)


def stem_of(source: str) -> str:
    """Return the name of an input without folders and format: ``a/1abc.pdb.gz`` becomes ``1abc``."""
    name = PurePath(source).name
    path = PurePath(name.removesuffix(".gz"))
    return path.stem if source != "-" else "stdin"


def target_of(source: str, output: str, suffix: str) -> str:
    """Return the file an input is written to: ``output`` with ``{stem}`` replaced, or a file in the folder it names."""
    if output.endswith("/") or os.path.isdir(output):  # noqa: PTH112 (Path.is_dir raises for names too long)
        return str(Path(output) / f"{stem_of(source)}{suffix}")
    return output.replace("{stem}", stem_of(source))


def save(target: str, data: bytes) -> None:
    """Write a file beside its target and rename it, or write to standard output for ``-``.

    An existing file is untouched when anything fails; raises InputError naming the target then.
    """
    path = Path(target)
    try:
        if target == "-":
            _print(data)
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        _replace(path, data)
    except BrokenPipeError:
        raise  # the reader has enough: no error to tell
    except OSError as wrong:
        raise InputError(f"cannot be written: {wrong.strerror}", target) from None


def _print(data: bytes) -> None:
    if sys.stdout is None:
        raise OSError(errno.EBADF, "standard output is closed")
    sys.stdout.buffer.write(data)
    sys.stdout.buffer.flush()


def _replace(path: Path, data: bytes) -> None:
    handle, beside = tempfile.mkstemp(prefix=f".{path.name[:100]}.", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        Path(beside).chmod(path.stat().st_mode if path.exists() else 0o666 & ~_umask())
        Path(beside).replace(path)
    except BaseException:
        Path(beside).unlink(missing_ok=True)
        raise


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
