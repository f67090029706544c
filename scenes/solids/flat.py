"""A flat port: a plate of glass 10 mm thick, 40 mm before the entrance pupil."""

from __future__ import annotations

from daguerre.exporters.gltf import Glb
from solids.housing import BACK_M, OVERLAP_M, Profile, add_housing
from solids.pool import pool

PORT_M, THICK_M, RADIUS_M = 0.04, 0.01, 0.075


def make() -> Glb:
    """The scene."""
    studio = pool()
    r, front = RADIUS_M, PORT_M + THICK_M
    air: Profile = [(0, BACK_M), (r, BACK_M), (r, PORT_M + OVERLAP_M), (0, PORT_M + OVERLAP_M)]
    port: Profile = [(0, PORT_M), (r + OVERLAP_M, PORT_M), (r + OVERLAP_M, front), (0, front)]
    add_housing(studio, air, port, r - 0.005)
    return studio.glb
