"""Facts of a camera that is set up, in the names and units of the EXR attributes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera import shutter
from daguerre.camera.exposure import exposure_metadata

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera

    from .camera import CameraSetup


def camera_metadata(camera: Camera, setup: CameraSetup, columns: int) -> dict[str, Any]:
    """Facts of the camera for a picture's metadata.

    Args:
        camera: In a photographer's terms.
        setup: The same, set up.
        columns: Width of the picture, px.
    """
    facts = setup.facts
    matrix = np.asarray(facts["world_from_camera"])
    width, height = setup.frame_size
    return {
        "isoSpeed": camera.iso,
        **shutter.metadata(camera),
        **exposure_metadata(camera, facts, shutter.shutter_time(camera)),
        "tStop": facts.get("t_stop"),
        "pixelAspectRatio": facts.get("squeeze", 1.0),
        "focus": facts.get("focus_distance_m"),
        "nominalFocalLength": facts.get("focal_length_mm"),
        "effectiveFocalLength": facts.get(
            "effective_focal_length_mm", facts.get("focal_length_mm")
        ),
        "pinholeFocalLength": setup.pinhole_focal_length,
        "entrancePupilOffset": facts.get("entrance_pupil_offset_mm"),
        "lensModel": facts.get("lens"),
        "sensorPhotositePitch": width / columns * 1e3,
        "sensorOverallDimensions": (width, height),
        "sensorCenterOffset": tuple(1e3 * shift for shift in facts["shift_mm"]),
        "worldToCamera": _world_to_camera(matrix),
        "worldToNDC": _world_to_ndc(
            matrix, setup.pinhole_focal_length, width * facts.get("squeeze", 1.0), height
        ),
        "camera": facts,
    }


def _world_to_camera(world_from_camera: NDArray[np.float64]) -> NDArray[np.float64]:
    """OpenEXR's convention: row vectors, left-handed camera with +z forward, +x right, +y up."""
    camera_from_world = np.linalg.inv(world_from_camera)
    return np.asarray((np.diag([1.0, 1.0, -1.0, 1.0]) @ camera_from_world).T)


def _world_to_ndc(
    world_from_camera: NDArray[np.float64], focal_length: float, width: float, height: float
) -> NDArray[np.float64]:
    """Row-vector matrix to NDC (-1 .. 1, y up) of the pinhole with the same framing."""
    scale = np.diag([2 * focal_length / width, 2 * focal_length / height, 1.0, 0.0])
    scale[2, 3] = 1.0  # w = z
    return np.asarray(_world_to_camera(world_from_camera) @ scale)
