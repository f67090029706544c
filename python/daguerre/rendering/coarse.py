"""A coarse picture for the first second: few pixels, one sample each, by a session of its own.

The session that draws the picture knows nothing of it, so no bit of the picture depends on it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from daguerre.camera.camera import Camera
from daguerre.frame.frame import Frame
from daguerre.scene.scene import Scene

from .settings import RenderSettings

if TYPE_CHECKING:
    from daguerre.setup.built_scene import BuiltScene

#: Pixels of the picture that is drawn, about.
PIXELS = 20_000


def coarse(
    scene: Scene, camera: Camera, settings: RenderSettings, built: BuiltScene | None = None
) -> tuple[Frame, BuiltScene]:
    """The picture in large squares, at its full size, and the scene that was built for it.

    Light paths, ghosts, scatter and diffraction are left out, for they need time to be set up.

    Args:
        scene: The scene.
        camera: The camera.
        settings: How the picture is going to be rendered.
        built: The scene built for another picture.
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
    x0, y0, x1, y1 = settings.film.crop or (0, 0, width, height)
    columns = np.clip(np.arange(x0, x1) * size[0] // width, 0, size[0] - 1)
    rows = np.clip(np.arange(y0, y1) * size[1] // height, 0, size[1] - 1)
    facts = {"resolution": (width, height), "crop": (x0, y0, x1, y1)}
    rgb = np.ascontiguousarray(frame.rgb[rows][:, columns])
    return Frame(rgb, metadata={**frame.metadata, **facts}), session.built
