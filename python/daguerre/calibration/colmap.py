"""Reads COLMAP's text models: ``cameras.txt``, and ``images.txt`` with a pose for each picture.

COLMAP has the upper left corner of the picture at (0, 0), so **pixel centres are at halves**,
unlike in most other formats here. Its camera frame is OpenCV's, and a pose maps world points into
it. COLMAP's world is taken as the scene's, so a reconstructed mesh appears as in the pictures.

Source: COLMAP, "Output Format" and src/colmap/sensor/models.h (names and order of parameters).
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from daguerre.camera.projection import Projection
from daguerre.checks import short
from daguerre.doors import guarded
from daguerre.errors import InputError, UsageError, suggest
from daguerre.files.reading import not_utf8, reading, size_of

from .calibration import FLIP, Calibration, FloatArray, projection

#: Largest file; most of ``images.txt`` are points, which are skipped.
MAX_BYTES = 1 << 30
#: Model -> Daguerre's, number of focal lengths, and number of parameters beside the centre.
MODELS = {
    "SIMPLE_PINHOLE": ("rectilinear", 1, 0),
    "PINHOLE": ("rectilinear", 2, 0),
    "SIMPLE_RADIAL": ("opencv", 1, 1),
    "RADIAL": ("opencv", 1, 2),
    "OPENCV": ("opencv", 2, 4),
    "FULL_OPENCV": ("opencv", 2, 8),
    "OPENCV_FISHEYE": ("kannala_brandt", 2, 4),
    "SIMPLE_RADIAL_FISHEYE": ("kannala_brandt", 1, 1),
    "RADIAL_FISHEYE": ("kannala_brandt", 1, 2),
    "FOV": ("fov", 2, 1),
}


def is_colmap(source: object) -> bool:
    """Whether a source is a COLMAP folder, or its file of cameras or images."""
    if not isinstance(source, str | os.PathLike):
        return False
    path = Path(source)
    return path.is_dir() or path.name in ("cameras.txt", "images.txt")


@guarded
def read_colmap(source: str | os.PathLike[str], *, unit_m: float = 1.0) -> dict[str, Calibration]:
    """Reads the pictures of a model by name; without ``images.txt`` the cameras by number.

    Args:
        source: Folder of the model.
        unit_m: Length of the model's unit, m, which COLMAP does not know.

    Raises:
        InputError: A file cannot be used; the message has file and line.
    """
    path = Path(source)
    folder = path if os.path.isdir(path) else path.parent  # noqa: PTH112
    cameras = {}
    for where, words in _lines(folder / "cameras.txt"):
        name, made = _camera(where, words)
        if name in cameras:
            raise InputError(f"{where}: camera {name} appears twice")
        cameras[name] = made
    if not cameras:
        raise InputError(f"{folder / 'cameras.txt'}: no cameras")
    images = folder / "images.txt"
    if not images.exists():
        return {f"camera{name}": Calibration(made) for name, made in cameras.items()}
    found: dict[str, Calibration] = {}
    for where, words in _lines(images, every=2):
        one = _image(where, words, cameras, unit_m)
        if one.name in found:
            raise InputError(f"{where}: picture {short(one.name)} appears twice")
        found[one.name] = one
    if not found:
        raise InputError(f"{images}: no pictures")
    return found


def _lines(path: Path, every: int = 1) -> Iterator[tuple[str, list[str]]]:
    """Yields place and words of every ``every``-th line that is not a comment."""
    size_of(path, MAX_BYTES)
    try:
        with reading(path), path.open(encoding="utf-8") as file:
            count = 0
            for number, line in enumerate(file, 1):
                # An empty line is a picture without points, or the end of the file.
                if line.startswith("#") or (not line.strip() and count % every == 0):
                    continue
                if count % every == 0:
                    yield f"{path}: line {number}", line.split()
                count += 1
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path}: {not_utf8(error)} (COLMAP's .bin files are not supported: export as text)"
        ) from None


def _camera(where: str, words: list[str]) -> tuple[str, Projection]:
    """Parses CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]."""
    if len(words) < 5:
        raise InputError(
            f"{where}: wanted CAMERA_ID MODEL WIDTH HEIGHT PARAMS, got {len(words)} words"
        )
    name, model = words[:2]
    if model not in MODELS:
        raise InputError(
            f"{where}: model: wanted {', '.join(MODELS)}; got {short(model)}"
            f"{suggest(model, MODELS)}"
        )
    ours, focals, more = MODELS[model]
    width, height = (_number(where, word) for word in words[2:4])
    for side in (width, height):
        if not 1 <= side <= 65536 or side != int(side):
            raise InputError(f"{where}: size: wanted whole numbers of 1 .. 65536 px, got {side:g}")
    numbers = [_number(where, word) for word in words[4:]]
    if len(numbers) != focals + 2 + more:
        raise InputError(
            f"{where}: {model}: wanted {focals + 2 + more} parameters, got {len(numbers)}"
        )
    fx, fy = numbers[0], numbers[focals - 1]
    x, y = numbers[focals : focals + 2]
    values = tuple(numbers[focals + 2 :])
    size = int(width), int(height)
    return name, projection(where, ours, size, (fx, fy), (x - 0.5, y - 0.5), values)


def _image(
    where: str, words: list[str], cameras: dict[str, Projection], unit_m: float
) -> Calibration:
    """Parses IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME; names may have blanks."""
    if len(words) < 10:
        raise InputError(
            f"{where}: wanted IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, got {len(words)} words"
        )
    values = np.array([_number(where, word) for word in words[1:8]])
    turn, size = values[:4], float(np.linalg.norm(values[:4]))
    if not abs(size - 1) < 1e-3:
        raise InputError(f"{where}: wanted a quaternion of length 1, got {size:.4g}")
    if words[8] not in cameras:
        raise InputError(f"{where}: wanted a CAMERA_ID of cameras.txt, got {short(words[8])}")
    camera_from_world = np.eye(4)
    camera_from_world[:3, :3] = _rotation(turn / size)
    camera_from_world[:3, 3] = unit_m * values[4:]
    world_from_camera = np.linalg.inv(camera_from_world) @ FLIP
    settings = {"transform": world_from_camera}
    return Calibration(cameras[words[8]], " ".join(words[9:]), settings=settings)


def _rotation(q: FloatArray) -> FloatArray:
    """Matrix of a unit quaternion (w, x, y, z), Hamilton's."""
    w, v = q[0], q[1:]
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.asarray(np.eye(3) + 2 * w * cross + 2 * cross @ cross)


def _number(where: str, word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = np.nan
    if not abs(value) < 1e15:
        raise InputError(f"{where}: wanted a finite number below 1e15 in size, got {short(word)}")
    return value


def check_unit(unit_m: float) -> None:
    """Checks the length of a file's unit, m."""
    if not 1e-9 <= unit_m <= 1e9:
        raise UsageError(f"calibration: unit_m: wanted 1e-9 .. 1e9 m, got {unit_m:g}")
