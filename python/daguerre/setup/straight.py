"""Rectilinear pictures, recognised from their metadata."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from daguerre.camera.ideal import IDEAL
from daguerre.errors import InputError

_STRAIGHT = (*IDEAL, "rectilinear")


def straight_focal_px(metadata: Mapping[str, Any], where: str) -> float:
    """Returns the focal length of a rectilinear picture along its rows, px.

    Args:
        metadata: Metadata of a frame, as :func:`.metadata.camera_metadata` makes it.
        where: Name of the caller, for messages.

    Raises:
        InputError: Another kind of camera, or metadata without a camera.
    """
    facts = metadata.get("camera", {})
    projection = facts.get("projection", {})
    kind = projection.get("model") or facts.get("lens_model")
    if kind not in _STRAIGHT:
        raise InputError(
            f"{where}: wanted a pinhole, a thin lens or a rectilinear projection, got {kind}"
        )
    try:
        focal = float(metadata["pinholeFocalLength"] / metadata["sensorPhotositePitch"] * 1e3)
        if projection:  # the one of both axes is their geometric mean
            across, down = projection["focal_px"]
            focal *= math.sqrt(across / down)
    except (KeyError, TypeError, ValueError) as error:
        text = f"{type(error).__name__}: {error}"
        raise InputError(f"{where}: wanted the camera's focal length, got {text}") from None
    return focal
