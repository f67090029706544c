"""Light of a plate: its pixels without the vignetting of the lens, and its camera."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.camera import shutter
from daguerre.camera.overscan import NONE
from daguerre.scene.scene import Scene
from daguerre.setup.camera import set_up
from daguerre.setup.scene import build

from .film_parts import core_settings

if TYPE_CHECKING:
    from .prepare import Prepared

#: Longer side, px, and samples per pixel of the white picture that shows a lens's vignetting.
ACROSS, SPP = 64, 256
#: Share of the light below which a corner is too dark to correct.
DARK = 0.02


def throw_plate(prepared: Prepared, core: _core.RenderSettings) -> None:
    """Passes the scene's plate, if any, to the core as light seen by its camera."""
    plate = prepared.scene.plate
    if plate is None:
        return
    camera = prepared.camera if plate.camera is None else plate.camera
    size = plate.pixels.shape[1], plate.pixels.shape[0]
    setup = (
        prepared.setup
        if plate.camera is None
        else set_up(prepared.scene, camera, size, prepared.core_scene)
    )
    options = {"seed": 0, "filter": _core.Filter("box", 0.0)}
    taken = core_settings(setup, size, shutter.core_shutter(camera, size), NONE, options)
    light = plate.pixels / np.maximum(shading(setup.core, taken, size), DARK)
    core.set_plate(prepared.core_scene, setup.core, taken, np.ascontiguousarray(light, np.float32))


def shading(
    camera: _core.Camera, taken: _core.RenderSettings, size: tuple[int, int]
) -> NDArray[np.float32]:
    """Relative exposure of each pixel by a white world, shape (H, W, 3).

    It is drawn small and interpolated. It includes the tint of the glass.
    """
    scale = min(1.0, ACROSS / max(size))
    small = max(2, math.ceil(size[0] * scale)), max(2, math.ceil(size[1] * scale))
    white = Scene()
    white.set_environment(color=(1, 1, 1))
    film = _core.Film(_core.FilmLayout(width=small[0], height=small[1]))
    settings = _core.RenderSettings()
    settings.resolution = small
    settings.sensor_size_mm = taken.sensor_size_mm
    settings.sensor_center_mm = taken.sensor_center_mm
    settings.filter = _core.Filter("box", 0.0)
    _core.render(build(white), camera, film, settings, 0, SPP)
    return _grown(film.mean_rgb(), size)


def _grown(small: NDArray[np.float32], size: tuple[int, int]) -> NDArray[np.float32]:
    """Resizes a picture linearly between pixel centres."""
    for axis, wanted in ((0, size[1]), (1, size[0])):
        count = small.shape[axis]
        at = np.clip((np.arange(wanted) + 0.5) * count / wanted - 0.5, 0, count - 1)
        low = np.minimum(at.astype(int), count - 2)
        share = np.expand_dims((at - low).astype(np.float32), (1 - axis, 2))
        left, right = (np.take(small, low + i, axis) for i in range(2))
        small = left + (right - left) * share
    return np.asarray(small, np.float32)
