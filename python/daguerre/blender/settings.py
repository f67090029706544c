"""Turns render settings of Blender into ours, and states how light is converted.

One rule for light, for lamps, glowing surfaces and worlds alike: a watt is 683 lumens
(``LUMENS_PER_WATT``), so a value of 1 of Blender's scene-linear pictures and colours is a luminance
of 683 cd/m2. A frame of ours counts cd/m2, so :func:`factor_of` divides by the same number, and
multiplies by the exposure of Blender's film: both pictures of a scene have equal values.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from daguerre.rendering.settings import RenderSettings

from .camera_panel import CameraPanel
from .film import resolution_of

if TYPE_CHECKING:
    import bpy

#: Luminous efficacy, lm/W; equally cd/m2 for a value of 1 of Blender. Source: the maximum by the
#: definition of the candela (SI Brochure, 2019), as the lights of Blender's glTF exporter have it.
LUMENS_PER_WATT = 683.0
#: Most samples of a pixel that Blender asks for and Daguerre takes over.
_MOST_SAMPLES = 1 << 16
_STRAY = ("flare", "scatter", "diffraction")


def factor_of(scene: bpy.types.Scene) -> float:
    """Value of Blender for 1 cd/m2 of a frame."""
    cycles = getattr(scene, "cycles", None)
    return float(getattr(cycles, "film_exposure", 1.0)) / LUMENS_PER_WATT


def settings_of(scene: bpy.types.Scene, camera: bpy.types.Object | None = None) -> RenderSettings:
    """Render settings of a scene; the panels of scene and camera take precedence.

    Args:
        scene: Scene of Blender.
        camera: Camera object with switches of stray light; default: the scene's.

    Raises:
        UsageError: A value is out of its range.
    """
    eye = scene.camera if camera is None else camera
    panel, switches = CameraPanel(scene, always=True), CameraPanel(getattr(eye, "data", None))
    render = scene.render
    size = resolution_of(render)
    values: dict[str, Any] = {"resolution": size, "threads": _threads(render)}
    values["crop"] = region_of(render, size)
    if render.film_transparent:
        values["background"] = "transparent"
    return RenderSettings.of(**values, **_sampling(scene, panel), **_light(panel, switches))


def _threads(render: bpy.types.RenderSettings) -> int:
    """Number of threads; 0: all cores."""
    return int(render.threads) if render.threads_mode == "FIXED" else 0


def region_of(
    render: bpy.types.RenderSettings, size: tuple[int, int]
) -> tuple[int, int, int, int] | None:
    """Render region, px, from the top left, ends exclusive; None: the whole picture.

    It has at least a pixel.

    Blender counts from the lower left, and rounds the edges down in single precision.
    """
    if not render.use_border:
        return None
    columns, rows = size
    width, height = map(np.float32, size)
    left, right = (int(v * width) for v in (render.border_min_x, render.border_max_x))
    bottom, top = (int(v * height) for v in (render.border_min_y, render.border_max_y))
    left, bottom = min(max(left, 0), columns - 1), min(max(bottom, 0), rows - 1)
    right, top = min(max(right, left + 1), columns), min(max(top, bottom + 1), rows)
    return left, rows - top, right, rows - bottom


def _sampling(scene: bpy.types.Scene, panel: CameraPanel) -> dict[str, Any]:
    """Samples, noise and seed."""
    cycles = getattr(scene, "cycles", None)
    found: dict[str, Any] = {}
    if (samples := panel.chosen("spp")) is not None:
        found["spp"] = int(samples)
    elif cycles is not None:
        found["spp"] = min(max(1, int(cycles.samples)), _MOST_SAMPLES)
    if noise := panel.chosen("noise"):
        found["noise"] = float(noise)
    if cycles is not None:
        turn = scene.frame_current if cycles.use_animated_seed else 0
        found["seed"] = max(0, int(cycles.seed) + int(turn))
    return found


def _light(panel: CameraPanel, switches: CameraPanel) -> dict[str, Any]:
    """Light paths of the scene's panel, stray light of the camera's."""
    found: dict[str, Any] = {}
    if (paths := panel.named("light_paths")) is not None:
        found["light_paths"] = paths
    for name in _STRAY:
        if switches.chosen(name):
            found[name] = True if name == "diffraction" else "auto"
    return found
