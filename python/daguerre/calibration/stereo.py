"""Stereo pairs as OpenCV calibrates them: two cameras, and the second's pose from the first.

``R`` and ``T`` of ``cv::stereoCalibrate`` take points of the first camera into the second's frame;
``R1`` and ``R2`` of ``cv::stereoRectify`` turn points of each raw camera onto common rows, where
``P1`` and ``P2`` project them. Lengths have the unit of the board's squares: metres only if these
were given in metres.

Source: OpenCV 5, calib3d, ``stereoCalibrate`` and ``stereoRectify``; samples/cpp/stereo_calib.cpp,
which writes two files, ``intrinsics.yml`` and ``extrinsics.yml``.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.camera.projection import Projection
from daguerre.checks import short
from daguerre.files.json_item import Item
from daguerre.files.reading import exists
from daguerre.files.source import Source

from .calibration import FLIP, Calibration, FloatArray, projection
from .opencv import COUNTS, model_of, size_of
from .source import camera_matrix, first, load, matrix, needed, row

SIDES = ("left", "right")
#: Longest credible baseline, m.
LONGEST_M = 20.0


def is_stereo(root: Item) -> bool:
    """Whether a file is about two cameras."""
    found = first(root, *_matrices(2))
    return found is not None and isinstance(found.value, dict | list)  # K2 may be a coefficient


@guarded
def read_stereo(
    source: Source,
    *,
    model: str | None = None,
    size: tuple[int, int] | None = None,
    rectified: bool = False,
    unit_m: float = 1.0,
) -> dict[str, Calibration]:
    """Reads both cameras of a pair: left, right.

    Args:
        source: YAML, XML or JSON, or the same as a dict. Where it has no R and T, they are read
            from ``extrinsics`` beside it.
        model: opencv or fisheye; None: the file's, else opencv.
        size: Size of the picture, px, if the file does not say it.
        rectified: Read the pictures after rectification, by P1 and P2, not the raw pictures.
        unit_m: Length of the file's unit, m.

    Raises:
        InputError: The file cannot be used; the message names the place.
    """
    root = load(source)
    pixels = size_of(root, size)
    pose = _with_pose(root, source, rectified=rectified)
    made = {}
    for number, name in enumerate(SIDES, 1):
        if rectified:
            one, stands = _rectified(pose, number, pixels, unit_m)
        else:
            one = _raw(root, number, pixels, model)
            stands = np.eye(4) if number == 1 else _second(pose, unit_m)
        notes = _too_far(stands) if number == 2 else ()
        made[name] = Calibration(one, name, FLIP @ stands @ FLIP, notes=notes)
    return made


def _matrices(number: int) -> list[str]:
    names = ("M{}", "K{}", "cameraMatrix{}", "camera_matrix{}", "camera_matrix_{}", "mtx{}")
    return [name.format(number) for name in names]


def _coefficients(number: int) -> list[str]:
    names = ("D{}", "distCoeffs{}", "dist_coeffs{}", "dist_coeffs_{}", "dist{}")
    return [name.format(number) for name in names] + [f"distortion_coefficients{number}"]


def _raw(root: Item, number: int, pixels: tuple[int, int], model: str | None) -> Projection:
    focal, principal = camera_matrix(needed(root, "a camera matrix", *_matrices(number)))
    kind, found = model_of(root, model), first(root, *_coefficients(number))
    counts = (0, 4) if kind == "kannala_brandt" else COUNTS
    values = () if found is None else row(found, counts)
    if not values and kind == "opencv":
        kind = "rectilinear"
    return projection(f"{root.file}: camera {number}", kind, pixels, focal, principal, values)


def _with_pose(root: Item, source: Source, *, rectified: bool) -> Item:
    """File with the pose: this file, or ``extrinsics`` beside it."""
    wanted = ("R1", "R2", "P1", "P2") if rectified else ("R", "T")
    if all(root.get(name) is not None for name in wanted):
        return root
    beside = None
    if isinstance(source, str | os.PathLike):
        beside = Path(source).with_name("extrinsics" + Path(source).suffix)
    if beside is None or not exists(beside):
        where = "" if beside is None else f", here or in {beside}"
        root.fail(f"missing: {', '.join(wanted)}{where}")
    return load(beside)


def _second(pose: Item, unit_m: float) -> FloatArray:
    """Pose of the second raw camera in the first one's frame."""
    turn = rotation(pose.need("R"))
    stands = np.eye(4)
    stands[:3, :3] = turn.T
    stands[:3, 3] = -unit_m * turn.T @ row(pose.need("T"), (3,))
    return stands


def _rectified(
    pose: Item, number: int, pixels: tuple[int, int], unit_m: float
) -> tuple[Projection, FloatArray]:
    """Projection by P, and pose in the frame to which R1 rotates the first camera."""
    turn = rotation(pose.need("R1"))
    rotation(pose.need(f"R{number}"))
    found = rectified_of(pose.need(f"P{number}"))
    where = f"{pose.file}: P{number}"
    made = projection(where, "rectilinear", pixels, found.focal, found.principal, ())
    stands = np.eye(4)
    stands[:3, :3] = turn.T
    stands[:3, 3] = unit_m * turn.T @ found.shift
    return made, stands


class Rectified(NamedTuple):
    """Numbers of a projection matrix P.

    Attributes:
        focal: Focal lengths, px.
        principal: Principal point, px.
        shift: Shift of the camera, right and down, in the unit of P.
    """

    focal: tuple[float, float]
    principal: tuple[float, float]
    shift: tuple[float, float, float]


def rectified_of(item: Item) -> Rectified:
    """Reads a projection matrix P."""
    p = matrix(item, 3, 4)
    if p[0, 1] != 0 or p[1, 0] != 0 or (p[2] != (0, 0, 1, 0)).any() or min(p[0, 0], p[1, 1]) <= 0:
        item.fail(f"wanted [fx 0 cx tx; 0 fy cy ty; 0 0 1 0], got {p.tolist()}")
    away = float(-p[0, 3] / p[0, 0]), float(-p[1, 3] / p[1, 1]), 0.0
    focal, principal = (float(p[0, 0]), float(p[1, 1])), (float(p[0, 2]), float(p[1, 2]))
    return Rectified(focal, principal, away)


def rotation(item: Item) -> FloatArray:
    """Reads a rotation, shape (3, 3)."""
    turn = matrix(item, 3, 3)
    if np.abs(turn @ turn.T - np.eye(3)).max() > 1e-4 or np.linalg.det(turn) < 0:
        item.fail(f"wanted a rotation, got {short(turn.tolist())}")
    return turn


def _too_far(stands: FloatArray) -> tuple[str, ...]:
    baseline = float(np.linalg.norm(stands[:3, 3]))
    if baseline <= LONGEST_M:
        return ()
    return (
        f"the cameras are {baseline:.4g} m apart: lengths are probably in units of the "
        f"calibration board (--calibration-unit, unit_m)",
    )
