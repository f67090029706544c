"""Draws the data sheet, one page on a lens, by matplotlib (extra ``plot``)."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any, TypeVar

from daguerre.analysis.figures import Figures

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.gridspec import SubplotSpec

Sheet = TypeVar("Sheet", bound="Figure")
A4 = (8.27, 11.69)  # inches
STYLE: Any = {  # matplotlib's keys
    "font.size": 6.5,
    "font.family": "DejaVu Sans",
    "axes.titlesize": 7,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 6,
    "axes.linewidth": 0.5,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.4,
    "lines.linewidth": 0.9,
    "xtick.labelsize": 5.5,
    "ytick.labelsize": 5.5,
    "xtick.major.width": 0.4,
    "ytick.major.width": 0.4,
    "xtick.major.size": 2,
    "ytick.major.size": 2,
    "legend.fontsize": 5.2,
    "legend.frameon": False,
    "legend.handlelength": 1.6,
    "text.parse_math": False,  # names are plain text
    "svg.hashsalt": "daguerre",
    "svg.fonttype": "path",
}


def page(made: Figures, kind: str = "svg") -> bytes:
    """Draws the data sheet of given figures; returns the bytes of a file."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    with rc_context(STYLE):
        return saved(draw_sheet(made, Figure), kind, made.bench.lens.name)


def draw_sheet(made: Figures, kind: type[Sheet]) -> Sheet:
    """Draws the page of given figures as a figure of matplotlib of a kind."""
    from . import panels, panels_field

    page = kind(figsize=A4)
    panels.header(page, made)
    top = _row(page, 0.742, 0.93).subgridspec(1, 2, width_ratios=(2.15, 1), wspace=0.06)
    panels.layout(page.add_subplot(top[0]), made)
    panels.facts(page.add_subplot(top[1]), made)
    panels.spots(page, _row(page, 0.61, 0.716), made)
    panels.psfs(page, _row(page, 0.463, 0.565), made)
    mtf = _row(page, 0.333, 0.43).subgridspec(1, 2, wspace=0.16)
    panels.mtf_over_field(page.add_subplot(mtf[0]), made)
    panels.mtf_over_frequency(page.add_subplot(mtf[1]), made)
    f = panels_field
    for bottom, drawers in (
        (0.196, (f.spherical, f.curvature, f.distorted, f.lateral)),
        (0.058, (f.illumination, f.pupils, f.axial, f.seidel)),
    ):
        cells = _row(page, bottom, bottom + 0.088).subgridspec(1, 4, wspace=0.34)
        for k, drawer in enumerate(drawers):
            drawer(page.add_subplot(cells[k]), made)
    panels.dispersions(page, made)
    return page


def _row(page: Figure, bottom: float, top: float) -> SubplotSpec:
    """Strip across the page, between heights given as shares of the page."""
    return page.add_gridspec(1, 1, left=0.075, right=0.965, bottom=bottom, top=top)[0]


def saved(page: Figure, kind: str, title: str) -> bytes:
    """Encodes a figure; equal figures give equal bytes."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    FigureCanvasAgg(page)  # no window system, and no state shared with user plots
    out = io.BytesIO()
    facts: dict[str, Any] = {"Title": title}
    if kind == "svg":
        facts["Date"] = None
    if kind == "pdf":
        facts |= {"Creator": "daguerre", "CreationDate": None}
    page.savefig(out, format=kind, dpi=200, metadata=facts)
    return out.getvalue()
