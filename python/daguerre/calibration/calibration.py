"""Calibration of a camera: projection, pose in its rig, and further settings of its file."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.camera import shutter
from daguerre.camera.camera import Camera
from daguerre.camera.projection import Projection
from daguerre.checks import number, short
from daguerre.errors import InputError, UsageError
from daguerre.files.value import BriefRecord
from daguerre.setup.pose import mounted

FloatArray = NDArray[np.float64]
#: Conversion between camera frames of calibrations (y down, z ahead) and Daguerre's (y up, z back).
FLIP = np.diag((1.0, -1.0, -1.0, 1.0))
#: Models of pinholes with distortion, and polynomial fisheyes.
WHOLE, FISHEYES = ("opencv", "opencv_inverse"), ("kannala_brandt", "omni")
#: Angle from the axis, degrees, from which on a picture is a circle that may end within the frame.
SIDEWAYS = 90.0
#: Lens parameters that a projection replaces, with the values that unset them.
OF_LENSES: dict[str, Any] = {
    **dict.fromkeys(("lens", "lens_model", "degree", "fit_tolerance", "focal_length", "zoom")),
    **dict.fromkeys(("aperture_diameter", "t_stop", "front_mask", "iris_mask", "ripple")),
    **{"decenter": (), "tilt": (0.0, 0.0), "natural_vignetting": False},
}


@guarded
@dataclass(frozen=True, repr=False)
class Calibration(BriefRecord):
    """Calibration of one camera.

    Attributes:
        projection: Projection model and its parameters.
        name: Name of the camera; empty: none.
        rig_from_camera: Pose of the camera in the frame of the rig's first camera, shape (4, 4), m.
            Both frames are Daguerre's: x right, y up, looking along -z.
        pixel_pitch: Pixel pitch, um; None: not in the file.
        settings: Parameters of ``Camera`` in the file, such as ``f_stop``.
        notes: Notes for the user, a sentence each.
        delay_s: Trigger delay after the rig's first camera, s.
    """

    projection: Projection
    name: str = ""
    rig_from_camera: FloatArray = field(default_factory=lambda: np.eye(4))
    pixel_pitch: float | None = None
    settings: dict[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    delay_s: float = 0.0

    def camera(
        self,
        camera: Camera | None = None,
        pixel_pitch: float | None = None,
        *,
        timeshift: bool = False,
    ) -> Camera:
        """Returns a camera with this calibration.

        Args:
            camera: Camera that provides all other parameters, and the pose of the rig's first
                camera; its lens is replaced. None: a default camera at the origin.
            pixel_pitch: Pixel pitch of the calibrated sensor, um, which sets the size of the film
                and so of blur. None: from the file, else the camera's ``sensor_size``.
            timeshift: Whether the shutter opens ``delay_s`` later.
        """
        given: Any = Camera() if camera is None else camera
        if not isinstance(given, Camera):
            raise UsageError(f"calibration: camera: wanted a Camera or None, got {short(given)}")
        pitch = self.pixel_pitch if pixel_pitch is None else pixel_pitch
        changes: dict[str, Any] = {**OF_LENSES, "projection": self.projection, **self.settings}
        if pitch is not None:
            number(pitch, "camera: pixel_pitch", 0.01, 1e4)
            changes["sensor_size"] = tuple(side * pitch * 1e-3 for side in self.projection.size)
        if "transform" not in changes and not np.array_equal(self.rig_from_camera, np.eye(4)):
            given = mounted(given, self.rig_from_camera)
        made = given.with_(**changes)
        return self._moved(delayed(made, self.delay_s) if timeshift else made)

    def _moved(self, camera: Camera) -> Camera:
        """Returns the camera with this calibration's motion, if any."""
        return camera

    def starting(self, time_s: float) -> Self:
        """Returns the calibration with frame 0 at a time, s; unchanged if it has no frames."""
        return self

    def check(self, frame: int | None, time_s: float, fps: float) -> None:
        """Checks that the calibration is known at a frame; only a :class:`Take` may fail."""


def delayed(camera: Camera, seconds: float) -> Camera:
    """Returns a calibrated camera with a later shutter opening; the delay is in s."""
    if not seconds or camera.projection is None:
        return camera
    opens = shutter.interval(camera, 0.0, camera.projection.size)[0]
    return camera.with_(shutter_offset=(opens + seconds) * camera.fps)


def projection(
    where: str,
    model: str,
    size: tuple[int, int],
    focal: tuple[float, float],
    center: tuple[float, float],
    parameters: tuple[float, ...],
) -> Projection:
    """Makes a projection from a file's values, and checks that it is valid all over its picture.

    Args:
        where: File, and place in it, for messages.
        model: Name of the model.
        size: Width and height, px.
        focal: Focal lengths, px.
        center: Principal point, px.
        parameters: Parameters of the model.

    Raises:
        InputError: The values are invalid, or the model folds within its picture.
    """
    try:
        made = Projection(model, size, focal, center, parameters)
    except UsageError as error:
        raise InputError(f"{where}: {error}") from None
    check_field(made, where)
    return made


def check_field(made: Projection, where: str) -> None:
    """Checks that the polynomial of a model does not fold within the picture.

    Corners may stay dark, so it is checked up to the nearest edge only. A fisheye is not checked if
    it sees 90 degrees and more, as its image circle may then lie within the picture.

    Raises:
        InputError: The model folds within the picture.
    """
    (fx, fy), (width, height), (x, y) = made.focal, made.size, made.center
    fold, angle = made.core.largest_radius * math.sqrt(fx * fy), made.largest_angle
    border = _border(width, height)
    dark = ~np.isfinite(made.unproject(border)).all(axis=1)
    if made.model in WHOLE and dark.any() and not math.isfinite(fold):
        u, v = border[dark][0]
        raise InputError(
            f"{where}: {made.model}: pixel ({u:.4g}, {v:.4g}) sees nothing: the distortion "
            f"folds over within the picture"
        )
    reach = min(x, y, width - 1 - x, height - 1 - y)
    if made.model in WHOLE and dark.any():
        if fold >= reach:
            return
    elif made.model in FISHEYES and math.isfinite(fold):
        last = made.unproject([[x + 0.999 * fold * math.sqrt(fx / fy), y]])[0]
        angle = math.degrees(math.acos(min(max(last[2], -1), 1)))
        if fold >= reach or math.isnan(angle) or angle >= SIDEWAYS:
            return
    else:
        return
    raise InputError(
        f"{where}: {made.model}: the radial polynomial folds at {fold:.4g} px from the principal "
        f"point ({angle:.4g} degrees); it must not fold up to the nearest edge of the picture, "
        f"at {reach:.4g} px"
    )


def field_notes(made: Projection) -> list[str]:
    """Returns notes on values that are valid but may be mistakes, a sentence each."""
    notes = []
    (fx, fy), (width, height), (x, y) = made.focal, made.size, made.center
    ends = np.array([[0, y], [width - 1, y], [x, 0], [x, height - 1]])
    ends = _border(width, height) if made.model in WHOLE else ends
    if made.model in (*WHOLE, *FISHEYES) and not np.isfinite(made.unproject(ends)).all():
        fold = made.core.largest_radius * math.sqrt(fx * fy)
        if math.isfinite(fold):
            notes.append(
                f"its picture is a circle of {fold:.4g} px radius around the principal point"
            )
    away = _from_middle(x / width, y / height)
    if away > 0.1 > 3 * _from_middle(x / height, y / width):
        notes.append(
            f"the principal point is ({x:.4g}, {y:.4g}) in {width} x {height} px, near the middle "
            f"of {height} x {width} px: are width and height swapped?"
        )
    return notes


def _from_middle(x: float, y: float) -> float:
    return max(abs(x - 0.5), abs(y - 0.5))


def _border(width: int, height: int) -> FloatArray:
    """Pixels around the picture, shape (N, 2)."""
    across, along = np.linspace(0, width - 1, 65), np.linspace(0, height - 1, 65)
    sides = [(across, np.full(65, end)) for end in (0, height - 1)]
    sides += [(np.full(65, end), along) for end in (0, width - 1)]
    return np.concatenate([np.stack(side, axis=-1) for side in sides])
