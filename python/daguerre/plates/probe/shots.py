"""Reads photographs for light probes, with their saturation and exposure."""

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
from daguerre.files.reading import size_of
from daguerre.pictures.light import read_environment
from daguerre.plates.display_file import read_display
from daguerre.plates.files import DISPLAY
from daguerre.plates.raw_file import raw_facts

White = float | tuple[float, float] | None
LINEAR = (".exr", ".hdr")
#: Share of full scale from which on a channel counts as clipped, as demosaicing and JPEG smear it.
CLIPPED = 0.98
#: Number of pixels with the highest value of linear light from which on it counts as saturation.
_SHARED = 3


@dataclass(frozen=True)
class Shot:
    """One photograph.

    Attributes:
        path: Path of its file.
        numbers: Upright pixels, shape (H, W, 3): uint8 or uint16 encoded by a curve, else float32
            linear.
        full: Saturation of each channel of ``numbers``, shape (3,); infinite: never.
        rgb: Matrix from linear ``numbers`` to linear Rec.709, shape (3, 3); None: identity, or
            encoded.
        facts: Known metadata of the shot by OpenEXR's names.
    """

    path: Path
    numbers: NDArray[Any]
    full: NDArray[np.float64]
    rgb: NDArray[np.float64] | None
    facts: dict[str, Any]

    @property
    def coded(self) -> bool:
        """Whether pixels are encoded by a response curve."""
        return bool(np.issubdtype(self.numbers.dtype, np.integer))

    @property
    def metered(self) -> bool:
        """Whether a value of 1 is white by ISO 12232, not a luminance."""
        return self.path.suffix.lower() not in LINEAR

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, px."""
        return self.numbers.shape[1], self.numbers.shape[0]

    @property
    def focal_px(self) -> float | None:
        """Focal length, px, from the lens's focal length and the sensor's size; None: unknown."""
        focal = self.facts.get("nominalFocalLength")
        sensor = self.facts.get("sensorOverallDimensions")
        if focal is None or sensor is None:
            return None
        return float(focal / math.hypot(*sensor) * math.hypot(*self.size))

    @property
    def top(self) -> NDArray[np.float32]:
        """Largest channel of each pixel as a share of saturation, shape (H, W)."""
        if not np.isfinite(self.full).all():
            return np.zeros(self.numbers.shape[:2], np.float32)
        shares = [self.numbers[..., c] / np.float32(self.full[c]) for c in range(3)]
        return np.asarray(np.maximum(np.maximum(*shares[:2]), shares[2]))


def read_shot(path: str | Path, white: White, notes: Notes, one_of: int = 1) -> Shot:
    """Reads a photograph: JPEG, PNG, TIFF, .hdr, .exr, or a raw file.

    Args:
        path: Path of the file.
        white: White that becomes neutral in raw files: K or (x, y); None: as shot.
        notes: Gets notes, such as on rotation and colour space.
        one_of: Number of photographs of its view.

    Raises:
        InputError: The file cannot be read; the message has its path.
    """
    file = Path(path)
    suffix = file.suffix.lower()
    if suffix in LINEAR:
        light = read_environment(file, notes)
        return Shot(file, light, _plateau(light, one_of), None, {})
    size_of(file)
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
    """Reads a raw file as linear light; developed white is 1."""
    from daguerre.development import libraw
    from daguerre.development.camera_raw import read_shot as read_raw

    channels = read_raw(file)
    at = channels.as_shot if white is None else illuminants.white_xy(white)
    rgb = rgb_from_xyz() @ adaptation(at, illuminants.D65_XY) @ channels.xyz_from(at)
    unit = channels.unit.astype(np.float32)
    facts, told = raw_facts(file, libraw.read(file))
    for note in told:
        notes.add(note)
    if white is None:
        notes.add("raw file developed with its as-shot white balance")
    return Shot(file, channels.pixels / unit, channels.full / unit, rgb, facts)


def _plateau(light: NDArray[np.float32], one_of: int) -> NDArray[np.float64]:
    """Saturation of linear light: its highest value, if several pixels share it.

    In a single picture these pixels must be few and bright; otherwise they may be an even sky.
    """
    top = light.max(axis=2)
    highest = float(top.max())
    count = int((top >= highest * (1 - 1e-6)).sum())
    sparse = count < 0.2 * top.size and highest > 4 * float(np.median(top))
    return np.full(3, highest if count >= _SHARED and (sparse or one_of > 1) else math.inf)


def check_together(shots: list[Shot]) -> None:
    """Checks that photographs of one view have the same size and kind.

    Raises:
        InputError: They differ; the message has the file.
    """
    first = shots[0]
    for shot in shots[1:]:
        if shot.size != first.size:
            raise InputError(
                f"{shot.path}: size: wanted {first.size[0]}x{first.size[1]} px like {first.path}, "
                f"got {shot.size[0]}x{shot.size[1]}"
            )
        if shot.coded != first.coded:
            raise InputError(
                f"{shot.path}: wanted photographs of one kind, like {first.path}; got linear and "
                "developed ones"
            )
