"""Writes whole pictures as OpenEXR, in one part or several."""

from __future__ import annotations

import os
import struct
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .header import PIXEL_TYPES, ExrChannel, channel_list, header_bytes
from .layout import COMPRESSIONS, ZIP
from .rows import packed

#: Blocks that are packed before the first of them is written.
AT_ONCE = 64
_USUAL: dict[str, Any] = {
    "compression": ZIP,
    "pixelAspectRatio": 1.0,
    "screenWindowCenter": np.zeros(2, np.float32),
    "screenWindowWidth": 1.0,
}
#: Types of arrays, by the number of their values.
_ARRAYS = {2: "v2f", 3: "v3f", 8: "chromaticities", 9: "m33f", 16: "m44f"}


@dataclass(frozen=True)
class WholePart:
    """A part of a file.

    Attributes:
        name: Name of the part.
        values: Attributes by name: numbers, texts, fractions, arrays, and boxes as two corners.
        planes: Channels by name, shape (H, W).
    """

    name: str
    values: Mapping[str, Any]
    planes: Mapping[str, NDArray[Any]]

    @property
    def compression(self) -> int:
        """Compression, as an index in ``COMPRESSIONS``."""
        return int(self.values.get("compression", ZIP))

    @property
    def starts(self) -> range:
        """First row of each block."""
        height = len(next(iter(self.planes.values())))
        return range(0, height, COMPRESSIONS[self.compression][1])

    @property
    def channels(self) -> list[ExrChannel]:
        """Channels in the order of the file, which sorts names by their bytes."""
        names = sorted(self.planes, key=str.encode)
        return [ExrChannel(name, self.planes[name].dtype.name) for name in names]

    def attributes(self, *, several: bool) -> dict[str, tuple[str, bytes]]:
        """Type and bytes of all attributes; ``several``: the file has other parts."""
        own: dict[str, Any] = {"name": self.name, "type": "scanlineimage"}
        if several:
            own["chunkCount"] = len(self.starts)
        found = {
            name: _typed(name, value) for name, value in {**_USUAL, **self.values, **own}.items()
        }
        found["channels"] = ("chlist", channel_list(self.channels))
        found["lineOrder"] = ("lineOrder", b"\0")
        return found

    def blocks(self, pool: ThreadPoolExecutor) -> Iterator[tuple[int, bytes]]:
        """First row and bytes of each block."""
        channels, starts = self.channels, self.starts

        def block(start: int) -> bytes:
            rows = {name: plane[start : start + starts.step] for name, plane in self.planes.items()}
            return packed(rows, channels, self.compression)

        for k in range(0, len(starts), AT_ONCE):
            some = starts[k : k + AT_ONCE]
            yield from zip(some, pool.map(block, some), strict=True)


def write_whole(path: Path, parts: list[WholePart]) -> None:
    """Writes the parts of a file.

    Raises:
        OSError: The file cannot be written.
    """
    several = len(parts) > 1
    offsets: list[int] = []
    count = sum(len(part.starts) for part in parts)
    with path.open("wb") as stream, ThreadPoolExecutor(min(os.cpu_count() or 1, 8)) as pool:
        stream.write(header_bytes([part.attributes(several=several) for part in parts]))
        table = stream.tell()
        stream.write(bytes(8 * count))
        for number, part in enumerate(parts):
            top = int(part.values["dataWindow"][0][1])
            for start, data in part.blocks(pool):
                offsets.append(stream.tell())
                stream.write(struct.pack("<i", number) if several else b"")
                stream.write(struct.pack("<ii", top + start, len(data)))
                stream.write(data)
        stream.seek(table)
        stream.write(struct.pack(f"<{count}Q", *offsets))


def planes_of(channels: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Planes (H, W) by name; three in one array (H, W, 3) become NAME.R, NAME.G and NAME.B."""
    found: dict[str, NDArray[Any]] = {}
    for name, values in channels.items():
        if values.ndim == 2:
            found[name] = values
        else:
            layer = "" if name in ("RGB", "RGBA") else f"{name}."
            colors = "RGBA"[: values.shape[2]]
            found |= {f"{layer}{color}": values[..., i] for i, color in enumerate(colors)}
    assert all(plane.dtype.name in PIXEL_TYPES for plane in found.values())
    return found


def _typed(name: str, value: Any) -> tuple[str, bytes]:
    """Type and bytes of an attribute."""
    if name == "compression":
        return name, struct.pack("<B", value)
    if isinstance(value, str):
        return "string", value.encode("utf-8", "surrogateescape")
    if isinstance(value, Fraction):
        return "rational", struct.pack("<iI", value.numerator, value.denominator)
    if isinstance(value, int | np.integer):
        return "int", struct.pack("<i", value)
    if isinstance(value, float | np.floating):
        return "float", struct.pack("<f", value)
    if isinstance(value, tuple) and isinstance(value[0], np.ndarray):
        return "box2i", struct.pack("<4i", *value[0], *value[1])
    numbers = np.asarray(value, "<f4").reshape(-1)
    return _ARRAYS[len(numbers)], numbers.tobytes()
