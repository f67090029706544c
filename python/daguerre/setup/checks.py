"""Checks of camera parameters: their ranges, and whether the lens model supports them."""

from __future__ import annotations

import math
from collections.abc import Sized
from functools import lru_cache
from pathlib import Path

import numpy as np

from daguerre import lenses
from daguerre.camera import shutter
from daguerre.camera.camera import Camera
from daguerre.camera.exposure import check_exposure
from daguerre.camera.ideal import IDEAL
from daguerre.camera.parameters import CAMERA, OPTICS
from daguerre.camera.parameters.needs import LENS_ITSELF, TRACED
from daguerre.checks import short
from daguerre.errors import UsageError
from daguerre.parameters.parameter import Parameter

#: Trait of a camera's lens, without and with a prescription.
PRESCRIBED = ("ideal", "prescription")


def check_surfaces(model: str, where: str) -> None:
    """Checks that the lens model has surfaces.

    Raises:
        UsageError: It has none.
    """
    if model not in TRACED:
        raise UsageError(
            f"{where}: wanted a lens with surfaces, such as double-gauss-50mm-f2 "
            f"(lens_model {' or '.join(TRACED)}), got {model}"
        )


def lens_and_model(camera: Camera) -> tuple[lenses.Lens | None, str]:
    """Returns the prescription, if any, and the model: one of ``MODELS``, or ``projection``."""
    if camera.projection is not None:
        return None, _projection(camera)
    model = camera.lens_model
    CAMERA["lens_model"].check(model, "camera: lens_model")
    if camera.lens is None or (isinstance(camera.lens, str) and camera.lens in IDEAL):
        kind = str(camera.lens or "thin")
        if model in (*TRACED, "thick"):
            raise UsageError(
                f"camera: lens_model: {model} needs a lens with a prescription: set lens to a name "
                "of the library or a lens file"
            )
        return None, model or kind
    if not isinstance(camera.lens, lenses.Lens | str | Path):
        raise UsageError(
            f"camera: lens: wanted a name, a file, a Lens or None, got {short(camera.lens)}"
        )
    return prescription_of(camera), model or "exact"


def prescription_of(camera: Camera) -> lenses.Lens:
    """Loads the lens of a camera with a prescription."""
    from daguerre.lenses.dispersion import without_dispersion
    from daguerre.lenses.library import FOLDER, path_of

    lens = camera.lens or ""
    if not isinstance(lens, lenses.Lens):
        path = path_of(lens, IDEAL)
        lens = _of_library(path) if path.parent == FOLDER else lenses.read(path)
    return lens if camera.dispersion else without_dispersion(lens)


@lru_cache(8)
def _of_library(path: Path) -> lenses.Lens:
    """Reads a lens of the library once: a session of a viewfinder begins at each turn."""
    return lenses.read(path)


def _projection(camera: Camera) -> str:
    """Checks a projection, which replaces a lens."""
    from daguerre.camera.projection import Projection

    if not isinstance(camera.projection, Projection):
        raise UsageError(f"camera: projection: wanted a Projection, got {short(camera.projection)}")
    for row in CAMERA:
        if LENS_ITSELF in row.needs and is_given(camera, row):
            way_out = f"; {row.name}=None removes it" if row.default is None else ""
            raise UsageError(f"camera: wanted either projection or {row.name}, got both{way_out}")
    return "projection"


def is_given(camera: Camera, row: Parameter) -> bool:
    """Whether the camera has a value other than the default, or one over time."""
    value = getattr(camera, row.name)
    if row.name in camera.motion:
        return True
    if row.default is not None:
        return not np.array_equal(value, row.default)
    return value is not None and not (isinstance(value, Sized) and len(value) == 0)


def check(camera: Camera, model: str, *, prescription: bool) -> None:
    """Checks the ranges of values, and that the lens model supports them.

    Args:
        camera: Camera at one moment.
        model: One of ``MODELS``, or projection.
        prescription: Whether its lens has a prescription.

    Raises:
        UsageError: The message names the parameter.
    """
    OPTICS.check(camera, "camera")
    shutter.check(camera)
    check_exposure(camera)
    traits = {model} if model == "projection" else {model, PRESCRIBED[prescription]}
    for row in CAMERA:
        if row.needs and is_given(camera, row):
            for need in row.needs:
                need.check(traits, model, f"camera: {row.name}")
    given = {row.name for row in CAMERA if getattr(camera, row.name) is not None}
    CAMERA.refuse_rivals(given, "camera")
    _check_together(camera, model)


def _check_together(camera: Camera, model: str) -> None:
    """Refuses combinations of values that are valid by themselves."""
    most = CAMERA["tilt"].high
    if math.hypot(*camera.tilt) > most:
        raise UsageError(f"camera: tilt: wanted at most {most:g} degrees, got {camera.tilt}")
    if model in TRACED and camera.aperture_image is not None and camera.shutter_type == "leaf":
        raise UsageError(
            "camera: shutter_type leaf: wanted blades for the iris of an exact lens, "
            "got an aperture_image"
        )
    if camera.blades and camera.aperture_image is not None:
        raise UsageError("camera: wanted either blades or aperture_image, got both")
