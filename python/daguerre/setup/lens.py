"""Set-up of a camera with a real lens: traced exactly, or as a thick or ideal lens.

Lengths are in mm unless the name says otherwise. Focus distances are in m.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre import lenses
from daguerre.camera.camera import Camera
from daguerre.camera.exposure import without_brightness
from daguerre.camera.ideal import WITHOUT_IRIS
from daguerre.camera.parameters.needs import TRACED
from daguerre.lenses.checking import frame_notes
from daguerre.lenses.engraved import AS_GIVEN, opened, remark
from daguerre.lenses.errors import LensError, reported
from daguerre.lenses.focus import focused
from daguerre.lenses.focusing import whole_lens_note
from daguerre.lenses.setting import LensSetting
from daguerre.lenses.stop_size import check_stop_size

from . import tilt
from .body import parts_of, stack_of
from .fit import DEFAULT_DEGREE, FitQuality, judged
from .focus import ideal_direction
from .framing import Framing
from .ideal import DEFAULT_F_STOP, core_of
from .imperfections import imperfect
from .iris import iris_of, mask_of
from .near_clip import Directions
from .resolved import Glass, ResolvedLens

#: Number of cached lenses, and of cached focus distances of each.
_KEPT = 16


@dataclass(frozen=True)
class _UnfocusedLens:
    """A prescription at its zoom and f-stop, and the model that draws it.

    Attributes:
        lens: The lens, focused as in its file.
        model: One of ``MODELS``.
        first_order: First-order data of that lens.
        transmittance: Share of the light on the axis that the glass transmits.
        f_stop: Focal length / entrance pupil diameter.
    """

    lens: lenses.Lens
    model: str
    first_order: lenses.FirstOrder
    transmittance: float
    f_stop: float

    @property
    def traced(self) -> bool:
        """Whether the model traces surfaces, or polynomials fitted to them."""
        return self.model in TRACED

    @property
    def squeeze(self) -> float:
        """Squeeze of the picture; models without surfaces have one focal length."""
        return self.lens.squeeze if self.traced else 1.0


@dataclass(frozen=True)
class _FocusedLens:
    """A focused lens, with its film and f-stop.

    Attributes:
        lens: The lens with the gaps of its zoom and focus.
        first_order: First-order data of that lens.
        film_z: Position of the film on the lens's axis, in the lens's frame.
        distance: Focus distance from the entrance pupil along the lens's axis, m.
        f_stop: Focal length / entrance pupil diameter.
    """

    lens: lenses.Lens
    first_order: lenses.FirstOrder
    film_z: float
    distance: float
    f_stop: float


@dataclass(frozen=True)
class _CoreCamera:
    """The core's camera with a lens, and facts of it.

    Attributes:
        camera: Camera of the core.
        h0: Illuminance on the axis by a world of 1 cd/m2, lux.
        fit: Quality of its polynomials, if the model has them.
        notes: Notes for the user.
    """

    camera: _core.Camera
    h0: float
    fit: FitQuality | None = None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Exact:
    """A lens of the core: its exact surfaces, or polynomials fitted to them.

    Attributes:
        lens: The lens.
        fit: Quality of its polynomials, if the model has them.
        notes: Notes for the user.
    """

    lens: _core.ExactLens
    fit: FitQuality | None
    notes: tuple[str, ...]


class _Glass:
    """A lens as a camera sets it, with a cache of focused lenses for the next picture.

    Attributes:
        unfocused: The lens at its zoom and f-stop.
    """

    def __init__(self, camera: Camera, lens: lenses.Lens, model: str) -> None:
        self._camera, self._model = camera, model
        self.unfocused = _unfocused(camera, lens, model)
        self.whole = lru_cache(_KEPT)(self._whole)
        self.notes = lru_cache(_KEPT)(self._notes)
        self.in_focus = lru_cache(_KEPT)(self._focused)
        self.exact = lru_cache(_KEPT)(self._exact)
        self.at_infinity = lru_cache(_KEPT)(self._at_infinity)

    def _whole(self, distance: float) -> str | None:
        focused_lens = self.in_focus(distance)
        first_order = focused_lens.first_order
        magnification = (first_order.back_focal_point - focused_lens.film_z) / first_order.efl
        return whole_lens_note(self.unfocused.lens, magnification)

    def _notes(self, distance: float) -> tuple[str, ...]:
        return tuple(_notes(self._camera, self.unfocused, self.whole(distance)))

    def _focused(self, distance: float) -> _FocusedLens:
        return _focused(self._camera, self.unfocused, distance)

    def _exact(self, distance: float, film_mm: tuple[float, float], pitch_mm: float) -> _Exact:
        return _exact(self._camera, self._model, self.in_focus(distance), film_mm, pitch_mm)

    def _at_infinity(self, film_mm: tuple[float, float]) -> _core.ExactLens:
        return _exact_lens(self._camera, film_mm, self.in_focus(math.inf))


@lru_cache(_KEPT)
def _glass(camera: Camera, lens: lenses.Lens, model: str) -> _Glass:
    """Glass of a camera; cached without pose and exposure, which do not change it."""
    return _Glass(camera, lens, model)


def set_up(framing: Framing, lens: lenses.Lens, model: str) -> ResolvedLens:
    """Focuses a lens and makes the camera of the model.

    Raises:
        UsageError: Autofocus on a pixel outside of the frame.
        InputError: The lens has no such focus or stop.
    """
    camera, focus = framing.camera, framing.focus
    glass = _glass(without_brightness(camera).with_(transform=np.eye(4)), lens, model)
    unfocused = glass.unfocused
    lens = unfocused.lens
    if any(camera.tilt):
        cardinal = _cardinal_points(unfocused.first_order)
        focus = replace(focus, sharp_at=lambda p: tilt.focus_on(cardinal, camera.tilt, p))
    found = focus.settled(lambda s: _directions(framing, glass, s))
    focused_lens = glass.in_focus(found.distance_m)
    film_distance = framing_distance(focused_lens) * tilt.cosine(camera.tilt)
    if unfocused.traced:
        exact = glass.exact(found.distance_m, framing.film_mm, framing.pitch_mm)
        core_camera = _traced(framing, exact)
    else:
        core_camera = _ideal(framing, model, focused_lens, film_distance)
    from_pupil = focused_lens.film_z - focused_lens.first_order.entrance_pupil.z
    fit = core_camera.fit
    return ResolvedLens(
        core=core_camera.camera,
        model=model if fit is None or fit.used else "exact",
        name=lens.name,
        focal_length_mm=lens.zoom_mm or lens.nominal.efl_mm or unfocused.first_order.efl,
        pinhole_focal_length_mm=film_distance,
        f_stop=unfocused.f_stop,
        focus_distance_m=focused_lens.distance,
        glass=Glass(
            lens=lens,
            effective_focal_length_mm=focused_lens.first_order.efl,
            entrance_pupil_offset_mm=from_pupil * tilt.cosine(camera.tilt),
            squeeze=unfocused.squeeze,
            transmittance=unfocused.transmittance,
            h0=core_camera.h0,
            fit=fit,
            whole=glass.whole(found.distance_m),
        ),
        notes=(*found.notes, *lens.notes, *glass.notes(found.distance_m), *core_camera.notes),
    )


def _unfocused(camera: Camera, lens: lenses.Lens, model: str) -> _UnfocusedLens:
    lens = lens if camera.zoom is None else lens.at_zoom(camera.zoom)
    first_order = lens.first_order()
    transmittance = _transmittance(lens, first_order)
    f_stop = _f_stop(camera, lens, model, first_order, transmittance)
    return _UnfocusedLens(lens, model, first_order, transmittance, f_stop)


def _notes(camera: Camera, unfocused: _UnfocusedLens, whole: str | None) -> list[str]:
    """Notes on zoom, focusing, light lost in the glass, and squeeze."""
    notes = []
    lens, squeeze = unfocused.lens, unfocused.squeeze
    if camera.zoom is None and (ends := lens.zoom_range_mm):
        short_end, long_end = ends
        notes.append(
            f"{lens.name} is a zoom lens of {short_end:.4g} to {long_end:.4g} mm, set to "
            f"{lens.zoom_mm:.4g} mm"
        )
    if whole is not None:
        notes.append(whole)
    notes += _stop_notes(camera, unfocused)
    if camera.t_stop is not None:
        notes.append(
            f"T/{camera.t_stop:.3g} of {lens.name} is f/{unfocused.f_stop:.3g}: the glass "
            f"transmits {100 * unfocused.transmittance:.3g} % of the light"
        )
    if squeeze != 1:
        notes.append(
            f"{lens.name} is anamorphic: it squeezes the picture's width by {squeeze:.3g}; "
            f"view it with a pixel aspect of {squeeze:.3g} (the EXR file says so)"
        )
    elif not unfocused.traced and lens.squeeze != 1:
        notes.append(
            f"{lens.name} is anamorphic: its {unfocused.model} model has only the vertical focal "
            "length and does not squeeze"
        )
    return notes


def _stop_notes(camera: Camera, unfocused: _UnfocusedLens) -> list[str]:
    """Note that the lens is wide open, since the stop is slightly wider than it opens."""
    if camera.t_stop is not None:
        widest = unfocused.first_order.f_number / math.sqrt(unfocused.transmittance)
        text = remark(unfocused.lens.name, camera.t_stop, widest, "T")
    elif camera.f_stop is not None and unfocused.model not in WITHOUT_IRIS:
        text = remark(unfocused.lens.name, camera.f_stop, unfocused.first_order.f_number)
    else:
        return []
    return [] if text is None else [text]


def _transmittance(lens: lenses.Lens, first_order: lenses.FirstOrder) -> float:
    """Luminous transmittance on the axis for D65, which is the same at any f-stop."""
    check_stop_size(lens)
    with reported(lens.source):
        thick = _core.ThickLens(lens.prescription, first_order.f_number, _core.Iris(), math.inf)
    return float(thick.transmittance)


def _f_stop(
    camera: Camera,
    lens: lenses.Lens,
    model: str,
    first_order: lenses.FirstOrder,
    transmittance: float,
) -> float:
    widest = first_order.f_number
    if camera.t_stop is None:
        f_stop = opened(camera.f_stop or max(DEFAULT_F_STOP, widest), widest)
        # A pinhole has no f-stop, so a scene's f-stop that the lens lacks is no error.
        if model in WITHOUT_IRIS:
            return max(f_stop, widest)
        if f_stop < AS_GIVEN * widest:
            raise LensError(
                f"{lens.source}: f_stop: wanted {widest:.3g} or more, as this lens opens "
                f"to f/{widest:.3g}; got {f_stop:.4g}",
                "lens-f-stop",
            )
        return f_stop
    f_stop = opened(camera.t_stop * math.sqrt(transmittance), widest)
    if f_stop < AS_GIVEN * widest:
        raise LensError(
            f"{lens.source}: t_stop: wanted {widest / math.sqrt(transmittance):.3g} or more, as "
            f"this lens opens to f/{widest:.3g} and transmits {100 * transmittance:.3g} % of the "
            f"light; got {camera.t_stop:.4g}",
            "lens-f-stop",
        )
    return f_stop


def _focused(camera: Camera, unfocused: _UnfocusedLens, distance: float) -> _FocusedLens:
    setting = LensSetting(
        f_stop=unfocused.f_stop,
        focus_m=distance,
        focus_by="best" if camera.focus_by == "best" else "paraxial",
        focus_from="sensor" if _from_sensor(camera) else "pupil",
    )
    found = focused(unfocused.lens, setting)
    if setting.from_sensor:  # the film's position is known now: count from the pupil
        distance -= (found.film_z_mm - found.entrance_pupil_z) * 1e-3
    used = imperfect(found.lens, camera)
    return _FocusedLens(used, found.lens.first_order(), found.film_z_mm, distance, unfocused.f_stop)


def _from_sensor(camera: Camera) -> bool:
    return camera.focus_from == "sensor" and camera.focus_distance is not None


def _exact(
    camera: Camera,
    model: str,
    focused_lens: _FocusedLens,
    film_mm: tuple[float, float],
    pitch_mm: float,
) -> _Exact:
    """Sets up a focused lens by its surfaces or by polynomials."""
    fit, notes = None, []
    if model == "polynomial":
        exact = _exact_lens(camera, film_mm, focused_lens, camera.degree or DEFAULT_DEGREE)
        fit = judged(exact, camera, focused_lens.lens.name, pitch_mm)
        exact = exact if fit.used else exact.without_fit()
        notes.append(fit.note)
    else:
        exact = _exact_lens(camera, film_mm, focused_lens)
    notes += frame_notes(exact, focused_lens.lens, film_mm, camera.shift)
    masks = mask_of(camera, "front_mask"), mask_of(camera, "iris_mask")
    if any(mask is not None for mask in masks):
        exact = exact.with_dirt(*masks)
    return _Exact(exact, fit, tuple(notes))


def _traced(framing: Framing, exact: _Exact) -> _CoreCamera:
    """Makes the camera of an exact lens."""
    core = _core.Camera.exact(framing.pose, exact.lens)
    core.sensor_stack = stack_of(framing.camera)
    core.scatter = parts_of(framing.camera)
    return _CoreCamera(core, exact.lens.h0, exact.fit, exact.notes)


def _ideal(
    framing: Framing, model: str, focused_lens: _FocusedLens, film_distance: float
) -> _CoreCamera:
    """Makes the camera of a model without surfaces."""
    camera = framing.camera
    with reported(focused_lens.lens.source):
        thick = _core.ThickLens(
            focused_lens.lens.prescription,
            focused_lens.f_stop,
            iris_of(camera),
            focused_lens.distance,
            film_z_mm=focused_lens.film_z,
            tilt_deg=camera.tilt,
        )
    if model == "thick":
        return _CoreCamera(_core.Camera.thick(framing.pose, thick), thick.h0)
    radius = focused_lens.first_order.efl / focused_lens.f_stop / 2
    core = core_of(framing, model, film_distance, radius, focused_lens.distance)
    return _CoreCamera(core, thick.h0)


def _directions(framing: Framing, glass: _Glass, distance: float) -> Directions:
    """View directions of film points at a trial focus distance."""
    camera = framing.camera
    if camera.focus_at is None or not glass.unfocused.traced or any(camera.tilt):
        film_distance = framing_distance(glass.in_focus(distance))
        return ideal_direction(film_distance * tilt.cosine(camera.tilt))
    at_infinity = glass.at_infinity(framing.film_mm)

    def direction(x: float, y: float) -> NDArray[np.float64]:
        return np.array(at_infinity.chief_direction(x, y))

    return direction


def _cardinal_points(first_order: lenses.FirstOrder) -> tilt.CardinalPoints:
    front = first_order.front_principal_point - first_order.front_focal_point
    return tilt.CardinalPoints(
        first_order.front_focal_point,
        first_order.back_focal_point,
        first_order.efl * front,
        front,
        first_order.entrance_pupil.z,
    )


def framing_distance(focused_lens: _FocusedLens) -> float:
    """Film distance (mm) of the pinhole, at the entrance pupil, with the framing of a real lens.

    A chief ray of slope t crosses the plane of focus at height t s_pupil and the film at
    t s_pupil s' / s, with s and s' measured from the principal points.
    """
    first_order = focused_lens.first_order
    if math.isinf(focused_lens.distance):
        return first_order.efl
    from_pupil = focused_lens.distance * 1e3
    from_principal = from_pupil + first_order.front_principal_point - first_order.entrance_pupil.z
    return (focused_lens.film_z - first_order.back_principal_point) * from_pupil / from_principal


def _exact_lens(
    camera: Camera,
    film_mm: tuple[float, float],
    focused_lens: _FocusedLens,
    fit_degree: int | None = None,
) -> _core.ExactLens:
    half = [abs(s) + size / 2 for s, size in zip(camera.shift, film_mm, strict=True)]
    settings = _core.ExactLensSettings(
        f_stop=focused_lens.f_stop,
        iris=iris_of(camera),
        focus_distance_m=focused_lens.distance,
        # The reconstruction filter reaches over the frame's edge.
        half_diagonal_mm=1.02 * math.hypot(*half),
        film_z_mm=focused_lens.film_z,
        tilt_deg=camera.tilt,
        film_center_mm=camera.shift,
        film_half_mm=(0.51 * film_mm[0], 0.51 * film_mm[1]),
        fit_degree=fit_degree,
    )
    with reported(focused_lens.lens.source):
        return _core.ExactLens(focused_lens.lens.prescription, settings)
