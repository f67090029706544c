"""OpenEXR files as strangers send them, made from bytes: each meets ``--env`` and ``post``."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .bases import beside_scene
from .case import DRAW, Case

ENV = ("render", "{folder}/scene.glb", "--env", "{bad}", *DRAW)
POST = ("post", "{bad}", "-o", "{out}.exr", "--effect", "distortion:fx=9,k1=0.01")
TILED, DEEP, PARTS = 0x200, 0x800, 0x1000
NONE, ZIP = 0, 3


@dataclass
class Exr:
    """A file of one part, plain floats of 1, made by hand; every claim can be a lie.

    Attributes:
        names: Channels.
        box: Data window.
        compression: Number that the header says.
        flags: Beside version 2.
        more: Attributes by name: type and bytes; empty: the attribute is left out.
        rows: Rows in a chunk.
        chunk: Bytes of a chunk's pixels, from the plain ones.
        places: The list of chunks, from the right one.
        heads: Row and length in front of each chunk, from the right ones.
        sampling: That of all channels but Y.
        drawn: Rows that are there.
    """

    names: tuple[bytes, ...] = (b"B", b"G", b"R")
    box: tuple[int, int, int, int] = (0, 0, 7, 3)
    compression: int = NONE
    flags: int = 0
    more: Mapping[bytes, tuple[bytes, bytes]] = field(default_factory=dict)
    rows: int = 1
    chunk: Callable[[bytes], bytes] = bytes
    places: Callable[[list[int]], list[int]] = list
    heads: Callable[[int, int], tuple[int, int]] = lambda y, n: (y, n)
    sampling: int = 1
    drawn: int = 4

    def data(self) -> bytes:
        """The file."""
        listed = b"".join(
            n + b"\0" + struct.pack("<4i", 2, 0, *[self.sampling if n != b"Y" else 1] * 2)
            for n in self.names
        )
        attributes = {
            b"channels": (b"chlist", listed + b"\0"),
            b"compression": (b"compression", bytes([self.compression])),
            b"dataWindow": (b"box2i", struct.pack("<4i", *self.box)),
            b"displayWindow": (b"box2i", struct.pack("<4i", 0, 0, 7, 3)),
            b"lineOrder": (b"lineOrder", b"\0"),
            b"pixelAspectRatio": (b"float", struct.pack("<f", 1)),
            b"screenWindowCenter": (b"v2f", bytes(8)),
            b"screenWindowWidth": (b"float", struct.pack("<f", 1)),
            **self.more,
        }
        head = struct.pack("<ii", 20000630, 2 | self.flags)
        for name, (kind, value) in attributes.items():
            if kind:
                head += name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
        head += b"\0"
        blocks, places = [], []
        starts = range(0, self.drawn, self.rows)
        at = len(head) + 8 * len(starts)
        for start in starts:
            tall = min(self.rows, self.drawn - start)
            plain = np.ones(8 * len(self.names) * tall, "<f4").tobytes()
            packed = self.chunk(plain)
            y, length = self.heads(self.box[1] + start, len(packed))
            places.append(at)
            blocks.append(struct.pack("<2i", y, length) + packed)
            at += len(blocks[-1])
        table = [p & 0xFFFFFFFFFFFFFFFF for p in self.places(places)]
        return head + struct.pack(f"<{len(table)}Q", *table) + b"".join(blocks)


def packed(plain: bytes) -> bytes:
    """Bytes deflated as ZIP has them."""
    found = np.frombuffer(plain, np.uint8)
    halves = np.concatenate([found[0::2], found[1::2]])
    halves[1:] = halves[1:] - halves[:-1] + np.uint8(128)
    return zlib.compress(halves.tobytes())


def tiles(mode: int, count: int, size: tuple[int, int] = (4, 2)) -> Exr:
    """A tiled file whose list of chunks has ``count`` entries, none of which is right."""
    tiled = (b"tiledesc", struct.pack("<2IB", *size, mode))
    return Exr(flags=TILED, more={b"tiles": tiled}, places=lambda p: p[:1] * count)


def many(count: int) -> tuple[bytes, ...]:
    return tuple(b"c%05d" % i for i in range(count))


A = b"string"
FLAT = "deep pixels are not supported"
LIE: dict[str, tuple[Exr, str]] = {
    "deep scanlines": (Exr(flags=DEEP, more={b"type": (A, b"deepscanline")}), FLAT),
    "deep tiles": (Exr(flags=DEEP | TILED, more={b"type": (A, b"deeptile")}), FLAT),
    "ids manifest deep": (
        Exr(flags=DEEP, more={b"idManifest": (b"idmanifest", bytes(64))}), FLAT),
    "unknown flags": (Exr(flags=0x8000), "wanted OpenEXR 2"),
    "version 3": (Exr(flags=1), "wanted OpenEXR 2"),
    "channel not UTF-8": (Exr(names=(b"B", b"G", b"R", b"\xff\xfe")), "names in UTF-8"),
    "channel twice": (Exr(names=(b"B", b"G", b"G", b"R")), "channel 'G' appears twice"),
    "no channels": (Exr(names=()), "channels: none"),
    "10000 channels": (Exr(names=many(10000)), "channels: damaged list of channels"),
    "long channel": (Exr(names=(b"B", b"G", b"R", b"R" * 300)), "damaged list of channels"),
    "luminance and chroma": (
        Exr(names=(b"BY", b"RY", b"Y"), sampling=2), "subsampled channels are not supported"),
    "sampling 0": (Exr(sampling=0), "damaged list of channels"),
    "channels of another type": (
        Exr(more={b"channels": (A, b"RGB")}), "channels: wanted a chlist"),
    "compression 99": (Exr(compression=99), "compression: wanted one of"),
    "no compression": (Exr(more={b"compression": (b"", b"")}), "wanted a compression, got none"),
    "no data window": (Exr(more={b"dataWindow": (b"", b"")}), "dataWindow: wanted a box2i"),
    "data window of floats": (
        Exr(more={b"dataWindow": (b"box2f", bytes(16))}), "dataWindow: wanted a box2i"),
    "window overflows": (
        Exr(box=(-(2**31), -(2**31), 2**31 - 1, 2**31 - 1)), "corners in order"),
    "window back to front": (Exr(box=(7, 3, 0, 0)), "corners in order"),
    "window far away": (Exr(box=(2**30, 0, 2**30 + 7, 3)), "corners in order"),
    "huge window": (Exr(box=(0, 0, 65535, 65535)), "cut off or damaged"),
    "wide window": (Exr(box=(0, 0, 2**30 - 1, 3)), "65536 pixels each way|wanted"),
    "attribute twice": (
        Exr(more={b"x": (b"int\0\4\0\0\0abcdx\0int", bytes(4))}), "header: damaged"),
    "attribute of -1 bytes": (
        Exr(more={b"x": (b"int\0\xff\xff\xff\xff", b"")}), "header: damaged"),
    "attribute beyond the file": (
        Exr(more={b"x": (b"int\0\0\0\0\x7f", b"")}), "header|broken"),
    "chunk of another row": (Exr(heads=lambda y, n: (y + 1, n)), "wanted a block of"),
    "chunk of -1 bytes": (Exr(heads=lambda y, n: (y, -1)), "bytes, got -1"),
    "chunk of 2^31 bytes": (Exr(heads=lambda y, n: (y, 2**31 - 1)), "bytes, got 2147483647"),
    "chunk too small": (Exr(heads=lambda y, n: (y, 1)), "bytes, got 1"),
    "places of 0": (Exr(places=lambda p: [0] * len(p)), "cut off or damaged"),
    "places beyond": (Exr(places=lambda p: [2**62] * len(p)), "cut off or damaged"),
    "places below 0": (Exr(places=lambda p: [-1] * len(p)), "cut off or damaged"),
    "places in the list": (Exr(places=lambda p: [p[0] - 8] * len(p)), "cut off or damaged"),
    "places all alike": (Exr(places=lambda p: p[:1] * len(p)), "wanted a block of"),
    "zip of noise": (Exr(compression=ZIP, rows=16, chunk=lambda b: b"\1" * 60), "damaged pixels"),
    "zip too short": (
        Exr(compression=ZIP, rows=16, chunk=lambda b: packed(b[:64])), "bytes of pixels, got 64"),
    "zip bomb": (
        Exr(compression=ZIP, rows=16, chunk=lambda b: packed(b + bytes(10**7))),
        "wanted|bytes of pixels, got more"),
    "more than deflate holds": (
        Exr(box=(0, 0, 60000, 3), compression=ZIP, rows=16, chunk=packed),
        r"rows from 0: wanted \d{4} to \d+ bytes, got"),
    "tiles of 0": (tiles(0, 4, (0, 0)), "tiles: wanted a size"),
    "tiles of 2^32": (tiles(0, 4, (2**32 - 1, 2**32 - 1)), "tiles: wanted a size"),
    "tiles of mode 7": (tiles(7, 4), "tiles: wanted a size"),
    "tiles of others": (tiles(0, 4), "wanted a block of|got"),
    "mip-map of others": (tiles(1, 8), "wanted a block of|got"),
    "no tiles": (Exr(flags=TILED), "tiles: wanted a tiledesc"),
    "parts without names": (Exr(flags=PARTS), "header|type"),
    "rle of noise": (Exr(compression=1, chunk=lambda b: b"\7" * 50), "cannot be decoded"),
    "piz of noise": (Exr(compression=4, rows=32, chunk=lambda b: b"\7" * 90), "cannot be dec"),
    "pxr24 of noise": (Exr(compression=5, rows=16, chunk=lambda b: b"\7" * 90), "cannot be dec"),
    "dwaa of noise": (Exr(compression=8, rows=32, chunk=lambda b: b"\7" * 200), "cannot be dec"),
    "htj2k of noise": (Exr(compression=11, rows=32, chunk=lambda b: b"\7" * 90), "cannot be dec"),
}  # fmt: skip
READ: dict[str, Exr] = {
    "plain": Exr(),
    "zip": Exr(compression=ZIP, rows=16, chunk=packed),
    "attribute not UTF-8": Exr(more={b"\xff\xfe": (A, b"\xfd")}),
    "facts of other types": Exr(
        more={
            b"expTime": (A, b"soon"),
            b"isoSpeed": (b"v2f", bytes(8)),
            b"daguerre:bad_samples": (A, b"many"),
            b"daguerre:bad_sample_places": (A, b"[1, 2]"),
            b"worldToCamera": (A, b"here"),
            b"chromaticities": (b"float", bytes(4)),
        }
    ),
    "negative window": Exr(box=(-3, -2, 4, 1)),
    "1000 channels": Exr(names=(b"B", b"G", b"R", *many(997))),
}


def _put(make: Callable[[], bytes]) -> Callable[[Path], Path]:
    return beside_scene("e.exr", lambda path: path.write_bytes(make()))


CASES = [
    *(
        Case(f"exr-{way}-{key}", _put(one.data), error, command=command)
        for key, (one, error) in LIE.items()
        for way, command in (("env", ENV), ("post", POST))
    ),
    *(
        Case(f"exr-{way}-{key}", _put(one.data), command=command)
        for key, one in READ.items()
        for way, command in (("env", ENV), ("post", POST))
    ),
]
