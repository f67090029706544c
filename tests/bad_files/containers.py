"""The container of a .glb, and JSON as text."""

from __future__ import annotations

import json
import os
import struct
from pathlib import Path

from tests.support.formats.make_gltf import glb_bytes, triangle

from .bases import full
from .case import Case, files

GOOD = b'{"asset":{"version":"2.0"}}'


def header(
    magic: bytes = b"glTF",
    version: int = 2,
    length: int | None = None,
    size: int = 28,
    kind: bytes = b"JSON",
    rest: bytes = GOOD + b" ",
) -> bytes:
    """A .glb of one chunk, each of its numbers free to lie."""
    body = struct.pack("<I4s", size, kind) + rest
    return struct.pack("<4sII", magic, version, 12 + len(body) if length is None else length) + body


FILES = {
    "empty": (b"", r"empty file"),
    "magic": (
        header(magic=b"glTf"),
        r"header\.magic: wanted .* begins with b'glTF', got b'glTf'",
    ),
    "json in a glb": (
        GOOD,
        r"header\.magic: wanted .* begins with b'glTF', got b'{\"as'",
    ),
    "five bytes": (b"glTF\2", r"header: truncated: wanted at least 20 bytes, got 5"),
    "version": (header(version=1), r"header\.version: wanted 2, got 1"),
    "length too long": (
        header(length=1000),
        r"header\.length: truncated: wanted 1000 bytes, got 48",
    ),
    "length too short": (header(length=12), r"header: truncated: wanted at least 20 bytes, got 12"),
    "chunk too long": (header(size=29), r"chunk 0\.length: wanted at most 28 bytes left, got 29"),
    "chunk of 4 GiB": (header(size=2**32 - 1), r"chunk 0\.length: wanted at most 28 bytes left"),
    "chunk type": (header(kind=b"BIN\0"), r"chunk 0\.type: wanted 0x4e4f534a \(JSON\)"),
    "half a header": (
        header(rest=GOOD + b" ABCD"),
        r"chunk 1: truncated: wanted 8 bytes of header",
    ),
    "cut off": (header()[:-9], r"header\.length: truncated: wanted 48 bytes, got 39"),
    "no json": (glb_bytes(b""), r"JSON: empty file"),
    "comma": (
        glb_bytes(b'{"asset":\n  {"version":"2.0",}}'),
        r"JSON: line 2, column \d+: ",
    ),
    "nan": (
        glb_bytes(b'{"asset":{"version":"2.0"},\n "x": "NaN", "y": NaN}'),
        r"JSON: line 2, column 19: wanted a finite number, got NaN",
    ),
    "infinity": (
        glb_bytes(b'{"a":-Infinity}'),
        r"JSON: line 1, column 6: wanted a finite number, got -Infinity",
    ),
    "not utf-8": (glb_bytes(b'{"a":"\xff"}'), r"JSON: wanted UTF-8, got byte 0xff at byte 6"),
    "deep json": (glb_bytes(b"[" * 200_000), r"JSON: nested too deeply"),
    "long integer": (
        glb_bytes(b'{"a":' + b"9" * 9000 + b"}"),
        r"JSON: a whole number has too many digits",
    ),
    "a list": (glb_bytes(b"[1, 2]"), r"wrong type: wanted an object, got \[1, 2\]"),
    "a string": (glb_bytes(b'"scene"'), r"wrong type: wanted an object, got 'scene'"),
}

DOUBLED = (
    b'{"asset":{"version":"2.0"},"nodes":[{"name":"a","name":"b"}]}',
    b'{"asset":{"version":"2.0"},"asset":{"version":"2.0"}}',
    b'{"asset":{"version":"2.0"},"extras":{"a":{"b":1,"b":1}}}',
)
TEXTS: dict[str, tuple[bytes, str]] = {
    "empty text": (
        b"",
        r"empty file",
    ),
    "stl": (
        b"solid cube",
        r"header\.magic: wanted .* begins with b'glTF' or a JSON object",
    ),
    "zip": (
        b"PK\3\4" + bytes(60),
        r"header\.magic: wanted .* begins with b'glTF' or a JSON object",
    ),
    "zeros": (
        bytes(4096),
        r"header\.magic: wanted .* begins with b'glTF' or a JSON object",
    ),
    "half a document": (GOOD[:-3], r"JSON: line 1, column \d+: "),
    "two documents": (GOOD + GOOD, r"JSON: line 1, column \d+: Extra data"),
    "single quotes": (b"{'asset': 1}", r"JSON: line 1, column 2: "),
    "comment": (b'{"asset":1 // no\n}', r"JSON: line 1, column \d+: "),
    "utf-16": (
        '{"asset":1}'.encode("utf-16"),
        r"header\.magic: wanted .* begins with b'glTF' or a JSON object",
    ),
    "control character": (b'{"asset":"\x01"}', r"JSON: line 1, column \d+: Invalid control"),
    "deep lists": (b'{"a":' + b"[" * 500_000, r"JSON: nested too deeply"),
    "deep objects": (b'{"a":' * 300_000, r"JSON: nested too deeply"),
    "deep and closed": (
        b'{"a":' + b"[" * 50_000 + b"]" * 50_000 + b"}",
        r"JSON: nested too deeply",
    ),
    "doubled name": (DOUBLED[0], r"nodes\[0\]\.name: .*twice"),
    "doubled asset": (DOUBLED[1], r"asset: .*twice"),
    "doubled extra": (DOUBLED[2], r"extras\.a\.b: .*twice"),
    "long exponent": (
        b'{"asset":{"version":"2.0"},"nodes":[{"scale":[1e99999,1,1]}]}',
        r"nodes\[0\]\.scale\[0\]: not finite: wanted a finite number",
    ),
    "no camera": (
        json.dumps({"asset": {"version": "2.0"}}).encode(),
        r"no camera and nothing visible",
    ),
    "lone surrogate": (
        b'{"asset":{"version":"2.0"},"extensionsRequired":["\\ud800"]}',
        r"extensionsRequired\[0\]: unknown extension",
    ),
}


def no_file(folder: Path) -> Path:
    return folder / "none.glb"


def a_folder(folder: Path) -> Path:
    (folder / "scene.glb").mkdir()
    return folder / "scene.glb"


def a_pipe(folder: Path) -> Path:
    os.mkfifo(folder / "pipe.glb")
    return folder / "pipe.glb"


def a_link_to_itself(folder: Path) -> Path:
    (folder / "loop.glb").symlink_to("loop.glb")
    return folder / "loop.glb"


def a_device(folder: Path) -> Path:
    (folder / "zero.glb").symlink_to("/dev/zero")
    return folder / "zero.glb"


def a_long_name(folder: Path) -> Path:
    return folder / ("x" * 5000 + ".glb")


def a_sparse_giant(folder: Path) -> Path:
    """A file of 2^40 bytes that takes none on the disk."""
    path = folder / "giant.gltf"
    with path.open("wb") as stream:
        stream.write(GOOD)
        stream.truncate(2**40)
    return path


def a_giant_tail(folder: Path) -> Path:
    """A scene and 2^40 bytes behind its end."""
    path = full().glb(folder / "bad.glb")
    with path.open("r+b") as stream:
        stream.truncate(2**40)
    return path


def truncated(tenths: int) -> Case:
    def make(folder: Path) -> Path:
        path = full().glb(folder / "bad.glb")
        data = path.read_bytes()
        path.write_bytes(data[: len(data) * tenths // 10])
        return path

    return Case(f"container-cut at {tenths} tenths", make, "header" if tenths else "empty file")


def trailing(folder: Path) -> Path:
    path = full().glb(folder / "bad.glb")
    path.write_bytes(path.read_bytes() + b"more")
    return path


def short_buffer_file(folder: Path) -> Path:
    path = triangle().gltf(folder / "a.gltf", "mesh.bin")
    (folder / "mesh.bin").write_bytes(b"1234")
    return path


def sparse_buffer_file(folder: Path) -> Path:
    """A buffer of 2^40 bytes, as the file beside it says too."""
    path = triangle().gltf(folder / "a.gltf", "mesh.bin")
    with (folder / "mesh.bin").open("r+b") as stream:
        stream.truncate(2**40)
    text = path.read_text()
    document = json.loads(text)
    document["buffers"][0]["byteLength"] = 2**40
    path.write_text(json.dumps(document))
    return path


CASES = [
    *files("container", "bad.glb", FILES),
    *files("json", "bad.gltf", TEXTS),
    *(truncated(tenths) for tenths in range(10)),
    Case("container-trailing bytes", trailing, warning="after the stated end"),
    Case("file-none", no_file, r"no such file"),
    Case("file-folder", a_folder, r"wanted a file, got a folder"),
    Case("file-pipe", a_pipe, r"not a regular file"),
    Case("file-link to itself", a_link_to_itself, r"cannot read"),
    Case("file-device", a_device, r"not a regular file"),
    Case("file-long name", a_long_name, r"cannot read: File name too long"),
    Case("file-sparse giant", a_sparse_giant, r"wanted at most \d+ bytes of JSON"),
    Case("file-giant tail", a_giant_tail, warning="after the stated end"),
    Case("buffer-short file", short_buffer_file, r"buffers\[0\]\.byteLength: 'mesh\.bin' is too"),
    Case(
        "buffer-sparse giant",
        sparse_buffer_file,
        r"buffers\[0\]\.byteLength: too many bytes of buffers",
    ),
    Case("info-nothing", no_file, r"no such file", command=("info", "{bad}")),
]
