"""A camera without a housing: the water begins at its front lens, which is in air by itself."""

from __future__ import annotations

from daguerre.exporters.gltf import Glb
from solids.pool import pool


def make() -> Glb:
    """The scene."""
    return pool().glb
