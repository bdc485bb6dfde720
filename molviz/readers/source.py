"""The bytes of an input, unpacked, as lines that can be numbered."""

import gzip
import io
import zlib
from pathlib import Path

from molviz.errors import InputError

FREELY, PACKED = 1 << 20, 25  # bytes that any archive may hold, and for each of its own; coordinates have 3 to 10
_GZIP, _BYTE_ORDER_MARK = b"\x1f\x8b", b"\xef\xbb\xbf"
_NOT_TEXT = bytes(set(range(32)) - set(b"\t\n\v\f\r\x1a"))


def note(message: str, source: str, line: int | None = None) -> str:
    """Return a warning, worded as errors are: ``FILE:LINE: message``."""
    return str(InputError(message, source, line))


def text_of(source: str, data: bytes | None, unpack_all: bool = False) -> tuple[bytes, list[str]]:
    """Return the text of a file (or the data given for it), lines ending in ``\\n`` alone, and warnings.

    Raises InputError where the file cannot be read, its archive is broken or (unless ``unpack_all``) holds far more
    than molecules do, or what is in it is no text.
    """
    raw = _file(source) if data is None else data
    warnings = []
    if raw.startswith(_GZIP):
        raw = _unzipped(raw, source, None if unpack_all else FREELY + PACKED * len(raw))
    elif source.lower().endswith(".gz"):
        warnings.append(note("the suffix says gzip, but the file is not compressed; read as it is", source))
    text = raw.removeprefix(_BYTE_ORDER_MARK)
    _check_text(text, source)
    return text.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in text else text, warnings


def _file(source: str) -> bytes:
    try:
        return Path(source).read_bytes()
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}; expected a readable file", source) from error


def _unzipped(raw: bytes, source: str, most: int | None) -> bytes:
    """Return what an archive holds, read as a stream and no further than ``most`` bytes, where it is refused."""
    whole = _only_member(raw, most)
    if whole is not None:
        return whole
    try:
        with gzip.open(io.BytesIO(raw)) as stream:
            text: bytes = stream.read() if most is None else stream.read(most + 1)
        if most is not None and len(text) > most:
            message = f"an archive of {len(raw)} bytes that unpacks to over {most}; expected --unpack-all if it shall"
            raise InputError(message, source)
        return text
    except (EOFError, OSError, zlib.error) as error:
        raise InputError(f"broken gzip archive ({error}); expected a complete one", source) from error


def _only_member(raw: bytes, most: int | None) -> bytes | None:
    """Return what an archive of one sound member holds, None for all others: at once takes half as long."""
    member = zlib.decompressobj(wbits=16 + zlib.MAX_WBITS)
    try:
        text = member.decompress(raw, 0 if most is None else most + 1)
    except zlib.error:
        return None
    return text if member.eof and not member.unused_data and (most is None or len(text) <= most) else None


def _check_text(text: bytes, source: str) -> None:
    if not text.strip():
        raise InputError("the file is empty; expected atoms", source)
    binary = text.translate(None, delete=bytes(set(range(256)) - set(_NOT_TEXT)))
    if binary:
        line = text[: text.index(binary[:1])].count(b"\n") + 1
        raise InputError(f"binary data (byte {binary[0]}); expected text", source, line)
