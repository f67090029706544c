"""A camera in a photographer's terms.

Units are the ones read on the object: mm for lens and sensor, m for distances, s for time, degrees
for angles.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .errors import UsageError, suggest

if TYPE_CHECKING:
    from .lenses import Lens


#: lenses without a prescription
IDEAL = ("thin", "pinhole")


#: smallest and largest values, far beyond any camera: what lies outside is a mistake, and single
#: precision would overflow on the way
LIMITS = {
    "focal_length": (1e-3, 1e6),  # mm
    "f_stop": (1e-2, 1e9),
    "aperture_diameter": (1e-9, 1e6),  # mm
    "sensor_size": (1e-3, 1e5),  # mm
    "focus_distance": (1e-6, 1e12),  # m, or infinite
    "shift": (-1e5, 1e5),  # mm
}


@dataclass(frozen=True)
class Camera:
    """A camera; ``with_`` makes changed copies.

    Attributes:
        transform: World from camera, shape (4, 4), m; the camera looks along its -z, +y is up.
        lens: Library name, file, ``Lens``, ``"thin"`` or ``"pinhole"``; None: thin.
        lens_model: exact, thin or pinhole; None: exact if a prescription is named.
        focal_length: mm, of an ideal lens; None: 50. A prescription has its own and takes no other.
        sensor_size: Width and height, mm.
        sensor_fit: horizontal, vertical, auto or fill: which side of the sensor the picture spans.
        f_stop: Focal length / entrance pupil diameter; None: the file's, else 5.6, or the widest of
            the lens if that is slower.
        aperture_diameter: mm; the lecture's parameter, instead of ``f_stop`` (thin lens only).
        focus_distance: m from the entrance pupil along the axis; None: autofocus.
        focus_at: Pixel (x, y) whose surface is to be sharp.
        focus_on: Node whose nearest surface point is to be sharp.
        focus_from: pupil or sensor.
        focus_breathing: Thin lens: keep the focal length, so that the field narrows when it focuses
            close, as a real lens does that moves as a whole; False keeps the field.
        blades: Number of straight or curved iris blades; 0: round.
        blade_rotation: Degrees.
        blade_curvature: -1 .. 1; 1 is round, 0 straight.
        aperture_image: Grey picture (H, W) of the iris opening; None: by blades.
        natural_vignetting: Thin lens and pinhole: darken by cos^4 of the field angle.
        shift: Film shift, mm.
        shutter_time: s; None: the file's.
        iso, exposure_compensation: For development; they never change ``frame.rgb``.
    """

    transform: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    lens: str | Lens | None = None
    lens_model: str | None = None
    focal_length: float | None = None
    sensor_size: tuple[float, float] = (36.0, 24.0)
    sensor_fit: str = "horizontal"
    f_stop: float | None = None
    aperture_diameter: float | None = None
    focus_distance: float | None = None
    focus_at: tuple[float, float] | None = None
    focus_on: str | None = None
    focus_from: str = "pupil"
    focus_breathing: bool = False
    blades: int = 0
    blade_rotation: float = 0.0
    blade_curvature: float = 0.0
    aperture_image: NDArray[np.float32] | None = None
    natural_vignetting: bool = False
    shift: tuple[float, float] = (0.0, 0.0)
    shutter_time: float | None = None
    iso: float = 100.0
    exposure_compensation: float = 0.0

    def with_(self, **changes: Any) -> Camera:
        """A copy with some parameters changed.

        What the change makes obsolete goes: the focal length of an ideal lens when a prescription
        takes its place, the f-stop for an aperture diameter, one way to focus for another.

        Raises:
            UsageError: An unknown name (the nearest is suggested), or values that exclude others.
        """
        for name in changes:
            if name not in self.__dataclass_fields__:
                raise UsageError(
                    f"camera: no parameter {name!r}{suggest(name, self.__dataclass_fields__)}"
                )
        given = {name for name, value in changes.items() if value is not None}
        if "pinhole" in (changes.get("lens"), changes.get("lens_model")):
            odd = sorted(given & {"f_stop", "aperture_diameter", "aperture_image"})
            if odd:
                raise UsageError(f"camera: a pinhole has no {odd[0]}")
        replaced: dict[str, None] = {}
        for rivals in (("f_stop", "aperture_diameter"), ("focus_distance", "focus_at", "focus_on")):
            both = sorted(given & set(rivals))
            if len(both) > 1:
                raise UsageError(f"camera: wanted either {both[0]} or {both[1]}, got both")
            replaced |= dict.fromkeys(rivals) if both else {}
        if changes.get("lens") not in (None, *IDEAL):
            replaced |= {"focal_length": None, "aperture_diameter": None}
        return replace(self, **(replaced | changes))
