"""Flags of a calibration that stands in the place of a lens.

Annotations must be real objects here (see ``flags.py``), so no ``annotations`` future.
"""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

from . import quantities as q
from .flags import Text, option

_CAMERA = "Camera"
#: Parameters of lenses, and their flags.
_OF_LENSES = {
    **{name: "--" + name.replace("_", "-") for name in ("lens", "lens_model", "degree", "zoom")},
    **{name: "--" + name.replace("_", "-") for name in ("fit_tolerance", "focal_length", "t_stop")},
    **{name: "--" + name.replace("_", "-") for name in ("aperture_diameter", "decenter", "tilt")},
    **{name: "--" + name.replace("_", "-") for name in ("natural_vignetting", "ripple", "shift")},
}


@dataclass(frozen=True)
class CalibrationFlags:
    """A camera that is known by its calibration."""

    calibration: Annotated[
        Text,
        option(
            "--calibration",
            metavar="FILE[:cam0]",
            help="Instead of a lens: OpenCV, ROS, Kalibr (with the name of a camera), OpenTrackIO.",
            panel=_CAMERA,
        ),
    ] = None
    pixel_pitch: Annotated[
        Text,
        option(
            "--pixel-pitch",
            metavar="UM",
            help="Of the calibrated sensor, um: blur by --f-stop depends on it [by --sensor].",
            panel=_CAMERA,
        ),
    ] = None

    @cached_property
    def found(self) -> Any:
        """The calibration, read once; None without the flag."""
        from daguerre.calibration import read
        from daguerre.errors import UsageError

        if self.calibration is None:
            if self.pixel_pitch is not None:
                raise UsageError("--pixel-pitch: wanted --calibration too")
            return None
        file, _, name = self.calibration.rpartition(":")
        if not file or "/" in name or Path(self.calibration).exists():
            file, name = self.calibration, ""
        return read(file, name or None)

    def resolution(self, res: str | None, default: tuple[int, int]) -> tuple[int, int]:
        """Of the picture, px: the calibrated one's, unless ``--res`` says another."""
        size = default if self.found is None else self.found.projection.size
        return q.resolution("--res", res, size) if res else size

    def check(self, changes: dict[str, Any]) -> None:
        """A calibration takes the place of a lens.

        Raises:
            UsageError: Both are given; the message names the flags.
        """
        from daguerre.errors import UsageError

        if self.found is None:
            return
        both = [flag for name, flag in _OF_LENSES.items() if name in changes]
        if self.pixel_pitch is not None and {"sensor", "sensor_size"} & set(changes):
            raise UsageError("--pixel-pitch and --sensor: wanted one of them, got both")
        if both:
            raise UsageError(f"--calibration and {both[0]}: wanted one of them, got both")

    def camera(self, camera: Any, changes: dict[str, Any]) -> Any:
        """The scene's camera, calibrated and changed."""
        if self.found is not None:
            pitch = self.pixel_pitch
            um = None if pitch is None else q.pitch_um("--pixel-pitch", pitch)
            camera = self.found.camera(camera, um)
        return camera.with_(**changes)

    def notes(self, camera: Any) -> list[str]:
        """What was decided, a sentence each."""
        if self.found is None:
            return []
        notes = list(self.found.notes)
        if camera.f_stop is not None and self.pixel_pitch is None and not self.found.pixel_pitch:
            notes.append(
                f"no --pixel-pitch: blur is that of a sensor {camera.sensor_size[0]:g} mm wide"
            )
        return notes
