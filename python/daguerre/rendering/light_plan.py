"""Numbers of light paths, ghost paths and scatter paths, in picture and overscan."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.camera import shutter
from daguerre.camera.overscan import NONE, Overscan
from daguerre.errors import InputError, UsageError, core_errors
from daguerre.sensors.bands import responses
from daguerre.setup.camera import set_up
from daguerre.setup.checks import check_surfaces
from daguerre.setup.resolved import ResolvedCamera

from .film_memory import check_film
from .film_parts import FilmPart, area, core_settings
from .light_paths import OFF, PER_PIXEL, Plan, check_light_paths, check_paths
from .parameters import ENVIRONMENT
from .pixels import parse_filter
from .plate_light import throw_plate
from .prepare import Prepared
from .settings import RenderSettings
from .surroundings import solids_around

#: Reasons for not drawing requested paths.
DARK = {
    "flare": "no light of this scene makes a ghost in this lens",
    "scatter": "the scene has no lights, or the lens scatters nothing",
}


@dataclass(frozen=True)
class LightPlan:
    """Numbers of paths per sample index, and the parts of the film that draw them.

    Attributes:
        parts: The picture and its overscan, as far as the crop has them.
        light_paths: Number of paths from the lights: directly to the lens, and with bounces.
        flare: Number of ghost paths.
        scatter: Number of paths that the lens scatters.
        notes: Reasons why some kinds of paths are not drawn.
        piloted: Result of the pilot render that chose the numbers; None: there was no pilot.
        core: Settings of the core for the picture.
    """

    parts: list[FilmPart]
    light_paths: Plan
    flare: float
    scatter: float
    notes: tuple[str, ...]
    piloted: Plan | None
    core: _core.RenderSettings

    @property
    def followed(self) -> bool:
        """Whether any part draws light paths."""
        return any(part.settings.light_paths != OFF for part in self.parts)


def plan_light(prepared: Prepared, piloted: Plan | None = None) -> LightPlan:
    """Makes the plan for a picture.

    Args:
        prepared: The picture.
        piloted: Result of a pilot render of the same picture; None: not known, so that automatic
            numbers need a pilot render.
    """
    check_light(prepared)
    core = core_settings_of(prepared)
    wanted = check_light_paths(prepared.settings.light.light_paths)
    inside, notes = solids_around(prepared)
    if _is_over_plate(prepared):
        wanted = OFF
    elif inside and wanted != OFF:
        notes.append(f"light paths are off: the camera is inside {inside[0]}")
        wanted = OFF
    if piloted is not None:
        piloted = check_light_paths(piloted, "piloted")
    if wanted is not None:
        plan, piloted = wanted, None
    else:
        plan = piloted = piloted or pilot(prepared, core)
    # The pilot renders the whole frame; a crop gets paths in proportion to its pixels.
    shared = prepared.share(area(prepared.window)) if wanted is None else 1.0
    core.light_paths = light_paths = (plan[0] * shared, plan[1] * shared)
    core.prepare_light(prepared.core_scene, prepared.setup.core)
    paths = {name: _prepare(prepared, core, name, notes) for name in DARK}
    parts = []
    if inner := area(prepared.window):
        if prepared.overscan:
            core.window = prepared.window
        parts.append(FilmPart(prepared.setup.core, core, (0, 0), inner))
    if outer := area(prepared.crop) - inner:
        grown = prepared.share(area(prepared.overscan.region(prepared.size)))
        times = prepared.share(outer) if wanted is None else grown
        parts.append(_around(prepared, (plan[0] * times, plan[1] * times), paths, outer))
    return LightPlan(parts, light_paths, **paths, notes=tuple(notes), piloted=piloted, core=core)


def check_light(prepared: Prepared) -> None:
    """Checks that lens and scene allow the light that is asked for, before anything is set up.

    Raises:
        UsageError: The message names the parameter.
    """
    if _is_over_plate(prepared):
        _check_catchers(prepared)
    for name in DARK:
        if check_paths(getattr(prepared.settings.light, name), name) != 0:
            check_surfaces(prepared.setup.lens.model, name)


def core_settings_of(prepared: Prepared) -> _core.RenderSettings:
    """Settings of the core for a picture, before any paths are planned."""
    with core_errors(UsageError):
        return _settings(prepared, prepared.setup, NONE)


@dataclass(frozen=True)
class FilmPlan:
    """Film that a picture needs; it takes memory when it is made.

    Attributes:
        layout: Its layout.
        responses: Responses of its channels; None: it has no channels.
    """

    layout: _core.FilmLayout
    responses: NDArray[np.float64] | None

    def film(self) -> _core.Film:
        """Makes the film."""
        made = _core.Film(self.layout)
        if self.responses is not None:
            made.set_responses(self.responses)
        return made


def plan_film(prepared: Prepared, plan: LightPlan) -> FilmPlan:
    """Plans the film, with the layers that the picture needs.

    Raises:
        InputError: The film would be too large.
    """
    x0, y0, x1, y1 = prepared.crop
    film, waves = prepared.settings.film, prepared.settings.diffraction
    curves = None if prepared.sensor is None else responses(prepared.sensor)
    layout = _core.FilmLayout(
        width=x1 - x0,
        height=y1 - y0,
        offset_x=x0,
        offset_y=y0,
        aovs=film.aovs,
        splats=plan.followed,
        flare=plan.flare > 0 or plan.scatter > 0,
        halves=film.halves,
        coverage=True,
        objects=bool(film.cryptomatte),
        catchers=prepared.scene.has_catchers,
        bands=film.bands if waves is None else waves.bands,
        channels=0 if curves is None else len(curves),
    )
    check_film(layout, truth=prepared.settings.truth.moment is not None, scatter=plan.scatter > 0)
    return FilmPlan(layout, curves)


def _is_over_plate(prepared: Prepared) -> bool:
    return prepared.scene.has_catchers or prepared.scene.plate is not None


def _check_catchers(prepared: Prepared) -> None:
    """Refuses effects that would be in a plate twice, or in the wrong place.

    Raises:
        UsageError: The message names the parameter.
    """
    light = prepared.settings.light
    for name in DARK:
        if check_paths(getattr(light, name), name) != 0:
            raise UsageError(
                f"{name}: cannot be used with catchers: the plate already has the {name} of its "
                "own lights"
            )
    if prepared.settings.diffraction is not None or prepared.settings.film.bands:
        name = "bands" if prepared.settings.diffraction is None else "diffraction"
        raise UsageError(
            f"{name}: cannot be used with catchers, as their layers store only colours"
        )
    if check_light_paths(light.light_paths) not in (None, OFF):
        raise UsageError("light_paths: wanted auto or off with catchers, got a number of paths")


def pilot(prepared: Prepared, core: _core.RenderSettings) -> Plan:
    """Numbers of light paths that pay off in this scene, estimated by a few samples."""
    m1, m2 = _core.pilot(prepared.core_scene, prepared.setup.core, core)
    return m1, m2


def _around(prepared: Prepared, plan: Plan, paths: dict[str, float], pixels: int) -> FilmPart:
    """Film part of the overscan, drawn by the same camera with a larger sensor."""
    overscan = prepared.overscan
    setup = set_up(
        prepared.scene, prepared.focused_camera, prepared.size, prepared.core_scene, overscan
    )
    core = _settings(prepared, setup, overscan)
    core.light_paths = plan
    core.prepare_light(prepared.core_scene, setup.core)
    grown = prepared.share(area(overscan.region(prepared.size)))
    for name, count in paths.items():
        if count and getattr(core, f"prepare_{name}")(prepared.core_scene, setup.core):
            setattr(core, name, count * grown)
    return FilmPart(setup.core, core, (overscan.left, overscan.top), pixels)


def _prepare(prepared: Prepared, core: _core.RenderSettings, name: str, notes: list[str]) -> float:
    """Paths per sample index of flare or scatter, as for the whole frame; 0: none."""
    paths = check_paths(getattr(prepared.settings.light, name), name)
    if paths == 0:
        return 0.0
    with core_errors(InputError, name):
        shines = getattr(core, f"prepare_{name}")(prepared.core_scene, prepared.setup.core)
    if not shines:
        notes.append(f"{name}: {DARK[name]}")
        return 0.0
    if name == "flare" and core.flare_maps_failed:
        off = f"{core.flare_map_error:.1%}"
        notes.append(f"flare: ghost maps are off by {off}, wanted 1 %; paths draw all ghosts")
    count = PER_PIXEL[name] * area((0, 0, *prepared.size)) if paths is None else paths
    setattr(core, name, count)
    return float(count)


def _settings(
    prepared: Prepared, setup: ResolvedCamera, overscan: Overscan
) -> _core.RenderSettings:
    core_shutter = shutter.core_shutter(prepared.camera, prepared.size)
    core = core_settings(setup, prepared.size, core_shutter, overscan, _options(prepared.settings))
    throw_plate(prepared, core)
    return core


def _options(settings: RenderSettings) -> dict[str, Any]:
    """Settings of the core, by name."""
    light, reference = settings.light, settings.reference
    name, radius = parse_filter(settings.sampling.filter)
    return {
        "seed": settings.sampling.seed,
        "threads": settings.threads,
        "filter": _core.Filter(name, radius),
        "max_depth": light.max_depth,
        "transparent": settings.backdrop.background != ENVIRONMENT,
        "see_through": settings.backdrop.see_through,
        "strategy": reference.strategy,
        "dispersion": reference.dispersion,
        "technique": reference.technique,
        "flare_order": light.flare_order,
        "flare_highlights": light.flare_highlights,
        "flare_maps": not (settings.film.bands or settings.diffraction),
    }
