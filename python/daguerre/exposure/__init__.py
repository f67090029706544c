"""Exposure of pictures: lux seconds of a frame, electrons of a sensor, metering."""

from __future__ import annotations

from daguerre.camera.exposure import (
    check_exposure,
    exposure_facts,
    exposure_metadata,
    exposure_notes,
    ideal_h0,
    lens_h0,
    without_exposure,
)

from .lux_seconds import (
    display_gain,
    exposure_of_one,
    frame_iso,
    in_light,
    luminance_exposure,
    pinhole_note,
    with_exposure,
)

__all__ = [
    "check_exposure",
    "display_gain",
    "exposure_facts",
    "exposure_metadata",
    "exposure_notes",
    "exposure_of_one",
    "frame_iso",
    "ideal_h0",
    "in_light",
    "lens_h0",
    "luminance_exposure",
    "pinhole_note",
    "with_exposure",
    "without_exposure",
]
