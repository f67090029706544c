"""Draws the lower half of the data sheet: field aberrations, light, colour, Seidel sums."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from daguerre.analysis.figures import COLORS_NM, CURVE, PUPIL_SHARES, Figures

from . import curves
from .curves import around_zero
from .panels import LINE_COLORS, LINE_NAMES

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def spherical(axes: Axes, made: Figures) -> None:
    """Plots longitudinal spherical aberration of three colours."""
    for values, color, name in zip(made.spherical, LINE_COLORS, LINE_NAMES, strict=True):
        axes.plot(values, PUPIL_SHARES, color=color, label=name)
    axes.set_title("Spherical aberration")
    axes.set_xlabel("focus against the film, mm")
    axes.set_ylabel("height in the pupil")
    axes.set_ylim(0, 1)
    around_zero(axes, made.spherical)
    axes.legend(loc="upper left")


def curvature(axes: Axes, made: Figures) -> None:
    """Plots sagittal and tangential focus over the field."""
    for curve, color in zip(made.curves, LINE_COLORS, strict=True):
        axes.plot(curve.sagittal, curve.height_mm, color=color)
        axes.plot(curve.tangential, curve.height_mm, color=color, ls="--")
    axes.set_title("Field curvature (- S, -- T)")
    axes.set_xlabel("focus against the film, mm")
    axes.set_ylabel("image height, mm")
    axes.set_ylim(0, made.bench.field_mm)
    around_zero(axes, [v for c in made.curves for v in (c.sagittal, c.tangential)])


def distorted(axes: Axes, made: Figures) -> None:
    """Plots distortion over the field, percent."""
    curves.distortion(axes, made.distortion)
    axes.set_ylabel("")
    axes.set_ylim(0, made.bench.field_mm)


def lateral(axes: Axes, made: Figures) -> None:
    """Plots lateral colour of F and C relative to d over the field."""
    um = 1e3 * made.lateral
    for k in (0, 2):
        axes.plot(um[:, k], made.bench.field_mm * CURVE, color=LINE_COLORS[k], label=LINE_NAMES[k])
    axes.set_title("Lateral colour")
    axes.set_xlabel("against d, µm")
    axes.set_ylim(0, made.bench.field_mm)
    around_zero(axes, um, least=1.0)
    axes.legend(loc="upper left")


def illumination(axes: Axes, made: Figures) -> None:
    """Plots relative illumination over the field."""
    curves.illumination(axes, made.illumination)
    axes.set_xlim(0, made.bench.field_mm)


def pupils(axes: Axes, made: Figures) -> None:
    """Draws the pupil seen from points of the film."""
    axes.set_title("Pupil seen from the film")
    axes.set_aspect("equal")
    sizes = [np.ptp(p.outline, axis=0).max() for p in made.points if len(p.outline)]
    size = max(sizes, default=1.0)
    for k, point in enumerate(made.points):
        x, y = 1.12 * size * (k % 3), -1.3 * size * (k // 3)
        if len(point.outline):
            middle = 0.5 * (point.outline.min(axis=0) + point.outline.max(axis=0))
            axes.fill(
                *(point.outline - middle + [x, y]).T,
                facecolor="#f6e7b4",
                edgecolor="#975a16",
                lw=0.7,
            )
        axes.text(x, y - 0.56 * size, f"{point.height_mm:.1f} mm", size=5.2, ha="center", va="top")
    axes.set_xlim(-0.6 * size, 2.84 * size)
    axes.set_ylim(-2.2 * size, 0.75 * size)
    axes.set_axis_off()


def axial(axes: Axes, made: Figures) -> None:
    """Plots paraxial focus over the wavelength."""
    axes.plot(COLORS_NM, made.axial, color="#1a202c")
    axes.axhline(0, color="#999999", lw=0.5)
    axes.set_title("Axial colour, mm")
    axes.set_xlabel("wavelength, nm")
    axes.set_xlim(COLORS_NM[0], COLORS_NM[-1])


def seidel(axes: Axes, made: Figures) -> None:
    """Plots Seidel sums by surface, if the lens has any."""
    if made.seidel is not None:
        curves.seidel(axes, made.seidel)
        return
    axes.set_title("Seidel sums, mm")
    axes.set_axis_off()
    axes.text(0.5, 0.5, "no axial symmetry", ha="center", transform=axes.transAxes, color="#888888")
