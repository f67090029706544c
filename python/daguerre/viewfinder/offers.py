"""All that a page can choose from."""

from __future__ import annotations

from typing import Any

from daguerre import sensors, units
from daguerre.camera.exposure_mode import METERS, MODES
from daguerre.development.looks import LOOKS
from daguerre.files import extras

from . import lens_list
from .dials import DIALS, Dials
from .rungs import MODELS
from .shot import Shot
from .stage import Stage
from .switches import on_in
from .tint import legends


def offers(stage: Stage, first: Dials, shot: Shot) -> dict[str, Any]:
    """Facts of a scene that a page needs before any picture.

    Args:
        stage: Scene, camera and settings.
        first: Dials of the command line.
        shot: The present shot.
    """
    scene, settings = stage.scene, stage.settings
    return {
        "scene": "scene" if scene.path is None else scene.path.name,
        "lenses": lens_list.offered(),
        "shutter_types": list(DIALS["shutter_type"].choices),
        "sensors": [*units.SENSORS, *sensors.names()],
        "looks": list(LOOKS),
        "cameras": list(scene.cameras),
        "duration_s": scene.duration,
        "denoises": not extras.missing("mitsuba_oidn"),
        "models": list(MODELS),
        "modes": list(MODES),
        "meters": list(METERS),
        "legends": legends(),
        "dials": dict(first.texts),
        "resolution": settings.film.resolution,
        "window": shot.window,
        "spp": shot.settings.sampling.most,
        "lit": on_in(settings),
    }
