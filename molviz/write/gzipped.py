"""Gzip with a header that says nothing of where and when it was made: RFC 1952."""

import struct
import zlib
from collections.abc import Iterable, Iterator

_HEADER = b"\x1f\x8b\x08\x00" + bytes(4) + b"\x02\xff"  # deflate, no name, no date, smallest, no system named


def gzipped(data: Iterable[bytes]) -> Iterator[bytes]:
    """Yield data as an archive of one member; Python's own writes other headers from one version to the next."""
    packer, checksum, size = zlib.compressobj(zlib.Z_BEST_COMPRESSION, zlib.DEFLATED, -zlib.MAX_WBITS), 0, 0
    yield _HEADER
    for piece in data:
        checksum, size = zlib.crc32(piece, checksum), size + len(piece)
        yield packer.compress(piece)
    yield packer.flush() + struct.pack("<II", checksum, size & 0xFFFFFFFF)
