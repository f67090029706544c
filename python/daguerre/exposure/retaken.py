"""Frames in another exposure mode than they were taken in."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from daguerre import units
from daguerre.camera.exposure_mode import LIGHT, split_pattern
from daguerre.frame.frame import Frame
from daguerre.sensors.library import load
from daguerre.sensors.sensor import Sensor

from .auto_iso import automatic_iso, iso_limits
from .lux_seconds import compensation_ev, luminance_exposure
from .meter_words import NO_LIGHT, missing, reading
from .metering import luminance_of, wanted_lux_s


@dataclass(frozen=True)
class Retaken:
    """A frame in an exposure mode.

    Attributes:
        frame: The frame; its metadata have the mode, the ISO and the whole compensation.
        notes: Reading and choice of a meter.
    """

    frame: Frame
    notes: list[str] = field(default_factory=list)


def retaken(
    frame: Frame,
    mode: str | None = None,
    pattern: str = "centre",
    ev: float = 0.0,
    sensor: str | Sensor | None = None,
) -> Retaken:
    """Changes the exposure of a frame.

    Args:
        frame: The frame.
        mode: ``light``, ``manual`` or ``auto``; None: the frame's.
        pattern: Metering pattern of the mode ``auto``.
        ev: Compensation that adds to the frame's, EV.
        sensor: Sensor that limits an automatic ISO; None: the frame's.

    Raises:
        UsageError: The spot of a meter is not in the picture.
        InputError: An automatic ISO needs metadata that the frame lacks.
    """
    total = compensation_ev(frame.metadata) + ev
    if mode == "auto":
        return _metered(frame, pattern, total, sensor)
    changes: dict[str, Any] = {"exposure_compensation": total or None} if ev else {}
    if mode is not None:
        changes |= {"exposure": mode, "metering": None}
    return Retaken(_changed(frame, changes) if changes else frame)


def _changed(frame: Frame, changes: dict[str, Any]) -> Frame:
    return replace(frame, metadata={**frame.metadata, **changes})


def _metered(frame: Frame, pattern: str, ev: float, sensor: str | Sensor | None) -> Retaken:
    """Chooses the ISO by a meter, with the compensation folded in."""
    unit = luminance_exposure(frame.metadata)
    luminance = luminance_of(frame, split_pattern(pattern)[0], _spot(pattern))
    if not luminance > 0:
        changes = {"exposure": LIGHT, "metering": None, "exposure_compensation": ev or None}
        return Retaken(_changed(frame, changes), [NO_LIGHT])
    wanted = wanted_lux_s(luminance, ev) / unit
    sensor = sensor or frame.metadata.get("sensor")
    limits = iso_limits(None if sensor is None else load(sensor))
    iso = automatic_iso(wanted, limits)
    own = compensation_ev(frame.metadata)
    words = f"--exposure manual --iso {iso:g}{f' --ev {-own:g}' if own else ''}"
    ends = f"ISO {limits[0]:g} .. {limits[1]:g}"
    left = missing(ends, iso / wanted)
    notes = [reading(pattern, luminance, ev, words), left and f"exposure auto: {left}"]
    changes = {"exposure": "auto", "metering": pattern, "isoSpeed": iso}
    changed = _changed(frame, {**changes, "exposure_compensation": None})
    return Retaken(changed, [text for text in notes if text])


def _spot(pattern: str) -> tuple[float, float] | None:
    """Centre of the pixel that a pattern names; None: the middle of the picture."""
    _, place = split_pattern(pattern)
    if not place:
        return None
    x, y = units.numbers("--meter spot", place, 2, "480,270, as a frame has no nodes")
    return x + 0.5, y + 0.5
