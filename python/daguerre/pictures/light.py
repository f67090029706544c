"""Reads light: environments, and textures of light, from files.

Files that state other colours than linear Rec.709 are converted (:mod:`.stated_colors`).
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color import srgb
from daguerre.color.display import into_gamut
from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.files.reading import size_of

from .images import upright
from .radiance import as_rgbe, is_radiance, read_header
from .reading.read import FilePicture, read
from .reading.size import MAX_ENVIRONMENT_BYTES, check_size
from .reading.source import PictureBytes
from .stated_colors import PLAIN, Colors, of_exr

#: Largest colour channel of an environment: the sum of three still fits a float.
MAX_LIGHT = 1e38
#: Rows that are converted at once; share of a pixel's light below which a negative channel is the
#: rounding of half floats.
_STRIPE, _ROUNDING = 64, 2e-3


def read_environment(
    path: str | Path, notes: Notes | None = None, *, is_data: bool = False
) -> NDArray[np.float32]:
    """Reads an equirectangular picture; .hdr and .exr are linear, integer formats sRGB.

    Args:
        path: The file.
        notes: Receives a note if colours are converted (:mod:`.stated_colors`), or mixed with grey
            because they lie outside of Rec.709.
        is_data: Whether the numbers are no colours, as in a point spread, and are not converted.

    Returns:
        Linear RGB, float32, shape (H, W, 3), row 0 at the zenith.

    Raises:
        InputError: The file cannot be read, has no colour, or has NaN, Inf or negative light.
    """
    file = Path(path)
    rgb, colors = read_light(file)
    rgb = checked_light(file, rgb)
    if is_data:
        return rgb
    if notes is not None:
        colors.tell(notes, file.name)
    if colors.is_plain:
        return rgb
    return _in_gamut(colors.light(rgb, in_place=rgb.flags.writeable), notes, file.name)


def read_light(file: Path) -> tuple[NDArray[np.float32], Colors]:
    """Reads a picture of light, upright, with the numbers of the file and their colour encoding.

    Raises:
        InputError: The file cannot be read, or has no colour.
    """
    from .exr.reader import is_exr

    size_of(file)
    if is_exr(file):
        light, turn, colors = _linear(file)
        return upright(light, turn), colors
    header = read_header(file) if is_radiance(file) else None
    with as_rgbe(file, header) if header else nullcontext(file) as source:
        picture = read(PictureBytes(source), str(file), MAX_ENVIRONMENT_BYTES)
    pixels = picture.pixels
    if np.issubdtype(pixels.dtype, np.integer):
        scale = np.float32(np.iinfo(pixels.dtype).max)
        rgb = srgb.to_linear(_rgb(picture, file).astype(np.float32) / scale)
    else:
        rgb = _rgb(picture, file).astype(np.float32)
    if header:
        rgb /= header.gains.astype(np.float32)
    return upright(rgb, picture.orientation), header.colors if header else PLAIN


def _in_gamut(light: NDArray[np.float32], notes: Notes | None, name: str) -> NDArray[np.float32]:
    """Mixes colours outside of Rec.709 with grey of their luminance, as light is not negative."""
    count = 0
    for row in range(0, len(light), _STRIPE):
        part = light[row : row + _STRIPE]
        lowest = part.min(axis=2)
        if (lowest < 0).any():
            count += int((lowest < -_ROUNDING * part.max(axis=2)).sum())
            part = into_gamut(part)
        np.minimum(part, np.float32(MAX_LIGHT), out=light[row : row + _STRIPE])
    if count and notes is not None:
        remark = f"{count} pixels outside of the gamut of Rec.709 are mixed with grey"
        notes.add(f"{remark} of their luminance", name=name)
    return light


def checked_light(file: Path, rgb: NDArray[np.float32]) -> NDArray[np.float32]:
    """Checks that light is finite and not negative in all pixels."""
    for name, bad in (("finite", ~(np.abs(rgb) <= MAX_LIGHT)), ("non-negative", rgb < 0)):
        count = int(bad.any(axis=2).sum())
        if count:
            y, x = np.argwhere(bad.any(axis=2))[0]
            raise InputError(
                f"{file}: pixel ({x}, {y}): wanted {name} light, got {rgb[y, x].tolist()} "
                f"({count} such pixels)"
            )
    return np.ascontiguousarray(rgb)


def _rgb(picture: FilePicture, file: Path) -> NDArray[Any]:
    """Selects the colour channels: R, G, B in any position, or a single grey channel."""
    pixels = picture.pixels
    names = [name.rsplit(".", 1)[-1].upper() for name in picture.names]
    if all(name in names for name in "RGB"):
        return pixels[:, :, [names.index(name) for name in "RGB"]]
    if names[:1] in (["Y"], ["I"], ["L"]) or len(names) == 1:
        return np.repeat(pixels[:, :, :1], 3, axis=2)
    raise InputError(f"{file}: channels: wanted R, G, B or one grey, got {', '.join(names[:8])}")


def _white_luminance(facts: Mapping[str, Any]) -> list[str]:
    """Note on a luminance of (1, 1, 1) that the file states: the scene sets it."""
    value = facts.get("whiteLuminance")
    if not isinstance(value, float) or not 0 < value < MAX_LIGHT or value == 1:
        return []
    return [f"whiteLuminance says that 1 is {value:g} cd/m2, which the scale of the scene sets"]


def _linear(file: Path) -> tuple[NDArray[np.float32], int, Colors]:
    """Reads an EXR's display window, 0 outside its data window, its orientation and colours."""
    from .exr.reader import ExrReader, light_names

    with ExrReader(file) as reader:
        names = light_names(list(reader.channels), str(file))
        colors = of_exr(reader.facts, tuple(names))
        remarks = _white_luminance(reader.facts)
        colors = replace(colors, remarks=(*colors.remarks, *remarks))
        full = (reader.full_size[1], reader.full_size[0])
        most = MAX_ENVIRONMENT_BYTES
        check_size(reader.width, reader.height, 3, 4, str(file), most)
        check_size(full[1], full[0], 3, 4, f"{file}: display window", most)
        planes = reader.rows(0, reader.height, names)
        x, y = (a - b for a, b in zip(reader.corner, reader.full_corner, strict=True))
        turn = reader.facts.get("Orientation", 1)
    rgb = np.zeros((*full, 3), np.float32)
    x0, y0 = max(x, 0), max(y, 0)
    x1, y1 = min(x + reader.width, full[1]), min(y + reader.height, full[0])
    if x1 > x0 and y1 > y0:
        for i, name in enumerate(names):
            rgb[y0:y1, x0:x1, i] = planes[name][y0 - y : y1 - y, x0 - x : x1 - x]
    return rgb, turn if isinstance(turn, int) else 1, colors
