"""Writes EXIF blocks like a camera: short fractions such as 1/125, names of lens and body.

The block is a small TIFF file: a main directory, whose tag 34665 points to the EXIF directory.
JPEG (APP1) and PNG (eXIf) embed the block unchanged; TIFF and DNG have the same tags in their
directories. Tags, types and units: Exif 3.0 (CIPA DC-008-2023), 4.6.
"""

from __future__ import annotations

import math
import os
import struct
import time
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

BYTE, ASCII, SHORT, LONG, RATIONAL, UNDEFINED, SRATIONAL, DOUBLE = 1, 2, 3, 4, 5, 7, 10, 12
#: Type and values by tag; texts are str, other values tuples.
Tags = dict[int, tuple[int, Any]]

EXIF_DIRECTORY = 34665
#: 35 mm equivalents are computed from diagonals, whatever the aspect ratio.
FULL_FRAME_DIAGONAL_MM = math.hypot(36, 24)
_FORMATS = {BYTE: "B", SHORT: "H", LONG: "I", RATIONAL: "2I", UNDEFINED: "B", SRATIONAL: "2i"}
_LIMIT = 2**31 - 1


def rational(value: float) -> tuple[int, int]:
    """Simplest fraction within one millionth of a value: 0.008 is 1/125, also from a float32."""
    for denominator in (10**power for power in range(1, 8)):
        fraction = Fraction(value).limit_denominator(denominator)
        if abs(fraction - Fraction(value)) <= abs(Fraction(value)) / 10**6:
            break
    if abs(fraction.numerator) > _LIMIT:
        return (_LIMIT if value > 0 else -_LIMIT, 1)
    return fraction.numerator, fraction.denominator


def main_tags(metadata: Mapping[str, Any]) -> Tags:
    """Tags of the main directory: camera, software, date and orientation."""
    texts = {
        271: metadata.get("cameraMake"),
        272: metadata.get("cameraModel"),
        305: f"daguerre {metadata.get('version', '')}".strip(),
        306: date(metadata),
    }
    tags: Tags = {number: (ASCII, str(text)) for number, text in texts.items() if text}
    tags[274] = (SHORT, (1,))  # upright
    return tags


def exposure_tags(metadata: Mapping[str, Any]) -> Tags:
    """Tags of the EXIF directory for facts in ``metadata``, which has OpenEXR's names."""
    tags: Tags = {36864: (UNDEFINED, tuple(b"0232"))}
    tags |= {at: (RATIONAL, value) for at, value in rationals(metadata).items()}
    if iso := _number(metadata, "isoSpeed"):
        tags[34855] = (SHORT, (min(round(iso), 65535),))
        tags[34864] = (SHORT, (1,))  # standard output sensitivity, ISO 12232
        tags[34865] = (LONG, (round(iso),))
    if metadata.get("exposure_compensation") is not None:
        tags[37380] = (SRATIONAL, rational(float(metadata["exposure_compensation"])))
    tags |= _lens_tags(metadata)
    tags[36867] = tags[36868] = (ASCII, date(metadata))
    return dict(sorted(tags.items()))


def _lens_tags(metadata: Mapping[str, Any]) -> Tags:
    names = {42035: metadata.get("lensMake"), 42036: metadata.get("lensModel")}
    tags: Tags = {number: (ASCII, str(name)) for number, name in names.items() if name}
    focal, size = _number(metadata, "nominalFocalLength"), metadata.get("sensorOverallDimensions")
    if focal and size is not None and len(size) == 2 and min(size) > 0:
        scale = FULL_FRAME_DIAGONAL_MM / math.hypot(*map(float, size))
        tags[41989] = (SHORT, (min(round(focal * scale), 65535),))
    if span := _focal_lengths(metadata.get("camera")):
        shortest, longest = (rational(round(focal, 1)) for focal in span)
        # 0/0: the widest f-numbers are unknown, as a prescription has only the f-number in use.
        tags[42034] = (RATIONAL, (*shortest, *longest, 0, 0, 0, 0))
    return tags


def _focal_lengths(camera: object) -> tuple[float, float] | None:
    """Shortest and longest focal length of a lens with a prescription, mm; None: no such lens."""
    if not isinstance(camera, Mapping) or not camera.get("lens_sha256"):
        return None
    if zoom := camera.get("zoom_range_mm"):
        return float(zoom[0]), float(zoom[1])
    focal = _number(camera, "focal_length_mm")
    return None if focal is None else (focal, focal)


def block(metadata: Mapping[str, Any], size: tuple[int, int], srgb: bool) -> bytes:
    """Makes a complete EXIF block.

    Args:
        metadata: Metadata of the frame.
        size: Width and height of the picture, px.
        srgb: Whether colours are sRGB; the standard has no code for other spaces.
    """
    main, exposure = main_tags(metadata), exposure_tags(metadata)
    exposure |= {40961: (SHORT, (1 if srgb else 65535,))}
    exposure |= {40962: (LONG, (size[0],)), 40963: (LONG, (size[1],))}
    main[EXIF_DIRECTORY] = (LONG, (0,))
    start = 8 + len(directory(main, 8))
    main[EXIF_DIRECTORY] = (LONG, (start,))
    return struct.pack("<2sHI", b"II", 42, 8) + directory(main, 8) + directory(exposure, start)


def directory(tags: Tags, offset: int) -> bytes:
    """Makes a little-endian image file directory (TIFF 6.0, section 2) with its values.

    Args:
        tags: Type and values by tag number.
        offset: Position of the directory in the file, bytes; even.
    """
    entries, values = b"", b""
    after = offset + 2 + 12 * len(tags) + 4
    for number, (kind, value) in sorted(tags.items()):
        data, count = _packed(kind, value)
        if len(data) > 4:
            place, data = struct.pack("<I", after + len(values)), data + b"\0" * (len(data) % 2)
            values, data = values + data, place
        entries += struct.pack("<HHI", number, kind, count) + data.ljust(4, b"\0")
    return struct.pack("<H", len(tags)) + entries + struct.pack("<I", 0) + values


def with_rationals(block: bytes, values: Mapping[int, tuple[int, int]]) -> bytes:
    """Replaces fractions of existing tags in an EXIF block.

    This undoes OpenImageIO's 20833/1000000 for 1/48 s.
    """
    data = bytearray(block)
    order = "<" if data[:2] == b"II" else ">"
    directories = [struct.unpack_from(f"{order}I", data, 4)[0]]
    for at in directories:
        (count,) = struct.unpack_from(f"{order}H", data, at)
        for entry in range(at + 2, at + 2 + 12 * count, 12):
            number, kind, _, place = struct.unpack_from(f"{order}HHII", data, entry)
            if number == EXIF_DIRECTORY:
                directories.append(place)
            elif number in values and kind == RATIONAL:
                struct.pack_into(f"{order}2I", data, place, *values[number])
    return bytes(data)


def rationals(metadata: Mapping[str, Any]) -> dict[int, tuple[int, int]]:
    """Known exposure time, f-number, focus distance and focal length as fractions, by tag."""
    names = {33434: "expTime", 33437: "aperture", 37382: "focus", 37386: "nominalFocalLength"}
    known = {at: _number(metadata, name) for at, name in names.items()}
    return {at: rational(value) for at, value in known.items() if value}


def date(metadata: Mapping[str, Any]) -> str:
    """Date and time of capture: ``capDate``, else SOURCE_DATE_EPOCH (UTC), else the local time.

    With this variable of reproducible-builds.org, equal pictures give equal files.
    """
    if metadata.get("capDate"):
        return str(metadata["capDate"])
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    at = time.gmtime(int(epoch)) if epoch.isdigit() else time.localtime()
    return time.strftime("%Y:%m:%d %H:%M:%S", at)


def _packed(kind: int, value: Any) -> tuple[bytes, int]:
    if kind == ASCII:
        data = value.encode("utf-8") + b"\0"
        return data, len(data)
    each = _FORMATS[kind]
    parts = len(each.lstrip("<")) if each[0] != "2" else 2
    count = len(value) // parts
    return struct.pack(f"<{len(value)}{each[-1]}", *value), count


def _number(metadata: Mapping[str, Any], name: str) -> float | None:
    """Number in the metadata; None if missing, or not positive and finite, as EXIF needs."""
    value = metadata.get(name)
    if value is None or not math.isfinite(float(value)) or float(value) <= 0:
        return None
    return float(value)
