"""Fitted lenses as dictionaries and back: the form ``daguerre-lens-fit/0.1``.

Lengths are mm, angles rad, lens frame (z from the scene to the film). A film ray is a film point p
and a slope m = (dx/dz, dy/dz). In units of the film f = (p - center) / half, and
q = by_film f + by_slope m + shift, component by component; l = offset + scale / lambda^2 (um).

Axial lenses: variables (s, W, U, l), s = f.q, W = 2 |q|^2 - 1, U = (2 |f|^2 - low - high) /
(high - low) with the segment's [low, high]; a vector is f A + q B. Others: (q.x, q.y, f.x, f.y, l),
and vectors have an x and a y of their own. A function is the sum over rows of
``coefficients[row][function]`` x the product of the variables to ``powers[row]``. If a segment has
a ``bend``, its ``direction`` reads q + bend in the place of q.

The scene ray: direction v = theta (dx, dy) / sin(theta), theta from -z; offset e from
(0, 0, entrance_pupil_z): the ray passes there through e - v (e.v) (1 - cos(theta)) / theta^2 in x
and y, (e.v) sin(theta) / theta in z.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import daguerre._core as _core
from daguerre.checks import short
from daguerre.errors import CoreError, InputError

FORMAT = "daguerre-lens-fit/0.1"
_PAIRS = ("direction", "film", "iris", "mount", "transmittance")
_UNITS = {"direction": "_rad", "film": "_um", "iris": "_mm", "mount": "_mm", "transmittance": ""}


def error_zone(zone: _core.FitErrorZone) -> dict[str, Any]:
    """Errors of one zone, by the names of ``ErrorZone``."""
    pairs = {
        name + _UNITS[name]: (getattr(zone, name).rms, getattr(zone, name).max) for name in _PAIRS
    }
    return {
        "low": zone.low,
        "high": zone.high,
        "rays": zone.rays,
        **pairs,
        "lost": zone.lost,
        "leaked": zone.leaked,
    }


def to_dict(fit: _core.LensFit) -> dict[str, Any]:
    """Converts a fit to JSON-compatible data."""
    axial, mirror_x, mirror_y = fit.symmetry
    points = ["offset", "iris", *(f"mount{i}" for i in range(len(fit.mounts)))]
    offset, scale = fit.wavelength_scale
    center, x, y = fit.film_plane
    return {
        "format": FORMAT,
        "lens": fit.lens,
        "degree": fit.degree,
        "symmetry": {"axial": axial, "mirror_x": mirror_x, "mirror_y": mirror_y},
        "wavelength": {"offset": offset, "scale": scale},
        "film": {
            "center": list(fit.film_center),
            "half": list(fit.film_half),
            "plane": {"center": list(center), "x": list(x), "y": list(y)},
        },
        "pupil": _pupil(fit.pupil),
        "entrance_pupil_z": fit.entrance_pupil_z,
        "front": {"z": fit.front_z, "curvature": fit.front_curvature},
        "iris": {"radius": fit.iris_radius, "outer": fit.iris_outer},
        "mounts": [
            {"surface": m.surface, "radius": m.radius, "inner": m.inner} for m in fit.mounts
        ],
        "segments": [
            {
                "u": [s.u_low, s.u_high],
                "bend": _vectors(s.bend, ["bend"], axial) if len(s.bend.x.powers) else None,
                "direction": _vectors(s.direction, ["direction"], axial),
                "points": _vectors(s.points, points, axial),
                "light": _functions(s.light.x, ["transmittance"]),
            }
            for s in fit.segments
        ],
        "inverse": {
            "direction": fit.inverse.direction,
            "pupil": _pupil(fit.inverse.pupil),
            "rays": _vectors(fit.inverse.rays, ["film", "pupil"], axial),
        },
        "error": {
            "all": error_zone(fit.error.all),
            "zones": [error_zone(zone) for zone in fit.error.zones],
        },
    }


def from_dict(data: object) -> _core.LensFit:
    """Makes a fit from the data of ``to_dict``."""
    form = data.get("format") if isinstance(data, dict) else None
    if not isinstance(data, dict) or form != FORMAT:
        raise InputError(f"lens fit: format: wanted {FORMAT!r}, got {short(form)}")
    try:
        return _read(data)
    except CoreError as error:
        raise InputError(f"lens fit: wanted data in the format {FORMAT}, got {error}") from None
    except (KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
        text = f"{type(error).__name__}: {error}"
        raise InputError(f"lens fit: wanted data in the format {FORMAT}, got {text}") from None


def _read(data: dict[str, Any]) -> _core.LensFit:
    fit = _core.LensFit()
    fit.lens, fit.degree = data["lens"], data["degree"]
    symmetry = data["symmetry"]
    fit.symmetry = (symmetry["axial"], symmetry["mirror_x"], symmetry["mirror_y"])
    film = data["film"]
    fit.film_center, fit.film_half = tuple(film["center"]), tuple(film["half"])
    fit.film_plane = [film["plane"][name] for name in ("center", "x", "y")]
    fit.pupil = _read_pupil(data["pupil"])
    fit.entrance_pupil_z = data["entrance_pupil_z"]
    fit.front_z, fit.front_curvature = data["front"]["z"], data["front"]["curvature"]
    fit.iris_radius, fit.iris_outer = data["iris"]["radius"], data["iris"]["outer"]
    fit.mounts = [_read_mount(mount) for mount in data["mounts"]]
    fit.segments = [_read_segment(segment) for segment in data["segments"]]
    inverse = _core.FitInverse()
    inverse.direction = data["inverse"]["direction"]
    inverse.pupil = _read_pupil(data["inverse"]["pupil"])
    inverse.rays = _read_block(data["inverse"]["rays"])
    fit.inverse = inverse
    error = _core.FitError()
    error.all = _read_zone(data["error"]["all"])
    error.zones = [_read_zone(zone) for zone in data["error"]["zones"]]
    fit.error = error
    fit.check()
    return fit


def _pupil(pupil: _core.FitPupil) -> dict[str, list[float]]:
    return {name: list(getattr(pupil, name)) for name in ("by_film", "by_slope", "shift")}


def _functions(functions: _core.FitFunctions, names: list[str]) -> dict[str, Any]:
    return {
        "functions": names,
        "powers": functions.powers.tolist(),
        "coefficients": functions.coefficients.tolist(),
    }


def _vectors(block: _core.FitBlock, names: list[str], axial: bool) -> dict[str, Any]:
    if axial:
        return _functions(block.x, [f"{name}.{side}" for name in names for side in "AB"])
    return {
        axis: _functions(getattr(block, axis), [f"{name}.{axis}" for name in names])
        for axis in "xy"
    }


def _read_pupil(data: dict[str, Any]) -> _core.FitPupil:
    pupil = _core.FitPupil()
    for name in ("by_film", "by_slope", "shift"):
        setattr(pupil, name, tuple(data[name]))
    return pupil


def _read_functions(data: dict[str, Any]) -> _core.FitFunctions:
    return _core.FitFunctions(
        np.array(data["powers"], np.int32).reshape(-1, 5),
        np.array(data["coefficients"], np.float64).reshape(-1, len(data["functions"])),
    )


def _read_block(data: dict[str, Any]) -> _core.FitBlock:
    block = _core.FitBlock()
    if "powers" in data:
        block.x = _read_functions(data)
    else:
        block.x, block.y = _read_functions(data["x"]), _read_functions(data["y"])
    return block


def _read_mount(data: dict[str, Any]) -> _core.FitMount:
    mount = _core.FitMount()
    mount.surface, mount.radius, mount.inner = data["surface"], data["radius"], data["inner"]
    return mount


def _read_segment(data: dict[str, Any]) -> _core.FitSegment:
    segment = _core.FitSegment()
    segment.u_low, segment.u_high = data["u"]
    if data["bend"] is not None:
        segment.bend = _read_block(data["bend"])
    segment.direction = _read_block(data["direction"])
    segment.points = _read_block(data["points"])
    segment.light = _read_block(data["light"])
    return segment


def _read_zone(data: dict[str, Any]) -> _core.FitErrorZone:
    zone = _core.FitErrorZone()
    for name in ("low", "high", "rays", "lost", "leaked"):
        setattr(zone, name, data[name])
    for name in _PAIRS:
        deviation = _core.FitDeviation()
        deviation.rms, deviation.max = data[name + _UNITS[name]]
        setattr(zone, name, deviation)
    return zone
