"""Plots of predicted against measured values, and of six lenses."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from kept import fitted
from matplotlib import rc_context
from matplotlib.figure import Figure

from daguerre import lenses
from daguerre.plots.curves import BLUE, INK, RED
from daguerre.plots.figure import SINGLE
from daguerre.plots.sheet import saved

Row = dict[str, Any]
#: Lenses with all three measurements; the focal lengths are those of the plots, mm.
SIX = {
    "canon-rf-85mm-f1.2": 85.0,
    "fujifilm-gf-110mm-f2": 110.0,
    "nikon-ai-s-50mm-f1.8": 50.0,
    "nikon-z-14-30mm-f4": 14.0,
    "sigma-50mm-f1.4": 50.0,
    "voigtlander-apo-lanthar-50mm-f2": 50.0,
}
SHOWN = ("distortion", "colour", "vignetting")
GOLD = "#b7791f"
TENTHS = (0.1, 0.2, 0.5, 1)
Dot = tuple[float, float, str]  # measured, predicted, name of the lens
#: Letters of the overview are legible where the page is as narrow as a phone.
LARGE: Any = {
    **SINGLE,
    "font.size": 11,
    "axes.titlesize": 12,
    "axes.labelsize": 11,
    "xtick.labelsize": 10.5,
    "ytick.labelsize": 10.5,
    "legend.fontsize": 10.5,
    "legend.handletextpad": 0.1,
    "legend.borderaxespad": 0.2,
}


def drawings(rows: Row) -> dict[str, bytes]:
    """Files by their names in docs, without suffix."""
    made = {"measured": overview(rows)}
    for name, mm in SIX.items():
        own = at_focal_length(name, mm, rows)
        if all(own.values()):
            made[f"measured/{name}"] = one_lens(name, mm, own)
        else:
            print(f"{name}: no measurements at {mm:g} mm, so its plot stays", file=sys.stderr)
    return made


def at_focal_length(name: str, focal_mm: float, rows: Row) -> dict[str, list[Row]]:
    """Rows of a lens's own product at one focal length."""
    wanted = {"lens": name, "focal_mm": focal_mm, "match": "A"}
    seen = {k: [r for r in rows[k] if "error" not in r] for k in SHOWN}
    return {k: [r for r in found if wanted.items() <= r.items()] for k, found in seen.items()}


def overview(rows: Row) -> bytes:
    """Values at the corner of every setting, and magnifications."""
    seen = {name: [r for r in rows[name] if "error" not in r] for name in (*SHOWN, "magnification")}
    light = {k: [r for r in seen["vignetting"] if r["kind"] == k] for k in ("open", "stopped")}
    near = [(r["magnification"], r["predicted"], r["lens"]) for r in seen["magnification"]]
    with rc_context(LARGE):
        figure = Figure(figsize=(6.4, 6.4), layout="constrained")
        figure.get_layout_engine().set(w_pad=0.12, h_pad=0.12)
        (shape, colour), (vignetting, magnified) = figure.subplots(2, 2)
        dots(shape, "", {"": (INK, corners(seen["distortion"]))})
        named = (("red", RED), ("blue", BLUE))
        dots(colour, "", {n: (c, corners(seen["colour"], f"{n}_curve")) for n, c in named})
        stops = {"wide open": (INK, light["open"]), "stopped down": (GOLD, light["stopped"])}
        dots(vignetting, "vignetting", {n: (c, corners(found)) for n, (c, found) in stops.items()})
        magnified.set(xscale="log", yscale="log")
        for axis in (magnified.xaxis, magnified.yaxis):
            axis.set_ticks(TENTHS, labels=map(str, TENTHS))
            axis.set_ticks([], minor=True)
        dots(magnified, "magnification", {"": (INK, near)})
        for axes, title in (
            (shape, "Distortion, %"),
            (colour, "Lateral colour, px"),
            (vignetting, "Light at the corner, EV"),
            (magnified, "Closest magnification"),
        ):
            axes.set(title=title, xlabel="measured", ylabel="predicted")
        magnified.set_xlabel("stated by the maker")
        return saved(figure, "svg", "Predicted against measured")


def corners(found: list[Row], curve: str = "curve") -> list[Dot]:
    """Values of curves at the corner."""
    return [(r[curve]["measured"][-1], r[curve]["predicted"][-1], r["lens"]) for r in found]


def dots(axes: Any, quantity: str, groups: dict[str, tuple[str, list[Dot]]]) -> None:
    """Measured values across, predicted up, rings where fitted; on the line both are the same."""
    for name, (color, found) in groups.items():
        axes.plot([], [], "o", ms=5, mew=0, alpha=0.5, color=color, label=name)
        for measured, predicted, lens in found:
            look = {"mfc": "none"} if quantity in fitted(lens) else {"mew": 0}
            axes.plot(measured, predicted, "o", ms=5, alpha=0.5, color=color, **look)
    low, high = np.array([axes.get_xlim(), axes.get_ylim()]).T
    ends = float(low.min()), float(high.max())
    axes.plot(ends, ends, color="#888888", lw=1, zorder=1)
    axes.set(xlim=ends, ylim=ends, aspect="equal")
    if axes.get_xscale() == "linear":
        axes.locator_params(nbins=4)
    if len(groups) > 1:
        axes.legend(loc="upper left")


def one_lens(name: str, focal_mm: float, own: dict[str, list[Row]]) -> bytes:
    """Distortion, lateral colour and light over the image height of a lens."""
    with rc_context(SINGLE):
        figure = Figure(figsize=(8.4, 2.7), layout="constrained")
        shape, colour, light = figure.subplots(1, 3)
        pair(shape, shifted(own["distortion"][0]), INK)
        for color, label in ((RED, "red"), (BLUE, "blue")):
            pair(colour, own["colour"][0][f"{label}_curve"], color, label)
        stops = [r for r in own["vignetting"] if r["kind"] != "between"]
        for color, row in zip((INK, GOLD), (stops[0], stops[-1]), strict=True):
            pair(light, row["curve"], color, f"f/{row['f_stop']:g}")
        for axes, title, low, high in (
            (shape, "Distortion, px at 24 MP", -5.0, 5.0),
            (colour, "Lateral colour, px at 24 MP", -1.0, 1.0),
            (light, "Light against the axis, EV", -1.0, 0.1),
        ):
            bottom, top = axes.get_ylim()
            axes.set(title=title, xlabel="image height, mm")
            axes.set(xlim=(0, None), ylim=(min(low, bottom), max(high, top)))
        for axes in (colour, light):
            axes.legend(loc="best")
        setting = f"{lenses.load(name).name}, {focal_mm:g} mm"
        figure.suptitle(f"{setting}: lines predicted, circles measured", size=10)
        return saved(figure, "svg", name)


def shifted(row: Row) -> Row:
    """Distortion as shifts of points from the straightest picture, px."""
    heights = np.array(row["curve"]["height_mm"])
    found = {k: np.array(row["curve"][k]) / 100 for k in ("measured", "predicted")}
    shifts = {k: heights * v / (1 + v) / row["pixel_mm"] for k, v in found.items()}
    return {"height_mm": heights, **shifts}


def pair(axes: Any, curve: Row, color: str, label: str = "") -> None:
    """A line for the lens, and circles for the product."""
    axes.plot(curve["height_mm"], curve["predicted"], color=color, label=label)
    axes.plot(curve["height_mm"], curve["measured"], "o", ms=3.5, mfc="none", mew=0.8, color=color)
