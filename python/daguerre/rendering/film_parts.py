"""Parts of a film: the picture, and with overscan the pixels around it.

The picture is drawn as without overscan, so it keeps its bits: lens tables, aims of light paths and
ghosts, and weights of dispersed wavelengths do not depend on the pixels around it. The same camera
with a larger sensor draws those pixels, into the same film.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import daguerre._core as _core
from daguerre.camera.overscan import Overscan

from .pixels import Box

if TYPE_CHECKING:
    from daguerre.setup.resolved import ResolvedCamera

NOWHERE: Box = (0, 0, 0, 0)
#: Changes the seed of the overscan, which has its own random numbers.
_SEED = 0x9E3779B97F4A7C15


@dataclass
class FilmPart:
    """Pixels of a film that are drawn together.

    Attributes:
        camera: Camera of the core.
        settings: Settings of the part's frame: the picture, or the larger frame around it.
        before: Columns and rows of that frame before the picture.
        pixels: Number of pixels.
    """

    camera: _core.Camera
    settings: _core.RenderSettings
    before: tuple[int, int]
    pixels: int

    def draw(
        self,
        draw: Callable[..., Any],
        scene: _core.Scene,
        film: _core.Film,
        corner: tuple[int, int],
        which: tuple[Any, ...],
        progress: object,
    ) -> tuple[bool, _core.RenderCounters]:
        """Draws samples; returns whether all of them were drawn, and the counters.

        Args:
            draw: ``render`` or ``render_round`` of the core.
            scene: The scene.
            film: Film with all pixels.
            corner: First pixel of the film in the picture's coordinates, px.
            which: Samples, in the form that ``draw`` takes.
            progress: Progress callback, see ``Session.draw``.
        """
        film.place(corner[0] + self.before[0], corner[1] + self.before[1])
        try:
            complete, counters = draw(scene, self.camera, film, self.settings, *which, progress)
        finally:
            film.place(*corner)
        return bool(complete), counters


def inside(region: Box, resolution: tuple[int, int]) -> Box:
    """Part of a region inside the picture; ``NOWHERE`` if they do not overlap."""
    x0, y0, x1, y1 = region
    cut = (max(x0, 0), max(y0, 0), min(x1, resolution[0]), min(y1, resolution[1]))
    return cut if cut[0] < cut[2] and cut[1] < cut[3] else NOWHERE


def area(box: Box) -> int:
    """Number of pixels of a region."""
    return (box[2] - box[0]) * (box[3] - box[1])


def core_settings(
    setup: ResolvedCamera,
    resolution: tuple[int, int],
    core_shutter: _core.Shutter,
    overscan: Overscan,
    options: dict[str, Any],
) -> _core.RenderSettings:
    """Makes the core's settings for the picture, or for the larger frame with ``overscan``.

    Args:
        setup: The camera.
        resolution: Size of the picture, px.
        core_shutter: Shutter of the core.
        overscan: Pixels around the picture.
        options: Other settings of the core, by name.
    """
    settings = _core.RenderSettings()
    size, center = frame_around(setup, resolution, overscan)
    settings.resolution = overscan.grown(resolution)
    settings.sensor_size_mm = size
    settings.sensor_center_mm = center
    settings.shutter = core_shutter
    for name, value in options.items():
        setattr(settings, name, value)
    if overscan:
        settings.shutter = core_shutter.within(overscan.left, overscan.top)
        settings.seed = options["seed"] ^ _SEED
        left, top, (width, height) = overscan.left, overscan.top, resolution
        settings.hole = (left, top, left + width, top + height)
    return settings


def frame_around(
    setup: ResolvedCamera, resolution: tuple[int, int], overscan: Overscan
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Size and middle (mm, upright) of the film that a picture with its overscan covers."""
    right, up = setup.shift_mm  # at mid-exposure
    if not overscan:
        return setup.frame_size_mm, (right, up)
    across, along = (mm / n for mm, n in zip(setup.frame_size_mm, resolution, strict=True))
    columns, rows = overscan.grown(resolution)
    center = (
        right + across * (overscan.right - overscan.left) / 2,
        up + along * (overscan.top - overscan.bottom) / 2,
    )
    return (columns * across, rows * along), center
