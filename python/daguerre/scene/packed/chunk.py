"""The chunk of a .glb file that holds a scene as it is.

A reader of glTF ignores chunks of types that it does not know. Source: glTF 2.0 specification,
chapter 4.4 (binary glTF layout).
"""

from __future__ import annotations

import math
import struct
from pathlib import Path

from daguerre.errors import InputError
from daguerre.files.atomic import write_bytes
from daguerre.files.packing import pack, unpack
from daguerre.scene.scene import Scene

from . import CHUNK
from .parts import parts_of
from .rebuild import rebuilding, rebuilt
from .values import make

_HEADER, _MOST = 12, (1 << 32) - 1


def embed(path: str | Path, scene: Scene) -> None:
    """Writes a scene as it is into a .glb file, beside glTF's own content.

    Raises:
        UsageError: The scene has something that cannot be packed.
        InputError: The file is no .glb, or would be larger than 4 GiB.
        OutputError: The file cannot be written.
    """
    packed = pack(parts_of(scene), large=math.inf).data
    packed = b" " * (-len(packed) % 4) + packed  # spaces before JSON mean nothing
    file = Path(path)
    data = file.read_bytes()
    if data[:4] != b"glTF" or len(data) < _HEADER:
        raise InputError(f"{path}: not a .glb file")
    length = len(data) + 8 + len(packed)
    if length > _MOST:
        raise InputError(f"{path}: wanted at most {_MOST} bytes, got {length}")
    head = data[:8] + struct.pack("<I", length)
    chunk = struct.pack("<II", len(packed), CHUNK)
    write_bytes(file, b"".join([head, data[_HEADER:], chunk, packed]))


def scene_of(chunk: memoryview, path: Path) -> Scene:
    """Reads the scene of a chunk.

    Args:
        chunk: Its bytes, from a file that may be anybody's.
        path: The file, for messages.

    Raises:
        MismatchError: Another version of Daguerre wrote it.
        InputError: It is damaged; the message names the place.
    """
    data = bytes(chunk)
    with rebuilding(f"{path}: chunk DGSC"):
        scene = rebuilt(unpack(data, _elsewhere, make), len(data))
    scene.path = path
    return scene


def _elsewhere(name: str) -> bytes:
    """Refuses arrays outside the chunk."""
    raise LookupError(f"array {name[:20]!r} is not in the file")
