"""Plots of results of the bench, each in a single axes, drawn by ``result.plot()``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from daguerre.analysis.bench import Bench
from daguerre.analysis.calibrate import ProjectionFit
from daguerre.analysis.field import Distortion, FieldCurve
from daguerre.analysis.figures import Figures
from daguerre.analysis.ghosts import Ghosts
from daguerre.analysis.illumination import Illumination, within_light
from daguerre.analysis.modulation import Mtf
from daguerre.analysis.pencils import Pencil
from daguerre.analysis.plotted import Plotted
from daguerre.analysis.psf import Psf
from daguerre.analysis.seidel import SeidelSums
from daguerre.analysis.spots import Spot
from daguerre.analysis.wavefronts import Wavefront
from daguerre.checks import shown
from daguerre.errors import UsageError
from daguerre.files import extras

from . import curves, images
from .ghost_plot import draw_ghosts
from .lens_section import Drawing, section, to_svg
from .residual_plot import draw_residuals

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Functions that draw a kind of result into axes.
DRAWERS: dict[type, Callable[[Axes, Any], None]] = {
    Bench: lambda axes, bench: _section(axes, drawing(bench)),
    Pencil: lambda axes, light: _section(axes, drawing(light)),
    Spot: images.spot,
    Psf: images.psf,
    Wavefront: images.wavefront,
    Ghosts: draw_ghosts,
    ProjectionFit: draw_residuals,
    Mtf: curves.mtf,
    SeidelSums: curves.seidel,
    Illumination: curves.illumination,
    FieldCurve: curves.field_curve,
    Distortion: curves.distortion,
}
_SIZES = {Bench: (8.0, 4.0), Pencil: (8.0, 4.0), ProjectionFit: (8.0, 6.0), Ghosts: (8.0, 6.0)}
_SIZE = (5.5, 4.2)  # inches


@dataclass(frozen=True)
class Drawn:
    """A result of the bench, as this room draws it."""

    result: Plotted

    def plot(self, axes: Axes | None = None) -> Figure:
        """Plots it into axes, or as a new figure, which is returned; see ``Plotted.plot``."""
        extras.need("matplotlib", "plot")
        from matplotlib.axes import Axes as MatplotlibAxes

        from . import figure

        result = self.result
        if isinstance(result, Figures):
            if axes is not None:
                raise UsageError("plot: axes: wanted None, as a data sheet fills a page, got axes")
            return figure.sheet_of(result)
        if axes is not None and not isinstance(axes, MatplotlibAxes):
            raise UsageError(f"plot: axes: wanted axes of matplotlib, got {shown(axes)}")
        draw = DRAWERS[type(result)]
        if axes is None:
            return figure.drawn(draw, result, _SIZES.get(type(result), _SIZE))
        draw(axes, result)
        return axes.figure  # type: ignore[return-value]  # or a part of one

    def svg(self) -> str:
        """Draws the section of a lens as SVG."""
        return to_svg(drawing(self.result))


def drawing(result: Any) -> Drawing:
    """Section of a lens at its setting, with rays of three fields, or of one pencil."""
    bench = result if isinstance(result, Bench) else result.bench
    light = None if isinstance(result, Bench) else [result]
    return section(bench.lens, bench.film_z, within_light(bench).field_mm, light)


def _section(axes: Axes, drawing: Drawing) -> None:
    images.lens(axes, drawing)
    axes.set_title(drawing.title, parse_math=False)  # a lens's name is plain text
