"""Shutters: when each line of pixels is exposed.

Times are in seconds. ``shutter_time`` is the exposure of one point of the film, from first to last
light; a shutter that scans takes longer for the whole frame. docs/motion.md explains the types and
the sources of the default times.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

import daguerre._core as _core
from daguerre.checks import number, short
from daguerre.errors import UsageError, core_errors, suggest

from .parameters import CAMERA, SHUTTER
from .rolling_shutter import RollingShutter
from .settled import settled

if TYPE_CHECKING:
    from .camera import Camera

SCAN_ORDERS = ("top", "bottom", "left", "right")
#: Travel time of focal-plane curtains, slightly less than a fast camera's flash sync time.
CURTAIN_S = 1 / 300
#: Read-out time of a full-frame sensor of a video camera.
READOUT_S = 1 / 60
#: Angle that the gate spans on the rotating disc, degrees.
GATE_ANGLE = 60.0
#: Efficiency of a leaf shutter: it moves for as long as it rests wide open (radius).
LEAF_EFFICIENCY = 0.75


def shutter_time(camera: Camera) -> float:
    """Exposure time of a point of the film, s."""
    if camera.shutter_time is not None:
        return float(camera.shutter_time)
    angle = CAMERA["shutter_angle"].usual if camera.shutter_angle is None else camera.shutter_angle
    return float(angle / 360 / camera.fps)


def core_shutter(camera: Camera, resolution: tuple[int, int]) -> _core.Shutter:
    """Makes the core's shutter for a frame of this size.

    Raises:
        UsageError: A parameter is wrong, or does not go with another.
    """
    check(camera)
    order, line_time = scan(camera, resolution)
    with core_errors(UsageError, "camera"):
        return _core.Shutter(
            shutter_time(camera), _curve(camera), order, line_time, _is_leaf(camera), resolution
        )


def interval(camera: Camera, time: float, resolution: tuple[int, int]) -> tuple[float, float]:
    """Interval from first light on the first line to last light on the last, s of scene time.

    It is centred on ``time`` unless ``shutter_offset`` is given.

    Raises:
        UsageError: The shutter is wrong, see ``core_shutter``; or the time is no number, or too
            large for double precision to hold the exposure.
    """
    camera = settled(camera, number(time, "scene: time"))
    duration = core_shutter(camera, resolution).duration_s
    begin = time - duration / 2
    if camera.shutter_offset is not None:
        begin = time + camera.shutter_offset / camera.fps
    end = begin + duration
    if abs(end - begin - duration) > 0.01 * duration:
        raise UsageError(
            f"scene: time: {time:g} s is too large for an exposure of {duration:g} s in double "
            f"precision"
        )
    return begin, end


def facts(camera: Camera, resolution: tuple[int, int]) -> dict[str, Any]:
    """Resolved shutter as JSON values, for metadata and hashes."""
    order, line_time = scan(camera, resolution)
    begin, end = interval(camera, 0.0, resolution)
    return {
        "type": type_of(camera),
        "time_s": shutter_time(camera),
        "opens_s": begin,
        "closes_s": end,
        "curve": [list(point) for point in _curve(camera).nodes],
        "fps": camera.fps,
        **({} if order == "none" else {"scan_order": order, "line_time_s": line_time}),
    }


def metadata(camera: Camera) -> dict[str, Any]:
    """Metadata by names of EXR attributes; the shutter angle only if the exposure fits a frame."""
    time = shutter_time(camera)
    angle = 360 * time * camera.fps
    fits = angle <= 360
    return {
        "expTime": time,
        "shutterAngle": angle if fits else None,
        "captureRate": camera.fps if fits else None,
    }


def type_of(camera: Camera) -> str:
    """Shutter type: the one given, else electronic with a rolling shutter, else box."""
    return camera.shutter_type or ("box" if camera.rolling_shutter is None else "electronic")


def check(camera: Camera) -> None:
    """Checks the shutter parameters, and that they do not exclude each other."""
    SHUTTER.check(camera, "camera")
    given = {row.name for row in SHUTTER if getattr(camera, row.name) is not None}
    SHUTTER.refuse_rivals(given, "camera")
    kind = camera.shutter_type
    if kind == "rotary" and shutter_time(camera) > 1 / camera.fps:
        raise UsageError(
            f"camera: shutter_type rotary: wanted at most {1 / camera.fps:g} s at "
            f"{camera.fps:g} frames per second, got {shutter_time(camera):g} s"
        )
    _check_rolling(camera)
    _curve(camera)


def _check_rolling(camera: Camera) -> None:
    rolling = camera.rolling_shutter
    if rolling is None:
        return
    where = "camera: rolling_shutter"
    if not isinstance(rolling, RollingShutter):
        raise UsageError(f"{where}: wanted a RollingShutter, got {short(rolling)}")
    if camera.shutter_type in ("box", "leaf"):
        raise UsageError(
            f"{where}: a {camera.shutter_type} shutter exposes all lines at once; "
            "wanted focal_plane, rotary or electronic"
        )
    order: object = rolling.scan_order
    if not isinstance(order, str) or order not in SCAN_ORDERS:
        raise UsageError(
            f"{where}: scan_order: wanted {', '.join(SCAN_ORDERS)}, got {short(order)}"
            f"{suggest(short(order), SCAN_ORDERS)}"
        )
    if (rolling.line_time is None) == (rolling.readout_time is None):
        got = "none" if rolling.line_time is None else "both"
        raise UsageError(f"{where}: wanted either line_time or readout_time, got {got}")
    for name in ("line_time", "readout_time"):
        value = getattr(rolling, name)
        if value is not None:
            CAMERA["shutter_time"].check(value, f"{where}: {name}")


def scan(camera: Camera, resolution: tuple[int, int]) -> tuple[str, float]:
    """Scan order (none: all lines at once), and the time from one line to the next, s."""
    usual = {
        # Curtains fall, and the picture on the film is upside down.
        "focal_plane": RollingShutter("bottom", readout_time=CURTAIN_S),
        "rotary": RollingShutter("left", readout_time=GATE_ANGLE / 360 / camera.fps),
        "electronic": RollingShutter("top", readout_time=READOUT_S),
    }
    rolling = camera.rolling_shutter or usual.get(type_of(camera))
    if rolling is None:
        return "none", 0.0
    lines = resolution[1 if rolling.scan_order in ("top", "bottom") else 0]
    if rolling.line_time is not None:
        return rolling.scan_order, float(rolling.line_time)
    return rolling.scan_order, float(rolling.readout_time or 0.0) / lines


def _is_leaf(camera: Camera) -> bool:
    return type_of(camera) == "leaf"


def _curve(camera: Camera) -> _core.OpeningCurve:
    curve: Any = camera.shutter_curve
    if curve is None:
        curve = ("trapezoid", LEAF_EFFICIENCY) if _is_leaf(camera) else "box"
    where = "camera: shutter_curve"
    wanted = "box, ('trapezoid', efficiency) or points [(fraction of the time, opening), ...]"
    if isinstance(curve, str):
        if curve == "box":
            return _core.OpeningCurve()
        hint = "; it takes its efficiency: ('trapezoid', 0.8)" if curve == "trapezoid" else ""
        raise UsageError(
            f"{where}: wanted {wanted}, got {curve!r}{hint or suggest(curve, ('box', 'trapezoid'))}"
        )
    if isinstance(curve, tuple) and len(curve) == 2 and isinstance(curve[0], str):
        if curve[0] != "trapezoid":
            raise UsageError(f"{where}: wanted {wanted}, got {curve!r}")
        efficiency = number(curve[1], f"{where}: efficiency", 0.5, 1)
        return _core.OpeningCurve.trapezoid(efficiency)
    return _points(curve, where, wanted)


def _points(curve: object, where: str, wanted: str) -> _core.OpeningCurve:
    try:
        points = np.array(curve, np.float64)
    except (TypeError, ValueError):
        raise UsageError(f"{where}: wanted {wanted}, got {short(curve)}") from None
    if points.ndim != 2 or points.shape[1] != 2:
        raise UsageError(f"{where}: wanted {wanted}, got {short(curve)}")
    with core_errors(UsageError, "camera"):
        return _core.OpeningCurve.points(
            np.ascontiguousarray(points[:, 0]), np.ascontiguousarray(points[:, 1])
        )


def seconds(time: float) -> str:
    """Time as photographers write it, such as ``1/48 s`` or ``2 s``."""
    return f"1/{1 / time:.4g} s" if 0 < time < 0.5 else f"{time:.4g} s"


def describe(camera: Camera, resolution: tuple[int, int]) -> str:
    """Describes the shutter in one line, such as ``1/48 s, 180 deg at 24 fps, box``."""
    time, kind = shutter_time(camera), type_of(camera)
    if time == 0:
        parts = ["0 s (frozen)"]
    else:
        parts = [seconds(time)]
        if time * camera.fps <= 1:
            parts.append(f"{360 * time * camera.fps:.4g} deg at {camera.fps:.4g} fps")
    parts.append(kind)
    order, _ = scan(camera, resolution)
    if order != "none":
        whole = core_shutter(camera, resolution).duration_s
        parts.append(f"from the {order}, {whole * 1e3:.4g} ms in all")
    efficiency = _curve(camera).mean
    if not math.isclose(efficiency, 1):
        what = "mean radius" if kind == "leaf" else "efficiency"
        parts.append(f"{what} {efficiency:.3g}")
    return ", ".join(parts)
