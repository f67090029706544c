"""Makes clean frames look like a plate: vignetting, blur, noise and development."""

from __future__ import annotations

import zlib
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color.spectra import xyz_of
from daguerre.frame.frame import Frame
from daguerre.frame.picture import Picture

from .grain import Grain
from .grain_draw import with_grain
from .plate_camera import PlateCamera

Floats = NDArray[np.float32]
#: Planes of a frame with light: those for sensors and development, and catchers.
_LIGHT = ("rgb", "xyz", "channels", "bands", "catcher", "catcher_channels")
_RATIOS = ("catcher_ratio", "catcher_ratio_channels")


class PlateLook:
    """The look of a plate.

    Attributes:
        plate: Matched camera.
        look: Tone curve of development.
    """

    def __init__(self, plate: PlateCamera) -> None:
        self.plate, self.look = plate, plate.look

    @property
    def facts(self) -> dict[str, Any]:
        """Metadata about the plate for the file of a frame."""
        return {"file": self.plate.plate, "sha256": self.plate.sha256, "kind": self.plate.kind}

    def seen(self, frame: Frame, seed: int = 0) -> Frame:
        """Applies the vignetting and blur of the plate's camera to a clean frame.

        For a plate in linear light, noise is added, too; for others a sensor or development adds
        it later.

        Args:
            frame: Scene-linear frame without noise.
            seed: Seed of the noise.
        """
        frame = frame.without_overscan()
        factor, scale = self._factor(frame), self._scale(frame)
        planes: dict[str, Any] = {
            name: self._blurred(plane, factor, scale)
            for name in _LIGHT
            if (plane := getattr(frame, name)) is not None
        }
        planes |= self._covered(frame, scale)
        noise = self.plate.noise
        if isinstance(noise, Grain) and noise.linear:
            place = _corner(frame.metadata)
            planes["rgb"] = with_grain(planes["rgb"], noise, _own(seed, frame.metadata), place)
            planes["xyz"] = xyz_of(planes["rgb"])
        return replace(frame, **planes)

    def finished(self, picture: Picture, seed: int = 0) -> Picture:
        """Adds the noise of a developed plate to a developed picture; others have noise already."""
        noise = self.plate.noise
        if not isinstance(noise, Grain) or noise.linear:
            return picture
        facts = picture.metadata
        noisy = with_grain(picture.pixels, noise, _own(seed, facts), _corner(facts))
        return Picture(np.clip(noisy, 0, 1), picture.colour_space, facts)

    def _covered(self, frame: Frame, scale: float) -> dict[str, Floats]:
        """Blurs alpha and ratios like the light; ratios are weighted by the uncovered share."""
        if self.plate.sharpness is None or bool((frame.alpha == 1).all()):
            return {}
        left = 1 - frame.alpha[:, :, None]
        soft = np.clip(self._blurred(left, None, scale), 0, 1)
        found = {"alpha": 1 - soft[:, :, 0]}
        for name in _RATIOS:
            ratio = getattr(frame, name)
            if ratio is not None:
                share = np.maximum(self._blurred(left * ratio, None, scale), 0)
                found[name] = np.divide(share, soft, out=np.ones_like(share), where=soft > 1e-6)
        return found

    def _blurred(self, plane: Floats, factor: Floats | None, scale: float) -> Floats:
        lit = plane if factor is None else plane * factor[:, :, None]
        if self.plate.sharpness is None:
            return lit
        return self.plate.sharpness.blur.applied(np.ascontiguousarray(lit), scale)

    def _factor(self, frame: Frame) -> Floats | None:
        """Vignetting over the frame's part of the picture, shape (H, W); None: unknown."""
        if self.plate.falloff is None:
            return None
        width, height = frame.metadata.get("resolution") or (frame.width, frame.height)
        x, y = _corner(frame.metadata)
        whole = self.plate.falloff.factor(height, width)
        return whole[y : y + frame.height, x : x + frame.width]

    def _scale(self, frame: Frame) -> float:
        """Pixels of the frame for each pixel of the plate."""
        width = (frame.metadata.get("resolution") or (frame.width, frame.height))[0]
        return float(width / self.plate.resolution[0])


def _corner(facts: dict[str, Any]) -> tuple[int, int]:
    x, y = (facts.get("crop") or (0, 0))[:2]
    return int(x), int(y)


def _own(seed: int, facts: dict[str, Any]) -> int:
    """Seed that depends on the time of the frame, so that noise differs within a sequence."""
    time = float(facts.get("time") or 0.0)
    return seed if time == 0 else (seed + zlib.crc32(repr(time).encode())) % 2**53
