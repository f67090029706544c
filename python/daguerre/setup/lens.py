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
class _Chosen:
    """A prescription at its zoom and f-stop, and the model that draws it.

    Attributes:
        lens: The lens, focused as in its file.
        model: One of ``MODELS``.
        order: First-order data of that lens.
        transmittance: Share of the light on the axis that the glass transmits.
        f_stop: Focal length / entrance pupil diameter.
    """

    lens: lenses.Lens
    model: str
    order: lenses.FirstOrder
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
class _InFocus:
    """A focused lens, with its film and f-stop.

    Attributes:
        lens: The lens with the gaps of its zoom and focus.
        order: First-order data of that lens.
        film_z: Position of the film on the lens's axis, in the lens's frame.
        distance: Focus distance from the entrance pupil along the lens's axis, m.
        f_stop: Focal length / entrance pupil diameter.
    """

    lens: lenses.Lens
    order: lenses.FirstOrder
    film_z: float
    distance: float
    f_stop: float


@dataclass(frozen=True)
class _Drawn:
    """A lens that is ready to draw.

    Attributes:
        core: Camera of the core.
        h0: Illuminance on the axis by a world of 1 cd/m2, lux.
        fit: Quality of its polynomials, if the model has them.
        notes: Notes for the user.
    """

    core: _core.Camera
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
        chosen: The lens at its zoom and f-stop.
    """

    def __init__(self, camera: Camera, lens: lenses.Lens, model: str) -> None:
        self._camera, self._model = camera, model
        self.chosen = _chosen(camera, lens, model)
        self.whole = lru_cache(_KEPT)(self._whole)
        self.notes = lru_cache(_KEPT)(self._notes)
        self.in_focus = lru_cache(_KEPT)(self._focused)
        self.exact = lru_cache(_KEPT)(self._exact)
        self.far = lru_cache(_KEPT)(self._far)

    def _whole(self, distance: float) -> str | None:
        sharp = self.in_focus(distance)
        magnification = (sharp.order.back_focal_point - sharp.film_z) / sharp.order.efl
        return whole_lens_note(self.chosen.lens, magnification)

    def _notes(self, distance: float) -> tuple[str, ...]:
        return tuple(_notes(self._camera, self.chosen, self.whole(distance)))

    def _focused(self, distance: float) -> _InFocus:
        return _focused(self._camera, self.chosen, distance)

    def _exact(self, distance: float, film_mm: tuple[float, float], pitch_mm: float) -> _Exact:
        return _exact(self._camera, self._model, self.in_focus(distance), film_mm, pitch_mm)

    def _far(self, film_mm: tuple[float, float]) -> _core.ExactLens:
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
    chosen = glass.chosen
    lens = chosen.lens
    if any(camera.tilt):
        cardinal = _cardinal_points(chosen.order)
        focus = replace(focus, sharp_at=lambda p: tilt.focus_on(cardinal, camera.tilt, p))
    found = focus.settled(lambda s: _directions(framing, glass, s))
    sharp = glass.in_focus(found.distance_m)
    film = framing_distance(sharp) * tilt.cosine(camera.tilt)
    if chosen.traced:
        exact = glass.exact(found.distance_m, framing.film_mm, framing.pitch_mm)
        drawn = _traced(framing, exact)
    else:
        drawn = _ideal(framing, model, sharp, film)
    offset = (sharp.film_z - sharp.order.entrance_pupil.z) * tilt.cosine(camera.tilt)
    fit = drawn.fit
    return ResolvedLens(
        core=drawn.core,
        model=model if fit is None or fit.used else "exact",
        name=lens.name,
        focal_length_mm=lens.zoom_mm or lens.nominal.efl_mm or chosen.order.efl,
        pinhole_focal_length_mm=film,
        f_stop=chosen.f_stop,
        focus_distance_m=sharp.distance,
        glass=Glass(
            lens=lens,
            effective_focal_length_mm=sharp.order.efl,
            entrance_pupil_offset_mm=offset,
            squeeze=chosen.squeeze,
            transmittance=chosen.transmittance,
            h0=drawn.h0,
            fit=fit,
            whole=glass.whole(found.distance_m),
        ),
        notes=(*found.notes, *lens.notes, *glass.notes(found.distance_m), *drawn.notes),
    )


def _chosen(camera: Camera, lens: lenses.Lens, model: str) -> _Chosen:
    lens = lens if camera.zoom is None else lens.at_zoom(camera.zoom)
    order = lens.first_order()
    transmittance = _transmittance(lens, order)
    f_stop = _f_stop(camera, lens, model, order, transmittance)
    return _Chosen(lens, model, order, transmittance, f_stop)


def _notes(camera: Camera, chosen: _Chosen, whole: str | None) -> list[str]:
    """Notes on zoom, focusing, light lost in the glass, and squeeze."""
    notes = []
    lens, squeeze = chosen.lens, chosen.squeeze
    if camera.zoom is None and (ends := lens.zoom_range_mm):
        short_end, long_end = ends
        notes.append(
            f"{lens.name} is a zoom lens of {short_end:.4g} to {long_end:.4g} mm, set to "
            f"{lens.zoom_mm:.4g} mm"
        )
    if whole is not None:
        notes.append(whole)
    notes += _stop_notes(camera, chosen)
    if camera.t_stop is not None:
        notes.append(
            f"T/{camera.t_stop:.3g} of {lens.name} is f/{chosen.f_stop:.3g}: the glass "
            f"transmits {100 * chosen.transmittance:.3g} % of the light"
        )
    if squeeze != 1:
        notes.append(
            f"{lens.name} is anamorphic: it squeezes the picture's width by {squeeze:.3g}; "
            f"view it with a pixel aspect of {squeeze:.3g} (the EXR file says so)"
        )
    elif not chosen.traced and lens.squeeze != 1:
        notes.append(
            f"{lens.name} is anamorphic: its {chosen.model} model has only the vertical focal "
            "length and does not squeeze"
        )
    return notes


def _stop_notes(camera: Camera, chosen: _Chosen) -> list[str]:
    """Note that the lens is wide open, since the stop is slightly wider than it opens."""
    if camera.t_stop is not None:
        widest = chosen.order.f_number / math.sqrt(chosen.transmittance)
        text = remark(chosen.lens.name, camera.t_stop, widest, "T")
    elif camera.f_stop is not None and chosen.model not in WITHOUT_IRIS:
        text = remark(chosen.lens.name, camera.f_stop, chosen.order.f_number)
    else:
        return []
    return [] if text is None else [text]


def _transmittance(lens: lenses.Lens, order: lenses.FirstOrder) -> float:
    """Luminous transmittance on the axis for D65, which is the same at any f-stop."""
    check_stop_size(lens)
    with reported(lens.source):
        thick = _core.ThickLens(lens.prescription, order.f_number, _core.Iris(), math.inf)
    return float(thick.transmittance)


def _f_stop(
    camera: Camera,
    lens: lenses.Lens,
    model: str,
    order: lenses.FirstOrder,
    transmittance: float,
) -> float:
    if camera.t_stop is None:
        f_stop = opened(camera.f_stop or max(DEFAULT_F_STOP, order.f_number), order.f_number)
        # A pinhole has no f-stop, so a scene's f-stop that the lens lacks is no error.
        if model in WITHOUT_IRIS:
            return max(f_stop, order.f_number)
        if f_stop < AS_GIVEN * order.f_number:
            raise LensError(
                f"{lens.source}: f_stop: wanted {order.f_number:.3g} or more, as this lens opens "
                f"to f/{order.f_number:.3g}; got {f_stop:.4g}",
                "lens-f-stop",
            )
        return f_stop
    f_stop = opened(camera.t_stop * math.sqrt(transmittance), order.f_number)
    if f_stop < AS_GIVEN * order.f_number:
        widest = order.f_number / math.sqrt(transmittance)
        raise LensError(
            f"{lens.source}: t_stop: wanted {widest:.3g} or more, as this lens opens to "
            f"f/{order.f_number:.3g} and transmits {100 * transmittance:.3g} % of the light; "
            f"got {camera.t_stop:.4g}",
            "lens-f-stop",
        )
    return f_stop


def _focused(camera: Camera, chosen: _Chosen, distance: float) -> _InFocus:
    setting = LensSetting(
        f_stop=chosen.f_stop,
        focus_m=distance,
        focus_by="best" if camera.focus_by == "best" else "paraxial",
        focus_from="sensor" if _from_sensor(camera) else "pupil",
    )
    found = focused(chosen.lens, setting)
    if setting.from_sensor:  # the film's position is known now: count from the pupil
        distance -= (found.film_z_mm - found.entrance_pupil_z) * 1e-3
    used = imperfect(found.lens, camera)
    return _InFocus(used, found.lens.first_order(), found.film_z_mm, distance, chosen.f_stop)


def _from_sensor(camera: Camera) -> bool:
    return camera.focus_from == "sensor" and camera.focus_distance is not None


def _exact(
    camera: Camera,
    model: str,
    sharp: _InFocus,
    film_mm: tuple[float, float],
    pitch_mm: float,
) -> _Exact:
    """Sets up a focused lens by its surfaces or by polynomials."""
    fit, notes = None, []
    if model == "polynomial":
        exact = _exact_lens(camera, film_mm, sharp, camera.degree or DEFAULT_DEGREE)
        fit = judged(exact, camera, sharp.lens.name, pitch_mm)
        exact = exact if fit.used else exact.without_fit()
        notes.append(fit.note)
    else:
        exact = _exact_lens(camera, film_mm, sharp)
    notes += frame_notes(exact, sharp.lens, film_mm, camera.shift)
    masks = mask_of(camera, "front_mask"), mask_of(camera, "iris_mask")
    if any(mask is not None for mask in masks):
        exact = exact.with_dirt(*masks)
    return _Exact(exact, fit, tuple(notes))


def _traced(framing: Framing, exact: _Exact) -> _Drawn:
    """Makes the camera of an exact lens."""
    core = _core.Camera.exact(framing.pose, exact.lens)
    core.sensor_stack = stack_of(framing.camera)
    core.scatter = parts_of(framing.camera)
    return _Drawn(core, exact.lens.h0, exact.fit, exact.notes)


def _ideal(framing: Framing, model: str, sharp: _InFocus, film: float) -> _Drawn:
    """Makes the camera of a model without surfaces."""
    camera = framing.camera
    with reported(sharp.lens.source):
        thick = _core.ThickLens(
            sharp.lens.prescription,
            sharp.f_stop,
            iris_of(camera),
            sharp.distance,
            film_z_mm=sharp.film_z,
            tilt_deg=camera.tilt,
        )
    if model == "thick":
        return _Drawn(_core.Camera.thick(framing.pose, thick), thick.h0)
    radius = sharp.order.efl / sharp.f_stop / 2
    return _Drawn(core_of(framing, model, film, radius, sharp.distance), thick.h0)


def _directions(framing: Framing, glass: _Glass, distance: float) -> Directions:
    """View directions of film points at a trial focus distance."""
    camera = framing.camera
    if camera.focus_at is None or not glass.chosen.traced or any(camera.tilt):
        film = framing_distance(glass.in_focus(distance))
        return ideal_direction(film * tilt.cosine(camera.tilt))
    far = glass.far(framing.film_mm)

    def direction(x: float, y: float) -> NDArray[np.float64]:
        return np.array(far.chief_direction(x, y))

    return direction


def _cardinal_points(order: lenses.FirstOrder) -> tilt.CardinalPoints:
    front = order.front_principal_point - order.front_focal_point
    return tilt.CardinalPoints(
        order.front_focal_point,
        order.back_focal_point,
        order.efl * front,
        front,
        order.entrance_pupil.z,
    )


def framing_distance(sharp: _InFocus) -> float:
    """Film distance (mm) of the pinhole, at the entrance pupil, with the framing of a real lens.

    A chief ray of slope t crosses the plane of focus at height t s_pupil and the film at
    t s_pupil s' / s, with s and s' measured from the principal points.
    """
    order = sharp.order
    if math.isinf(sharp.distance):
        return order.efl
    from_pupil = sharp.distance * 1e3
    from_principal = from_pupil + order.front_principal_point - order.entrance_pupil.z
    return (sharp.film_z - order.back_principal_point) * from_pupil / from_principal


def _exact_lens(
    camera: Camera,
    film_mm: tuple[float, float],
    sharp: _InFocus,
    fit_degree: int | None = None,
) -> _core.ExactLens:
    half = [abs(s) + size / 2 for s, size in zip(camera.shift, film_mm, strict=True)]
    settings = _core.ExactLensSettings(
        f_stop=sharp.f_stop,
        iris=iris_of(camera),
        focus_distance_m=sharp.distance,
        # The reconstruction filter reaches over the frame's edge.
        half_diagonal_mm=1.02 * math.hypot(*half),
        film_z_mm=sharp.film_z,
        tilt_deg=camera.tilt,
        film_center_mm=camera.shift,
        film_half_mm=(0.51 * film_mm[0], 0.51 * film_mm[1]),
        fit_degree=fit_degree,
    )
    with reported(sharp.lens.source):
        return _core.ExactLens(sharp.lens.prescription, settings)
