"""Remarks on what is put together: parts that do not go together, and what is missing."""

from __future__ import annotations

from pathlib import Path

from daguerre.frame.frame import Frame
from daguerre.plates.match.plate_camera import PlateCamera
from daguerre.plates.photograph import Photograph


def of_plate(plate: Photograph, camera: PlateCamera | None) -> list[str]:
    """Tells what was left out of the plate, and whether the matched camera is another's."""
    notes = [f"{plate.path}: {note}" for note in plate.notes]
    if camera is not None and camera.sha256 != plate.sha256():
        notes.append(f"{plate.path}: the matched camera is that of {camera.plate}, another file")
    return notes


def of_camera(camera: PlateCamera | None) -> list[str]:
    """Tells what objects cannot get."""
    if camera is None or camera.noise is not None or camera.sensor is not None:
        return []
    return [f"no noise was measured in {camera.plate}: objects get no grain"]


def of_objects(frame: Frame, path: Path) -> list[str]:
    """Tells that a picture covers the whole plate."""
    if not bool((frame.alpha >= 1).all()):
        return []
    return [f"{path}: has no alpha, or 1 everywhere: it covers the whole plate"]
