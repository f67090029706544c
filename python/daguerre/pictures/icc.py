"""Makes ICC profiles of the colour spaces that Daguerre writes: three primaries and a curve.

They are matrix profiles of version 4 (ICC.1:2022): primaries adapted to D50 by Bradford's matrix,
and parametric curve 3, which is exact for the transfer functions of sRGB and ITU-R BT.2020.
"""

from __future__ import annotations

import struct
from functools import cache

import numpy as np
from numpy.typing import NDArray

from daguerre.color.adaptation import adaptation_of_xyz
from daguerre.color.illuminants import D65_STATED, xyz_of_xy
from daguerre.color.spaces import COLOR_SPACES, xyz_from_rgb

FloatArray = NDArray[np.float64]
#: White of the profile connection space, XYZ, with the digits of ICC.1.
D50_XYZ = (0.9642, 1.0, 0.8249)


@cache
def profile(name: str) -> bytes:
    """Makes the profile of a colour space of ``COLOR_SPACES``."""
    space = COLOR_SPACES[name]
    to_d50 = adaptation_of_xyz(xyz_of_xy(D65_STATED), np.array(D50_XYZ))
    columns = (to_d50 @ xyz_from_rgb(space)).T
    if space.curve is None:
        raise ValueError(f"{name} has no curve")
    curve = struct.pack(">4s4xH2x", b"para", 3) + _fixed(space.curve)
    tags = {
        b"desc": _text(space.title),
        b"cprt": _text("No copyright, use freely"),
        b"wtpt": _xyz(D50_XYZ),
        b"chad": struct.pack(">4s4x", b"sf32") + _fixed(to_d50.ravel()),
        **{b"rgb"[k : k + 1] + b"XYZ": _xyz(columns[k]) for k in range(3)},
        **dict.fromkeys((b"rTRC", b"gTRC", b"bTRC"), curve),
    }
    return _file(tags)


def _file(tags: dict[bytes, bytes]) -> bytes:
    """Joins header, tag table and data; equal data are stored once (ICC.1:2022, 7)."""
    table, data, places = struct.pack(">I", len(tags)), b"", {}
    start = 128 + 4 + 12 * len(tags)
    for tag, value in tags.items():
        if value not in places:
            places[value] = start + len(data)
            data += value + b"\0" * (-len(value) % 4)
        table += struct.pack(">4sII", tag, places[value], len(value))
    size = start + len(data)
    header = struct.pack(">I4x4B4s4s4s", size, 4, 0x40, 0, 0, b"mntr", b"RGB ", b"XYZ ")
    header += struct.pack(">6H4s", 2026, 1, 1, 0, 0, 0, b"acsp") + bytes(28) + _fixed(D50_XYZ)
    return header.ljust(128, b"\0") + table + data


def _xyz(values: tuple[float, ...] | FloatArray) -> bytes:
    return struct.pack(">4s4x", b"XYZ ") + _fixed(values)


def _text(text: str) -> bytes:
    data = text.encode("utf-16-be")
    return struct.pack(">4s4xII2s2sII", b"mluc", 1, 12, b"en", b"US", len(data), 28) + data


def _fixed(values: tuple[float, ...] | FloatArray) -> bytes:
    """Encodes s15Fixed16 numbers."""
    return b"".join(struct.pack(">i", round(float(value) * 65536)) for value in values)
