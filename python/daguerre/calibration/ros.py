"""ROS ``camera_info``: the YAML of ``camera_info_manager``, and messages as they are echoed.

Cameras draw the raw picture, by K and D, or the rectified picture, by P. R and P have the pose of
the camera in a stereo rig. The conventions are OpenCV's.

Source: sensor_msgs/CameraInfo (also for regions and binning), and REP 104.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.errors import InputError
from daguerre.files.json_item import Item
from daguerre.files.source import Source

from .calibration import FLIP, Calibration, FloatArray, projection
from .opencv import COUNTS, coefficients, matrix_of
from .source import camera_matrix, choice, first, load, matrix, needed, row
from .stereo import rectified_of, rotation

Pair = tuple[float, float]
PROJECTION = ("projection_matrix", "P", "p")
OFFSETS, SIDES = ("x_offset", "y_offset"), ("width", "height")

COEFFICIENTS = ("distortion_coefficients", "D", "d")
#: Largest number of coefficients of plumb_bob.
_MOST_OF_PLUMB_BOB = 5
#: Name -> Daguerre's model, and allowed numbers of coefficients.
MODELS = {
    "plumb_bob": ("opencv", COUNTS),
    "rational_polynomial": ("opencv", COUNTS),
    "equidistant": ("kannala_brandt", (4,)),
    "fisheye": ("kannala_brandt", (4,)),
}


@guarded
def read_ros(source: Source, *, rectified: bool = False) -> Calibration:
    """Reads a ``camera_info``.

    Args:
        source: YAML or JSON file, or its values as a dict.
        rectified: Whether to read the rectified camera, by P, not the raw camera, by K and D.

    Raises:
        InputError: The file cannot be used; the message has the place in it.
    """
    root = load(source)
    root = root.get("msg") or root  # rosbridge puts a message into an envelope
    sides = [
        needed(root, "the size of the picture", *names).integer(1, 65536)
        for names in (("image_width", "width"), ("image_height", "height"))
    ]
    model, focal, principal, values = _rectified(root) if rectified else _raw(root)
    size, focal, principal, notes = _read_out(root, sides, focal, principal, whole=rectified)
    made = projection(root.file, model, size, focal, principal, values)
    name = root.get("camera_name")
    stands = _rig_from_camera(root, rectified=rectified)
    if not rectified:
        notes += _length_notes(root, len(values))
    return Calibration(made, "" if name is None else name.text(), stands, notes=notes)


class _Intrinsics(NamedTuple):
    """Intrinsics of a picture, px, before region of interest and binning."""

    model: str
    focal: Pair
    principal: Pair
    parameters: tuple[float, ...]


def _raw(root: Item) -> _Intrinsics:
    """Reads the intrinsics of the raw picture."""
    focal, principal = camera_matrix(needed(root, "a camera matrix", "camera_matrix", "K", "k"))
    named = choice(needed(root, "a model", "distortion_model"), MODELS)
    model, counts = MODELS[named]
    found = needed(root, "coefficients", *COEFFICIENTS)
    # Some drivers write a shape that does not fit the numbers.
    data = found.need("data") if isinstance(found.value, dict) else found
    values = row(data, counts)
    return _Intrinsics(model if values else "rectilinear", focal, principal, values)


def _length_notes(root: Item, count: int) -> tuple[str, ...]:
    """Notes on coefficients where the model or the shape has another number of them."""
    notes = []
    if root.need("distortion_model").value == "plumb_bob" and count > _MOST_OF_PLUMB_BOB:
        notes.append(f"plumb_bob has {count} coefficients: they are read as rational_polynomial")
    found = needed(root, "coefficients", *COEFFICIENTS)
    if isinstance(found.value, dict):
        shape = [found.need(name).integer(0, 4096) for name in ("rows", "cols")]
        if shape[0] * shape[1] != count:
            notes.append(
                f"{found.key}: {shape[0]} x {shape[1]} by its rows and cols, with {count} numbers: "
                "all numbers count"
            )
    return tuple(notes)


def _rectified(root: Item) -> _Intrinsics:
    """Reads the intrinsics of the rectified picture."""
    found = rectified_of(needed(root, "a projection matrix", *PROJECTION))
    return _Intrinsics("rectilinear", found.focal, found.principal, ())


def _read_out(
    root: Item, sides: list[int], focal: Pair, principal: Pair, *, whole: bool
) -> tuple[tuple[int, int], Pair, Pair, tuple[str, ...]]:
    """Size and intrinsics of the picture after region of interest and binning; K and P are before.

    The region is cut first, then blocks of b x b pixels are averaged to single pixels, with centres
    (b - 1) / 2 beyond the centres of the first pixels of their blocks. (``image_geometry`` only
    scales K and lacks this offset.)
    """
    corner, size = [0, 0], [*sides]
    roi = root.get("roi")
    if roi is not None:
        corner = [_or_0(roi, name, n - 1) for name, n in zip(OFFSETS, sides, strict=True)]
        given = [_or_0(roi, name, n) for name, n in zip(SIDES, sides, strict=True)]
        size = [a or n - c for a, n, c in zip(given, sides, corner, strict=True)]
        if any(c + a > n for c, a, n in zip(corner, size, sides, strict=True)):
            ends = " and ".join(f"{c} .. {c + a}" for c, a in zip(corner, size, strict=True))
            roi.fail(f"wanted a region within {sides[0]} x {sides[1]}, got columns and rows {ends}")
        if whole and size != sides:
            roi.fail("a rectified camera must not have a region of interest")
    bins = [max(_or_0(root, name, 1024), 1) for name in ("binning_x", "binning_y")]
    pixels = [a // b for a, b in zip(size, bins, strict=True)]
    if min(pixels) < 1:
        root.fail(f"binning: wanted at most the size of the picture, got {bins[0]} x {bins[1]}")
    notes: tuple[str, ...] = ()
    if bins != [1, 1]:
        notes = (f"{bins[0]} x {bins[1]} pixels are binned: give the pixel pitch after binning",)
    zoomed = [f / b for f, b in zip(focal, bins, strict=True)]
    moved = [(p - c - (b - 1) / 2) / b for p, c, b in zip(principal, corner, bins, strict=True)]
    return (pixels[0], pixels[1]), (zoomed[0], zoomed[1]), (moved[0], moved[1]), notes


def _or_0(item: Item, name: str, most: int) -> int:
    found = item.get(name)
    return 0 if found is None else found.integer(0, most)


def _rig_from_camera(root: Item, *, rectified: bool) -> FloatArray:
    """Pose of the camera in the rig; the rig's frame is the first camera's after rectification.

    A point X of the raw camera is R X in it, and P's last column is -fx times the shift to the
    right.
    """
    rig = np.eye(4)
    turn = first(root, "rectification_matrix", "R", "r")
    if turn is not None and not rectified:
        rig[:3, :3] = rotation(turn)
    ahead = first(root, *PROJECTION)
    if ahead is not None and matrix(ahead, 3, 4).any():  # all 0: not calibrated
        rig[:3, 3] = rectified_of(ahead)[2]
    return np.asarray(FLIP @ rig @ FLIP)


def write_ros(calibration: Calibration) -> str:
    """Formats YAML for ``camera_info_manager``, for a single camera: R is the identity."""
    made = calibration.projection
    if not np.array_equal(calibration.rig_from_camera, np.eye(4)):
        raise InputError("calibration: ROS: the rig_from_camera of the camera must be the identity")
    values = coefficients(made, (4,) if made.model == "kannala_brandt" else (5, 8, 12, 14))
    name = "plumb_bob" if len(values) == 5 else "rational_polynomial"
    if made.model == "kannala_brandt":
        name = "equidistant"
    k = matrix_of(made)
    p = [*k[:3], 0.0, *k[3:6], 0.0, *k[6:], 0.0]
    lines = [f"image_width: {made.size[0]}", f"image_height: {made.size[1]}"]
    lines += [f"camera_name: {_quoted(calibration.name or 'camera')}", *_matrix("camera", 3, k)]
    lines += [f"distortion_model: {name}", "distortion_coefficients:", "  rows: 1"]
    lines += [f"  cols: {len(values)}", f"  data: {_list(values)}"]
    lines += _matrix("rectification", 3, np.eye(3).ravel().tolist())
    lines += _matrix("projection", 3, p)
    return "\n".join(lines) + "\n"


def _matrix(name: str, rows: int, values: list[float]) -> list[str]:
    columns = len(values) // rows
    return [f"{name}_matrix:", f"  rows: {rows}", f"  cols: {columns}", f"  data: {_list(values)}"]


def _list(values: tuple[float, ...] | list[float]) -> str:
    return "[" + ", ".join(repr(float(value)) for value in values) + "]"


def _quoted(text: str) -> str:
    """Quotes a name in YAML's single quotes, in which only the quote itself is special."""
    return "'" + text.replace("'", "''") + "'"
