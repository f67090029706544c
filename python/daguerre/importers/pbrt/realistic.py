"""Reads the realistic camera: a lens file, its iris, its focus and its film.

The prescription is traced exactly. pbrt's camera is at its film and focuses from
there; Daguerre's is in the entrance pupil.

Source: pbrt-v4's user's guide ("realistic"); ``RealisticCamera`` of pbrt-v4 and pbrt-v3.
"""

from __future__ import annotations

import math
from typing import Any

import daguerre._core as _core
from daguerre.errors import InputError, asked_by
from daguerre.files.reading import MISSING
from daguerre.lenses import Lens
from daguerre.lenses import read as read_lens
from daguerre.lenses.errors import reported
from daguerre.lenses.focus import Focused

from .files import Files
from .film import FilmSize
from .ledger import Ledger
from .seen import Seen
from .state import Entity

#: Shapes of the iris in pbrt-v4 by the number of blades.
_BLADES = {"square": 4, "pentagon": 5}
#: pbrt-v3 draws rays from squares around the exit pupil, which it widens by this share of the rear
#: element's radius on each side: twice the diagonal of 1.5 radii, in 1024 steps.
_WIDENED = 2 * 3 * math.sqrt(2) / 1024
#: Half the diagonal of a film that only needs its middle, mm.
_SMALL_MM = 0.5


def lens_of(
    entity: Entity, film: FilmSize, unit: float, files: Files, version: int, ledger: Ledger
) -> Seen:
    """Reads a realistic camera.

    Args:
        entity: Directive.
        film: Film.
        unit: Length of a unit of the world, m; lens files and irises are in mm.
        files: Files of the scene.
        version: Version of pbrt, 3 or 4.
        ledger: Counts directives.

    Raises:
        InputError: A parameter or the lens file is wrong.
    """
    parameters = entity.parameters
    name = parameters.text("lensfile")
    if not name:
        entity.place.fail("lensfile: missing")
    path = files.find(name, entity.place, "lensfile")
    if path is None:
        entity.place.fail(f"lensfile: {name[:200]!r}: {MISSING}")
    with asked_by(entity.place):
        lens = read_lens(path)
    f_stop = _f_stop(entity, lens, parameters.number("aperturediameter", 1.0, 1e-6), ledger)
    distance = parameters.number("focusdistance", 10.0, 1e-6) * unit
    try:
        focused = lens.focused(distance, f_stop=f_stop, measured_from="sensor")
    except InputError as error:
        entity.place.fail(f"focusdistance: {error}")
    fields: dict[str, Any] = {
        "lens": lens,
        "f_stop": f_stop,
        "focus_distance": distance,
        "focus_from": "sensor",
        "sensor_size": film.millimetres,
        **_iris(entity, ledger),
    }
    simple = version == 3 and entity.parameters.flag("simpleweighting", True)
    ahead = (focused.film_z_mm - focused.entrance_pupil_z) / 1000
    if simple:
        weight = _simple_share(focused, parameters.number("aperturediameter", 1.0))
    else:
        weight = _illuminance(entity, focused, f_stop, distance - ahead)
    return Seen(fields, ahead, weight, timed=not simple)


def _f_stop(entity: Entity, lens: Lens, diameter: float, ledger: Ledger) -> float:
    """F-stop of an iris of a diameter, mm."""
    order = lens.first_order()
    widest = 2 * order.stop_semi_diameter
    if diameter > widest * (1 + 1e-9):
        ledger.notes.add("an iris is limited to the size in its lens file")
    if not widest > 0:
        entity.place.fail("lensfile: the iris is closed")
    return float(order.f_number * max(widest / diameter, 1.0))


def _iris(entity: Entity, ledger: Ledger) -> dict[str, Any]:
    name = entity.parameters.text("aperture")
    if not name or name == "gaussian":
        if name:
            ledger.notes.add("the iris 'gaussian' is left out: it is round")
        return {}
    if name in _BLADES:
        return {"blades": _BLADES[name]}
    ledger.notes.add(f"the iris {name[:40]!r} is left out: it is round")
    return {}


def _illuminance(entity: Entity, focused: Focused, f_stop: float, distance: float) -> float:
    """Illuminance of the film's middle by a radiance of 1, for glass that loses no light."""
    lens = focused.lens
    settings = _core.ExactLensSettings(
        f_stop=f_stop,
        focus_distance_m=distance,
        half_diagonal_mm=_SMALL_MM,
        film_z_mm=focused.film_z_mm,
    )
    with asked_by(entity.place), reported(lens.source):
        exact = _core.ExactLens(lens.prescription, settings)
    return float(exact.h0 / exact.transmittance)


def _simple_share(focused: Focused, diameter: float) -> float:
    """Share of the square around the exit pupil that passes light: pbrt-v3's factor on radiance.

    The square is in the plane of the rear element, as the film's centre sees the pupil.
    """
    order, rear = focused.lens.first_order(), focused.lens.surfaces[-1].semi_diameter
    pupil, vertex = order.exit_pupil, float(focused.lens.vertices[-1])
    opened = min(diameter / (2 * order.stop_semi_diameter), 1.0)
    scale = (focused.film_z_mm - vertex) / (focused.film_z_mm - pupil.z)
    side = abs(pupil.diameter * opened * scale)
    return float(math.pi / 4 * (side / (side + 2 * _WIDENED * (rear or 0.0))) ** 2)
