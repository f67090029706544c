"""Restores the sun of an environment that clipping has weakened."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError

from .asked import Asked
from .from_balls import shading
from .from_panorama import PanoramaLight
from .restore import (
    by_grey_ball,
    by_illuminance,
    clipped_facts,
    ground_illuminance,
    shared,
)
from .sun import DIAMETER_DEG, Sun, Taken, take_out, with_disc


@dataclass(frozen=True)
class Lit:
    """An environment with and without its sun, and warnings on missing light."""

    image: NDArray[np.float32]
    rest: NDArray[np.float32]
    sun: Sun | None
    absolute: bool
    warnings: tuple[str, ...] = ()


def sun_and_light(asked: Asked, source: PanoramaLight) -> Lit:
    """Finds the sun and the light lost to clipping.

    Raises:
        InputError: There is no sun to solve for, or it does not fit the measurement.
    """
    solve = bool(asked.grey or asked.illuminance)
    taken = _taken(asked, source, solve)
    if solve and source.clipped.any():
        return _solved(asked, source, taken)
    lit = _as_it_is(asked, source, taken)
    if asked.grey:
        asked.notes.add("--grey is ignored, as nothing is clipped")
    return _scaled(lit, asked.illuminance) if asked.illuminance else lit


def _taken(asked: Asked, source: PanoramaLight, solve: bool) -> Taken | None:
    if source.sun is not None:
        if asked.sun == "off":
            return None
        direction, energy = ([float(v) for v in part] for part in source.sun)
        x, y, z = direction
        red, green, blue = energy
        made = Sun((x, y, z), (red, green, blue), DIAMETER_DEG)
        return Taken(shared(made, source.light), source.light)
    if asked.sun == "off" and not solve:
        return None
    return take_out(source.light, source.clipped, seek_clipped=solve)


def _as_it_is(asked: Asked, source: PanoramaLight, taken: Taken | None) -> Lit:
    """Keeps the light as photographed, with a warning if it is clipped."""
    warnings = _warnings(source)
    if taken is None:
        return Lit(source.light, source.light, None, source.absolute, warnings)
    sun, image = taken.sun, source.light
    if asked.sun == "disc" or source.sun is not None:
        sun = _sized(asked, sun)
        image = with_disc(taken.rest, sun)
    return Lit(image, taken.rest, sun, source.absolute, warnings)


def _sized(asked: Asked, sun: Sun) -> Sun:
    if asked.sun_diameter is not None:
        return replace(sun, diameter_deg=asked.sun_diameter)
    return replace(sun, diameter_deg=DIAMETER_DEG) if sun.clipped else sun


def _warnings(source: PanoramaLight) -> tuple[str, ...]:
    if not source.clipped.any():
        return ()
    facts = clipped_facts(source.light, source.clipped)
    unit = "lux" if source.absolute else "(unknown unit)"
    return (
        f"{facts['share']:.3%} of the sphere is clipped in every photograph, around azimuth "
        f"{facts['azimuth_deg']:.0f}, elevation {facts['elevation_deg']:.0f} degrees: at least "
        f"{facts['illuminance_at_least']:.4g} {unit}, {facts['light_share_at_least']:.1%} "
        "of all light, and more is lost; add a shorter exposure, --illuminance or --grey",
    )


def _solved(asked: Asked, source: PanoramaLight, taken: Taken | None) -> Lit:
    """Solves for the sun from a light meter or a matt ball."""
    if taken is None or not taken.sun.clipped:
        raise InputError(
            f"{asked.photographs[0]}: clipped light: wanted one clipped area of at most 40 degrees "
            "that could be the sun, got none; photograph it with shorter exposures"
        )
    if asked.illuminance is not None:
        if not source.absolute:
            raise InputError(
                f"{asked.photographs[0]}: --illuminance needs light in a known unit, to subtract "
                "the rest of it; give --scale, or use --grey instead"
            )
        sun = by_illuminance(taken.sun, taken.rest, asked.illuminance)
    else:
        matt, _, _ = shading(asked, asked.grey, asked.grey_circle, asked.grey_yaw)
        sun = by_grey_ball(taken.sun, taken.rest, matt)
    sun = shared(_sized(asked, sun), taken.rest)
    return Lit(with_disc(taken.rest, sun), taken.rest, sun, source.absolute)


def _scaled(lit: Lit, lux: float) -> Lit:
    """Scales the whole map to the reading of a light meter, if nothing is clipped.

    Raises:
        InputError: The upper half is black.
    """
    now = ground_illuminance(lit.image)
    if not now > 0:
        raise InputError("--illuminance: wanted light from above the horizon, got none")
    factor = np.float32(lux / now)
    red, green, blue = ((v * lux / now) for v in (lit.sun.illuminance if lit.sun else (0, 0, 0)))
    sun = lit.sun and replace(lit.sun, illuminance=(red, green, blue))
    return Lit(lit.image * factor, lit.rest * factor, sun, True)
