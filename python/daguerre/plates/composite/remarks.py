"""Notes on parts of a composite that do not fit together or are missing."""

from __future__ import annotations

from pathlib import Path

from daguerre.frame.frame import Frame
from daguerre.plates.match.plate_camera import PlateCamera
from daguerre.plates.photograph import Photograph


def of_plate(plate: Photograph, camera: PlateCamera | None) -> list[str]:
    """Returns notes on the plate, and on a camera that was matched to another plate."""
    notes = [f"{plate.path}: {note}" for note in plate.notes]
    if camera is not None and camera.sha256 != plate.sha256():
        notes.append(f"{plate.path}: the camera was matched to another file, {camera.plate}")
    return notes


def of_camera(camera: PlateCamera | None) -> list[str]:
    """Returns a note if objects get no grain."""
    if camera is None or camera.noise is not None or camera.sensor is not None:
        return []
    return [f"no noise was measured in {camera.plate}: objects get no grain"]


def of_objects(frame: Frame, path: Path) -> list[str]:
    """Returns notes on converted colours, and if the render covers the whole plate."""
    notes = [f"{path}: {note}" for note in frame.metadata.get("notes", [])]
    if not bool((frame.alpha >= 1).all()):
        return notes
    return [
        *notes,
        f"{path}: alpha is missing or 1 everywhere, so the render covers the whole plate",
    ]
