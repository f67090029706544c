"""Reads the container of a glTF scene: .glb chunks or .gltf text, and the bytes of buffers.

It uses plain ``json``, as dataclasses of pygltflib silently accept a string for a number, lose the
place of a value and drop unknown members, so that no error could name the JSON path.
Source: glTF 2.0 specification, chapters 3.6 (buffers) and 4 (GLB).
"""

from __future__ import annotations

import os
import re
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

from daguerre.errors import InputError, asked_by
from daguerre.files.budget import Budget
from daguerre.files.json_item import Item, short
from daguerre.files.json_text import parse
from daguerre.files.reading import opened, reading, size_of
from daguerre.files.uris import Folder, data_bytes, is_data
from daguerre.scene.packed import CHUNK as PACKED_CHUNK

from .meshopt import placeholders

_JSON_CHUNK, _BIN_CHUNK = 0x4E4F534A, 0x004E4942
#: Largest size of a .gltf, and of all buffers of a file together.
MAX_TEXT_BYTES = 1 << 30
MAX_BUFFER_BYTES = 1 << 34


@dataclass(frozen=True)
class Document:
    """A parsed file.

    Attributes:
        root: The JSON object.
        binary: The BIN chunk of a .glb; None: no such chunk.
        folder: Folders that URIs may point to.
        trailing: Number of bytes after the stated end of a .glb.
        packed: The chunk of a .glb with a packed scene of Daguerre; None: no such chunk.
    """

    root: Item
    binary: memoryview | None
    folder: Folder
    trailing: int = 0
    packed: memoryview | None = None


def open_document(path: Path, folder: Folder) -> Document:
    """Reads a .glb or .gltf file; its first bytes decide.

    Raises:
        InputError: The file cannot be read, is truncated or is not glTF 2.0.
    """
    data, trailing = _read(path)
    packed = None
    if not data:
        raise InputError(f"{path}: empty file")
    if data[:4] == b"glTF":
        text, binary, packed = _split_chunks(path, data)
    elif path.suffix.lower() == ".glb" or data.lstrip()[:1] not in (b"{", b"\xef"):
        wanted = "b'glTF'" if path.suffix.lower() == ".glb" else "b'glTF' or a JSON object"
        raise InputError(
            f"{path}: header.magic: wanted a glTF file, which begins with {wanted}, "
            f"got {short(data[:4])}"
        )
    else:
        text, binary = memoryview(data), None
    root = parse(bytes(text), str(path))
    root.members()
    _check_asset(root)
    return Document(root, binary, folder, trailing, packed)


def _read(path: Path) -> tuple[bytes, int]:
    """Reads a file, a .glb up to the length in its header; also counts the bytes after it."""
    size = size_of(path)
    with opened(path) as stream, reading(path):
        start = stream.read(12)
        wanted = size
        if start[:4] == b"glTF" and len(start) == 12:
            wanted = min(size, int.from_bytes(start[8:], "little"))
        elif size > MAX_TEXT_BYTES:
            raise InputError(f"{path}: wanted at most {MAX_TEXT_BYTES} bytes of JSON, got {size}")
        return start + stream.read(max(wanted - 12, 0)), max(size - max(wanted, 12), 0)


def _split_chunks(
    path: Path, data: bytes
) -> tuple[memoryview, memoryview | None, memoryview | None]:
    """Chunks with JSON, with the buffer, and with a scene of Daguerre."""

    def fail(where: str, message: str) -> NoReturn:
        raise InputError(f"{path}: {where}: {message}")

    view = memoryview(data)
    if len(data) < 20:
        fail("header", f"truncated: wanted at least 20 bytes, got {len(data)}")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        fail("header.version", f"wanted 2, got {version}")
    if length > len(data):
        fail("header.length", f"truncated: wanted {short(length)} bytes, got {len(data)}")
    if length < 20:
        fail("header.length", f"wanted at least 20 bytes, got {length}")
    chunks: list[tuple[int, memoryview]] = []
    offset = 12
    while offset < length:
        where = f"chunk {len(chunks)}"
        if length - offset < 8:
            fail(where, f"truncated: wanted 8 bytes of header, got {length - offset}")
        size, kind = struct.unpack_from("<II", data, offset)
        if size > length - offset - 8:
            fail(f"{where}.length", f"wanted at most {length - offset - 8} bytes left, got {size}")
        chunks.append((kind, view[offset + 8 : offset + 8 + size]))
        offset += 8 + size
    if chunks[0][0] != _JSON_CHUNK:
        fail("chunk 0.type", f"wanted 0x{_JSON_CHUNK:08x} (JSON), got 0x{chunks[0][0]:08x}")
    binary = chunks[1][1] if len(chunks) > 1 and chunks[1][0] == _BIN_CHUNK else None
    packed = next((held for kind, held in chunks[1:] if kind == PACKED_CHUNK), None)
    return chunks[0][1], binary, packed


def _check_asset(root: Item) -> None:
    asset = root.need("asset")
    for key in ("version", "minVersion"):
        version = asset.need(key) if key == "version" else asset.get(key)
        if version is None:
            continue
        match = re.fullmatch(r"([0-9]{1,4})\.([0-9]{1,4})", version.text())
        if not match:
            version.fail(f"wanted a version such as '2.0', got {short(version.text())}")
        if int(match[1]) != 2 or (key == "minVersion" and int(match[2]) > 0):
            version.fail(f"unsupported: wanted glTF 2.0, got {short(version.text())}")


def load_buffers(document: Document) -> list[memoryview]:
    """Loads ``byteLength`` bytes of each buffer; buffers that are never read stay empty.

    Raises:
        InputError: A file is missing, outside of the folder, or shorter than ``byteLength``.
    """
    unread = placeholders(document.root)
    budget = Budget(MAX_BUFFER_BYTES, "bytes of buffers")
    return [
        memoryview(b"") if index in unread else _load_buffer(document, item, budget)
        for index, item in enumerate(document.root.list_of("buffers"))
    ]


def _load_buffer(document: Document, item: Item, budget: Budget) -> memoryview:
    length_item = item.need("byteLength")
    length = length_item.integer(0)
    if length == 0:  # some exporters write an empty buffer that nothing reads
        return memoryview(b"")
    budget.spend(length, length_item)
    uri = item.get("uri")
    if uri is None:
        if item.key != 0 or document.binary is None:
            Item(None, "uri", item).fail("missing (the file has no binary chunk)")
        data, source = document.binary, "the binary chunk"
    elif is_data(uri):
        data, source = memoryview(data_bytes(uri)), "the data URI"
    else:
        file = document.folder.resolve(uri)
        source = repr(file.name)
        with asked_by(uri.where), opened(file) as stream, reading(file):
            size = os.fstat(stream.fileno()).st_size  # a limit, as byteLength may be wrong
            data = memoryview(stream.read(min(length, size)))
    if len(data) < length:
        length_item.fail(f"{source} is too short: wanted {short(length)} bytes, got {len(data)}")
    return data[:length]
