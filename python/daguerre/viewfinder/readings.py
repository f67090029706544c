"""Readings: the numbers of a camera that the page shows beside its dials."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.placement import look_at
from daguerre.errors import DaguerreError
from daguerre.exposure.metering import ev100_of, luminance_of, stops_over_grey
from daguerre.lenses.focus import closest_focus_m
from daguerre.rendering.over_meter import metered_part
from daguerre.rendering.session import Session
from daguerre.setup.camera_facts import UNLIT, Facts, camera_warnings, facts_of, lit
from daguerre.setup.resolved import ResolvedLens

from .beside import models_beside
from .drawn import Drawn
from .sight import ring_offset_m
from .switches import possible


def readings_of(drawn: Drawn) -> dict[str, Any]:
    """Numbers of the camera that drew a picture, as JSON values; infinity is null."""
    session = drawn.session
    facts = _facts(session)
    return {
        "lens": facts.lens,
        "focal_length_mm": facts.focal_length_mm,
        "f_stop": facts.f_stop,
        "t_stop": facts.t_stop,
        "zoom_mm": facts.zoom_mm,
        "zoom_range_mm": facts.zoom_range_mm,
        "field_of_view_deg": facts.picture_field_of_view_deg,
        **_distances(session, facts),
        "shutter_s": facts.shutter_s,
        "shutter": facts.shutter,
        "ev100": facts.ev100,
        "warnings": _warnings(drawn),
        "meter": _meter(drawn),
        **_body(drawn),
    }


def limits_of(session: Session) -> tuple[float | None, float | None]:
    """Limits of the depth of field on the focus ring, m; None: infinity."""
    distances = _distances(session, _facts(session))
    return distances["near_m"], distances["far_m"]


def _facts(session: Session) -> Facts:
    return facts_of(
        session.prepared.setup, session.camera, session.scene.time, session.prepared.size
    )


def _distances(session: Session, facts: Facts) -> dict[str, float | None]:
    """Distances of the focus ring, from where the camera measures them; None: infinity."""
    camera, lens = session.camera, session.prepared.setup.lens
    from_sensor = camera.focus_from == "sensor"
    more = ring_offset_m(session)
    found = {
        "focus_m": facts.focus_m,
        "hyperfocal_m": facts.hyperfocal_m,
        "near_m": facts.near_m,
        "far_m": facts.far_m,
    }
    closest = closest_m(lens, from_sensor=from_sensor, breathes=camera.focus_breathing)
    return {
        "closest_m": None if closest is None else _rounded_up(closest),
        **{name: _finite(None if m is None else m + more) for name, m in found.items()},
    }


def closest_m(lens: ResolvedLens, *, from_sensor: bool, breathes: bool) -> float | None:
    """Closest distance of the focus ring, m; None: no limit.

    Ideal lenses that focus by moving the film reach 1:1; other ideal lenses focus anywhere.
    """
    if lens.glass is not None:
        return closest_focus_m(lens.glass.lens, from_sensor=from_sensor)
    if lens.focus_distance_m is None or lens.projection is not None or not breathes:
        return None
    return 1e-3 * lens.focal_length_mm * (4 if from_sensor else 2)


def _rounded_up(value: float) -> float:
    """Value with the four digits of the ring's texts, not below it."""
    if not value > 0:
        return 0.0
    digits = 3 - math.floor(math.log10(value))
    scale = 10.0**digits
    return math.ceil(round(value * scale, 6)) / scale


def _warnings(drawn: Drawn) -> list[str]:
    """Warnings as the command line gives them, and notes that a turn of a ring can bring."""
    session, chosen = drawn.session, drawn.shot.chosen
    glass = session.prepared.setup.lens.glass
    whole = [glass.whole] if glass is not None and glass.whole is not None else []
    unlit = [] if lit(session.scene) else [UNLIT]
    dim = [chosen.warning] if chosen is not None and chosen.warning else []
    alone = [drawn.note] if drawn.note else []
    return [*camera_warnings(session.camera), *unlit, *session.warnings, *whole, *dim, *alone]


def _meter(drawn: Drawn) -> dict[str, float] | None:
    """Light that a meter reads: luminance of the scene, and illuminance at the same EV100.

    Lux are for an incident meter with the constant C = 250 (ISO 2720): E = 2.5 * 2^EV100.
    ``over`` is the distance of the picture from the meter, EV, as ``render`` prints it.
    """
    whole = drawn.request.shot.settings.film.resolution
    try:
        part = metered_part(drawn.session, whole)
        luminance = luminance_of(drawn.frame, part.pattern, part.at)
        over = stops_over_grey(drawn.frame, luminance)
    except DaguerreError:  # such as a spot out of view, or a frozen shutter
        return None
    if over is None:
        return None
    ev100 = ev100_of(luminance)
    return {"luminance": luminance, "ev100": ev100, "lux": 2.5 * 2.0**ev100, "over": over}


def _body(drawn: Drawn) -> dict[str, Any]:
    """Positions of the dials of the body, and the place of the camera."""
    session = drawn.session
    camera = session.camera.frozen_at(session.scene.time)
    asked = drawn.request.shot.camera.frozen_at(session.scene.time)
    white, pose = camera.white_balance, np.asarray(camera.transform, np.float64)
    lens = session.prepared.setup.lens
    return {
        "fps": camera.fps,
        "iso": camera.iso,
        "ev": asked.exposure_compensation,  # a mode that chooses takes it in
        "white_k": white if isinstance(white, float | int) else None,
        "blades": camera.blades,
        "widest": None if lens.f_stop is None else lens.widest_stop,
        "models": models_beside(lens),
        "switches": possible(lens.model),
        "spp": drawn.shot.settings.sampling.most,
        "time_s": session.scene.time,
        "place": {
            "position": pose[:3, 3].tolist(),
            "forward": (-pose[:3, 2] / np.linalg.norm(pose[:3, 2])).tolist(),
            "roll": roll_of(pose),
        },
    }


def roll_of(pose: NDArray[np.float64]) -> float:
    """Roll of a camera from level, degrees; see ``look_at``."""
    level = look_at(tuple(pose[:3, 3]), tuple(pose[:3, 3] - pose[:3, 2]))
    right = pose[:3, 0] / np.linalg.norm(pose[:3, 0])
    return float(np.degrees(np.arctan2(-right @ level[:3, 1], right @ level[:3, 0])))


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None
