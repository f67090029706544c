"""Plots all ghosts of a lens on the film (extra ``plot``)."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from daguerre.analysis.ghosts import Ghosts

DECADES = 4
#: Titles and pictures, such as from ``Ghosts.picture``.
Panels = Sequence[tuple[str, NDArray[np.float64]]]


def plot_ghosts(ghosts: Ghosts, kind: str, panels: Panels | None = None) -> bytes:
    """Plots the upright film on a logarithmic scale; returns the bytes of a file of ``kind``.

    Args:
        ghosts: The ghosts.
        kind: File extension: svg, png or pdf.
        panels: Titles and pictures to draw side by side on one scale; None: the ghosts.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    width, height = ghosts.film
    shown = panels or [(_title(ghosts), ghosts.picture())]
    across = 8 if len(shown) == 1 else 6 * len(shown)
    figure = Figure(
        figsize=(across, across / len(shown) * height / width + 0.8), layout="constrained"
    )
    FigureCanvasAgg(figure)
    top = max(float(image.max()) for _, image in shown)
    for column, (title, image) in enumerate(shown):
        _draw(figure.add_subplot(1, len(shown), column + 1), ghosts.film, title, image, top)
    if panels:
        figure.suptitle(_title(ghosts), parse_math=False)
    out = io.BytesIO()
    figure.savefig(out, format=kind, dpi=110, metadata={"Title": "ghosts"})
    return out.getvalue()


def draw_ghosts(axes: Axes, ghosts: Ghosts) -> None:
    """Plots the upright film on a logarithmic scale into axes."""
    image = ghosts.picture()
    _draw(axes, ghosts.film, _title(ghosts), image, float(image.max()))


def _title(ghosts: Ghosts) -> str:
    return (
        f"{ghosts.bench.lens.name}, f/{ghosts.bench.f_stop:.3g}: "
        f"ghosts of light from {ghosts.angle_deg:g} deg"
    )


def _draw(
    axes: Axes, film: tuple[float, float], title: str, image: NDArray[np.float64], top: float
) -> None:
    top = top or 1.0
    shown = np.log10(np.maximum(image, top * 10.0**-DECADES))
    width, height = film
    drawn = axes.imshow(
        shown,
        extent=(-width / 2, width / 2, -height / 2, height / 2),
        cmap="magma",
        interpolation="nearest",
        vmin=math.log10(top) - DECADES,
        vmax=math.log10(top),
    )
    axes.figure.colorbar(drawn, ax=axes, label="log10 of light per mm2, over the picture's light")
    axes.set_xlabel("mm")
    axes.set_title(title, parse_math=False)  # a lens's name is plain text
    axes.grid(visible=False)
