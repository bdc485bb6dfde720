"""The bytes of an input, unpacked, as lines that can be numbered."""

import gzip
import zlib
from pathlib import Path

from molviz.errors import InputError

_GZIP, _BYTE_ORDER_MARK = b"\x1f\x8b", b"\xef\xbb\xbf"
_NOT_TEXT = bytes(set(range(32)) - set(b"\t\n\v\f\r\x1a"))


def note(message: str, source: str, line: int | None = None) -> str:
    """Return a warning, worded as errors are: ``FILE:LINE: message``."""
    return str(InputError(message, source, line))


def text_of(source: str, data: bytes | None) -> tuple[bytes, list[str]]:
    """Return the text of a file (or the data given for it), lines ending in ``\\n`` alone, and warnings.

    Raises InputError where the file cannot be read, its archive is broken, or what is in it is no text.
    """
    raw = _file(source) if data is None else data
    warnings = []
    if raw.startswith(_GZIP):
        raw = _unzipped(raw, source)
    elif source.lower().endswith(".gz"):
        warnings.append(note("the suffix says gzip, but the file is not compressed; read as it is", source))
    text = raw.removeprefix(_BYTE_ORDER_MARK)
    _check_text(text, source)
    return text.replace(b"\r\n", b"\n").replace(b"\r", b"\n"), warnings


def _file(source: str) -> bytes:
    try:
        return Path(source).read_bytes()
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}; expected a readable file", source) from error


def _unzipped(raw: bytes, source: str) -> bytes:
    try:
        return gzip.decompress(raw)
    except (EOFError, OSError, zlib.error) as error:
        raise InputError(f"broken gzip archive ({error}); expected a complete one", source) from error


def _check_text(text: bytes, source: str) -> None:
    if not text.strip():
        raise InputError("the file is empty; expected atoms", source)
    binary = text.translate(None, delete=bytes(set(range(256)) - set(_NOT_TEXT)))
    if binary:
        line = text[: text.index(binary[:1])].count(b"\n") + 1
        raise InputError(f"binary data (byte {binary[0]}); expected text", source, line)
