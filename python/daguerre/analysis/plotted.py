"""Results that plot themselves: ``spot.plot()``, and as pictures in a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


class Plotted:
    """Base of results of the bench that a plot shows; ``plots.results`` draws each."""

    def plot(self, axes: Axes | None = None) -> Figure:
        """Plots the result by matplotlib (extra ``plot``).

        Args:
            axes: Axes of matplotlib to draw into; None: a new figure.

        Returns:
            The figure: a notebook shows it, ``savefig`` writes it, ``show`` opens it.

        Raises:
            UsageError: matplotlib is not installed; the message says how to install it.
        """
        from daguerre.plots.results import plot

        return plot(self, axes)

    def _repr_png_(self) -> bytes | None:
        from daguerre.plots.results import png

        return png(self)


class Sectioned(Plotted):
    """Base of results that a notebook shows as a section of the lens, which needs no extra."""

    _repr_png_ = None  # type: ignore[assignment]

    def _repr_svg_(self) -> str:
        from daguerre.plots.results import svg

        return svg(self)
