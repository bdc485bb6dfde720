"""Output files appear complete or not at all."""

import os
import tempfile
from pathlib import Path

from molviz.errors import InputError


def save(data: bytes, target: Path) -> None:
    """Write beside the target and rename; an existing file stays untouched when anything fails.

    Raises ``InputError`` where the folder cannot be written to.
    """
    try:
        handle, beside = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    except OSError as error:
        raise InputError(f"{error.strerror}, expected a folder that can be written to", str(target)) from error
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        Path(beside).chmod(0o666 & ~_umask())
        Path(beside).replace(target)
    except OSError as error:
        Path(beside).unlink(missing_ok=True)
        raise InputError(f"{error.strerror}, expected a file that can be written", str(target)) from error


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
