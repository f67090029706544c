"""Figures of matplotlib that show themselves, without a window system or the user's pyplot."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure

from daguerre.frame.shown import Shown

from .sheet import STYLE

#: The style of the data sheet in the sizes of a single plot.
SINGLE: Any = {
    **STYLE,
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.labelsize": 9,
    "axes.linewidth": 0.8,
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.4,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "xtick.major.size": 3,
    "ytick.major.size": 3,
    "legend.fontsize": 8,
}


class Plot(Shown, Figure):  # type: ignore[misc]  # ``show`` needs no pyplot
    """A figure that a notebook shows; ``show`` opens it in the desktop's viewer."""

    def _repr_png_(self) -> bytes:
        out = io.BytesIO()
        self.savefig(out, format="png")
        return out.getvalue()


def drawn(draw: Callable[[Any, Any], None], result: object, size: tuple[float, float]) -> Plot:
    """Draws a result in a new figure of a size in inches."""
    with rc_context(SINGLE):
        figure = Plot(figsize=size, dpi=110, layout="constrained")
        draw(figure.add_subplot(), result)
    return figure


def sheet_of(result: Any) -> Plot:
    """Draws a data sheet on a page."""
    from .sheet import draw_sheet

    with rc_context(STYLE):
        return draw_sheet(result, Plot)
