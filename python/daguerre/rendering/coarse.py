"""A coarse preview for the first second: few pixels with one sample each, from a separate session.

The picture itself does not depend on it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from daguerre.camera.camera import Camera
from daguerre.frame.frame import Frame
from daguerre.scene.scene import Scene

from .pixels import crop_box
from .settings import RenderSettings

if TYPE_CHECKING:
    from daguerre.setup.built_scene import BuiltScene

#: Approximate number of pixels of the preview.
PIXELS = 20_000


def coarse(
    scene: Scene, camera: Camera, settings: RenderSettings, built: BuiltScene | None = None
) -> tuple[Frame, BuiltScene]:
    """Draws a preview in large squares at full size; returns it and the scene built for it.

    It omits light paths, ghosts, scatter and diffraction, because their set-up takes time.

    Args:
        scene: The scene.
        camera: The camera.
        settings: Settings of the picture to preview.
        built: Scene built for another picture, for reuse.
    """
    from .session import Session

    width, height = settings.film.resolution
    scale = min((PIXELS / (width * height)) ** 0.5, 1.0)
    size = max(round(width * scale), 1), max(round(height * scale), 1)
    few = RenderSettings.of(
        resolution=size,
        light_paths="off",
        seed=settings.sampling.seed,
        max_depth=settings.light.max_depth,
        threads=settings.threads,
    )
    session = Session(scene, camera, settings=few, built=built)
    session.draw(0, 1)
    frame = session.frame()
    x0, y0, x1, y1 = crop_box(settings.film.crop, (0, 0, width, height))
    columns = np.clip(np.arange(x0, x1) * size[0] // width, 0, size[0] - 1)
    rows = np.clip(np.arange(y0, y1) * size[1] // height, 0, size[1] - 1)
    facts = {"resolution": (width, height), "crop": (x0, y0, x1, y1)}
    rgb = np.ascontiguousarray(frame.rgb[rows][:, columns])
    return Frame(rgb, metadata={**frame.metadata, **facts}), session.built
