"""Iris of any kind of lens: blades, curvature, rotation, or an image."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.camera.camera import Camera
from daguerre.errors import UsageError, core_errors


def iris_of(camera: Camera) -> _core.Iris:
    """Makes the shape of the iris: round, blades, or a picture."""
    if camera.aperture_image is not None:
        try:
            picture = np.asarray(camera.aperture_image, np.float32)
        except (TypeError, ValueError) as error:
            raise UsageError(f"camera: {error}") from None
        if picture.ndim != 2:
            raise UsageError(f"camera: aperture_image: wanted shape (H, W), got {picture.shape}")
        with core_errors(UsageError, "camera"):
            return _core.Iris.image(np.ascontiguousarray(picture))
    if camera.blades:
        with core_errors(UsageError, "camera"):
            return _core.Iris.polygon(camera.blades, camera.blade_rotation, camera.blade_curvature)
    return _core.Iris()


def mask_of(camera: Camera, name: str) -> NDArray[np.float32] | None:
    """Checks ``front_mask`` or ``iris_mask``; None: clean."""
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
    """Masks for metadata and hashes."""
    masks = {name: mask_of(camera, name) for name in ("front_mask", "iris_mask")}
    return {
        f"{name}_sha256": hashlib.sha256(repr(mask.shape).encode() + mask.tobytes()).hexdigest()
        for name, mask in masks.items()
        if mask is not None
    }


def iris_facts(camera: Camera) -> dict[str, Any]:
    """Iris for metadata and hashes."""
    if camera.aperture_image is not None:
        image = np.ascontiguousarray(camera.aperture_image, np.float32)
        return {"aperture_image_sha256": hashlib.sha256(image.tobytes()).hexdigest()}
    return {
        "blades": camera.blades,
        "blade_rotation_deg": camera.blade_rotation,
        "blade_curvature": camera.blade_curvature,
    }
