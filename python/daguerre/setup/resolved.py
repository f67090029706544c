"""Records of a camera that is set up: resolved parameters, and the core's camera.

Lengths are in mm and angles in degrees unless a name says otherwise. :mod:`.metadata` converts
these records for files; they are never read back.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.camera.camera import Camera
from daguerre.camera.exposure import exposure_notes, lens_h0
from daguerre.camera.shutter import shutter_time
from daguerre.files.value import BriefRecord
from daguerre.scene.far import Place

from .pose import Change
from .tilt import cosine

if TYPE_CHECKING:
    from daguerre.camera.projection import Projection
    from daguerre.lenses import Lens
    from daguerre.lenses.setting import LensSetting

    from .fit import FitQuality


@dataclass(frozen=True)
class Glass:
    """A prescription as set up in a camera.

    Attributes:
        lens: The lens at its zoom, focused as in its file.
        effective_focal_length_mm: Focal length at its focus.
        entrance_pupil_offset_mm: Distance from the entrance pupil to the film, along the camera's
            axis.
        squeeze: Factor by which it narrows the picture; 1: none.
        transmittance: Share of the light on the axis that the glass transmits.
        h0: Illuminance on the axis by a world of 1 cd/m2, lux.
        fit: Quality of the polynomials, if the model has them.
        whole: Note that the model moves the whole lens to focus, unlike the product; None: none.
    """

    lens: Lens
    effective_focal_length_mm: float
    entrance_pupil_offset_mm: float
    squeeze: float
    transmittance: float
    h0: float
    fit: FitQuality | None = None
    whole: str | None = None


@dataclass(frozen=True)
class ResolvedLens:
    """A lens of any model, ready to draw.

    Attributes:
        core: Camera of the core.
        model: Model that draws: exact, polynomial, thick, thin, pinhole or projection.
        name: Name of the lens; without a prescription: thin, pinhole or projection.
        focal_length_mm: Focal length as engraved.
        pinhole_focal_length_mm: Film distance of the pinhole with the same framing.
        f_stop: F-stop; None: a pinhole without a prescription.
        aperture_diameter_mm: Aperture of an ideal lens; None: a prescription, or a pinhole.
        focus_distance_m: Focus distance from the entrance pupil along the lens's axis; None:
            everything is sharp.
        projection: Projection that replaces a lens.
        glass: Prescription, if the lens has one, for any model.
        notes: Decisions made on the user's behalf, one sentence each.
    """

    core: _core.Camera
    model: str
    name: str
    focal_length_mm: float
    pinhole_focal_length_mm: float
    f_stop: float | None = None
    aperture_diameter_mm: float | None = None
    focus_distance_m: float | None = None
    projection: Projection | None = None
    glass: Glass | None = None
    notes: tuple[str, ...] = ()

    @property
    def t_stop(self) -> float | None:
        """F-stop of a lossless lens of the same brightness; None: no glass."""
        if self.glass is None or self.f_stop is None:
            return None
        return self.f_stop / math.sqrt(self.glass.transmittance)

    @property
    def widest_stop(self) -> float:
        """Smallest f-stop; an ideal lens has none, and begins at f/1."""
        return 1.0 if self.glass is None else float(self.glass.lens.first_order().f_number)

    @property
    def effective_focal_length_mm(self) -> float:
        """Focal length at its focus; without glass, the engraved focal length."""
        return self.glass.effective_focal_length_mm if self.glass else self.focal_length_mm

    @property
    def entrance_pupil_offset_mm(self) -> float | None:
        """Distance from the entrance pupil to the film, along the camera's axis; None: no glass."""
        return self.glass.entrance_pupil_offset_mm if self.glass else None

    @property
    def squeeze(self) -> float:
        """Factor by which an anamorphic lens narrows the picture; else 1."""
        return self.glass.squeeze if self.glass else 1.0

    def film_offset_m(self, tilt_deg: tuple[float, float]) -> float:
        """Distance from the entrance pupil to the film along the lens's axis, m; 0: no glass."""
        return 1e-3 * (self.entrance_pupil_offset_mm or 0.0) / cosine(tilt_deg)


@dataclass(frozen=True, eq=False, repr=False)
class ResolvedCamera(BriefRecord):
    """A camera at mid-exposure, ready to draw.

    Attributes:
        camera: Camera parameters at mid-exposure.
        lens: The lens.
        resolution: Width and height of the picture, px.
        interval_s: Begin and end of the exposure.
        world_from_camera: Pose at mid-exposure, m, shape (4, 4).
        origin: Origin of the core's scene in the world, m.
        frame_size_mm: Width and height of the picture on the film.
        shift_mm: Position of the picture's middle relative to the lens's axis, right and up.
        changes: Changes while the shutter is open, by the name of the parameter.
        light_notes: Decisions made on the user's behalf, one sentence each, except about exposure.
    """

    camera: Camera
    lens: ResolvedLens
    resolution: tuple[int, int]
    interval_s: tuple[float, float]
    world_from_camera: NDArray[np.float64]
    origin: Place
    frame_size_mm: tuple[float, float]
    shift_mm: tuple[float, float]
    changes: Mapping[str, Change]
    light_notes: tuple[str, ...] = ()

    @property
    def notes(self) -> tuple[str, ...]:
        """Decisions made on the user's behalf, one sentence each."""
        exposure = exposure_notes(self.camera, self.lens.f_stop, shutter_time(self.camera))
        return (*self.light_notes, *exposure)

    @property
    def core(self) -> _core.Camera:
        """Camera of the core."""
        return self.lens.core

    @property
    def h0(self) -> float:
        """Illuminance on the axis by a world of 1 cd/m2, lux."""
        lens = self.lens
        if lens.glass is not None:
            return lens.glass.h0
        return lens_h0(self.camera, lens.pinhole_focal_length_mm, lens.aperture_diameter_mm)

    @property
    def setting(self) -> LensSetting:
        """Setting of a lens with glass, for the bench."""
        from daguerre.lenses.setting import LensSetting

        glass, zoomed = self.lens.glass, self.camera.zoom is not None
        return LensSetting(
            f_stop=self.lens.f_stop,
            focus_m=math.inf if self.lens.focus_distance_m is None else self.lens.focus_distance_m,
            zoom_mm=glass.lens.zoom_mm if glass and zoomed else None,
            focus_by="best" if self.camera.focus_by == "best" else "paraxial",
        )
