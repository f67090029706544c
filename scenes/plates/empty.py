"""The set as it is filmed: nothing stands on it yet."""

from __future__ import annotations

from daguerre.exporters.gltf import Glb
from night.stage import Stage
from plates.film_set import add_camera, add_set


def make() -> Glb:
    """The scene."""
    stage = Stage("daguerre scenes/plates.py")
    add_set(stage)
    add_camera(stage)
    return stage.glb
