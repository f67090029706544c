"""Converts figures to plain numbers for JSON. Lengths are in mm; names state other units."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .bench import FDC_NM
from .figures import COLORS_NM, CURVE, MTF_FIELDS, PUPIL_SHARES, FieldPoint, Figures
from .seidel import NAMES


def facts(made: Figures) -> dict[str, Any]:
    """Returns all figures of the data sheet as numbers and lists."""
    bench, light = made.bench, made.illumination
    working = bench.f_stop * (1 - bench.magnification / bench.order.pupil_magnification)
    return {
        "f_stop": bench.f_stop,
        "working_f_number": working,
        "focus_m": None if math.isinf(bench.focus_mm) else bench.focus_mm / 1e3,
        "film_z": bench.film_z,
        "efl": bench.order.efl,
        "magnification": bench.magnification,
        "pupil_magnification": bench.order.pupil_magnification,
        "half_image": bench.field_mm,
        "strehl_ratio": made.strehl,
        "points": [_point(point) for point in made.points],
        "mtf": {
            "height": _rounded(bench.field_mm * np.asarray(MTF_FIELDS)),
            "per_mm": _rounded(made.frequency),
            "diffraction_sagittal": _rounded(made.mtf_waves[..., 0]),
            "diffraction_tangential": _rounded(made.mtf_waves[..., 1]),
            "geometric_sagittal": _rounded(made.mtf_rays[..., 0]),
            "geometric_tangential": _rounded(made.mtf_rays[..., 1]),
        },
        "field": {
            "height": _rounded(bench.field_mm * CURVE),
            "angle_deg": _rounded(made.distortion.angle_deg),
            "distortion_percent": _rounded(made.distortion.percent),
            "law": made.distortion.law,
            "sagittal_focus": [_rounded(c.sagittal) for c in made.curves],
            "tangential_focus": [_rounded(c.tangential) for c in made.curves],
            "lateral_colour": _rounded(made.lateral),
            "wavelengths_nm": list(FDC_NM),
            "relative_illumination": _rounded(light.relative),
            "irradiance_over_radiance": _rounded(light.irradiance),
            "cos4_object": _rounded(light.cos4_object),
            "cos4_film": _rounded(light.cos4_film),
        },
        "axis": {
            "wavelength_nm": _rounded(COLORS_NM),
            "axial_colour": _rounded(made.axial),
            "pupil_share": _rounded(PUPIL_SHARES),
            "spherical_aberration": _rounded(made.spherical),
        },
        "seidel": _seidel(made),
    }


def _point(point: FieldPoint) -> dict[str, Any]:
    out: dict[str, Any] = {"height": point.height_mm, "angle_deg": point.angle_deg}
    if point.spot is not None:
        out |= {
            "rms": point.spot.rms,
            "radius_50": point.spot.energy_radius(0.5),
            "radius_80": point.spot.energy_radius(0.8),
        }
    return out | {"pupil": _rounded(point.outline)}


def _seidel(made: Figures) -> dict[str, Any] | None:
    if made.seidel is None:
        return None
    rows = made.seidel.surfaces
    surfaces = [dict(zip(NAMES, map(float, row), strict=True)) for row in rows]
    total = dict(zip(NAMES, map(float, made.seidel.total), strict=True))
    return {"field_deg": made.seidel.field_deg, "surfaces": surfaces, "total": total}


def _rounded(values: ArrayLike) -> Any:
    """Converts values to nested lists, rounded to seven digits."""
    flat = np.asarray(values, np.float64)
    return np.array([float(f"{v:.7g}") for v in flat.ravel()]).reshape(flat.shape).tolist()
