"""Photographs of a probe: numbers on a scale that ends at saturation, and how they were exposed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color import illuminants
from daguerre.color.adaptation import adaptation
from daguerre.color.spectra import rgb_from_xyz
from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.io.images import read_environment
from daguerre.plates.display_file import read_display
from daguerre.plates.files import DISPLAY
from daguerre.plates.shot_facts import shot_facts

White = float | tuple[float, float] | None
LINEAR = (".exr", ".hdr")
#: Share of full scale from which on a channel counts as clipped: demosaicing and JPEG smear.
CLIPPED = 0.98
#: Pixels that share the highest value of linear light from which on it counts as a ceiling.
_SHARED = 3


@dataclass(frozen=True)
class Shot:
    """One photograph.

    Attributes:
        path: Its file.
        numbers: Upright, shape (H, W, 3): uint8 or uint16 coded by a curve, float32 linear.
        full: Where each channel of ``numbers`` saturates, shape (3,); infinite: never.
        rgb: Linear Rec.709 of linear numbers, shape (3, 3); None: they are that, or coded.
        facts: Facts of the shot by the names of OpenEXR, as far as known.
    """

    path: Path
    numbers: NDArray[Any]
    full: NDArray[np.float64]
    rgb: NDArray[np.float64] | None
    facts: dict[str, Any]

    @property
    def coded(self) -> bool:
        """Whether a curve stands between light and numbers."""
        return bool(np.issubdtype(self.numbers.dtype, np.integer))

    @property
    def metered(self) -> bool:
        """Whether a value of 1 is white by ISO 12232, and no luminance already."""
        return self.path.suffix.lower() not in LINEAR

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, px."""
        return self.numbers.shape[1], self.numbers.shape[0]

    @property
    def focal_px(self) -> float | None:
        """Focal length by that of the lens and the size of the sensor, px."""
        focal = self.facts.get("nominalFocalLength")
        sensor = self.facts.get("sensorOverallDimensions")
        if focal is None or sensor is None:
            return None
        return float(focal / math.hypot(*sensor) * math.hypot(*self.size))

    @property
    def top(self) -> NDArray[np.float32]:
        """The fullest channel of each pixel as a share of saturation, shape (H, W)."""
        if not np.isfinite(self.full).all():
            return np.zeros(self.numbers.shape[:2], np.float32)
        shares = [self.numbers[..., c] / np.float32(self.full[c]) for c in range(3)]
        return np.asarray(np.maximum(np.maximum(*shares[:2]), shares[2]))


def read_shot(path: str | Path, white: White, notes: Notes, one_of: int = 1) -> Shot:
    """Reads a photograph: JPEG, PNG, TIFF, .hdr, .exr, or a raw file.

    Args:
        path: The file.
        white: White that becomes neutral in raw files: K or x, y; None: as shot.
        notes: Says what was turned, and which colours were taken for sRGB.
        one_of: Photographs of its view.

    Raises:
        InputError: It cannot be read; the message names the file.
    """
    file = Path(path)
    suffix = file.suffix.lower()
    if suffix in LINEAR:
        light = read_environment(file)
        return Shot(file, light, _plateau(light, one_of), None, {})
    if not file.is_file():
        got = "a folder" if file.is_dir() else "no such file"
        raise InputError(f"{file}: wanted a photograph, got {got}")
    if suffix not in DISPLAY:
        return _raw(file, white, notes)
    photograph = read_display(file)
    for note in photograph.notes:
        notes.add(note)
    numbers = photograph.pixels
    assert numbers is not None
    full = np.full(3, float(np.iinfo(numbers.dtype).max))
    return Shot(file, np.ascontiguousarray(numbers), full, None, photograph.facts)


def _raw(file: Path, white: White, notes: Notes) -> Shot:
    """A raw file: linear, in units of a developed white."""
    from daguerre.development.camera_raw import read_shot as read_raw
    from daguerre.development.camera_raw import tags_of

    channels = read_raw(file)
    at = channels.as_shot if white is None else illuminants.white_xy(white)
    rgb = rgb_from_xyz() @ adaptation(at, illuminants.D65_XY) @ channels.xyz_from(at)
    unit = channels.unit.astype(np.float32)
    height, width = channels.pixels.shape[:2]
    facts = shot_facts(tags_of(file), (width, height))
    if white is None:
        notes.add("raw file developed with its own white balance")
    return Shot(file, channels.pixels / unit, channels.full / unit, rgb, facts)


def _plateau(light: NDArray[np.float32], one_of: int) -> NDArray[np.float64]:
    """Saturation of linear light: its highest value, if many of the brightest pixels share it.

    In a single picture they must be few and bright, else they may be an even sky.
    """
    top = light.max(axis=2)
    highest = float(top.max())
    count = int((top >= highest * (1 - 1e-6)).sum())
    sparse = count < 0.2 * top.size and highest > 4 * float(np.median(top))
    return np.full(3, highest if count >= _SHARED and (sparse or one_of > 1) else math.inf)


def check_together(shots: list[Shot]) -> None:
    """Refuses photographs of one view that differ in size or kind.

    Raises:
        InputError: The message names the file and what is wanted.
    """
    first = shots[0]
    for shot in shots[1:]:
        if shot.size != first.size:
            raise InputError(
                f"{shot.path}: size: wanted {first.size[0]}x{first.size[1]} px as {first.path}, "
                f"got {shot.size[0]}x{shot.size[1]}"
            )
        if shot.coded != first.coded:
            raise InputError(
                f"{shot.path}: wanted photographs of one kind, as {first.path}; got linear and "
                "coded ones"
            )
