"""Plots residuals of a fitted projection over the picture (extra ``plot``)."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from daguerre.analysis.calibrate import ProjectionFit


def plot_residuals(fit: ProjectionFit, kind: str) -> bytes:
    """Plots arrows from the lens's points to the model's; returns the bytes of a file."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    width, height = fit.projection.size
    figure = Figure(figsize=(8.5, 7.5 * height / width + 1.2), layout="constrained")
    FigureCanvasAgg(figure)
    draw_residuals(figure.add_subplot(), fit)
    out = io.BytesIO()
    figure.savefig(out, format=kind, dpi=110, metadata={"Title": "residuals"})
    return out.getvalue()


def draw_residuals(axes: Axes, fit: ProjectionFit) -> None:
    """Plots arrows from the lens's points to the model's into axes."""
    (x, y), (dx, dy) = fit.pixels.T, fit.residuals.T
    width, height = fit.projection.size
    sizes = np.hypot(dx, dy)
    longest = float(sizes.max()) or 1.0
    apart = width / 40
    drawn = axes.quiver(
        x, y, dx, dy, sizes, angles="xy", scale_units="xy", scale=longest / (2 * apart),
        cmap="viridis", width=0.002,
    )  # fmt: skip
    axes.figure.colorbar(drawn, ax=axes, label="residual, px")
    axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5), xlabel="px", ylabel="px")
    axes.set_aspect("equal")
    axes.set_title(
        f"{fit.bench.lens.name} by {fit.projection.model}: {fit.rms:.3g} px RMS, "
        f"{fit.largest:.3g} px at most",
        fontsize=10,
        parse_math=False,  # a lens's name is plain text
    )
