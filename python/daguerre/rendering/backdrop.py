"""Background plate: composites a picture over the photograph of the set, with catchers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.exposure_mode import LIGHT
from daguerre.color.spectra import xyz_of
from daguerre.errors import InputError, UsageError
from daguerre.frame.frame import Frame
from daguerre.frame.over import change_of_rgb
from daguerre.scene.parts import Plate
from daguerre.scene.scene import Scene

from .parameters import PLATE
from .settings import RenderSettings

#: Difference of aspect, px of the smaller picture, that counts as rounding.
_ROUNDING = 1.0


def shows_plate(settings: RenderSettings) -> bool:
    """Whether the plate is the background."""
    return settings.backdrop.background == PLATE


def check_backdrop(scene: Scene, settings: RenderSettings, exposure: str) -> None:
    """Checks the background plate, and that the exposure mode leaves its values as they are.

    Raises:
        UsageError: There is no plate, another camera took it, or the mode is not ``light``.
        InputError: Its aspect ratio differs from the picture's.
    """
    if not shows_plate(settings):
        return
    if exposure != LIGHT:
        raise UsageError(
            f"background: plate: wanted the exposure mode {LIGHT}, as a plate is exposed already, "
            f"got {exposure}; use --background transparent, then `daguerre composite`"
        )
    plate = scene.plate
    if plate is None:
        raise UsageError("background: plate: wanted a photograph (--plate), got none")
    if plate.camera is not None:
        raise UsageError(
            "background: plate: wanted a photo by the camera that renders, got one with its own "
            "camera (--plate-camera)"
        )
    (height, width), (wide, high) = plate.pixels.shape[:2], settings.film.resolution
    scale = min(wide / width, high / height, 1.0)
    if (
        max(abs(wide * height / high - width), abs(high * width / wide - height)) * scale
        > _ROUNDING
    ):
        raise InputError(
            f"background: plate: wanted {wide} x {high} px, as the picture, or a multiple of "
            f"it, got {width} x {height} px"
        )


def over(frame: Frame, pixels: NDArray[np.float32]) -> Frame:
    """Composites the frame over its background; alpha and layers still describe the objects."""
    rgb = change_of_rgb(frame).of(pixels)
    return replace(frame, rgb=rgb, xyz=xyz_of(rgb))


def behind(frame: Frame, plate: Plate | None) -> NDArray[np.float32]:
    """Pixels of the plate behind a frame, shape (H, W, 3); 0 in the overscan."""
    wide, high = frame.metadata.get("resolution") or (frame.width, frame.height)
    left, top = (frame.metadata.get("crop") or (0, 0))[:2]
    assert plate is not None
    pixels = plate.pixels
    whole = pixels if pixels.shape[:2] == (high, wide) else _resized(pixels, wide, high)
    shown = np.zeros((frame.height, frame.width, 3), np.float32)
    x0, y0 = max(left, 0), max(top, 0)
    cut = whole[y0 : max(top + frame.height, 0), x0 : max(left + frame.width, 0)]
    shown[y0 - top : y0 - top + cut.shape[0], x0 - left : x0 - left + cut.shape[1]] = cut
    return shown


def _resized(pixels: NDArray[np.float32], width: int, height: int) -> NDArray[np.float32]:
    import OpenImageIO as oiio

    source = oiio.ImageBuf(np.ascontiguousarray(pixels))
    roi = oiio.ROI(0, width, 0, height, 0, 1, 0, 3)
    made = oiio.ImageBufAlgo.resize(source, filtername="triangle", roi=roi)
    return np.asarray(made.get_pixels(oiio.FLOAT), np.float32)
