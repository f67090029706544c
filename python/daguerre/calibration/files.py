"""Calibration files of any format."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from daguerre.errors import UsageError, suggest

from . import kalibr, opencv, opentrackio, ros
from .calibration import Calibration
from .source import Source, load

FORMATS = ("opencv", "ros", "kalibr", "opentrackio")


def format_of(source: Source) -> str:
    """Which format a file has, by the names in it."""
    names = set(load(source).value)
    if "cam0" in names:
        return "kalibr"
    if {"static", "lens"} <= names or "protocol" in names:
        return "opentrackio"
    if "distortion_model" in names or {"rectification_matrix", "projection_matrix"} & names:
        return "ros"
    return "opencv"


def read(
    source: Source,
    camera: str | None = None,
    *,
    format: str | None = None,
    size: tuple[int, int] | None = None,
) -> Calibration:
    """One camera of a calibration file.

    Args:
        source: File, or the same as a dict.
        camera: Which of several, such as ``cam1``; None: the first.
        format: One of ``FORMATS``; None: as the names in the file tell.
        size: Of the picture, px, where the file does not say it.

    Raises:
        InputError: The file cannot be used; the message names the place.
        UsageError: There is no such camera or format.
    """
    where = "calibration" if isinstance(source, dict) else str(source)
    return pick(read_all(source, format=format, size=size), camera, where)


def read_all(
    source: Source, *, format: str | None = None, size: tuple[int, int] | None = None
) -> dict[str, Calibration]:
    """All cameras of a calibration file, by name; the only one of a file has the file's own.

    Args: as of :func:`read`.
    """
    kind = format_of(source) if format is None else _format(format)
    if kind == "kalibr":
        return kalibr.read_kalibr(source)
    if kind == "ros":
        found = ros.read_ros(source)
    elif kind == "opentrackio":
        found = opentrackio.read_opentrackio(source, size=size)
    else:
        found = opencv.read_opencv(source, size=size)
    return {"camera" if isinstance(source, dict) else Path(source).stem: found}


def pick(cameras: dict[str, Calibration], name: str | None, where: str) -> Calibration:
    """One of several; without a name the first.

    Raises:
        UsageError: There is none of that name; the nearest is suggested.
    """
    wanted = next(iter(cameras)) if name is None else name
    if wanted not in cameras:
        known = ", ".join(cameras)
        raise UsageError(f"{where}: wanted {known}; got {wanted!r}{suggest(wanted, cameras)}")
    return cameras[wanted]


def write(path: str | Path, calibration: Calibration | Sequence[Calibration], format: str) -> None:
    """Writes a calibration file, as a whole or not at all.

    Args:
        path: The file.
        calibration: Of Kalibr's chains also several, in order.
        format: One of ``FORMATS``.

    Raises:
        InputError: The format does not have this model.
        OutputError: The file cannot be written.
    """
    from daguerre.io.atomic import write_bytes

    kind = _format(format)
    several = [calibration] if isinstance(calibration, Calibration) else list(calibration)
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


def _format(name: str) -> str:
    if name not in FORMATS:
        raise UsageError(
            f"calibration: format: wanted {', '.join(FORMATS)}; got {name!r}"
            f"{suggest(str(name), FORMATS)}"
        )
    return name
