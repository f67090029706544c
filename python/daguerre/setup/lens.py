"""A camera with a real lens: traced exactly, as a thick lens, or replaced by an ideal one.

All lengths in mm unless the name says otherwise. Distances of focus are m.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre import lenses
from daguerre.camera.camera import Camera, Decenter
from daguerre.camera.parameters import CAMERA
from daguerre.camera.parameters.needs import TRACED
from daguerre.checks import number, numbers, short, whole
from daguerre.errors import UsageError
from daguerre.lenses.checking import frame_notes
from daguerre.lenses.errors import LensError, reported

from . import fit as camera_fit
from . import tilt
from .aim_cache import exact_lens
from .body import parts_of, stack_facts, stack_of
from .focus import Focus, ideal_direction
from .iris import dirt_facts, iris_facts, iris_of, mask_of

DEFAULT_F_STOP: float = CAMERA["f_stop"].usual


Directions = Callable[[float, float], NDArray[np.float64]]


@dataclass(frozen=True)
class RealLens:
    """A prescription as a camera uses it.

    Attributes:
        core: The core's camera.
        pinhole_focal_length: Film distance of the pinhole with the same framing.
        facts: For metadata and hashes, JSON-able.
    """

    core: _core.Camera
    pinhole_focal_length: float
    facts: dict[str, Any]


@dataclass(frozen=True)
class _InFocus:
    """A lens, its film and its iris.

    Attributes:
        lens: With the gaps of its zoom and focus.
        order: First-order data of that lens.
        film_z: Film on the lens's axis, in its frame.
        distance: From the entrance pupil along the lens's axis, m.
        f_stop: Focal length / entrance pupil diameter.
    """

    lens: lenses.Lens
    order: lenses.FirstOrder
    film_z: float
    distance: float
    f_stop: float


def set_up(
    camera: Camera,
    lens: lenses.Lens,
    model: str,
    frame: tuple[float, float],
    pose: _core.Motion,
    focus: Focus,
) -> RealLens:
    """Focuses a lens and makes the camera of the model.

    Raises:
        UsageError: Autofocus on a pixel outside of the frame.
        InputError: The lens cannot focus or open so far.
    """
    lens = lens if camera.zoom is None else lens.at_zoom(camera.zoom)
    order = lens.first_order()
    transmittance = _transmittance(lens, order)
    f_stop = _f_stop(camera, lens, model, order, transmittance)
    if any(camera.tilt):
        imaging = _imaging(order)
        focus.sharp_at = lambda point: tilt.focus_on(imaging, camera.tilt, point)
    distance = focus.settled(lambda s: _directions(camera, lens, model, frame, f_stop, s))
    sharp = _focused(camera, lens, distance, f_stop)
    film = framing_distance(sharp) * tilt.cosine(camera.tilt)
    squeeze = lens.squeeze if model in TRACED else 1.0  # other models have one focal length
    focus.notes += lens.notes
    focus.notes += _notes(camera, lens, model, squeeze, f_stop, transmittance)
    fitted: dict[str, Any] = {}
    if model in TRACED:
        exact, fitted = _traced_lens(camera, model, sharp, frame, focus)
        core, h0 = _core.Camera.exact(pose, exact), exact.h0
        core.sensor_stack = stack_of(camera)
        core.scatter = parts_of(camera)
    else:
        core, h0 = _core_camera(camera, model, sharp, pose, film)
    facts = {
        "lens": lens.name,
        "lens_sha256": _hash_lens(lens),
        "coating": lens.coating,
        "focal_length_mm": lens.zoom_mm or lens.nominal.efl_mm or order.efl,
        "effective_focal_length_mm": sharp.order.efl,
        "zoom_mm": lens.zoom_mm,
        "zoom_range_mm": lens.zoom_range_mm,
        "squeeze": squeeze,
        "decenter": [[list(part) for part in one] for one in decenters(camera)],
        "f_stop": f_stop,
        "t_stop": f_stop / math.sqrt(transmittance),
        "focus_distance_m": sharp.distance,
        "focus_by": camera.focus_by,
        "entrance_pupil_offset_mm": (sharp.film_z - sharp.order.entrance_pupil.z)
        * tilt.cosine(camera.tilt),
        "h0": h0,
        "transmittance": transmittance,
        "ripple": None if camera.ripple is None else list(_ripple(camera)),
        **fitted,
        **iris_facts(camera),
        **dirt_facts(camera),
        **stack_facts(camera),
    }
    return RealLens(core, film, facts)


def _notes(
    camera: Camera, lens: lenses.Lens, model: str, squeeze: float, f_stop: float, share: float
) -> list[str]:
    """Notes on facts that a picture does not show: zoom, light lost in the glass, squeeze."""
    notes = []
    if lens.zoom_range_mm and camera.zoom is None:
        short_end, long_end = lens.zoom_range_mm
        notes.append(
            f"{lens.name} is a zoom of {short_end:.4g} to {long_end:.4g} mm and stands at "
            f"{lens.zoom_mm:.4g} mm"
        )
    if camera.t_stop is not None:
        notes.append(
            f"T/{camera.t_stop:.3g} of {lens.name} is f/{f_stop:.3g}: "
            f"{100 * share:.3g} % of the light passes the glass"
        )
    if squeeze != 1:
        notes.append(
            f"{lens.name} is anamorphic: it squeezes the picture's width by {squeeze:.3g}; "
            f"view it with a pixel aspect of {squeeze:.3g} (the EXR file says so)"
        )
    elif model not in TRACED and lens.squeeze != 1:
        notes.append(
            f"{lens.name} is anamorphic: its {model} model has the focal length of the height "
            "alone, and squeezes nothing"
        )
    return notes


def decenters(camera: Camera) -> list[Decenter]:
    """The elements off the axis, checked."""
    wanted = "((first, last), (x, y)) or ((first, last), (x, y), (about x, about y))"
    found: list[Decenter] = []
    given: Any = camera.decenter
    if not isinstance(given, tuple | list):
        raise UsageError(f"camera: decenter: wanted a list of {wanted}, got {short(given)}")
    for i, one in enumerate(given):
        where = f"camera: decenter[{i}]"
        if not isinstance(one, tuple | list) or len(one) not in (2, 3):
            raise UsageError(f"{where}: wanted {wanted}, got {short(one)}")
        first, last = numbers(one[0], where, 2, "the first and last surface")
        x, y = numbers(one[1], where, 2, "two finite numbers (mm)")
        a, b = numbers(one[2], where, 2, "two angles (deg)") if len(one) == 3 else (0.0, 0.0)
        found.append(((int(first), int(last)), (x, y), (a, b)))
    return found


def _ripple(camera: Camera) -> tuple[float, float, int]:
    given: Any = camera.ripple
    if not isinstance(given, tuple | list) or len(given) not in (2, 3):
        raise UsageError(f"camera: ripple: wanted (nm, um) or (nm, um, seed), got {short(given)}")
    height, period, seed = numbers((*given, 0)[:3], "camera: ripple", 3, "nm, um and a seed")
    number(height, "camera: ripple", 0, 1000)
    number(period, "camera: ripple", 5, 10000)
    return height, period, whole(int(seed), "camera: ripple: seed", 0, 2**32 - 1)


def _rippled(lens: lenses.Lens, ripple: tuple[float, float, int]) -> lenses.Lens:
    """The lens with grooves in all of its aspheric surfaces, each with its own."""
    height, period, seed = ripple
    if not any(s.kind == "aspheric" for s in lens.surfaces):
        raise UsageError(f"camera: ripple: {lens.name} has no aspheric surface")
    return lens.rebuilt(
        [
            s.replaced(ripple=(height, period, seed + i)) if s.kind == "aspheric" else s
            for i, s in enumerate(lens.surfaces)
        ]
    )


def _transmittance(lens: lenses.Lens, order: lenses.FirstOrder) -> float:
    """On the axis, of light as bright as a D65 world, at any f-stop."""
    f_stop = order.f_number or DEFAULT_F_STOP  # 0: a stop whose size nobody knows
    with reported(lens.source):
        thick = _core.ThickLens(lens.prescription, f_stop, _core.Iris(), math.inf)
    return float(thick.transmittance)


def _f_stop(
    camera: Camera,
    lens: lenses.Lens,
    model: str,
    order: lenses.FirstOrder,
    transmittance: float,
) -> float:
    if camera.t_stop is None:
        f_stop = camera.f_stop or max(DEFAULT_F_STOP, order.f_number)
        # A pinhole does not open: a scene's f-stop that the lens lacks is no error.
        return max(f_stop, order.f_number) if model == "pinhole" else f_stop
    f_stop = camera.t_stop * math.sqrt(transmittance)
    if f_stop < 0.99 * order.f_number:  # as the core grants
        widest = order.f_number / math.sqrt(transmittance)
        raise LensError(
            f"{lens.source}: t-stop: wanted T/{widest:.3g} or narrower (f/{order.f_number:.3g} "
            f"and {100 * transmittance:.3g} % of the light), got T/{camera.t_stop:.4g}",
            "lens-f-stop",
        )
    return f_stop


def _focused(camera: Camera, lens: lenses.Lens, distance: float, f_stop: float) -> _InFocus:
    from_sensor = camera.focus_from == "sensor" and camera.focus_distance is not None
    found = lens.focused(
        distance,
        f_stop=f_stop,
        by="best" if camera.focus_by == "best" else "paraxial",
        measured_from="sensor" if from_sensor else "pupil",
    )
    if from_sensor:  # the film's place is known now, and with it the way to the pupil
        distance -= (found.film_z_mm - found.entrance_pupil_z) * 1e-3
    used = found.lens
    for surfaces, place, angles in decenters(camera):
        used = used.decentered(surfaces, place, angles)
    if camera.ripple is not None:
        used = _rippled(used, _ripple(camera))
    return _InFocus(used, found.lens.first_order(), found.film_z_mm, distance, f_stop)


def _traced_lens(
    camera: Camera, model: str, sharp: _InFocus, frame: tuple[float, float], focus: Focus
) -> tuple[_core.ExactLens, dict[str, Any]]:
    """The lens by its surfaces or by polynomials, and what there is to say of those."""
    facts: dict[str, Any] = {}
    if model == "polynomial":
        degree = camera.degree or camera_fit.DEFAULT_DEGREE
        exact = _exact_lens(camera, sharp, frame, degree)
        pitch = focus.frame[0] / focus.resolution[0]
        exact, facts = camera_fit.judged(exact, camera, sharp.lens.name, pitch, focus.notes)
    else:
        exact = _exact_lens(camera, sharp, frame)
    focus.notes += frame_notes(exact, sharp.lens, frame, camera.shift)
    masks = mask_of(camera, "front_mask"), mask_of(camera, "iris_mask")
    if any(mask is not None for mask in masks):
        exact = exact.with_dirt(*masks)
    return exact, facts


def _core_camera(
    camera: Camera, model: str, sharp: _InFocus, pose: _core.Motion, film: float
) -> tuple[_core.Camera, float]:
    """Makes the camera of a model without surfaces; returns it with its H0."""
    with reported(sharp.lens.source):
        thick = _core.ThickLens(
            sharp.lens.prescription,
            sharp.f_stop,
            iris_of(camera),
            sharp.distance,
            film_z_mm=sharp.film_z,
            tilt_deg=camera.tilt,
        )
    radius = sharp.order.efl / sharp.f_stop / 2
    vignetting = camera.natural_vignetting
    if model == "thick":
        core = _core.Camera.thick(pose, thick)
    elif model == "thin":
        core = _core.Camera.thin(
            pose, film, radius, sharp.distance, iris_of(camera), vignetting, camera.tilt
        )
    else:
        core = _core.Camera.pinhole(pose, film, vignetting)
    return core, thick.h0


def _directions(
    camera: Camera,
    lens: lenses.Lens,
    model: str,
    frame: tuple[float, float],
    f_stop: float,
    distance: float,
) -> Directions:
    """View directions of film points at a focus distance that may not be the last one."""
    if camera.focus_at is None or model not in TRACED or any(camera.tilt):
        film = framing_distance(_focused(camera, lens, distance, f_stop))
        return ideal_direction(film * tilt.cosine(camera.tilt))
    far = _exact_lens(camera, _focused(camera, lens, math.inf, f_stop), frame)

    def direction(x: float, y: float) -> NDArray[np.float64]:
        return np.array(far.chief_direction(x, y))

    return direction


def _imaging(order: lenses.FirstOrder) -> tilt.Imaging:
    front = order.front_principal_point - order.front_focal_point
    return tilt.Imaging(
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
    camera: Camera, sharp: _InFocus, frame: tuple[float, float], fit_degree: int | None = None
) -> _core.ExactLens:
    half = [abs(s) + size / 2 for s, size in zip(camera.shift, frame, strict=True)]
    settings = _core.ExactLensSettings(
        f_stop=sharp.f_stop,
        iris=iris_of(camera),
        focus_distance_m=sharp.distance,
        # The reconstruction filter reaches over the frame's edge.
        half_diagonal_mm=1.02 * math.hypot(*half),
        film_z_mm=sharp.film_z,
        tilt_deg=camera.tilt,
        film_center_mm=camera.shift,
        film_half_mm=(0.51 * frame[0], 0.51 * frame[1]),
        fit_degree=fit_degree,
    )
    with reported(sharp.lens.source):
        return exact_lens(sharp.lens.prescription, settings)


def _hash_lens(lens: lenses.Lens) -> str:
    text = json.dumps(lens.data, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()
