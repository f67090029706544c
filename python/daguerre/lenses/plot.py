"""The drawing of a lens as a file: SVG by itself, PNG and PDF by matplotlib (extra ``plot``)."""

from __future__ import annotations

import io
from importlib.util import find_spec

from daguerre.errors import UsageError

from .drawing import Drawing, Polygon, section, to_svg
from .lens import Lens

FORMATS = (".svg", ".png", ".pdf")
WIDTH_INCHES = 8.0


def check_available(suffix: str) -> None:
    """Refuses a format whose package is missing, before anything is computed."""
    if suffix != ".svg" and find_spec("matplotlib") is None:
        raise UsageError(
            f'a drawing as {suffix} needs matplotlib: pip install "daguerre[plot]"; '
            ".svg needs nothing"
        )


def picture(lens: Lens, suffix: str) -> bytes:
    """The meridional section of a lens with rays, as the bytes of a file."""
    drawing = section(lens)
    if suffix == ".svg":
        return to_svg(drawing).encode()
    return _by_matplotlib(drawing, suffix[1:])


def _by_matplotlib(drawing: Drawing, kind: str) -> bytes:
    # The object-oriented face: no window system, and no state shared with the user's own plots.
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
        z, y = zip(*shape.points, strict=True)
        if isinstance(shape, Polygon):
            axes.fill(z, y, facecolor=(*_rgb(shape.fill), 0.35), edgecolor=shape.stroke, lw=0.8)
        else:
            style = (0, tuple(float(v) for v in shape.dash.split())) if shape.dash else "-"
            axes.plot(z, y, color=shape.stroke, lw=0.8 * shape.width, ls=style)
    out = io.BytesIO()
    facts = {"Title": drawing.title}
    if kind == "pdf":
        facts |= {"Creator": "daguerre"}
    figure.savefig(out, format=kind, dpi=150, metadata=facts)
    return out.getvalue()


def _rgb(colour: str) -> tuple[float, float, float]:
    r, g, b = (int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return r, g, b
