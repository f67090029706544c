"""Results that plot themselves: ``spot.plot()``, and as pictures in a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from daguerre.files import extras

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from daguerre.plots.results import Drawn


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
        return self._drawn().plot(axes)

    def _repr_png_(self) -> bytes | None:
        """The plot as PNG; None: matplotlib is not installed."""
        if extras.missing("matplotlib"):
            return None
        return cast("bytes", self.plot()._repr_png_())  # type: ignore[attr-defined]

    def _drawn(self) -> Drawn:
        """The result as ``plots.results`` draws it."""
        from daguerre.plots.results import Drawn

        return Drawn(self)


class Sectioned(Plotted):
    """Base of results that a notebook shows as a section of the lens, which needs no extra."""

    _repr_png_ = None  # type: ignore[assignment]

    def _repr_svg_(self) -> str:
        return self._drawn().svg()
