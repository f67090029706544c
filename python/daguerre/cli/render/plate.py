"""``--like-plate``: a camera matched to a photograph, and flags that override it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.camera.exposure_mode import CHOICES, chosen_by
from daguerre.camera.ideal import IDEAL
from daguerre.camera.parameters import CAMERA
from daguerre.cli import console
from daguerre.errors import UsageError

if TYPE_CHECKING:
    from daguerre.plates.match.plate_camera import PlateCamera

#: Parameters of a plate's camera that a given parameter overrides, too.
_WITH = {
    "lens": ("lens", "zoom", "focal_length", "exposure_f_stop"),
    "focal_length": ("lens", "zoom"),
    "f_stop": ("exposure_f_stop",),
    "sensor": ("sensor", "sensor_size", "responsivity"),
}


def read_plate(path: Path | None) -> PlateCamera | None:
    """Reads the camera file of the flag, if given, and prints notes on missing data."""
    if path is None:
        return None
    from daguerre.plates.composite.remarks import of_camera
    from daguerre.plates.match.reader import read_plate_camera

    plate = read_plate_camera(path)
    for text in of_camera(plate):
        console.note(text)
    return plate


def over_plate(
    plate: PlateCamera | None, given: dict[str, Any], *, calibrated: bool
) -> dict[str, Any]:
    """Parameters of the camera: the plate's, overridden by given parameters.

    Args:
        plate: The matched camera; None: no plate.
        given: Parameters from flags.
        calibrated: Whether a calibration replaces the lens.

    Raises:
        UsageError: A given exposure mode chooses a value that the plate sets.
    """
    if plate is None:
        return given
    found = plate.changes()
    dropped = {name for group in CAMERA.rivals() if set(group) & set(given) for name in group}
    dropped |= {name for each in given for name in _WITH.get(each, ())}
    if given.get("lens") in IDEAL and plate.focal_length is not None:
        found["focal_length"] = plate.focal_length
        dropped.discard("focal_length")
    if calibrated:
        dropped |= {name for name in found if not CAMERA[name].takes("projection")}
    kept = {name: value for name, value in found.items() if name not in dropped | given.keys()}
    _check_mode(given.get("exposure", ""), kept)
    return kept | given


def _check_mode(exposure: str, kept: dict[str, Any]) -> None:
    mode = exposure
    if any(name in kept for name in chosen_by(mode)):
        raise UsageError(
            f"--exposure {mode} and --like-plate: wanted one of them, got both; the plate sets "
            f"{CHOICES[mode]}"
        )
