"""ROS ``camera_info``: the YAML of ``camera_info_manager``, and messages as they are echoed.

What is drawn is the raw picture, by K and D. R and P say where the camera stands in a stereo rig.
The conventions are OpenCV's.

Source: sensor_msgs/CameraInfo, and REP 104.
"""

from __future__ import annotations

import numpy as np

from daguerre.errors import InputError
from daguerre.io.json_item import Item

from .calibration import FLIP, Calibration, FloatArray, projection
from .opencv import coefficients, matrix_of
from .source import Source, camera_matrix, choice, first, load, matrix, needed, row

#: Name -> our model, and how many coefficients there may be.
MODELS = {
    "plumb_bob": ("opencv", (0, 4, 5)),
    "rational_polynomial": ("opencv", (8, 12, 14)),
    "equidistant": ("kannala_brandt", (4,)),
}


def read_ros(source: Source) -> Calibration:
    """A ``camera_info``.

    Args:
        source: YAML, or the same as a dict.

    Raises:
        InputError: The file cannot be used; the message names the place.
    """
    root = load(source)
    sides = [
        needed(root, "the size of the picture", *names).integer(1, 65536)
        for names in (("image_width", "width"), ("image_height", "height"))
    ]
    focal, principal = camera_matrix(needed(root, "a camera matrix", "camera_matrix", "K", "k"))
    named = choice(needed(root, "a model", "distortion_model"), MODELS)
    model, counts = MODELS[named]
    values = row(needed(root, "coefficients", "distortion_coefficients", "D", "d"), counts)
    _check_whole(root)
    made = projection(
        root.file, model if values else "rectilinear", tuple(sides), focal, principal, values
    )
    name = root.get("camera_name")
    return Calibration(made, "" if name is None else name.text(), _rig_from_camera(root))


def _check_whole(root: Item) -> None:
    """K and D are about the whole sensor; of a part or of summed pixels they say little."""
    for name in ("binning_x", "binning_y"):
        found = root.get(name)
        if found is not None and found.integer() > 1:
            found.fail(f"wanted a picture without binning (0 or 1), got {found.value}")
    roi = root.get("roi")
    for name in ("x_offset", "y_offset"):
        found = None if roi is None else roi.get(name)
        if found is not None and found.integer() > 0:
            found.fail(f"wanted the whole picture (0), got {found.value}")


def _rig_from_camera(root: Item) -> FloatArray:
    """The rig's frame is that of the first camera after rectification.

    A point X of the raw camera is R X there, and P's last column is -fx times the way to the right.
    """
    rig = np.eye(4)
    turn = first(root, "rectification_matrix", "R", "r")
    if turn is not None:
        rig[:3, :3] = matrix(turn, 3, 3)
        if not np.allclose(rig[:3, :3] @ rig[:3, :3].T, np.eye(3), atol=1e-4):
            turn.fail("wanted a rotation")
    ahead = first(root, "projection_matrix", "P", "p")
    if ahead is not None:
        p = matrix(ahead, 3, 4)
        if p[0, 0] > 0 and p[1, 1] > 0:  # all 0 where nothing is calibrated
            rig[:2, 3] = -p[0, 3] / p[0, 0], -p[1, 3] / p[1, 1]
    return np.asarray(FLIP @ rig @ FLIP)


def write_ros(calibration: Calibration) -> str:
    """YAML as ``camera_info_manager`` reads it, of a camera on its own: R is the identity."""
    made = calibration.projection
    if not np.array_equal(calibration.rig_from_camera, np.eye(4)):
        raise InputError("calibration: ROS: wanted a camera that is not part of a rig")
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
    """A name in YAML's single quotes, in which only they themselves are special."""
    return "'" + text.replace("'", "''") + "'"
