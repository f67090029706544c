"""OpenTrackIO samples (SMPTE RIS OSVP): a tracked camera of a stage at a moment.

Lengths of the lens are mm, distances m. OpenLensIO's coefficients belong to points of the sensor in
mm from the centre, y down; its list alternates coefficients of the numerator and the denominator of
the rational polynomial. The name of the model has the direction: ``Brown-Conrady D-U``, the
default, takes distorted points to undistorted points; ``U-D`` is OpenCV's direction.

Offsets are from the middle of the sensor, (W - 1) / 2 in calibrations' pixels.

SMPTE's note on OpenCV differs from OpenLensIO's equations, which are used here, in two places: it
has the middle at W / 2, half a pixel off, and tangential terms p / F^2, though a coefficient for
points in mm is p / F for a coefficient p in focal lengths.

Sources: OpenLensIO 1.0.1, equations 4 and 17; the schema of OpenTrackIO 1.0 for units, axes and the
order of rotations; "Conversion of OpenCV to OpenTrackIO (OpenLensIO) lens calibration parameters".
"""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.errors import InputError
from daguerre.files.json_item import Item, short
from daguerre.files.source import Source

from .calibration import Calibration, FloatArray, projection
from .source import agreed, choice, load

DISTORTED_TO_IDEAL, IDEAL_TO_DISTORTED = "Brown-Conrady D-U", "Brown-Conrady U-D"
#: Rotation from OpenTrackIO's world (x right, y ahead, z up) to Daguerre's (y up, z toward viewer).
UPRIGHT = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
MODELS = {DISTORTED_TO_IDEAL: "opencv_inverse", IDEAL_TO_DISTORTED: "opencv"}


@guarded
def read_opentrackio(source: Source, *, size: tuple[int, int] | None = None) -> Calibration:
    """Reads the camera of a sample.

    Args:
        source: JSON file, or its values as a dict.
        size: Width and height of the picture, px, if the sample has no ``activeSensorResolution``.

    Raises:
        InputError: The file cannot be used; the message has the place in it.
    """
    root = load(source)
    lens = root.need("lens")
    still = root.need("static").need("camera")
    sensor = still.need("activeSensorPhysicalDimensions")
    film = sensor.need("width").number(above=0), sensor.need("height").number(above=0)
    pixels = agreed(still, "activeSensorResolution", _resolution(still), size)
    named = "pinholeFocalLength" if lens.get("focalLength") is None else "focalLength"
    focal = lens.need(named).number(above=0)
    across, down = pixels[0] / film[0], pixels[1] / film[1]  # px per mm
    offset = _offset(lens, "projectionOffset")
    moved = lens.get("distortionOffset")
    if moved is not None and any(_offset(lens, "distortionOffset")):
        moved.fail("must be (0, 0), the centre of the projection")
    model, values = _distortion(lens, focal)
    center = (pixels[0] - 1) / 2 + offset[0] * across, (pixels[1] - 1) / 2 + offset[1] * down
    made = projection(root.file, model, pixels, (focal * across, focal * down), center, values)
    settings = _settings(lens) | _pose(root, lens)
    return Calibration(made, "", np.eye(4), 1e3 / across, settings)


def _resolution(still: Item) -> tuple[int, int] | None:
    found = still.get("activeSensorResolution")
    if found is None:
        return None
    return found.need("width").integer(1, 65536), found.need("height").integer(1, 65536)


def _offset(lens: Item, name: str) -> tuple[float, float]:
    found = lens.get(name)
    if found is None:
        return 0.0, 0.0
    return found.need("x").number(), found.need("y").number()


def _distortion(lens: Item, focal: float) -> tuple[str, tuple[float, ...]]:
    """Daguerre's model and its parameters."""
    listed = lens.list_of("distortion")
    if not listed:
        return "rectilinear", ()
    known = {_direction(item): item for item in reversed(listed)}
    named = IDEAL_TO_DISTORTED if IDEAL_TO_DISTORTED in known else DISTORTED_TO_IDEAL
    return MODELS[named], _coefficients(known[named], focal)


def _direction(item: Item) -> str:
    named = item.get("model")
    if named is None:
        return DISTORTED_TO_IDEAL
    return choice(named, (DISTORTED_TO_IDEAL, IDEAL_TO_DISTORTED))


def _coefficients(item: Item, focal: float) -> tuple[float, ...]:
    """Coefficients in units of the focal length, in OpenCV's order: k1 k2 p1 p2 k3 k4 k5 k6.

    Odd elements of the list (the first is 1) belong to the numerator.
    """
    listed = [one.number() for one in item.need("radial")]
    if not 1 <= len(listed) <= 6:
        item.need("radial").fail(f"wrong length: wanted 1 to 6 numbers, got {len(listed)}")
    listed += [0.0] * (6 - len(listed))
    over = [listed[2 * i] * focal ** (2 * i + 2) for i in range(3)]
    under = [listed[2 * i + 1] * focal ** (2 * i + 2) for i in range(3)]
    aside = item.get("tangential")
    p1, p2 = (0.0, 0.0) if aside is None else aside.numbers(2)
    return (*over[:2], p1 * focal, p2 * focal, over[2], *under)


def _settings(lens: Item) -> dict[str, Any]:
    found = {"f_stop": lens.get("fStop"), "focus_distance": lens.get("focusDistance")}
    return {name: item.number(above=0) for name, item in found.items() if item is not None}


def _pose(root: Item, lens: Item) -> dict[str, Any]:
    """World from camera; the camera is at its entrance pupil."""
    listed = root.list_of("transforms")
    if not listed:
        return {}
    stage = np.eye(4)
    for item in listed:
        stage = stage @ _transform(item)
    world = UPRIGHT @ stage @ UPRIGHT.T
    ahead = lens.number_of("entrancePupilOffset", 0.0)
    world[:3, 3] -= ahead * world[:3, 2]
    return {"transform": world}


def _transform(item: Item) -> FloatArray:
    """Pose from pan (about z), tilt (turned x), then roll (turned y), degrees, and shift, m."""
    scale = item.get("scale")
    if scale is not None and any(scale.number_of(axis, 1.0) != 1 for axis in "xyz"):
        scale.fail(f"wanted x, y and z of 1, got {short(scale.value)}")
    turn, shift = item.need("rotation"), item.need("translation")
    made = np.eye(4)
    made[:3, 3] = [shift.number_of(axis, 0.0) for axis in "xyz"]
    angles = (math.radians(turn.number_of(name, 0.0)) for name in ("pan", "tilt", "roll"))
    for axis, angle in zip((2, 0, 1), angles, strict=True):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        one = np.eye(3)
        one[i, i] = one[j, j] = math.cos(angle)
        one[j, i] = math.sin(angle)
        one[i, j] = -one[j, i]
        made[:3, :3] = made[:3, :3] @ one
    return made


def write_opentrackio(calibration: Calibration) -> str:
    """Formats a sample with only the lens, as JSON; the distortion keeps the model's direction.

    Raises:
        InputError: OpenLensIO does not have the model, or there is no pixel pitch.
    """
    made, pitch = calibration.projection, calibration.pixel_pitch
    if pitch is None:
        raise InputError("calibration: OpenTrackIO: lengths in mm need a pixel pitch")
    values = (*made.parameters, *[0.0] * 14)[:14]
    named = next((name for name, model in MODELS.items() if model == made.model), None)
    if (named is None and made.model != "rectilinear") or any(values[8:]):
        raise InputError(
            "calibration: OpenTrackIO: wanted rectilinear, or opencv or opencv_inverse without "
            f"prism and tilt; got {made.model} with {len(made.parameters)} parameters"
        )
    focal = made.focal[0] * pitch * 1e-3
    down = pitch * 1e-3 * made.focal[0] / made.focal[1]  # mm: one focal length serves both axes
    k1, k2, p1, p2, k3, k4, k5, k6 = values[:8]
    alternating = ((k1, 2), (k4, 2), (k2, 4), (k5, 4), (k3, 6), (k6, 6))
    radial = [k / focal**power for k, power in alternating]
    (width, height), (x, y) = made.size, made.center
    lens: dict[str, Any] = {
        "pinholeFocalLength": focal,
        "projectionOffset": {
            "x": (x - (width - 1) / 2) * pitch * 1e-3,
            "y": (y - (height - 1) / 2) * down,
        },
    }
    if any(values):
        bent = {"model": named, "radial": radial}
        lens["distortion"] = [bent | {"tangential": [p1 / focal, p2 / focal]}]
    still = {
        "activeSensorPhysicalDimensions": {"width": width * pitch * 1e-3, "height": height * down},
        "activeSensorResolution": {"width": width, "height": height},
    }
    head = {"protocol": {"name": "OpenTrackIO", "version": [1, 0, 0]}}
    return json.dumps({**head, "static": {"camera": still}, "lens": lens}, indent=2) + "\n"
