"""Gzip with a header that says nothing of where and when it was made: RFC 1952."""

import struct
import zlib

_HEADER = b"\x1f\x8b\x08\x00" + bytes(4) + b"\x02\xff"  # deflate, no name, no date, smallest, no system named


def gzipped(data: bytes) -> bytes:
    """Return data as an archive of one member; Python's own writes other headers from one version to the next."""
    packer = zlib.compressobj(zlib.Z_BEST_COMPRESSION, zlib.DEFLATED, -zlib.MAX_WBITS)
    end = struct.pack("<II", zlib.crc32(data), len(data) & 0xFFFFFFFF)
    return _HEADER + packer.compress(data) + packer.flush() + end
