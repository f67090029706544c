"""Plots all ghosts of a lens on the film (extra ``plot``)."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from daguerre.analysis.ghosts import Ghosts

DECADES = 4


def plot_ghosts(ghosts: Ghosts, kind: str) -> bytes:
    """Plots the upright film on a logarithmic scale; returns the bytes of a file of ``kind``."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    width, height = ghosts.film
    figure = Figure(figsize=(8, 8 * height / width + 0.8), layout="constrained")
    FigureCanvasAgg(figure)
    draw_ghosts(figure.add_subplot(), ghosts)
    out = io.BytesIO()
    figure.savefig(out, format=kind, dpi=110, metadata={"Title": "ghosts"})
    return out.getvalue()


def draw_ghosts(axes: Axes, ghosts: Ghosts) -> None:
    """Plots the upright film on a logarithmic scale into axes."""
    image = ghosts.picture()
    top = float(image.max()) or 1.0
    shown = np.log10(np.maximum(image, top * 10.0**-DECADES))
    width, height = ghosts.film
    extent = (-width / 2, width / 2, -height / 2, height / 2)
    drawn = axes.imshow(shown, extent=extent, cmap="magma", interpolation="nearest")
    axes.figure.colorbar(drawn, ax=axes, label="log10 of light per mm2, over the picture's light")
    axes.set_xlabel("mm")
    axes.set_title(
        f"{ghosts.bench.lens.name}, f/{ghosts.bench.f_stop:.3g}: "
        f"ghosts of light from {ghosts.angle_deg:g} deg",
        parse_math=False,  # a lens's name is plain text
    )
    axes.grid(visible=False)
