"""Exposure mode of ``daguerre develop``: from its flags, else from the file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.camera.exposure_mode import LIGHT
from daguerre.errors import InputError, UsageError

from .exposure_flags import before_1_0, check_mode

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame

FLAGS = ("exposure", "meter", "ev")


def in_mode(
    frame: Frame, source: Path, used: dict[str, Any], wanted: dict[str, Any]
) -> tuple[Frame, list[str]]:
    """Returns a frame in its mode, with all of its compensation, and notes on its exposure.

    Args:
        frame: The frame.
        source: File of the frame.
        used: Flags of the sensor or film.
        wanted: Flags of development; flags of exposure are taken out.

    Raises:
        UsageError: Flags exclude each other.
        InputError: The frame lacks metadata of its exposure.
    """
    from daguerre.exposure.retaken import retaken

    flags = {name: wanted.pop(name) for name in FLAGS if name in wanted}
    mode = flags.get("exposure")
    _check_flags(mode, flags, used)
    _check_exposure(frame, mode)
    shot = retaken(
        frame, mode, flags.get("meter", "centre"), flags.get("ev", 0.0), used.get("sensor")
    )
    return shot.frame, [*(_mode_notes(frame, source, used) if mode is None else ()), *shot.notes]


def _check_flags(mode: str | None, flags: dict[str, Any], used: dict[str, Any]) -> None:
    """Refuses flags that exclude each other."""
    check_mode(used | flags)
    if mode == "auto" and "stock" in used:
        raise UsageError("--exposure auto chooses the ISO, but film has its own: leave one out")
    if "meter" in flags and mode != "auto":
        raise UsageError("--meter needs --exposure auto: nothing else is metered")


def _check_exposure(frame: Frame, mode: str | None) -> None:
    """Complains of missing metadata before all else."""
    from daguerre.exposure.lux_seconds import in_light, luminance_exposure

    if mode == LIGHT or (mode is None and in_light(frame.metadata)):
        return
    try:
        luminance_exposure(frame.metadata)
    except InputError as error:
        raise InputError(f"{error}; --exposure {LIGHT} needs none") from None


def _mode_notes(frame: Frame, source: Path, used: dict[str, Any]) -> list[str]:
    """Notes on the mode of a file where its picture is another than before version 1.0."""
    from daguerre.exposure.lux_seconds import in_light

    if frame.metadata.get("exposure") is None:
        return [
            f"{source} names no exposure mode: developed as manual; --exposure {LIGHT} shows 1 as "
            "white"
        ]
    if not in_light(frame.metadata):
        return []
    return [before_1_0("--iso" if "iso" in used else "develop")]
