"""Random changes within containers, which stay whole: metadata of photographs, stages, answers."""

from __future__ import annotations

import json
import struct
from random import Random

from . import changes

_JPEG, _PNG, _RIFF = b"\xff\xd8", b"\x89PNG", b"RIFF"
#: Head of a .usdc: mark, version, offset of the table of contents.
_CRATE_HEAD = 88


def in_metadata(rng: Random, data: bytes) -> bytes:
    """A photograph with its EXIF or XMP changed, and the length of that right again."""
    if data.startswith(_JPEG):
        return _in_jpeg(rng, data)
    if data.startswith(_PNG):
        return changes.in_png(rng, data)
    if data.startswith(_RIFF):
        return _in_riff(rng, data)
    return changes.in_part(rng, data)


def _in_jpeg(rng: Random, data: bytes) -> bytes:
    segments, at = [], 2
    while data[at + 1] != 0xDA:
        size = 2 + int.from_bytes(data[at + 2 : at + 4], "big")
        segments.append(data[at : at + size])
        at += size
    places = [i for i, one in enumerate(segments) if one[1] == 0xE1]
    i = rng.choice(places)
    held = _changed(rng, segments[i][4:])[:65533]
    segments[i] = segments[i][:2] + struct.pack(">H", len(held) + 2) + held
    return data[:2] + b"".join(segments) + data[at:]


def _in_riff(rng: Random, data: bytes) -> bytes:
    chunks, at = [], 12
    while at + 8 <= len(data):
        size = int.from_bytes(data[at + 4 : at + 8], "little")
        chunks.append((data[at : at + 4], data[at + 8 : at + 8 + size]))
        at += 8 + size + size % 2
    places = [i for i, (name, _) in enumerate(chunks) if name in (b"EXIF", b"XMP ")]
    i = rng.choice(places or range(len(chunks)))
    chunks[i] = (chunks[i][0], _changed(rng, chunks[i][1]))
    body = b"".join(
        name + struct.pack("<I", len(held)) + held + b"\0" * (len(held) % 2)
        for name, held in chunks
    )
    return b"RIFF" + struct.pack("<I", len(body) + 4) + b"WEBP" + body


def _changed(rng: Random, held: bytes) -> bytes:
    """Changes a block: a packet as text, another as bytes."""
    if b"<x:xmpmeta" in held or b"<rdf:" in held:
        text = held.decode("utf-8", "replace")
        change = rng.choice((changes.in_text, changes.in_attributes))
        return change(rng, text).encode("utf-8", "surrogatepass")
    return changes.in_bytes(rng, held)


def in_crate(rng: Random, data: bytes) -> bytes:
    """A .usdc with its head, its table of contents, or a place in one of its sections changed."""
    table = int.from_bytes(data[16:24], "little")
    begin = rng.choice((8, 16, table, table, rng.randrange(_CRATE_HEAD, len(data))))
    size = rng.choice((8, 40, 200))
    return data[:begin] + changes.in_bytes(rng, data[begin : begin + size]) + data[begin + size :]


def in_package(rng: Random, data: bytes) -> bytes:
    """A .usdz with a file in it changed at the same length, or its directory."""
    names = [at for at in range(len(data)) if data.startswith(b"PK\3\4", at)]
    at = rng.choice(names)
    name, more = struct.unpack_from("<HH", data, at + 26)
    size = int.from_bytes(data[at + 18 : at + 22], "little")
    begin = at + 30 + name + more
    if rng.random() < 0.2 or not size:
        return changes.in_part(rng, data)
    held = data[begin : begin + size]
    if held.startswith(b"PXR-USDC"):
        made = in_crate(rng, held)
    elif held.startswith(b"#usda"):
        made = changes.in_text(rng, held.decode()).encode("utf-8", "surrogatepass")
    else:
        made = changes.in_bytes(rng, held)
    return data[:begin] + made[:size].ljust(size, b" ") + data[begin + size :]


def in_answer(rng: Random, data: bytes) -> bytes:
    """An answer of a worker with its line or its words changed; the checksum is mostly right."""
    from .messages import with_checksum

    line, mark, words = data.partition(b"\n")
    if rng.random() < 0.6:
        line = changes.dumped(rng, changes.in_tree(rng, json.loads(line)))
    else:
        words = changes.in_bytes(rng, words)
    made = line + mark + words
    return with_checksum(made) if rng.random() < 0.9 else made
