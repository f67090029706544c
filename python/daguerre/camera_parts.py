"""Parts that all lens models share: frame on the film, place of the camera, iris."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core

from .camera import LIMITS, Camera
from .checks import numbers, short
from .errors import UsageError, suggest

FITS = ("horizontal", "vertical", "auto", "fill")


def frame_size(camera: Camera, resolution: tuple[int, int]) -> tuple[float, float]:
    """Width and height (mm) of the part of the film that a picture of this resolution covers."""
    width, height = numbers(camera.sensor_size, "camera: sensor_size", 2, "two positive mm")
    low, high = LIMITS["sensor_size"]
    if not (low <= min(width, height) and max(width, height) <= high):
        raise UsageError(
            f"camera: sensor_size: wanted {low:g} .. {high:g} mm, got {camera.sensor_size}"
        )
    columns, rows = resolution
    if camera.sensor_fit not in FITS:
        raise UsageError(
            f"camera: sensor_fit: wanted {', '.join(FITS)}, got {camera.sensor_fit!r}"
            f"{suggest(str(camera.sensor_fit), FITS)}"
        )
    scale = {  # mm per pixel
        "horizontal": width / columns,
        "vertical": height / rows,
        "auto": width / columns if columns >= rows else height / rows,
        "fill": min(width / columns, height / rows),
    }[camera.sensor_fit]
    return columns * scale, rows * scale


#: Largest distance of a camera from the origin, m: longer rays overflow in the ray tracer.
MAX_DISTANCE = 1e18


def rigid(transform: NDArray[np.float64]) -> NDArray[np.float64]:
    """The rotation and position of a transform: a camera has no scale.

    Raises:
        UsageError: The matrix is no 4x4 of finite numbers, is singular, or stands too far away.
    """
    try:
        matrix = np.asarray(transform, np.float64)
    except (TypeError, ValueError):
        raise UsageError(
            f"camera: transform: wanted a 4x4 matrix, got {short(transform)}"
        ) from None
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
        raise UsageError("camera: transform: wanted a finite 4x4 matrix")
    if np.abs(matrix[:3, 3]).max() > MAX_DISTANCE:
        raise UsageError(
            f"camera: transform: wanted a position within {MAX_DISTANCE:g} m of the origin, "
            f"got {matrix[:3, 3].tolist()}"
        )
    forward, up = -matrix[:3, 2], matrix[:3, 1]
    right = np.cross(forward, up)
    if not (np.linalg.norm(forward) > 0 and np.linalg.norm(right) > 0):
        raise UsageError(
            "camera: transform: wanted a view direction and an up vector, got a singular matrix"
        )
    z = -forward / np.linalg.norm(forward)
    x = right / np.linalg.norm(right)
    out = np.eye(4)
    out[:3, 0], out[:3, 1], out[:3, 2], out[:3, 3] = x, np.cross(z, x), z, matrix[:3, 3]
    return out


def iris_of(camera: Camera) -> _core.Iris:
    """The shape of the iris: round, blades, or a picture."""
    try:
        if camera.aperture_image is not None:
            picture = np.asarray(camera.aperture_image, np.float32)
            if picture.ndim != 2:
                raise UsageError(
                    f"camera: aperture_image: wanted shape (H, W), got {picture.shape}"
                )
            return _core.Iris.image(np.ascontiguousarray(picture))
        if camera.blades:
            return _core.Iris.polygon(camera.blades, camera.blade_rotation, camera.blade_curvature)
    except UsageError:
        raise
    except (TypeError, ValueError) as error:
        raise UsageError(f"camera: {error}") from None
    return _core.Iris()


def mask_of(camera: Camera, name: str) -> NDArray[np.float32] | None:
    """``front_mask`` or ``iris_mask``, checked; None: clean."""
    given = getattr(camera, name)
    if given is None:
        return None
    picture = np.ascontiguousarray(given, np.float32)
    if picture.ndim != 2 or not picture.size:
        raise UsageError(f"camera: {name}: wanted shape (H, W), got {picture.shape}")
    if not ((picture >= 0) & (picture <= 1)).all():
        raise UsageError(f"camera: {name}: wanted values of 0 to 1")
    return picture


def dirt_facts(camera: Camera) -> dict[str, Any]:
    """The masks for metadata and hashes."""
    masks = {name: mask_of(camera, name) for name in ("front_mask", "iris_mask")}
    return {
        f"{name}_sha256": hashlib.sha256(repr(mask.shape).encode() + mask.tobytes()).hexdigest()
        for name, mask in masks.items()
        if mask is not None
    }


def iris_facts(camera: Camera) -> dict[str, Any]:
    """The iris for metadata and hashes."""
    if camera.aperture_image is not None:
        image = np.ascontiguousarray(camera.aperture_image, np.float32)
        return {"aperture_image_sha256": hashlib.sha256(image.tobytes()).hexdigest()}
    return {
        "blades": camera.blades,
        "blade_rotation_deg": camera.blade_rotation,
        "blade_curvature": camera.blade_curvature,
    }
