"""Photographs with EXIF and XMP of any content, written byte by byte."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

EXIF_DIRECTORY, MAKER_NOTE = 34665, 37500
SHORT, LONG, RATIONAL, SRATIONAL = 3, 4, 5, 10
#: Tags of one directory: type and numbers, or a text.
Tags = Mapping[int, tuple[int, tuple[int, ...]] | str | bytes]

#: A usual shot: f/8, 1/200 s, ISO 200, 50 mm.
SHOT: Tags = {
    33434: (RATIONAL, (1, 200)),
    33437: (RATIONAL, (8, 1)),
    34855: (SHORT, (200,)),
    37386: (RATIONAL, (50, 1)),
    41989: (SHORT, (75,)),
    42036: "own 50mm",
}
#: Other numbers under the same tags, as maker notes and thumbnails have them.
OTHER: Tags = {
    274: (SHORT, (8,)),
    33434: (RATIONAL, (78, 1)),
    33437: (RATIONAL, (224, 1)),
    34855: (SHORT, (12800,)),
}


def _directory(tags: Tags, at: int, order: str, following: int = 0) -> bytes:
    entries, values = b"", b""
    end = at + 2 + 12 * len(tags) + 4
    for tag, value in sorted(tags.items()):
        if isinstance(value, str | bytes):
            data = value.encode() + b"\0" if isinstance(value, str) else value
            kind, count = (2 if isinstance(value, str) else 7), len(data)
        else:
            kind, numbers = value
            form = {SHORT: "H", LONG: "I", RATIONAL: "I", SRATIONAL: "i"}[kind]
            data = struct.pack(f"{order}{len(numbers)}{form}", *numbers)
            count = len(numbers) // (2 if kind in (RATIONAL, SRATIONAL) else 1)
        if len(data) > 4:
            place = struct.pack(f"{order}I", end + len(values))
            values += data + b"\0" * (len(data) % 2)
            data = place
        entries += struct.pack(f"{order}HHI", tag, kind, count) + data.ljust(4, b"\0")
    head = struct.pack(f"{order}H", len(tags))
    return head + entries + struct.pack(f"{order}I", following) + values


def block(shot: Tags, main: Tags | None = None, order: str = "<") -> bytes:
    """An EXIF block with a maker note and a thumbnail's directory that say other things."""
    main = {271: "Own", 272: "One", 274: (SHORT, (1,)), **(main or {})}
    shot = {**shot, MAKER_NOTE: _directory(OTHER, 0, order)}
    main = {**main, EXIF_DIRECTORY: (LONG, (0,))}
    start = 8 + len(_directory(main, 8, order))
    main = {**main, EXIF_DIRECTORY: (LONG, (start,))}
    exif = _directory(shot, start, order)
    whole = _directory(main, 8, order, start + len(exif)) + exif
    whole += _directory(OTHER, start + len(exif), order)
    return struct.pack(f"{order}2sHI", b"II" if order == "<" else b"MM", 42, 8) + whole


def xmp(**properties: Any) -> bytes:
    """An XMP packet: attributes and elements by turns; ISO as a list."""
    spaces = (
        'xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" '
        'xmlns:tiff="http://ns.adobe.com/tiff/1.0/" xmlns:exif="http://ns.adobe.com/exif/1.0/"'
    )
    attributes, elements = "", ""
    for i, (name, value) in enumerate(properties.items()):
        space = "tiff" if name in ("Orientation", "Make") else "exif"
        if name == "ISOSpeedRatings":
            value = f"<rdf:Seq><rdf:li>{value}</rdf:li></rdf:Seq>"
        if i % 2 or name == "ISOSpeedRatings":
            elements += f"<{space}:{name}>{value}</{space}:{name}>"
        else:
            attributes += f' {space}:{name}="{value}"'
    about = f'<rdf:Description rdf:about=""{attributes}>{elements}</rdf:Description>'
    graph = f"<rdf:RDF {spaces}>{about}</rdf:RDF>"
    return f'<x:xmpmeta xmlns:x="adobe:ns:meta/">{graph}</x:xmpmeta>'.encode()


def photograph(path: Path, exif: bytes = b"", packet: bytes = b"") -> Path:
    """Writes a small grey JPEG, PNG, WebP or TIFF with these blocks."""
    picture = Image.fromarray(np.full((24, 32, 3), 120, np.uint8))
    if path.suffix == ".tif":
        path.write_bytes(_tiff(exif))
        return path
    more: dict[str, Any] = {"exif": b"Exif\0\0" + exif} if exif else {}
    if path.suffix == ".png":
        from PIL.PngImagePlugin import PngInfo

        info = PngInfo()
        if packet:
            info.add_itxt("XML:com.adobe.xmp", packet.decode())
        picture.save(path, pnginfo=info, **more)
    else:
        picture.save(path, **more, **({"xmp": packet} if packet else {}))
    return path


def _tiff(exif: bytes) -> bytes:
    """A TIFF file: the EXIF block's own directory with the tags of a picture."""
    order = "<" if exif[:2] == b"II" else ">"
    (count,) = struct.unpack_from(f"{order}H", exif, 8)
    old = exif[10 : 10 + 12 * count]
    end = len(exif) + len(exif) % 2
    pixels = 24 * 32 * 3
    picture: Tags = {
        256: (SHORT, (32,)), 257: (SHORT, (24,)), 258: (SHORT, (8, 8, 8)), 259: (SHORT, (1,)),
        262: (SHORT, (2,)), 273: (LONG, (end,)), 277: (SHORT, (3,)), 278: (SHORT, (24,)),
        279: (LONG, (pixels,)),
    }  # fmt: skip
    at = end + pixels
    made = _directory(picture, at, order)
    each = [made[2 + 12 * i : 14 + 12 * i] for i in range(len(picture))]
    each += [old[12 * i : 12 * i + 12] for i in range(count)]
    shift = 12 * count  # the entries of the EXIF block push the values of the new ones
    fixed = []
    for entry in each:
        tag, kind, length = struct.unpack_from(f"{order}HHI", entry)
        if tag == 258:
            (place,) = struct.unpack_from(f"{order}I", entry, 8)
            entry = struct.pack(f"{order}HHII", tag, kind, length, place + shift)
        fixed.append((tag, entry))
    body = b"".join(entry for _, entry in sorted(fixed))
    values = made[2 + 12 * len(picture) + 4 :]
    directory = struct.pack(f"{order}H", len(fixed)) + body + b"\0" * 4 + values
    head = exif[:4] + struct.pack(f"{order}I", at)
    return head + exif[8:].ljust(end - 8, b"\0") + b"\x78" * pixels + directory
