"""Layout of the parts of an OpenEXR file, checked before any pixel is unpacked.

A :class:`Layout` has the size and channels of a part and the places of its chunks. This module
checks headers against the format and the length of the file, so that libraries get only checked
values.

Sources: "OpenEXR File Layout", https://openexr.com/en/latest/OpenEXRFileLayout.html; rows of
a chunk: "OpenEXR Technical Introduction", "Data Compression".
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path

from daguerre.cached import cached_property
from daguerre.errors import InputError
from daguerre.files.json_item import short

from .header import DEEP, MULTIPART, PIXEL_TYPES, TILED, ExrHeader, ExrHeaders, read_headers

#: Name of each compression and rows of its chunks; the index is its number.
COMPRESSIONS = (
    ("NONE", 1), ("RLE", 1), ("ZIPS", 1), ("ZIP", 16), ("PIZ", 32), ("PXR24", 16), ("B44", 32),
    ("B44A", 32), ("DWAA", 32), ("DWAB", 256), ("HTJ2K256", 256), ("HTJ2K32", 32),
)  # fmt: skip
NONE, ZIPS, ZIP = 0, 2, 3
#: Limit of coordinates of windows, as in the library: their differences fit 32 bits.
MAX_PLACE = 1 << 30
BYTES = dict(zip(PIXEL_TYPES, (4, 2, 4), strict=True))


@dataclass(frozen=True)
class Layout:
    """A part of flat pixels, checked against the file.

    Attributes:
        path: The file.
        header: The part's header.
        index: Number of the part.
        channels: Numpy type names by channel, in the order of the file.
        compression: Index in :data:`COMPRESSIONS`.
        box: Data window: first column and row, last column and row, px.
        tile: Width and height of tiles, px; None: scanlines.
        table: Position of its list of chunks in the file, bytes.
        data: Position of the first byte after all lists of chunks.
    """

    path: Path
    header: ExrHeader
    index: int
    channels: dict[str, str]
    compression: int
    box: tuple[int, int, int, int]
    tile: tuple[int, int] | None
    table: int
    data: int

    @property
    def width(self) -> int:
        """Columns, px."""
        return self.box[2] - self.box[0] + 1

    @property
    def height(self) -> int:
        """Rows, px."""
        return self.box[3] - self.box[1] + 1

    @property
    def name(self) -> str:
        """Name of the part; empty if it has none."""
        kind, data = self.header.attributes.get("name", ("", b""))
        return data.decode("utf-8", "replace") if kind == "string" else ""

    @property
    def multipart(self) -> bool:
        """Whether chunks begin with the number of their part."""
        return bool(self.header.flags & MULTIPART)

    @cached_property
    def pixel(self) -> int:
        """Bytes of a pixel."""
        return sum(BYTES[dtype] for dtype in self.channels.values())

    @property
    def size(self) -> int:
        """Bytes of all pixels."""
        return self.width * self.height * self.pixel

    @property
    def step(self) -> int:
        """Rows in a chunk."""
        return self.tile[1] if self.tile else COMPRESSIONS[self.compression][1]

    @property
    def steps(self) -> int:
        """Number of chunks from top to bottom."""
        return -(-self.height // self.step)

    @property
    def across(self) -> int:
        """Number of chunks from left to right."""
        return -(-self.width // self.tile[0]) if self.tile else 1


def read_layouts(path: Path, wanted: int | None = None) -> list[Layout]:
    """Reads and checks the layouts of the parts of a file.

    Args:
        path: The file.
        wanted: Number of the only part to check; other parts may be of any kind. None: all parts.

    Raises:
        InputError: The file is not OpenEXR; or a checked part is deep, subsampled, damaged,
            larger than its file can hold, or of an unknown kind.
    """
    headers = read_headers(path)
    counts = [_chunk_count(path, header) for header in headers.parts]
    if headers.end + 8 * sum(counts) > headers.size:
        raise InputError(
            f"{path}: {sum(counts)} blocks of pixels: wanted at least "
            f"{headers.end + 8 * sum(counts)} bytes, got {headers.size}: "
            "the file is cut off or damaged"
        )
    ends = [headers.end + 8 * sum(counts[: i + 1]) for i in range(len(counts))]
    found = range(len(counts)) if wanted is None else (wanted,)
    return [_layout(path, headers, i, ends[i] - 8 * counts[i], ends[-1]) for i in found]


def _layout(path: Path, headers: ExrHeaders, index: int, table: int, data: int) -> Layout:
    header = headers.parts[index]
    if _is_deep(header):
        raise InputError(f"{path}: format: deep pixels are not supported")
    return Layout(
        path, header, index, _channels(path, header), _compression(path, header),
        _box(path, header), _tile(path, header), table, data,
    )  # fmt: skip


def _value(path: Path, header: ExrHeader, name: str, kind: str, size: int | None) -> bytes:
    """Bytes of a required attribute, checked for type and size."""
    found, data = header.attributes.get(name, ("", b""))
    if found != kind or (size is not None and len(data) != size):
        got = f"{short(found)} of {len(data)} bytes" if found else "none"
        raise InputError(f"{path}: header: {name}: wanted a {kind}, got {got}")
    return data


def _kind(header: ExrHeader) -> str:
    """Type of a part: scanlineimage, tiledimage, deepscanline, deeptile."""
    if not header.flags & MULTIPART:  # single parts have it in the flags
        deep = "deeptile" if header.flags & TILED else "deepscanline"
        flat = "tiledimage" if header.flags & TILED else "scanlineimage"
        return deep if header.flags & DEEP else flat
    kind, data = header.attributes.get("type", ("", b""))
    return data.rstrip(b"\0").decode("utf-8", "replace") if kind == "string" else ""


def _is_deep(header: ExrHeader) -> bool:
    return _kind(header).startswith("deep")


def _compression(path: Path, header: ExrHeader) -> int:
    number = int(_value(path, header, "compression", "compression", 1)[0])
    if number >= len(COMPRESSIONS):
        raise InputError(
            f"{path}: compression: wanted one of {', '.join(name for name, _ in COMPRESSIONS)}, "
            f"got number {number}"
        )
    return number


def _box(path: Path, header: ExrHeader) -> tuple[int, int, int, int]:
    x0, y0, x1, y1 = struct.unpack("<4i", _value(path, header, "dataWindow", "box2i", 16))
    if min(x1 - x0, y1 - y0) < 0 or max(map(abs, (x0, y0, x1, y1))) >= MAX_PLACE:
        raise InputError(
            f"{path}: dataWindow: wanted corners in order, within {MAX_PLACE} px, "
            f"got ({x0}, {y0}) to ({x1}, {y1})"
        )
    return x0, y0, x1, y1


def _channels(path: Path, header: ExrHeader) -> dict[str, str]:
    _value(path, header, "channels", "chlist", None)
    try:
        channels = header.channels
    except (ValueError, IndexError, struct.error) as error:
        raise InputError(f"{path}: channels: damaged list of channels") from (error)
    if not channels:
        raise InputError(f"{path}: channels: none")
    found: dict[str, str] = {}
    for channel in channels:
        if any("\ud800" <= letter <= "\udfff" for letter in channel.name):
            raise InputError(
                f"{path}: channels: wanted names in UTF-8, got {ascii(channel.name)[:80]}"
            )
        if channel.subsampled:
            raise InputError(
                f"{path}: channel {short(channel.name)}: subsampled channels are not supported"
            )
        if channel.name in found:
            raise InputError(f"{path}: channel {short(channel.name)} appears twice")
        found[channel.name] = channel.dtype
    return found


def _tile(path: Path, header: ExrHeader) -> tuple[int, int] | None:
    """Width and height of tiles; None: scanlines."""
    kind = _kind(header)
    if kind == "scanlineimage":
        return None
    if kind != "tiledimage":
        raise InputError(f"{path}: type: wanted scanlineimage or tiledimage, got {short(kind)}")
    width, height, _ = _tiles(path, header)
    return width, height


def _tiles(path: Path, header: ExrHeader) -> tuple[int, int, int]:
    """Width and height of tiles, and the mode of their levels."""
    width, height, mode = struct.unpack("<2IB", _value(path, header, "tiles", "tiledesc", 9))
    if not (0 < width < MAX_PLACE and 0 < height < MAX_PLACE and mode & 15 < 3 and mode >> 4 < 2):
        raise InputError(
            f"{path}: tiles: wanted a size and a mode of levels, got {width} x {height}, {mode}"
        )
    return width, height, mode


def _chunk_count(path: Path, header: ExrHeader) -> int:
    """Number of chunks of a part, in all its levels.

    The count of deep parts, which are not read, is not checked, but the places after them are.
    """
    kind, data = header.attributes.get("chunkCount", ("", b""))
    stated: int | None = struct.unpack("<i", data)[0] if kind == "int" and len(data) == 4 else None
    if _is_deep(header):
        if stated is None or stated < 1:
            raise InputError(f"{path}: format: deep pixels are not supported")
        return stated
    x0, y0, x1, y1 = _box(path, header)
    width, height = x1 - x0 + 1, y1 - y0 + 1
    if _tile(path, header) is None:
        rows = COMPRESSIONS[_compression(path, header)][1]
        count = -(-height // rows)
    else:
        count = _tile_count((width, height), *_tiles(path, header))
    if header.flags & MULTIPART and stated != count:
        raise InputError(f"{path}: chunkCount: wanted {count}, got {stated}")
    return count


def _tile_count(size: tuple[int, int], width: int, height: int, mode: int) -> int:
    across = [-(-n // width) for n in _level_sizes(size[0], mode >> 4)]
    down = [-(-n // height) for n in _level_sizes(size[1], mode >> 4)]
    if mode & 15 == 0:
        return across[0] * down[0]
    if mode & 15 == 2:  # rip-map: every width with every height
        return sum(across) * sum(down)
    levels = max(len(across), len(down))  # mip-map: the shorter side stays at one pixel
    across += [1] * (levels - len(across))
    down += [1] * (levels - len(down))
    return sum(a * b for a, b in zip(across, down, strict=True))


def _level_sizes(size: int, up: int) -> list[int]:
    """Sizes of the levels along one side; each is half of the previous, rounded down or up."""
    found, level = [size], 0
    while found[-1] > 1:
        level += 1
        found.append(-(-size // (1 << level)) if up else size >> level)
    return found
