"""Pictures inside scenes: cut, corrupt, of absurd size, of another kind than they say."""

from __future__ import annotations

import base64
import json
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tests.support.formats.make_gltf import Builder, chunk, jpeg, png

from .bases import PIXELS, full, seen
from .case import Case

NAMED = r"images\[0\] \('wood'\): "
KTX2 = json.loads((Path(__file__).parents[1] / "data/ktx2.json").read_text())["files"]
_END = chunk(b"IEND", b"")


def bomb(
    width: int,
    height: int,
    data: bytes = b"\x78\x9c" + bytes(62),
    depth: int = 8,
    kind: int = 2,
) -> bytes:
    """A PNG that claims a size."""
    size = struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", size) + chunk(b"IDAT", data) + _END


def dense(width: int, height: int) -> bytes:
    """A PNG of zeros, as small as deflate can make it."""
    return bomb(width, height, zlib.compress(bytes(height * (1 + 3 * width)), 9))


def damaged(data: bytes, place: int) -> bytes:
    """One byte is another."""
    return data[:place] + bytes([data[place] ^ 255]) + data[place + 1 :]


def wide_jpeg(photo: bytes) -> bytes:
    """A JPEG whose frame header (SOF0) claims 65535 x 65535."""
    place = photo.index(b"\xff\xc0") + 5
    return photo[:place] + b"\xff\xff\xff\xff" + photo[place + 4 :]


def ktx(**numbers: tuple[int, int]) -> Callable[[Path], bytes]:
    """A KTX2 with numbers of its header overwritten: name -> (offset, value)."""

    def make(folder: Path) -> bytes:
        data = bytearray(bytes.fromhex(KTX2["uastc"]))
        for offset, value in numbers.values():
            struct.pack_into("<I", data, offset, value)
        return bytes(data)

    return make


GOOD = png(PIXELS)
WEBP = b"RIFF" + struct.pack("<I", 1000) + b"WEBPVP8L"
BAD: dict[str, tuple[bytes | Callable[[Path], bytes], str]] = {
    "cut png": (GOOD[:-20], "truncated PNG"),
    "png without end": (GOOD[:33], "truncated PNG: the IEND chunk is missing"),
    "png of a magic": (GOOD[:8], "truncated PNG"),
    "corrupt png": (damaged(GOOD, 45), "corrupt PNG: wrong checksum of chunk b'IDAT'"),
    "corrupt png header": (damaged(GOOD, 20), "corrupt PNG: wrong checksum of chunk b'IHDR'"),
    "png without header": (GOOD[:8] + _END, "corrupt PNG: wanted 13 bytes of IHDR, got 0"),
    "png of odd depth": (bomb(8, 8, depth=7), "corrupt PNG: wanted a known kind"),
    "png of odd kind": (bomb(8, 8, kind=9), "corrupt PNG: wanted a known kind"),
    "png of noise": (bomb(20, 20, bytes(64)), "corrupt PNG: wanted a deflate stream"),
    "png 60000x60000": (bomb(60000, 60000), r"image size: wanted at most .* got 60000x60000"),
    "png 16384x30000": (bomb(16384, 30000), "image size: wanted at most"),
    "png 8000x8000": (bomb(8000, 8000), "truncated PNG: 64 bytes cannot hold 8000x8000"),
    "png 0x20": (bomb(0, 20), "image size: wanted at least 1x1, got 0x20"),
    "png 20x0": (bomb(20, 0), "image size: wanted at least 1x1, got 20x0"),
    "png 2^31": (bomb(2**31 - 1, 1), "image size: wanted at most"),
    "png 2^32": (bomb(2**32 - 1, 2**32 - 1), "image size: wanted at most"),
    "png chunk 2^32": (
        GOOD[:33] + struct.pack(">I4s", 2**32 - 1, b"IDAT") + bytes(99),
        "truncated PNG: wanted at least 4294967340 bytes",
    ),
    "cut jpeg": (lambda d: jpeg(PIXELS, d)[:-10], "truncated JPEG: the end marker is missing"),
    "jpeg of 20 bytes": (
        lambda d: jpeg(PIXELS, d)[:20],
        "cannot be decoded: a JPEG without a frame",
    ),
    "jpeg of a magic": (b"\xff\xd8\xff", "cannot be decoded|truncated JPEG"),
    "jpeg 65535x65535": (
        lambda d: wide_jpeg(jpeg(PIXELS, d)),
        "image size: wanted at most|cannot be decoded",
    ),
    "cut webp": (WEBP, "truncated WebP: wanted 1008 bytes, got 16"),
    "webp of zeros": (WEBP + bytes(992), "cannot be decoded"),
    "gif": (b"GIF89a" + bytes(20), "wanted a PNG, JPEG, WebP or KTX2 image, got b'GIF89a"),
    "svg": (b"<svg xmlns='x'/>", "wanted a PNG, JPEG, WebP or KTX2 image"),
    "exr": (b"\x76\x2f\x31\x01" + bytes(40), "wanted a PNG, JPEG, WebP or KTX2 image"),
    "text": (b"hello", "wanted a PNG, JPEG, WebP or KTX2 image, got b'hello'"),
    "nothing": (b"", "wanted a PNG, JPEG, WebP or KTX2 image, got b''"),
    "cut ktx2": (bytes.fromhex(KTX2["uastc"])[:100], "KTX2 header: wanted at least 104 bytes"),
    "ktx2 of 2^31": (ktx(w=(20, 2**31), h=(24, 2**31)), "KTX2 level 0|image size"),
    "ktx2 0 wide": (ktx(w=(20, 0)), "KTX2 size: wanted at least 1x1"),
    "ktx2 with depth": (ktx(d=(28, 4)), "KTX2 depth, layers, faces"),
    "ktx2 of cubes": (ktx(f=(36, 6)), "KTX2 depth, layers, faces"),
    "ktx2 of many levels": (ktx(n=(40, 2**31)), "KTX2 levelCount"),
    "ktx2 packed oddly": (ktx(s=(44, 9)), "KTX2 supercompressionScheme"),
    "ktx2 level beyond": (ktx(o=(84, 2**31)), "KTX2 level 0: wanted at most"),
    "ktx2 level of 2^63": (ktx(o=(92, 2**31)), "KTX2 level 0: wanted at most"),
}


def _case(name: str, data: bytes | Callable[[Path], bytes], error: str) -> Case:
    def make(folder: Path) -> Path:
        b = full()
        raw = data if isinstance(data, bytes) else data(folder)
        uri = "data:image/png;base64," + base64.b64encode(raw).decode()
        b.json["images"][0] = {"name": "wood", "uri": uri}
        return b.glb(folder / "bad.glb")

    return Case(f"image-{name}", make, NAMED + f".*({error})")


def _odd(name: str, pixels: bytes, warning: str = "") -> Case:
    def make(folder: Path) -> Path:
        b: Builder = seen()
        view = b.view(pixels)
        b.json["images"][0]["bufferView"] = view
        return b.glb(folder / "bad.glb")

    return Case(f"picture-{name}", make, warning=warning)


def _unused(folder: Path) -> Path:
    """A picture that no material asks for is not read, but must not point outside."""
    b = full()
    b.add("images", {"uri": "../secret.png"})
    return b.glb(folder / "bad.glb")


CASES = [
    *(_case(name, data, error) for name, (data, error) in BAD.items()),
    Case("image-unused and outside", _unused, r"images\[1\]\.uri: leaves the scene's folder"),
    _odd("1x1", png(np.zeros((1, 1, 3), np.uint8))),
    _odd("1x999", png(np.zeros((1, 999, 3), np.uint8))),
    _odd("grey of 16 bits", png(np.full((3, 5, 1), 40000, np.uint16))),
    _odd("dense 4096x4096", dense(4096, 4096)),
    _odd("trailing bytes", GOOD + bytes(100)),
]
