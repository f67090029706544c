"""Reads and writes calibration files of any format."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.checks import short
from daguerre.errors import UsageError, suggest
from daguerre.exporters.export_camera import export_camera
from daguerre.files.numbered import has_place
from daguerre.files.source import Source

from . import (
    basalt,
    bop,
    camodocal,
    colmap,
    euroc,
    foreign,
    kalibr,
    kitti,
    opencv,
    opentrackio,
    ros,
    stereo,
    track,
    transforms,
)
from .calibration import Calibration
from .source import load
from .take import Take, take_of

FORMATS = (
    *("opencv", "ros", "kalibr", "opentrackio", "colmap", "transforms"),
    *("euroc", "camodocal", "basalt", "bop", "kitti"),
)
WRITTEN = (*FORMATS[:4], "usd")
#: Readers of formats that take no options.
_PLAIN: dict[str, Callable[[Source], dict[str, Calibration]]] = {
    "kalibr": kalibr.read_kalibr,
    "euroc": euroc.read_euroc,
    "camodocal": camodocal.read_camodocal,
    "basalt": basalt.read_basalt,
    "bop": bop.read_bop,
}


def format_of(source: Source) -> str:
    """Format of a file, recognized by the names in it.

    Raises:
        InputError: The format is unknown; the message names the known formats.
    """
    if colmap.is_colmap(source):
        return "colmap"
    foreign.refuse(source)
    if kitti.is_kitti(source):
        return "kitti"
    if track.is_take(source):
        return "opentrackio"
    root = load(source)
    names = set(root.value)
    if "cam0" in names:
        return "kalibr"
    if "T_BS" in names or {"camera_model", "intrinsics"} <= names:
        return "euroc"
    if "model_type" in names:
        return "camodocal"
    if "value0" in names or {"T_imu_cam", "intrinsics"} <= names:
        return "basalt"
    if set(bop.NAMES) <= names:
        return "bop"
    if {"static", "lens"} <= names or "protocol" in names:
        return "opentrackio"
    if "frames" in names:
        return "transforms"
    if "msg" in names or "distortion_model" in names:
        return "ros"
    if {"rectification_matrix", "projection_matrix"} & names:
        return "ros"
    if not stereo.is_stereo(root) and not names & set(opencv.MATRICES):
        wanted = f"missing: a camera matrix ({' or '.join(opencv.MATRICES)})"
        root.fail(f"{wanted}; {foreign.READ}")
    return "opencv"


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

    Args: as for :func:`read`.
    """
    kind = format_of(source) if format is None else _format(format, FORMATS)
    pair = kind == "opencv" and stereo.is_stereo(load(source))
    colmap.check_unit(unit_m)
    where = "calibration" if isinstance(source, dict) else str(source)
    if rectified and not (pair or kind in ("ros", "kitti")):
        raise UsageError(
            f"{where}: rectified: wanted ROS, KITTI or an OpenCV stereo pair, got {kind}"
        )
    if unit_m != 1 and not (pair or kind in ("colmap", "transforms")):
        raise UsageError(
            f"{where}: unit: wanted COLMAP, transforms.json or an OpenCV stereo pair, got {kind}"
        )
    if model is not None and kind != "opencv":
        raise UsageError(f"{where}: model: {kind} takes none, got {model!r}")
    if size is not None and kind in ("ros", "colmap", *_PLAIN):
        raise UsageError(f"{where}: size: {kind} takes none, got {short(size)}")
    if kind in _PLAIN:
        return _one_named_by_its_file(_PLAIN[kind](source), source)
    if kind == "kitti":
        return kitti.read_kitti(source, size=size, rectified=rectified)
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
    return _one_named_by_its_file({"camera": found}, source)


def _one_named_by_its_file(found: dict[str, Calibration], source: Source) -> dict[str, Calibration]:
    """Names a single camera without a name by its file."""
    if list(found) != ["camera"] or not isinstance(source, str | os.PathLike):
        return found
    return {Path(source).stem: found["camera"]}


@guarded
def pick(cameras: dict[str, Calibration], name: str | None, where: str) -> Calibration:
    """Picks a camera by name; None: the first; with # in the name, a take of numbered cameras.

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
