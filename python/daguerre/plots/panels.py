"""Draws the upper half of the data sheet: name, section, numbers, spots, PSFs, MTF."""

from __future__ import annotations

import math
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from daguerre.analysis.bench import FDC_NM
from daguerre.analysis.figures import FIELDS, FREQUENCIES, MTF_FIELDS, Figures
from daguerre.lenses.agreement import agreement
from daguerre.lenses.focusing import focusing, whole_lens_note

from . import images
from .lens_section import COLORS as FIELD_COLORS
from .lens_section import section

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.gridspec import SubplotSpec

#: Colours of the lines F, d, C.
LINE_COLORS = ("#2b6cb0", "#2f855a", "#c53030")
LINE_NAMES = ("F 486", "d 588", "C 656")
INK = "#222222"
#: Characters in a line at the foot of the page.
FOOT_LETTERS = 215


def header(page: Figure, made: Figures) -> None:
    """Draws name and source of the lens, and the setting of all figures."""
    bench, lens = made.bench, made.bench.lens
    page.text(0.075, 0.968, lens.name, size=14, weight="bold", color=INK)
    page.text(
        0.075, 0.952, shortened(lens.patent or "source not named", 110), size=7.5, color="#555555"
    )
    focus = "infinity" if math.isinf(bench.focus_mm) else f"{bench.focus_mm / 1e3:g} m"
    setting = f"{bench.order.efl:.1f} mm   f/{bench.f_stop:.3g}   focus {focus}"
    page.text(0.965, 0.968, setting, size=9, ha="right", color=INK)
    page.text(0.965, 0.952, "Daguerre lens data sheet", size=7, ha="right", color="#888888")
    page.add_artist(_rule(0.944))
    found = agreement(lens)
    if found is not None:
        page.text(0.075, 0.9375, str(found), size=5.2, color="#555555")
    page.text(
        0.075,
        0.0225,
        "Exact rays through the prescription; glass, coatings, every clear aperture and the iris. "
        "F, d, C weighted as the eye sees them; PSF: five wavelengths 470-650 nm. "
        "Film at the best focus on the axis unless stated.",
        size=5.2,
        color="#777777",
    )
    if note := whole_lens_note(lens, bench.magnification):
        page.text(0.075, 0.011, note, size=5.2, color=INK)


def _rule(y: float) -> Any:
    from matplotlib.lines import Line2D

    return Line2D([0.075, 0.965], [y, y], lw=0.8, color=INK)


def shortened(text: str, limit: int) -> str:
    """Shortens a text to one line of at most ``limit`` characters."""
    flat = " ".join(text.split())
    return flat if len(flat) <= limit else flat[: limit - 1].rstrip() + "…"


def layout(axes: Axes, made: Figures) -> None:
    """Draws the section with rays from three fields."""
    bench = made.bench
    drawing = section(bench.lens, bench.film_z, bench.field_mm)
    images.lens(axes, drawing, 0.6)


def facts(axes: Axes, made: Figures) -> None:
    """Draws first-order data beside the source's values, and figures of merit."""
    axes.set_axis_off()
    rows = fact_rows(made)
    step = 1 / max(len(rows), 17)
    axes.text(0.66, 1.0, "computed", size=5.8, color="#888888", ha="right")
    axes.text(1.0, 1.0, "stated", size=5.8, color="#888888", ha="right")
    for k, (name, value, stated) in enumerate(rows):
        y = 1 - (k + 1) * step
        axes.text(0, y, name, size=6.3, color="#444444", transform=axes.transAxes)
        axes.text(0.66, y, value, size=6.3, color=INK, ha="right", transform=axes.transAxes)
        axes.text(1.0, y, stated, size=6.3, color="#888888", ha="right", transform=axes.transAxes)


def fact_rows(made: Figures) -> list[tuple[str, str, str]]:
    """Rows of name, computed value and stated value."""
    bench, order, nominal = made.bench, made.bench.order, made.bench.lens.nominal
    working = bench.f_stop * (1 - bench.magnification / order.pupil_magnification)
    angle = made.points[-1].angle_deg
    field = nominal.full_field_deg
    rows = [
        ("focal length", f"{order.efl:.3f} mm", _stated(nominal.efl_mm, " mm")),
        ("f-number, open", f"{order.f_number:.3f}", _stated(nominal.f_number)),
        ("back focus", f"{order.bfl:.3f} mm", ""),
        ("length to film", f"{bench.film_z:.2f} mm", ""),
        ("full field", _known(2 * angle, ".1f", "°"), _stated(field, "°")),
        ("image circle", f"{2 * bench.field_mm:.1f} mm", _stated(nominal.image_circle_mm, " mm")),
        (
            "entrance pupil",
            f"ø{order.entrance_pupil.diameter:.2f} at {order.entrance_pupil.z:.2f}",
            "",
        ),
        ("exit pupil", f"ø{order.exit_pupil.diameter:.2f} at {order.exit_pupil.z:.2f}", ""),
        (
            "principal points",
            f"{order.front_principal_point:.2f}, {order.back_principal_point:.2f}",
            "",
        ),
        ("pupil magnification", f"{order.pupil_magnification:.3f}", ""),
        *_focusing(made),
    ]
    if not math.isinf(bench.focus_mm):
        rows.append(("magnification", f"1:{-1 / bench.magnification:.2f}", ""))
        rows.append(("working f-number", f"{working:.3f}", ""))
    if not bench.lens.prescription.is_axially_symmetric:
        across = bench.lens.first_order(section="x")
        rows.insert(
            1, ("in the x section", f"{across.efl:.3f} mm", _stated(nominal.efl_x_mm, " mm"))
        )
        rows.append(("field runs along", "y", ""))
    rows += [
        ("best - paraxial focus", f"{bench.film_z - paraxial_film(made):+.3f} mm", ""),
        ("RMS spot on axis", _um(made.points[0].spot.rms if made.points[0].spot else math.nan), ""),
        (
            "RMS spot at the edge",
            _um(made.points[-1].spot.rms if made.points[-1].spot else math.nan),
            "",
        ),
        ("Strehl ratio on axis", _known(made.strehl, ".3f"), ""),
        ("light at the edge", f"{100 * made.illumination.relative[-1]:.0f} %", ""),
        ("distortion at the edge", _known(float(made.distortion.percent[-1]), "+.2f", " %"), ""),
    ]
    return rows


def _focusing(made: Figures) -> list[tuple[str, str, str]]:
    lens = made.bench.lens
    how, product = focusing(lens), lens.product
    moves = "groups" + " (fitted)" * how.fitted if how.gaps else "whole lens"
    stated = _closest(product.closest_focus_m, product.magnification) if product else ""
    own = _closest(how.closest_focus_m, how.magnification)
    return [("focusing", moves, ""), ("closest focus", own, stated)]


def _closest(distance_m: float | None, magnification: float | None) -> str:
    known = ((distance_m, " m", ".3g"), (magnification, "x", ".2g"))
    return ", ".join(f"{value:{form}}{unit}" for value, unit, form in known if value is not None)


def paraxial_film(made: Figures) -> float:
    """Position of the film in paraxial focus, mm."""
    order, focus = made.bench.order, made.bench.focus_mm
    front = order.front_principal_point - order.front_focal_point
    x = focus - order.entrance_pupil.z + order.front_focal_point
    return order.back_focal_point + (0 if math.isinf(focus) else order.efl * front / x)


def _um(mm: float) -> str:
    return _known(1e3 * mm, ".1f", " µm")


def _known(value: float, form: str, unit: str = "") -> str:
    return f"{value:{form}}{unit}" if math.isfinite(value) else "-"


def _stated(value: float | None, unit: str = "") -> str:
    return "" if value is None else f"{value:g}{unit}"


def dispersions(page: Figure, made: Figures) -> None:
    """Names the rule that gives each glass its dispersion, at the foot of the page."""
    glasses: dict[str, list[str]] = {}
    for i, surface in enumerate(made.bench.lens.surfaces):
        if surface.dispersion is not None:
            glasses.setdefault(str(surface.dispersion), []).append(str(i))
    rules = (f"{name}: {', '.join(surfaces)}" for name, surfaces in glasses.items())
    text = f"Dispersion of the glass behind surfaces.  {'; '.join(rules)}"
    page.text(0.075, 0.019, fill(text, FOOT_LETTERS), size=4.6, color="#777777", va="top")


def spots(page: Figure, cell: SubplotSpec, made: Figures) -> None:
    """Draws spot diagrams of F, d and C, all to the same scale."""
    cells = cell.subgridspec(1, len(FIELDS), wspace=0.12)
    sizes = [np.abs(p.spot.points - p.spot.centroid).max() for p in made.points if p.spot]
    rms = [p.spot.rms for p in made.points if p.spot]
    half = min(max(sizes, default=0.1), 5 * max(rms, default=0.1))
    for k, point in enumerate(made.points):
        axes = page.add_subplot(cells[k])
        box(axes, half)
        if point.spot is None:
            axes.text(0.5, 0.5, "dark", transform=axes.transAxes, ha="center", color="#888888")
            caption(axes, point.height_mm, point.angle_deg, "")
            continue
        off = point.spot.points - point.spot.centroid
        for nm, color in zip(FDC_NM, LINE_COLORS, strict=True):
            of = point.spot.wavelength_nm == nm
            axes.plot(*off[of].T, ".", ms=0.9, mew=0, color=color, alpha=0.7, rasterized=True)
        caption(axes, point.height_mm, point.angle_deg, f"RMS {_um(point.spot.rms)}")
        if k == 0:
            axes.set_title(f"Spots in F, d, C; box {_um(2 * half)}")


def psfs(page: Figure, cell: SubplotSpec, made: Figures) -> None:
    """Draws point spread functions in white light, each to its own scale."""
    cells = cell.subgridspec(1, len(FIELDS), wspace=0.12)
    for k, point in enumerate(made.points):
        axes = page.add_subplot(cells[k])
        if point.psf is None:
            box(axes, 1.0)
            continue
        half = point.psf.half_mm
        image = np.sqrt(point.psf.image / point.psf.image.max())
        box(axes, half)
        axes.imshow(image, extent=(-half, half, -half, half), origin="lower", cmap="inferno")
        how = "waves" if point.psf.diffraction else "rays"
        axes.set_xlabel(f"box {_um(2 * half)}, {how}", labelpad=2)
        if k == 0:
            axes.set_title("Point spread functions (square root of the light)")


def box(axes: Axes, half: float) -> None:
    """Makes axes a square window without ticks."""
    axes.set_aspect("equal")
    axes.set_xlim(-half, half)
    axes.set_ylim(-half, half)
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(True)


def caption(axes: Axes, height: float, angle: float, text: str) -> None:
    """Writes height, angle and a text below a window."""
    where = f"{height:.1f} mm, {_known(angle, '.1f', '°')}"
    axes.set_xlabel(f"{where}\n{text}" if text else where, labelpad=2)


def legend_above(axes: Axes) -> None:
    """Draws the legend beside the title, clear of the curves."""
    axes.legend(
        ncols=3, loc="lower right", bbox_to_anchor=(1.0, 0.99), borderaxespad=0, columnspacing=1
    )


def mtf_over_field(axes: Axes, made: Figures) -> None:
    """Plots the diffraction MTF over the image height."""
    heights = made.bench.field_mm * np.asarray(MTF_FIELDS)
    for f, color in zip(FREQUENCIES, ("#1a202c", "#2b6cb0", "#c53030"), strict=True):
        values = made.mtf_over_field(f)
        axes.plot(heights, values[:, 0], color=color, label=f"{f:g}/mm sagittal")
        axes.plot(heights, values[:, 1], color=color, ls="--", label="tangential")
    axes.set_title("MTF over the field")
    axes.set_xlabel("image height, mm")
    axes.set_xlim(0, heights[-1])
    axes.set_ylim(0, 1)
    legend_above(axes)


def mtf_over_frequency(axes: Axes, made: Figures) -> None:
    """Plots diffraction and geometric MTF over frequency at three fields."""
    for share, color in zip((0.0, 0.7, 1.0), FIELD_COLORS, strict=True):
        k = MTF_FIELDS.index(share)
        for j, style in enumerate(("-", "--")):
            name = f"{share * made.bench.field_mm:.1f} mm {'ST'[j]}"
            axes.plot(made.frequency, made.mtf_waves[k, :, j], color=color, ls=style, label=name)
            axes.plot(made.frequency, made.mtf_rays[k, :, j], color=color, ls=":", lw=0.6)
    axes.set_title("MTF (dotted: rays alone)")
    axes.set_xlabel("cycles per mm")
    axes.set_xlim(0, made.frequency[-1])
    axes.set_ylim(0, 1)
    legend_above(axes)
