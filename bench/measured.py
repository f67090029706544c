"""Lenses of the library against measured products: distortion, lateral colour, vignetting, ...

    python bench/measured.py [--json] [--data FOLDER] [--lens NAME ...]

Data: lens_measured.json and closest_focus.json in ../shared/data/reality or in --data; without the
first, the package lensfunpy. Errors are RMS over the area of the frame, with pixels of 24 MP:

``distortion``: image heights without distortion, after the best scale: only its shape is measured.
    A fisheye's is relative to f x angle, as in the database. Curves are percent of the heights of
    the straightest picture.
``colour``: red and blue against green at f/8: chief rays of 410 to 690 nm, weighted by the response
    of a Sony A7R II times the wavelength. ``axial_g_um`` is the focus at 435.8 nm.
``vignetting``: EV, at the farthest distance measured; ``open`` is the widest stop of its focal
    length, ``stopped`` narrower by 3.5 x or more, for which the corner counts. Signs: predicted
    less measured.
``mtf``: at 30 lp/mm on the axis, wide open, of super-telephotos with fluorite.
``magnification``: at the product's closest focus, measured from the film, at a zoom's long end;
    ``at_m`` is the lens's own closest focus where that is farther. ``off`` is relative to the
    maker's figure.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from measured_products import FAR, Calibration, Floats, Terms, calibrations, closest_focus

from daguerre import lenses, sensors
from daguerre.analysis import (
    Bench,
    axial_colour,
    chief_rays,
    lateral_colour,
    modulation_transfer,
    pencil,
    relative_illumination,
    set_up,
)
from daguerre.errors import DaguerreError, InputError
from daguerre.lenses.focus import closest_focus_m

Row = dict[str, Any]
POINTS = 24  # image heights
BANDS_NM = np.arange(410.0, 691.0, 10.0)
G_LINE = 435.8343
SENSOR, COLOUR_STOP = "sony-a7r-ii", 8.0
NARROWER = 3.5  # a lens is stopped down at its widest f-number times this
DARKEST = 2.0**-10  # of the axis's light; less counts as this
SUPER_TELES = (
    "canon-ef-600mm-f4",
    "nikon-af-s-400mm-f2.8",
    "nikon-af-s-180-400mm-f4",
    "nikon-af-s-120-300mm-f2.8",
)
LINES_PER_MM = 30.0
#: Heads of the table.
FIGURES = ("median", "p90", "least", "most")
COLUMNS = ("shape", "red", "blue", "open", "stopped", "mtf", "closest")


def zoomed(name: str, focal_mm: float) -> lenses.Lens:
    """A lens at a focal length, or at the end of its zoom: printed lengths are nominal."""
    lens = lenses.load(name)
    ends = lens.zoom_range_mm
    return lens.at_zoom(float(np.clip(focal_mm, *ends))) if ends else lens


def placed(lens: lenses.Lens, f_stop: float, focus_m: float = math.inf) -> Bench:
    """A lens at an f-stop that it has: products' are rounded."""
    return set_up(lens, f_stop=max(f_stop, lens.first_order().f_number), focus_m=focus_m)


def rms(values: Floats, weights: Floats) -> float:
    """Root of the weighted mean square."""
    if not np.isfinite(values).all():
        raise InputError("no light reaches a part of the frame")
    return math.sqrt(float((weights * values**2).sum() / weights.sum()))


def distortion(one: Calibration, terms: Terms) -> Row:
    """Shape of distortion, measured and predicted."""
    bench = placed(zoomed(one.lens, terms["focal"]), COLOUR_STOP)
    heights, area = one.heights(POINTS)
    angles = chief_rays(bench, heights).angles
    ours = abs(bench.order.efl) * (angles if bench.is_fisheye else np.tan(angles))
    theirs = one.undistorted(terms, heights)
    ours = ours * float((area * ours * theirs).sum() / (area * ours**2).sum())
    straight = heights / float((area * heights * theirs).sum() / (area * theirs**2).sum())
    return {
        "efl_mm": bench.order.efl,
        "pixel_mm": one.pixel_mm,
        "px": rms((ours - theirs) / one.pixel_mm, area),
        "curve": curve(heights, 100 * (straight / theirs - 1), 100 * (straight / ours - 1)),
    }


@cache
def channels() -> dict[str, Floats]:
    """Weights of BANDS_NM in red, green and blue."""
    sensor = sensors.load(SENSOR)
    response = sensor.efficiency(BANDS_NM) * BANDS_NM
    return {
        name: response[sensor.channels.index(name)] / response[sensor.channels.index(name)].sum()
        for name in "RGB"
    }


def predicted_colour(bench: Bench, heights_mm: Floats) -> dict[str, Floats]:
    """Heights of red (``r``) and blue (``b``) less green's, mm."""
    shifts = lateral_colour(bench, heights_mm, list(BANDS_NM))
    red, green, blue = (shifts @ channels()[name] for name in "RGB")
    return {"r": red - green, "b": blue - green}


def colour(one: Calibration, terms: Terms) -> Row:
    """Lateral colour, measured and predicted, px."""
    bench = placed(zoomed(one.lens, terms["focal"]), COLOUR_STOP)
    heights, area = one.heights(POINTS)
    row: Row = {"efl_mm": bench.order.efl, "axial_g_um": 1e3 * axial_colour(bench, [G_LINE])[0]}
    for channel, shifts in predicted_colour(bench, heights).items():
        name = {"r": "red", "b": "blue"}[channel]
        ours = shifts / one.pixel_mm
        theirs = one.colour(terms, channel, heights) / one.pixel_mm
        row[f"{name}_px"] = rms(ours - theirs, area)
        row[f"{name}_curve"] = curve(heights, theirs, ours)
    return row


def vignetting(one: Calibration, terms: Terms) -> Row:
    """Vignetting, measured and predicted, EV."""
    focus_m = terms["distance"] if terms["distance"] < FAR else math.inf
    bench = placed(zoomed(one.lens, terms["focal"]), terms["aperture"], focus_m)
    heights, area = one.heights(POINTS)
    heights = np.concatenate([[0.0], heights, [one.half_diagonal_mm]])
    ours, theirs = (
        np.log2(np.maximum(light, DARKEST))
        for light in (
            relative_illumination(bench, heights).relative,
            one.illumination(terms, heights),
        )
    )
    return {
        "f_stop": terms["aperture"],
        "ev": rms((ours - theirs)[1:-1], area),
        "corner_ev": float(ours[-1] - theirs[-1]),
        "kind": kind(one, terms),
        "curve": curve(heights, theirs, ours),
    }


def kind(one: Calibration, terms: Terms) -> str:
    """``open``, ``stopped``, or ``between``."""
    same = [t["aperture"] for t in one.vignetting if t["focal"] == terms["focal"]]
    if terms["aperture"] == min(same):
        return "open"
    return "stopped" if terms["aperture"] >= NARROWER * min(same) else "between"


def curve(heights_mm: Floats, measured: Floats, predicted: Floats) -> Row:
    """Three lists for a plot."""
    lists = {"height_mm": heights_mm, "measured": measured, "predicted": predicted}
    return {name: [round(float(v), 5) for v in values] for name, values in lists.items()}


def mtf(name: str) -> Row:
    """MTF on the axis, wide open; a zoom is at its long end."""
    bench = set_up(zoomed(name, math.inf))
    light = pencil(bench)
    assert light is not None
    found = modulation_transfer(light, [LINES_PER_MM]).waves[0]
    return {"efl_mm": bench.order.efl, "f_stop": bench.f_stop, "mtf": float(found.min())}


def magnification(name: str, stated: Terms) -> Row:
    """Magnification at the product's closest focus, or the lens's, beside its maker's figure."""
    far = zoomed(name, math.inf)
    nearest = 1.0001 * closest_focus_m(far, from_sensor=True)
    at = max(stated["closest_focus_m"], nearest)
    lens = far.focused(at, measured_from="sensor")
    order = lens.lens.first_order()
    predicted = abs(order.back_focal_point - lens.film_z_mm) / abs(order.efl)
    return {**stated, "at_m": at, "efl_mm": far.first_order().efl, "predicted": predicted}


def row(key: Row, made: Any, *arguments: Any) -> Row:
    """A row, or why there is none."""
    try:
        return {**key, **made(*arguments)}
    except InputError as error:
        return {**key, "error": str(error).removeprefix(f"{key['lens']}: ")}


def rows(found: Sequence[Calibration], stated: Sequence[Terms], only: Sequence[str]) -> Row:
    """Rows of each quantity."""
    out: Row = {k: [] for k in ("distortion", "colour", "vignetting", "mtf", "magnification")}
    for one in found:
        if only and one.lens not in only:
            continue
        key = {"lens": one.lens, "product": one.product, "match": one.match}
        for name, made, settings in (
            ("distortion", distortion, one.distortion),
            ("colour", colour, one.lateral_colour),
            ("vignetting", vignetting, one.farthest()),
        ):
            for terms in settings:
                out[name].append(row({**key, "focal_mm": terms["focal"]}, made, one, terms))
    for name in SUPER_TELES:
        if not only or name in only:
            out["mtf"].append(row({"lens": name}, mtf, name))
    for terms in stated:
        if not only or terms["lens"] in only:
            made_of = row({"lens": terms["lens"]}, magnification, terms["lens"], terms)
            out["magnification"].append(made_of)
    return out


def figures(values: Sequence[float]) -> Row | None:
    """Count, median, 90th percentile, least and most; None without values."""
    if not values:
        return None
    found = (np.median(values), np.percentile(values, 90), min(values), max(values))
    return {"count": len(values), **dict(zip(FIGURES, map(float, found), strict=True))}


def quantities(out: Row) -> dict[str, list[float]]:
    """Values of each quantity over settings."""
    seen = {name: [r for r in found if "error" not in r] for name, found in out.items()}
    of = {k: [r for r in seen["vignetting"] if r["kind"] == k] for k in ("open", "stopped")}
    return {
        "distortion_px": [r["px"] for r in seen["distortion"]],
        "red_px": [r["red_px"] for r in seen["colour"]],
        "blue_px": [r["blue_px"] for r in seen["colour"]],
        "open_ev": [r["ev"] for r in of["open"]],
        "stopped_corner_ev": [abs(r["corner_ev"]) for r in of["stopped"]],
        "mtf": [r["mtf"] for r in seen["mtf"]],
        "magnification_off": [
            abs(r["predicted"] / r["magnification"] - 1) for r in seen["magnification"]
        ],
    }


def summary(out: Row) -> Row:
    """Figures of each quantity, and how many settings failed."""
    made: Row = {name: figures(values) for name, values in quantities(out).items()}
    return {**made, "errors": sum("error" in r for found in out.values() for r in found)}


def table(out: Row, made: Row) -> str:
    """The summary, medians of each lens, and what failed."""
    lines = [f"{'':32}{'settings':>9}" + "".join(f"{k:>9}" for k in FIGURES)]
    for name, one in made.items():
        if isinstance(one, dict):
            shown = "".join(f"{one[k]:9.2f}" for k in FIGURES)
            lines.append(f"{name:32}{one['count']:9d}{shown}")
    lines += ["", f"{'medians':32}" + "".join(f"{name:>9}" for name in COLUMNS)]
    names = dict.fromkeys(r["lens"] for found in out.values() for r in found)
    for lens in names:
        own = {name: [r for r in found if r["lens"] == lens] for name, found in out.items()}
        cells = [figures(values) for values in quantities(own).values()]
        shown = "".join(f"{one['median']:9.2f}" if one else f"{'-':>9}" for one in cells)
        lines.append(f"{lens:32}{shown}")
    failed = [r for found in out.values() for r in found if "error" in r]
    return "\n".join([*lines, *(f"{r['lens']}: {r['error']}" for r in failed)])


def main() -> None:
    """Prints the table, or one JSON object."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--data", type=Path, metavar="FOLDER")
    parser.add_argument("--lens", nargs="+", default=(), metavar="NAME")
    arguments = parser.parse_args()
    try:
        found, source = calibrations(arguments.data)
        stated = closest_focus(arguments.data)
    except DaguerreError as error:
        print(f"measured: {error}", file=sys.stderr)
        sys.exit(error.exit_code)
    known = {*(one.lens for one in found), *(terms["lens"] for terms in stated), *SUPER_TELES}
    for name in set(arguments.lens) - known:
        parser.error(f"--lens: wanted a lens with measurements, got {name}")
    out = rows(found, stated, arguments.lens)
    made = summary(out)
    if arguments.json:
        print(json.dumps({"bench": "measured", "source": source, "summary": made, **out}))
    else:
        print(table(out, made))


if __name__ == "__main__":
    main()
