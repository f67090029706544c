"""The set, and what is to be put into it."""

from __future__ import annotations

from daguerre.exporters.gltf import Glb
from night.stage import Stage
from plates.chessmen import add_chessmen
from plates.film_set import add_camera, add_set


def make() -> Glb:
    """The scene."""
    stage = Stage("daguerre scenes/plates.py")
    add_set(stage)
    add_camera(stage)
    add_chessmen(stage)
    return stage.glb
