"""Curves of the bench in axes: distortion, illumination, MTF, foci over the field, Seidel sums."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from daguerre.analysis.seidel import NAMES

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from daguerre.analysis.field import Distortion, FieldCurve
    from daguerre.analysis.illumination import Illumination
    from daguerre.analysis.modulation import Mtf
    from daguerre.analysis.seidel import SeidelSums

INK, BLUE, RED = "#1a202c", "#2b6cb0", "#c53030"
SURFACE_COLORS = "tab20"


def distortion(axes: Axes, found: Distortion) -> None:
    """Plots distortion over the field, percent."""
    axes.plot(found.percent, found.height_mm, color=INK)
    law = {"rectilinear": "f tan θ"}.get(found.law, found.law)
    axes.set_title("Distortion")
    axes.set_xlabel(f"% of the ideal height ({law})")
    axes.set_ylabel("image height, mm")
    around_zero(axes, found.percent, least=0.5)


def illumination(axes: Axes, light: Illumination) -> None:
    """Plots relative illumination over the field, with cos^4 (Kolb, Mitchell, Hanrahan 1995)."""
    for values, color, style, name in (
        (light.relative, INK, "-", "exact"),
        (light.cos4_object, RED, "--", "cos⁴, object"),
        (light.cos4_film, BLUE, ":", "cos⁴, film"),
    ):
        axes.plot(light.height_mm, 100 * values, color=color, ls=style, label=name)
    axes.set_title("Relative illumination, %")
    axes.set_xlabel("image height, mm")
    axes.set_ylim(0, max(105, 100 * float(np.nanmax(light.relative, initial=1)) + 5))
    axes.legend(loc="lower left")


def field_curve(axes: Axes, curve: FieldCurve) -> None:
    """Plots sagittal and tangential focus over the field."""
    axes.plot(curve.sagittal, curve.height_mm, color=INK, label="sagittal")
    axes.plot(curve.tangential, curve.height_mm, color=INK, ls="--", label="tangential")
    axes.set_title("Field curvature")
    axes.set_xlabel("focus against the film, mm")
    axes.set_ylabel("image height, mm")
    around_zero(axes, [curve.sagittal, curve.tangential])
    axes.legend()


def mtf(axes: Axes, found: Mtf) -> None:
    """Plots the MTF over frequency, of waves and (dotted) of rays."""
    for k, (name, style) in enumerate((("sagittal", "-"), ("tangential", "--"))):
        axes.plot(found.freq_per_mm, found.waves[:, k], color=BLUE, ls=style, label=name)
        axes.plot(found.freq_per_mm, found.rays[:, k], color=BLUE, ls=":", lw=0.8)
    axes.set_title("MTF (dotted: rays alone)")
    axes.set_xlabel("cycles per mm")
    axes.set_ylim(0, 1)
    axes.legend()


def seidel(axes: Axes, sums: SeidelSums) -> None:
    """Plots Seidel sums by surface as stacked bars, with their totals."""
    at = np.arange(len(NAMES))
    for sign in (1, -1):
        base = np.zeros(len(NAMES))
        for i, row in enumerate(sums.surfaces):
            part = np.where(sign * row > 0, row, 0)
            axes.bar(at, part, 0.75, base, color=_color(i), lw=0)
            base = base + part
    axes.plot(at, sums.total, "k_", ms=9, mew=1.4)
    axes.axhline(0, color="#444444", lw=0.5)
    axes.set_title("Seidel sums, mm")
    axes.set_xticks(at, NAMES)
    axes.set_xlabel("by surface; bar: total", labelpad=1)
    axes.grid(axis="x", visible=False)


def _color(i: int) -> tuple[float, float, float, float]:
    from matplotlib import colormaps

    r, g, b, a = colormaps[SURFACE_COLORS](i % 20)
    return float(r), float(g), float(b), float(a)


def around_zero(axes: Axes, values: object, least: float = 0.02) -> None:
    """Sets a range symmetric about zero that contains the values, and draws a line at zero."""
    parts = [np.ravel(np.asarray(v, np.float64)) for v in values]  # type: ignore[attr-defined]
    flat = np.concatenate(parts) if parts else np.zeros(1)
    finite = np.abs(flat[np.isfinite(flat)])
    reach = max(least, 1.08 * float(finite.max(initial=0)))
    axes.set_xlim(-reach, reach)
    axes.axvline(0, color="#444444", lw=0.5)
