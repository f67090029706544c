"""A dome port: glass 6 mm thick, with an outer radius of 100 mm, about the entrance pupil."""

from __future__ import annotations

from daguerre.exporters.gltf import Glb
from solids.housing import BACK_M, OVERLAP_M, add_housing, arc
from solids.pool import pool

RADIUS_M, THICK_M, EDGE_DEG = 0.1, 0.006, 80.0


def make() -> Glb:
    """The scene."""
    studio = pool()
    inner = RADIUS_M - THICK_M
    within = arc(inner + OVERLAP_M, EDGE_DEG, 0)
    air = [(0, BACK_M), (float(within[0, 0]), BACK_M), *map(tuple, within)]
    port = [*map(tuple, arc(inner, 0, EDGE_DEG)), *map(tuple, arc(RADIUS_M, EDGE_DEG, 0))]
    add_housing(studio, air, port, inner - 0.01)
    return studio.glb
