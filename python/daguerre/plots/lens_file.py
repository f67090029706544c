"""Encodes the drawing of a lens as SVG, or as PNG or PDF by matplotlib (extra ``plot``)."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from daguerre.errors import UsageError
from daguerre.files import extras

from .lens_section import Drawing, Line, Polygon, section, to_svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from daguerre.analysis.bench import Bench

WIDTH_INCHES = 8.0


def check_available(suffix: str, *, needed: bool) -> None:
    """Checks, before any computation, that the package for a format is installed.

    Args:
        suffix: Suffix of the file.
        needed: Whether SVG needs the package, too, as for a data sheet.

    Raises:
        UsageError: The package is missing.
    """
    if (needed or suffix != ".svg") and extras.missing("matplotlib"):
        other = "--drawing FILE.svg" if needed else ".svg"
        raise UsageError(
            f"a plot as {suffix} needs matplotlib: {extras.hint('matplotlib')}; {other} works "
            "without it"
        )


def picture(bench: Bench, suffix: str) -> bytes:
    """Draws the meridional section of a lens with rays; returns the bytes of a file."""
    from daguerre.analysis.illumination import within_light

    return drawn(section(bench.lens, bench.film_z, within_light(bench).field_mm), suffix)


def drawn(drawing: Drawing, suffix: str) -> bytes:
    """Encodes a drawing as the bytes of a file with this suffix."""
    if suffix == ".svg":
        return to_svg(drawing).encode()
    return _by_matplotlib(drawing, suffix[1:])


def _by_matplotlib(drawing: Drawing, kind: str) -> bytes:
    # The object-oriented interface needs no window system, and shares no state with user plots.
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    x0, x1, half = drawing.left, drawing.right, drawing.top
    figure = Figure(figsize=(WIDTH_INCHES, WIDTH_INCHES * 2 * half / (x1 - x0)))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set_xlim(x0, x1)
    axes.set_ylim(-half, half)
    axes.set_aspect("equal")
    for shape in drawing.shapes:
        add_shape(axes, shape)
    out = io.BytesIO()
    facts = {"Title": drawing.title}
    if kind == "pdf":
        facts |= {"Creator": "daguerre"}
    figure.savefig(out, format=kind, dpi=150, metadata=facts)
    return out.getvalue()


def add_shape(axes: Axes, shape: Line | Polygon, scale: float = 0.8) -> None:
    """Adds a shape to a matplotlib plot; ``scale``: points per px of its lines."""
    z, y = zip(*shape.points, strict=True)
    if isinstance(shape, Polygon):
        axes.fill(z, y, facecolor=(*_rgb(shape.fill), 0.45), edgecolor=shape.stroke, lw=scale)
        return
    style = (0, tuple(float(v) for v in shape.dash.split())) if shape.dash else "-"
    axes.plot(z, y, color=shape.stroke, lw=scale * shape.width, ls=style)


def _rgb(color: str) -> tuple[float, float, float]:
    r, g, b = (int(color[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return r, g, b
