"""Metadata of a camera: as JSON, and in the names and units of EXR attributes.

They are only for files and hashes; nothing computes with them.
"""

from __future__ import annotations

import functools
import hashlib
import json
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera import shutter
from daguerre.camera.exposure import exposure_facts, exposure_metadata

from .body import stack_facts
from .imperfections import decenters, ripple_of
from .iris import dirt_facts, iris_facts

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera
    from daguerre.lenses import Lens

    from .resolved import Glass, ResolvedCamera


def camera_metadata(camera: Camera, setup: ResolvedCamera, columns: int) -> dict[str, Any]:
    """Makes the camera's part of a picture's metadata.

    Args:
        camera: The camera.
        setup: The camera, set up.
        columns: Width of the picture, px.
    """
    lens, matrix = setup.lens, setup.world_from_camera
    width, height = setup.frame_size_mm
    return {
        "isoSpeed": camera.iso,
        **shutter.metadata(camera),
        **exposure_metadata(camera, lens.f_stop, setup.h0, shutter.shutter_time(camera)),
        "tStop": lens.t_stop,
        "pixelAspectRatio": lens.squeeze,
        "focus": lens.focus_distance_m,
        "nominalFocalLength": lens.focal_length_mm,
        "effectiveFocalLength": lens.effective_focal_length_mm,
        "pinholeFocalLength": lens.pinhole_focal_length_mm,
        "entrancePupilOffset": lens.entrance_pupil_offset_mm,
        "lensModel": lens.name,
        "sensorPhotositePitch": width / columns * 1e3,
        "sensorOverallDimensions": (width, height),
        "sensorCenterOffset": tuple(1e3 * shift for shift in setup.shift_mm),
        "worldToCamera": _world_to_camera(matrix),
        "worldToNDC": _world_to_ndc(
            matrix, lens.pinhole_focal_length_mm, width * lens.squeeze, height
        ),
        "camera": facts_of(setup),
    }


def facts_of(setup: ResolvedCamera) -> dict[str, Any]:
    """Resolved camera parameters as JSON values, for metadata and hashes."""
    camera = setup.camera
    return {
        "lens_model": setup.lens.model,
        **_lens_facts(setup),
        "h0": setup.h0,  # keeps its place among the facts of glass
        "sensor_size_mm": list(camera.sensor_size),
        "frame_size_mm": list(setup.frame_size_mm),
        "sensor_fit": camera.sensor_fit,
        "shift_mm": list(setup.shift_mm),
        "tilt_deg": list(camera.tilt),
        "world_from_camera": setup.world_from_camera.tolist(),
        **({"near_clip_m": camera.near_clip} if camera.near_clip else {}),
        **({} if camera.dispersion else {"dispersion": False}),
        "exposure": camera.exposure,
        "iso": camera.iso,
        "exposure_compensation": camera.exposure_compensation,
        **exposure_facts(camera),
        "shutter": shutter.facts(camera, setup.resolution),
        **_change_facts(setup),
    }


def _lens_facts(setup: ResolvedCamera) -> dict[str, Any]:
    camera, lens = setup.camera, setup.lens
    if lens.glass is not None:
        return _glass_facts(setup, lens.glass)
    facts: dict[str, Any] = {"lens": lens.name, "focal_length_mm": lens.focal_length_mm}
    if lens.projection is not None:
        facts["projection"] = lens.projection.facts()
    if lens.aperture_diameter_mm is None:
        return facts
    facts |= {
        "f_stop": lens.f_stop,
        "aperture_diameter_mm": lens.aperture_diameter_mm,
        "focus_distance_m": lens.focus_distance_m,
    }
    if lens.projection is None:
        facts["focus_breathing"] = camera.focus_breathing
    return facts | iris_facts(camera)


def _glass_facts(setup: ResolvedCamera, glass: Glass) -> dict[str, Any]:
    camera, lens = setup.camera, setup.lens
    ripple = ripple_of(camera)
    return {
        "lens": lens.name,
        "lens_sha256": _hash_lens(glass.lens),
        "coating": glass.lens.coating,
        "focal_length_mm": lens.focal_length_mm,
        "effective_focal_length_mm": glass.effective_focal_length_mm,
        "zoom_mm": glass.lens.zoom_mm,
        "zoom_range_mm": glass.lens.zoom_range_mm,
        "squeeze": glass.squeeze,
        "decenter": [[list(part) for part in one] for one in decenters(camera)],
        "f_stop": lens.f_stop,
        "t_stop": lens.t_stop,
        "focus_distance_m": lens.focus_distance_m,
        "focus_by": camera.focus_by,
        "entrance_pupil_offset_mm": glass.entrance_pupil_offset_mm,
        "h0": glass.h0,
        "transmittance": glass.transmittance,
        "ripple": None if ripple is None else list(ripple),
        **(glass.fit.facts if glass.fit else {}),
        **iris_facts(camera),
        **dirt_facts(camera),
        **stack_facts(camera),
    }


def _change_facts(setup: ResolvedCamera) -> dict[str, Any]:
    found = {name: change.facts for name, change in setup.changes.items()}
    return {"motion": found} if found else {}


@functools.lru_cache(16)
def _hash_lens(lens: Lens) -> str:
    text = json.dumps(lens.data, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()


def _world_to_camera(world_from_camera: NDArray[np.float64]) -> NDArray[np.float64]:
    """Camera from world as in OpenEXR: row vectors, left-handed, +z forward, +x right, +y up."""
    camera_from_world = np.linalg.inv(world_from_camera)
    return np.asarray((np.diag([1.0, 1.0, -1.0, 1.0]) @ camera_from_world).T)


def _world_to_ndc(
    world_from_camera: NDArray[np.float64], focal_length: float, width: float, height: float
) -> NDArray[np.float64]:
    """Row-vector matrix to NDC (-1 .. 1, y up) of the pinhole with the same framing."""
    scale = np.diag([2 * focal_length / width, 2 * focal_length / height, 1.0, 0.0])
    scale[2, 3] = 1.0  # w = z
    return np.asarray(_world_to_camera(world_from_camera) @ scale)
