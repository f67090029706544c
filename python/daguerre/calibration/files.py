"""Reads and writes calibration files of any format."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from daguerre.camera.camera import Camera
from daguerre.checks import short
from daguerre.doors import guarded
from daguerre.errors import UsageError, suggest
from daguerre.files.numbered import has_place
from daguerre.files.source import Source
from daguerre.io.export_camera import export_camera

from . import colmap, kalibr, opencv, opentrackio, ros, stereo, track, transforms
from .calibration import Calibration
from .source import load
from .take import Take, take_of

FORMATS = ("opencv", "ros", "kalibr", "opentrackio", "colmap", "transforms")
WRITTEN = (*FORMATS[:4], "usd")


def format_of(source: Source) -> str:
    """Format of a file, recognized by the names in it."""
    if colmap.is_colmap(source):
        return "colmap"
    if track.is_take(source):
        return "opentrackio"
    names = set(load(source).value)
    if "cam0" in names:
        return "kalibr"
    if {"static", "lens"} <= names or "protocol" in names:
        return "opentrackio"
    if "frames" in names:
        return "transforms"
    if "msg" in names or "distortion_model" in names:
        return "ros"
    return "ros" if {"rectification_matrix", "projection_matrix"} & names else "opencv"


@guarded(but=("source",))
def read(
    source: Source,
    camera: str | None = None,
    *,
    format: str | None = None,
    model: str | None = None,
    size: tuple[int, int] | None = None,
    rectified: bool = False,
    unit_m: float = 1.0,
) -> Calibration:
    """Reads one camera of a calibration file.

    Args:
        source: File, or the same as a dict; for COLMAP the folder.
        camera: Which of several, such as ``cam1``; None: the first. Of pictures with poses also a
            name with # for a number, ``IMG_####.jpg``: a camera that moves, with frame n as it
            was in the picture of that number.
        format: One of ``FORMATS``; None: recognized by the names in the file.
        model: Model of OpenCV's files: opencv or fisheye; None: the file's, else opencv.
        size: Size of the picture, px, where the file does not say it.
        rectified: Whether to read the picture after rectification, in ROS files and OpenCV's stereo
            pairs.
        unit_m: Length of the file's unit, m, in formats that do not say it: OpenCV's stereo
            pairs, COLMAP, ``transforms.json``.

    Raises:
        InputError: The file cannot be used; the message names the place.
        UsageError: There is no such camera or format.
    """
    where = "calibration" if isinstance(source, dict) else str(source)
    options: dict[str, Any] = {"format": format, "model": model, "size": size}
    found = read_all(source, **options, rectified=rectified, unit_m=unit_m)
    return pick(found, camera, where)


@guarded(but=("source",))
def read_all(
    source: Source,
    *,
    format: str | None = None,
    model: str | None = None,
    size: tuple[int, int] | None = None,
    rectified: bool = False,
    unit_m: float = 1.0,
) -> dict[str, Calibration]:
    """Reads all cameras of a calibration file, by name; a single camera has the file's name.

    Args: those of :func:`read`.
    """
    kind = format_of(source) if format is None else _format(format, FORMATS)
    pair = kind == "opencv" and stereo.is_stereo(load(source))
    colmap.check_unit(unit_m)
    where = "calibration" if isinstance(source, dict) else str(source)
    if rectified and not (pair or kind == "ros"):
        raise UsageError(f"{where}: rectified: wanted ROS or an OpenCV stereo pair, got {kind}")
    if unit_m != 1 and not (pair or kind in ("colmap", "transforms")):
        raise UsageError(
            f"{where}: unit: wanted COLMAP, transforms.json or an OpenCV stereo pair, got {kind}"
        )
    if model is not None and kind != "opencv":
        raise UsageError(f"{where}: model: {kind} takes none, got {model!r}")
    if size is not None and kind in ("kalibr", "ros", "colmap"):
        raise UsageError(f"{where}: size: {kind} takes none, got {short(size)}")
    if kind == "kalibr":
        return kalibr.read_kalibr(source)
    if kind == "colmap":
        if isinstance(source, dict):
            raise UsageError("calibration: colmap: wanted a folder, got a dict")
        return colmap.read_colmap(source, unit_m=unit_m)
    if kind == "transforms":
        return transforms.read_transforms(source, size=size, unit_m=unit_m)
    if pair:
        return stereo.read_stereo(
            source, model=model, size=size, rectified=rectified, unit_m=unit_m
        )
    if kind == "ros":
        found = ros.read_ros(source, rectified=rectified)
    elif kind == "opentrackio" and track.is_take(source):
        found = track.read_take(source, size=size)
    elif kind == "opentrackio":
        found = opentrackio.read_opentrackio(source, size=size)
    else:
        found = opencv.read_opencv(source, model=model, size=size)
    return {Path(source).stem if isinstance(source, str | os.PathLike) else "camera": found}


@guarded
def pick(cameras: dict[str, Calibration], name: str | None, where: str) -> Calibration:
    """Picks one of several cameras; None: the first; with # in the name a take of numbered ones.

    Raises:
        UsageError: The name is unknown; the message suggests the nearest.
    """
    wanted = next(iter(cameras)) if name is None else name
    if wanted not in cameras and has_place(wanted):
        return take_of(cameras, wanted, where)
    if wanted not in cameras:
        known = ", ".join(map(str, cameras))
        raise UsageError(
            f"{where}: wanted {known}; got {short(wanted)}{suggest(wanted, map(str, cameras))}"
        )
    return cameras[wanted]


@guarded
def write(path: str | Path, calibration: Calibration | Sequence[Calibration], format: str) -> None:
    """Writes a calibration file, as a whole or not at all.

    Args:
        path: The file.
        calibration: One calibration; for Kalibr's chains and USD also several, in order.
        format: One of ``WRITTEN``.

    Raises:
        InputError: The format does not have this model.
        OutputError: The file cannot be written.
    """
    from daguerre.files.atomic import write_bytes

    kind = _format(format, WRITTEN)
    several = [calibration] if isinstance(calibration, Calibration) else list(calibration)
    if any(isinstance(one, Take) for one in several):
        raise UsageError(f"calibration: {kind}: wanted a single calibration, got a take")
    if kind == "usd":
        export_camera(_named(several), path)
        return
    if kind == "kalibr":
        text = kalibr.write_kalibr(several)
    elif len(several) != 1:
        raise UsageError(f"calibration: {kind}: wanted one camera, got {len(several)}")
    else:
        texts: dict[str, Callable[[Calibration], str]] = {
            "opencv": opencv.write_opencv,
            "ros": ros.write_ros,
            "opentrackio": opentrackio.write_opentrackio,
        }
        text = texts[kind](several[0])
    write_bytes(path, text.encode())


def _named(several: Sequence[Calibration]) -> dict[str, Camera]:
    """Cameras by name, at their places in the rig."""
    return {one.name or f"cam{i}": one.camera() for i, one in enumerate(several)}


def _format(name: str, known: tuple[str, ...]) -> str:
    if name not in known:
        raise UsageError(
            f"calibration: format: wanted {', '.join(known)}; got {name!r}"
            f"{suggest(str(name), known)}"
        )
    return name
