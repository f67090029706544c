"""Pictures of calibration boards, as OpenCV takes them, and where corners should be in them."""

from __future__ import annotations

from typing import Any

import numpy as np

import daguerre as dg
from daguerre import charts

FLIP = np.array([1.0, -1, -1])


def seen(points: np.ndarray, pose: np.ndarray, projection: dg.Projection) -> np.ndarray:
    """Pixels of points (N, 3) of the world."""
    world = np.linalg.inv(pose)
    return projection.project((points @ world[:3, :3].T + world[:3, 3]) * FLIP)


def picture(
    chart: charts.Chart,
    camera: dg.Camera,
    projection: dg.Projection,
    **options: Any,
) -> np.ndarray:
    """8-bit light; what is not the board's is left black, for speed."""
    size = projection.size
    corners = charts.boards.outline(chart) * 1.01
    share = np.linspace(0, 1, 9)[:, None]
    sides = [a + (b - a) * share for a, b in zip(corners, np.roll(corners, -1, 0), strict=True)]
    border = np.concatenate(sides)
    pixels = seen(np.c_[border, np.zeros(len(border))], np.asarray(camera.transform), projection)
    low = np.maximum(np.floor(pixels.min(axis=0)) - 2, 0).astype(int)
    high = np.minimum(np.ceil(pixels.max(axis=0)) + 3, size).astype(int)
    given = {"spp": 16, "filter": "box", "max_depth": 1, "resolution": size} | options
    frame = dg.render(chart.scene(1.0), camera, crop=(*low, *high), **given)
    out = np.zeros(size[::-1], np.uint8)
    light = np.clip(frame.xyz[..., 1], 0, 1)
    out[low[1] : high[1], low[0] : high[0]] = (light * 255 + 0.5).astype(np.uint8)
    return out
