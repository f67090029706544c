"""Calibrations as OpenCV's ``FileStorage`` has them: YAML, XML and JSON.

The names are from OpenCV's calibration sample, and as people write them by hand. Pixel centres are
at integers; the distortion maps ideal points to points of the picture; p1 belongs to y.

Source: OpenCV 5, samples/cpp/tutorial_code/calib3d/camera_calibration, and ``cv::calibrateCamera``
and ``cv::fisheye::calibrate`` for the order of the coefficients.
"""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

from daguerre.argument_checks import guarded
from daguerre.camera.projection import Projection
from daguerre.errors import InputError, UsageError, suggest
from daguerre.files.json_item import Item
from daguerre.files.source import Source

from .calibration import Calibration, projection
from .source import agreed, camera_matrix, choice, first, load, needed, row

MATRICES = ("camera_matrix", "cameraMatrix", "K", "mtx", "M1")
COEFFICIENTS = (
    *("distortion_coefficients", "dist_coeffs", "dist_coeff", "distCoeffs", "distortion_coeffs"),
    *("D", "dist", "D1"),
)
SIZES = ("image_size", "imageSize", "img_size", "resolution", "size")
#: Names of fewer letters are too similar to others to be checked for typing errors.
SHORT = 5
#: Allowed numbers of coefficients.
COUNTS = (0, 4, 5, 8, 12, 14)
#: Names of models in files -> Daguerre's.
MODELS = {
    **dict.fromkeys(("opencv", "pinhole", "plumb_bob", "radtan", "rational_polynomial"), "opencv"),
    **dict.fromkeys(("fisheye", "equidistant", "kannala_brandt"), "kannala_brandt"),
}


@guarded
def read_opencv(
    source: Source, *, model: str | None = None, size: tuple[int, int] | None = None
) -> Calibration:
    """Reads an OpenCV calibration.

    Args:
        source: YAML, XML or JSON file of ``cv::FileStorage``, or its values as a dict.
        model: ``opencv`` or ``fisheye``; None: from the file, else opencv.
        size: Width and height of the picture, px, if the file does not have them.

    Raises:
        InputError: The file cannot be used; the message has the place in it.
        UsageError: The model is unknown.
    """
    root = load(source)
    where = root.file
    focal, principal = camera_matrix(needed(root, "a camera matrix", *MATRICES))
    kind = model_of(root, model)
    found = first(root, *COEFFICIENTS)
    values: tuple[float, ...] = ()
    if found is None:
        _check_spelling(root)
    else:
        values = row(found, (0, 4) if kind == "kannala_brandt" else COUNTS)
    if not values and kind == "opencv":
        kind = "rectilinear"
    made = projection(where, kind, size_of(root, size), focal, principal, values)
    name = root.get("camera_name")
    return Calibration(made, "" if name is None else name.text())


def _check_spelling(root: Item) -> None:
    """Checks for misspelt names, which would silently give a camera without distortion."""
    for item in root.members():
        name = str(item.key)
        near = [one for one in COEFFICIENTS if len(one) > SHORT]
        if len(name) > SHORT and get_close_matches(name, near, cutoff=0.8):
            item.fail(f"unknown name: wanted {COEFFICIENTS[0]} or none{suggest(name, near)}")


def model_of(root: Item, model: str | None = None) -> str:
    """Requested model, else the file's: by name, or by the flag of OpenCV's sample."""
    if model is not None:
        if model not in MODELS:
            raise UsageError(
                f"calibration: model: wanted opencv or fisheye, got {model!r}"
                f"{suggest(model, MODELS)}"
            )
        return MODELS[model]
    named = first(root, "distortion_model", "camera_model")
    if named is not None:
        return MODELS[choice(named, MODELS)]
    flag = first(root, "fisheye_model", "fisheye")
    return "kannala_brandt" if flag is not None and flag.value in (1, True) else "opencv"


def size_of(root: Item, given: tuple[int, int] | None) -> tuple[int, int]:
    """Size of the picture, px, from the file, else the given size."""
    return agreed(root, "image_width and image_height", _size(root), given)


def _size(root: Item) -> tuple[int, int] | None:
    width, height = first(root, "image_width", "width"), first(root, "image_height", "height")
    if width is not None and height is not None:
        return width.integer(1, 65536), height.integer(1, 65536)
    both = first(root, *SIZES)
    if both is None:
        return None
    across, down = row(both, (2,))
    if not (1 <= across == int(across) and 1 <= down == int(down)):
        both.fail(f"wanted two whole numbers of pixels, got {across:g}, {down:g}")
    return int(across), int(down)


def coefficients(made: Projection, counts: Sequence[int]) -> tuple[float, ...]:
    """Returns the coefficients of a model that OpenCV has, padded with zeros.

    Args:
        made: Projection: opencv, rectilinear or kannala_brandt.
        counts: Allowed numbers of coefficients, ascending.
    """
    if made.model not in ("opencv", "rectilinear", "kannala_brandt"):
        raise InputError(
            "calibration: wanted rectilinear, opencv or kannala_brandt for OpenCV or ROS, got "
            f"{made.model}"
        )
    used = list(made.parameters)
    while used and used[-1] == 0:
        used.pop()
    count = next((count for count in counts if count >= len(used)), None)
    if count is None:
        raise InputError(
            f"calibration: wanted at most {counts[-1]} coefficients in this format, got {len(used)}"
        )
    return (*used, *[0.0] * (count - len(used)))


def matrix_of(made: Projection) -> list[float]:
    """Camera matrix, row by row."""
    (fx, fy), (cx, cy) = made.focal, made.center
    return [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0]


def write_opencv(calibration: Calibration) -> str:
    """Formats YAML that ``cv::FileStorage`` of all versions reads."""
    made = calibration.projection
    fisheye = made.model == "kannala_brandt"
    values = coefficients(made, (4,) if fisheye else (5, 8, 12, 14))
    width, height = made.size
    lines = ["%YAML:1.0", "---", f"image_width: {width}", f"image_height: {height}"]
    lines += [f"fisheye_model: {int(fisheye)}"]
    lines += _matrix("camera_matrix", 3, 3, matrix_of(made))
    lines += _matrix("distortion_coefficients", 1, len(values), values)
    return "\n".join(lines) + "\n"


def _matrix(name: str, rows: int, columns: int, values: Sequence[float]) -> list[str]:
    data = ", ".join(repr(float(value)) for value in values)
    return [
        f"{name}: !!opencv-matrix",
        f"   rows: {rows}",
        f"   cols: {columns}",
        "   dt: d",
        f"   data: [ {data} ]",
    ]
