"""Pictures of environments (--env)."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

from .bases import ENDLESS, beside_scene
from .case import DRAW, Case

COMMAND = ("render", "{folder}/scene.glb", "--env", "{bad}", *DRAW)


def hdr(size: bytes = b"-Y 4 +X 7", head: bytes = b"", data: int = 112) -> bytes:
    """A Radiance file; below a width of 8 nothing is packed."""
    return (
        b"#?RADIANCE\n"
        + head
        + b"\nFORMAT=32-bit_rle_rgbe\n\n"
        + size
        + b"\n"
        + bytes((9, 9, 9, 128)) * (data // 4)
    )


def exr(
    value: float, height: int = 4, width: int = 8, names: str = "RGB"
) -> Callable[[Path], bytes]:
    """An EXR of one value."""

    def make(folder: Path) -> bytes:
        spec = oiio.ImageSpec(width, height, len(names), oiio.FLOAT)
        spec.channelnames = tuple(names)
        path = folder / "made.exr"
        out = oiio.ImageOutput.create(str(path))
        assert out.open(str(path), spec)
        assert out.write_image(np.full((height, width, len(names)), value, np.float32))
        out.close()
        data = path.read_bytes()
        path.unlink()
        return data

    return make


def windows(**boxes: tuple[int, int, int, int]) -> Callable[[Path], bytes]:
    """An EXR whose header claims other windows: name -> (x0, y0, x1, y1)."""

    def make(folder: Path) -> bytes:
        data = bytearray(exr(1.0)(folder))
        for name, box in boxes.items():
            key = name.encode() + b"\0box2i\0\x10\0\0\0"
            place = data.index(key) + len(key)
            struct.pack_into("<4i", data, place, *box)
        return bytes(data)

    return make


def cut(make: Callable[[Path], bytes], keep: float) -> Callable[[Path], bytes]:
    def shorter(folder: Path) -> bytes:
        data = make(folder)
        return data[: int(keep * len(data))]

    return shorter


HUGE = (0, 0, 2**31 - 2, 2**31 - 2)
#: name of the file, its bytes, what the error says
BAD: dict[str, tuple[str, bytes | Callable[[Path], bytes], str]] = {
    "empty hdr": ("e.hdr", b"", "cannot be decoded"),
    "empty exr": ("e.exr", b"", "cannot be decoded"),
    "text": ("e.hdr", b"hello", "cannot be decoded"),
    "unknown kind": ("e.txt", b"hello", "cannot be decoded"),
    "no suffix": ("e", hdr(), "cannot be decoded"),
    "a video": (
        "e.png",
        b"\0\0\0 ftypisom" + bytes(90),
        "wanted one of OpenEXR, PNG, .*; got a video",
    ),
    "a HEIF": ("e.jpg", b"\0\0\0 ftypheic" + bytes(90), "cannot be decoded: .*; got HEIF"),
    "a cut sgi": (
        "e.hdr",
        b"\x01\xda\x01\x01\0\x03" + bytes(600),
        "cannot be decoded: damaged SGI",
    ),
    "a dpx of zeros": ("e.png", b"SDPX" + bytes(4000), "cannot be decoded: damaged DPX"),
    "hdr without a size": ("e.hdr", hdr(size=b""), "cannot be decoded"),
    "hdr 0x0": ("e.hdr", hdr(size=b"-Y 0 +X 0"), "cannot be decoded|image size"),
    "hdr -4x7": ("e.hdr", hdr(size=b"-Y -4 +X 7"), "cannot be decoded|image size"),
    "hdr 2^31": ("e.hdr", hdr(size=b"-Y 2147483647 +X 2147483647"), "image size|cannot be"),
    "hdr 2^40": ("e.hdr", hdr(size=b"-Y 1099511627776 +X 1"), "image size|cannot be"),
    "hdr 16384x16384": (
        "e.hdr",
        hdr(size=b"-Y 16384 +X 16384"),
        "image size: wanted at most|cannot be decoded",
    ),
    "hdr 16384x8192": ("e.hdr", hdr(size=b"-Y 8192 +X 16384"), "truncated|cannot be decoded"),
    "cut hdr": ("e.hdr", hdr(data=40), "cannot be decoded|truncated"),
    "hdr exposure 0": ("e.hdr", hdr(head=b"EXPOSURE=0"), "EXPOSURE: wanted a positive number"),
    "hdr exposure nan": ("e.hdr", hdr(head=b"EXPOSURE=nan"), "EXPOSURE: wanted a positive"),
    "hdr exposure text": ("e.hdr", hdr(head=b"EXPOSURE=bright"), "EXPOSURE: wanted a positive"),
    "hdr exposure 1e-300": ("e.hdr", hdr(head=b"EXPOSURE=1e-300"), "EXPOSURE|finite light"),
    "exr of NaN": ("e.exr", exr(float("nan")), r"pixel \(0, 0\): wanted finite light"),
    "exr of Inf": ("e.exr", exr(float("inf")), r"pixel \(0, 0\): wanted finite light"),
    "exr of -1": ("e.exr", exr(-1), r"pixel \(0, 0\): wanted non-negative light"),
    "exr of 3e38": ("e.exr", exr(3e38), r"pixel \(0, 0\): wanted finite light"),
    "exr of depth": ("e.exr", exr(1, names="ZXA"), r"channels: wanted R, G, B or one grey"),
    "exr cut to a half": ("e.exr", cut(exr(1), 0.5), "header: truncated or too long"),
    "exr cut to nine tenths": ("e.exr", cut(exr(1, 64, 64), 0.9), "cut off or damaged"),
    "exr of a magic": ("e.exr", cut(exr(1), 0.02), "wanted an OpenEXR file"),
    "exr data window 2^31": ("e.exr", windows(dataWindow=HUGE), "dataWindow: wanted corners"),
    "exr display window 2^31": ("e.exr", windows(displayWindow=HUGE), "displayWindow: wanted 1 to"),
    "exr inside out": ("e.exr", windows(dataWindow=(5, 5, 0, 0)), "corners in order"),
    "exr 16384x8192": (
        "e.exr",
        windows(dataWindow=(0, 0, 16383, 8191), displayWindow=(0, 0, 16383, 8191)),
        "512 blocks of pixels: wanted at least 4447 bytes, got",
    ),
}


def _make(name: str, data: bytes | Callable[[Path], bytes]) -> Callable[[Path], Path]:
    def put(path: Path) -> None:
        path.write_bytes(data if isinstance(data, bytes) else data(path.parent))

    return beside_scene(name, put)


ODD: dict[str, tuple[str, Callable[[Path], bytes]]] = {
    "black": ("e.exr", exr(0)),
    "1x1": ("e.exr", exr(1, 1, 1)),
    "denormal": ("e.exr", exr(1e-42)),
    "one row": ("e.exr", exr(1, 1, 500)),
    "one column": ("e.exr", exr(1, 500, 1)),
}
CASES = [
    *(
        Case(f"env-{key}", _make(name, data), error, command=COMMAND)
        for key, (name, data, error) in BAD.items()
    ),
    *(
        Case(f"env-{key}", beside_scene("e.hdr", put), "not a regular file", command=COMMAND)
        for key, put in ENDLESS.items()
    ),
    Case(
        "env-missing",
        beside_scene("none.hdr", lambda _: None),
        "no such file",
        command=COMMAND,
    ),
    *(Case(f"env-{key}", _make(name, data), command=COMMAND) for key, (name, data) in ODD.items()),
]
