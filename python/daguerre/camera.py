"""A camera in a photographer's terms. Units are the ones read on the object: mm for lens and sensor,
m for distances, s for time, degrees for angles."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .errors import UsageError, suggest

if TYPE_CHECKING:
    from .lenses import Lens


@dataclass(frozen=True)
class Camera:
    """A camera; ``with_`` makes changed copies.

    Attributes:
        transform: World from camera, shape (4, 4), m; the camera looks along its -z, +y is up.
        lens: Library name, file, ``Lens``, ``"thin"`` or ``"pinhole"``; None: thin.
        lens_model: exact, thin or pinhole; None: exact if a prescription is named.
        focal_length: mm; None: the lens's own, else 50.
        sensor_size: Width and height, mm.
        sensor_fit: horizontal, vertical, auto or fill: which side of the sensor the picture spans.
        f_stop: Focal length / entrance pupil diameter; None: the lens's own, else 5.6.
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
        """A copy with some parameters changed; unknown names are an error that suggests the nearest."""
        for name in changes:
            if name not in self.__dataclass_fields__:
                raise UsageError(
                    f"camera: no parameter {name!r}{suggest(name, self.__dataclass_fields__)}"
                )
        return replace(self, **changes)
