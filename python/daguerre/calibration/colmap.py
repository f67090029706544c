"""Reads COLMAP's models: ``cameras``, and ``images`` with a pose for each picture, text or binary.

COLMAP has the upper left corner of the picture at (0, 0), so **pixel centres are at halves**,
unlike in most other formats here. Its camera frame is OpenCV's, and a pose maps world points into
it. COLMAP's world is taken as the scene's, so a reconstructed mesh appears as in the pictures.

Source: COLMAP, "Output Format" and src/colmap/sensor/models.h (names and order of parameters).
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from io import TextIOWrapper
from pathlib import Path

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.camera.projection import Projection
from daguerre.checks import short
from daguerre.errors import InputError, UsageError, suggest
from daguerre.files.reading import exists, is_folder, not_utf8, opened, reading, shown

from . import colmap_bin
from .calibration import FLIP, Calibration, projection
from .colmap_rows import MOST, CameraRow, ImageRow
from .source import turned

#: Largest file; most of ``images.txt`` are points, which are skipped.
MAX_BYTES = 1 << 30
_FILES = ("cameras.txt", "images.txt", "cameras.bin", "images.bin")
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
    return is_folder(path) or path.name in _FILES


@guarded
def read_colmap(source: str | os.PathLike[str], *, unit_m: float = 1.0) -> dict[str, Calibration]:
    """Reads the pictures of a model by name; without a file of images the cameras by number.

    Args:
        source: Folder of the model, with ``cameras.txt`` or else ``cameras.bin``; or a file in it.
        unit_m: Length of the model's unit, m, which COLMAP does not know.

    Raises:
        InputError: A file cannot be used; the message has file and line.
    """
    path = Path(source)
    if path.name not in _FILES and not exists(path):
        raise InputError(f"{shown(path)}: no such folder; wanted the folder of a COLMAP model")
    folder = path if os.path.isdir(path) else path.parent  # noqa: PTH112
    suffix = next((s for s in (".txt", ".bin") if exists(folder / f"cameras{s}")), None)
    if suffix is None:
        raise InputError(
            f"{folder / 'cameras.txt'}: no such file; wanted COLMAP's cameras.txt or cameras.bin"
        )
    text = suffix == ".txt"
    cameras: dict[str, Projection] = {}
    listed = folder / f"cameras{suffix}"
    counts = {name: focals + 2 + more for name, (_, focals, more) in MODELS.items()}
    for camera in _cameras_of_text(listed) if text else colmap_bin.cameras(listed, counts):
        if camera.name in cameras:
            raise InputError(f"{camera.where}: camera {camera.name} appears twice")
        cameras[camera.name] = _projection(camera)
    if not cameras:
        raise InputError(f"{listed}: no cameras")
    images = folder / f"images{suffix}"
    if not exists(images):
        return {f"camera{name}": Calibration(made) for name, made in cameras.items()}
    found: dict[str, Calibration] = {}
    for image in _images_of_text(images) if text else colmap_bin.images(images):
        if image.name in found:
            raise InputError(f"{image.where}: picture {short(image.name)} appears twice")
        if image.camera not in cameras:
            raise InputError(
                f"{image.where}: wanted a CAMERA_ID of {listed.name}, got {short(image.camera)}"
            )
        found[image.name] = _calibration(image, cameras[image.camera], unit_m)
    if not found:
        raise InputError(f"{images}: no pictures")
    return found


def _lines(path: Path, every: int = 1) -> Iterator[tuple[str, list[str]]]:
    """Yields place and words of every ``every``-th line that is not a comment."""
    try:
        with opened(path, MAX_BYTES) as data, reading(path):
            file = TextIOWrapper(data, encoding="utf-8")
            count = 0
            for number, line in enumerate(file, 1):
                # An empty line is a picture without points, or the end of the file.
                if line.startswith("#") or (not line.strip() and count % every == 0):
                    continue
                if count % every == 0:
                    yield f"{path}: line {number}", line.split()
                count += 1
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: {not_utf8(error)}") from None


def _cameras_of_text(path: Path) -> Iterator[CameraRow]:
    """Parses CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]."""
    for where, words in _lines(path):
        if len(words) < 5:
            raise InputError(
                f"{where}: wanted CAMERA_ID MODEL WIDTH HEIGHT PARAMS, got {len(words)} words"
            )
        width, height, *numbers = (_number(where, word) for word in words[2:])
        yield CameraRow(where, words[0], words[1], (width, height), numbers)


def _images_of_text(path: Path) -> Iterator[ImageRow]:
    """Parses IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME; names may have blanks."""
    for where, words in _lines(path, every=2):
        if len(words) < 10:
            raise InputError(
                f"{where}: wanted IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, got "
                f"{len(words)} words"
            )
        pose = [_number(where, word) for word in words[1:8]]
        yield ImageRow(where, pose, words[8], " ".join(words[9:]))


def _projection(row: CameraRow) -> Projection:
    where, model = row.where, row.model
    if model not in MODELS:
        raise InputError(
            f"{where}: model: wanted {', '.join(MODELS)}; got {short(model)}"
            f"{suggest(model, MODELS)}"
        )
    ours, focals, more = MODELS[model]
    width, height = row.size
    for side in (width, height):
        if not 1 <= side <= 65536 or side != int(side):
            raise InputError(f"{where}: size: wanted whole numbers of 1 .. 65536 px, got {side:g}")
    numbers = row.numbers
    if len(numbers) != focals + 2 + more:
        raise InputError(
            f"{where}: {model}: wanted {focals + 2 + more} parameters, got {len(numbers)}"
        )
    fx, fy = numbers[0], numbers[focals - 1]
    x, y = numbers[focals : focals + 2]
    values = tuple(numbers[focals + 2 :])
    size = int(width), int(height)
    return projection(where, ours, size, (fx, fy), (x - 0.5, y - 0.5), values)


def _calibration(row: ImageRow, camera: Projection, unit_m: float) -> Calibration:
    where, values = row.where, np.array(row.pose)
    turn, size = values[:4], float(np.linalg.norm(values[:4]))
    if not abs(size - 1) < 1e-3:
        raise InputError(f"{where}: wanted a quaternion of length 1, got {size:.4g}")
    camera_from_world = np.eye(4)
    camera_from_world[:3, :3] = turned(turn / size)
    camera_from_world[:3, 3] = unit_m * values[4:]
    world_from_camera = np.linalg.inv(camera_from_world) @ FLIP
    settings = {"transform": world_from_camera}
    return Calibration(camera, row.name, settings=settings)


def _number(where: str, word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = np.nan
    if not abs(value) < MOST:
        raise InputError(f"{where}: wanted a finite number below 1e15 in size, got {short(word)}")
    return value


def check_unit(unit_m: float) -> None:
    """Checks the length of a file's unit, m."""
    if not 1e-9 <= unit_m <= 1e9:
        raise UsageError(f"calibration: unit_m: wanted 1e-9 .. 1e9 m, got {unit_m:g}")
