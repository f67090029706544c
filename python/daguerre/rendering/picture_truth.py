"""Ground truth of a picture, bit-identical with and without overscan."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.overscan import NONE, Overscan

from .film_parts import area
from .pixels import Box
from .prepare import Prepared
from .truth import GroundTruth


def ground_truth(prepared: Prepared, region: Box, overscan: Overscan) -> GroundTruth:
    """Makes the ground truth at the moment of the settings; default: mid-exposure."""
    truth = prepared.settings.truth
    return GroundTruth(
        prepared.scene,
        prepared.focused_camera,
        prepared.size,
        region,
        truth.moment or "mid",
        truth.gt_lens,
        truth.rays,
        prepared.settings.threads,
        None if prepared.scene.motion else prepared.core_scene,
        overscan,
        prepared.built.origin,
    )


def truth_planes(prepared: Prepared, whole: GroundTruth) -> dict[str, NDArray[Any]]:
    """Channels (H, W) by name; pixels of the picture are computed as without overscan."""
    motion = prepared.settings.truth.motion
    planes = whole.planes(motion=motion)
    if prepared.overscan and area(prepared.window):
        (left, top), (x0, y0, x1, y1) = prepared.crop[:2], prepared.window
        part = np.s_[y0 - top : y1 - top, x0 - left : x1 - left]
        for name, plane in (
            ground_truth(prepared, prepared.window, NONE).planes(motion=motion).items()
        ):
            planes[name][part] = plane
    return planes
