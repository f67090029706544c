#!/usr/bin/env python3
"""The rays behind a sheet of imperfections, traced on the bench through the lens of the sheet.

    python script/docs/gallery/rays.py NAME [OUT.svg]        (default: out/rays_NAME.svg)

The left half shows rays close to the film, which is upright; heights are exaggerated. The right
half shows what follows. Needs the extra `plot`.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from words import (
    BIOTAR,
    CANON,
    ELCAN,
    FISHEYE,
    MASTER,
    PETZVAL,
    SOFT,
    WEAK,
    ZOOM,
)

from daguerre import analysis, lenses
from daguerre.analysis.ghosts import Ghosts
from daguerre.plots import images
from daguerre.plots.ghost_section import ghost_section

Floats = NDArray[np.float64]
#: Colours of rays by wavelength, nm: those of the sensor's channels, as docs/darkroom.md has them.
CHANNELS = {650.0: "#d62728", 545.0: "#2ca02c", 443.0: "#1f4fd6"}
SAGITTAL, TANGENTIAL = "#1f77b4", "#d95f02"
GREEN = 587.56  # nm
STYLE = {"font.size": 10, "svg.fonttype": "none", "svg.hashsalt": "daguerre", "axes.grid": False}


def main() -> None:
    """Draws one diagram."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("name", choices=DIAGRAMS)
    parser.add_argument("output", type=Path, nargs="?")
    given = parser.parse_args()
    draw(given.name, given.output or Path(f"out/rays_{given.name}.svg"))


def draw(name: str, file: Path) -> None:
    """Draws one diagram into a file; equal lenses give equal bytes."""
    _, drawing = DIAGRAMS[name]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(9, 3.4), layout="constrained")
        drawing(figure)
        file.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(file, metadata={"Date": None})


def bench_of(lens: str, **setting: float | str) -> analysis.Bench:
    """A lens focused as `daguerre render` does by default."""
    return analysis.set_up(lenses.load(lens), **{"by": "paraxial", **setting})  # type: ignore[arg-type]


def light_of(bench: analysis.Bench, height_mm: float = 0.0) -> analysis.Pencil:
    """Light of an image height."""
    light = analysis.pencil(bench, height_mm)
    if light is None:
        raise SystemExit(f"rays: no light arrives {height_mm} mm off the axis")
    return light


def fan(light: analysis.Pencil, axis: int, count: int) -> Floats:
    """Window coordinates (N, 2) of a fan of rays along one axis of the pupil."""
    at = np.zeros((count, 2))
    at[:, axis] = np.linspace(light.low[axis], light.high[axis], count)
    return at


def near_film(axes: Axes, light: analysis.Pencil, at: Floats, z: tuple[float, float],
              colours: Sequence[object], axis: int = 1, nm: float = GREEN) -> None:  # fmt: skip
    """Draws rays around the film, um over mm."""
    rays = light.trace(at, nm)
    heights = np.stack([light.on_film(rays.at(light.bench.film_z + dz))[:, axis] for dz in z], 1)
    for height, colour, passed in zip(heights, colours, rays.passed, strict=True):
        if passed:
            axes.plot(z, 1e3 * height, color=colour, lw=1)


def film(axes: Axes, title: str) -> None:
    """Marks the film, and names the axes."""
    axes.axvline(0, color="0.2", lw=3, alpha=0.35)
    axes.set(title=title, xlabel="mm behind the film", ylabel="height, µm")
    axes.margins(x=0)


def by_share(shares: Floats) -> list[object]:
    """Colours from the middle of the pupil, blue, to its rim, red."""
    return [mpl.colormaps["turbo"](0.1 + 0.8 * float(abs(s))) for s in shares]


def spherical(figure: Figure) -> None:
    """Rays of one point on the axis, and where they cross it."""
    left, right = figure.subplots(1, 2)
    bench = bench_of(SOFT, focus_m=1.6, by="best")
    light = light_of(bench)
    at = fan(light, 1, 26)
    near_film(left, light, at, (-9, 9), by_share(at[:, 1] / light.high[1]))
    film(left, "Rays through the rim (red) cross first")
    left.set_ylim(-1000, 1000)
    shares = np.linspace(0, 1, 41)
    right.scatter(
        analysis.spherical_aberration(bench, shares), shares, s=16, color=by_share(shares)
    )
    film(right, "Where rays cross the axis")
    right.set_ylabel("height in the pupil")


def coma(figure: Figure) -> None:
    """Rings of the pupil on the film, and a fan of rays that is not symmetric."""
    left, right = figure.subplots(1, 2, width_ratios=(1.3, 1))
    light = light_of(bench_of(ELCAN, focus_m=200), 12.0)
    at = fan(light, 1, 26)
    middle, half = (light.low + light.high) / 2, (light.high - light.low) / 2
    near_film(left, light, at, (-0.9, 0.9), by_share((at[:, 1] - middle[1]) / half[1]))
    film(left, "Rays of a star 12 mm off the axis")
    angle = np.linspace(0, 2 * np.pi, 181)
    ring = np.stack([np.cos(angle), np.sin(angle)], 1)
    for share in np.linspace(0.2, 1, 6):
        rays = light.trace(middle + share * half * ring)
        on = 1e3 * light.on_film(rays.at(light.bench.film_z))
        right.plot(*on.T, color=by_share(np.array([share]))[0], lw=1.6)
    right.set(title="Each ring of the pupil, on the film", xlabel="µm", aspect="equal")
    right.set_ylabel("away from the axis, µm")


def axial_colour(figure: Figure) -> None:
    """Rays of three colours, and the focus over wavelength."""
    left, right = figure.subplots(1, 2)
    bench = bench_of(MASTER, focus_m=1.5)
    light = light_of(bench)
    for nm, colour in CHANNELS.items():
        near_film(left, light, fan(light, 1, 7), (-0.5, 0.7), [colour] * 7, nm=nm)
    film(left, "Red, green and blue rays")
    left.set_ylim(-200, 200)
    nms = np.linspace(430, 680, 60)
    right.scatter(analysis.axial_colour(bench, nms), nms, c=nms, cmap="turbo", s=16)
    film(right, "Focus of each colour")
    right.set_ylabel("wavelength, nm")


def lateral_colour(figure: Figure) -> None:
    """Chief rays of three colours, and their heights over the field."""
    left, right = figure.subplots(1, 2)
    bench = bench_of(CANON, f_stop=8, focus_m=2.2)
    light = light_of(bench, 18.0)
    for nm, colour in CHANNELS.items():
        near_film(left, light, fan(light, 1, 5), (-0.4, 0.2), [colour] * 5, nm=nm)
    film(left, "Red, green and blue rays of one point, 18 mm off")
    heights = np.linspace(0, 20, 21)
    for nm, off in zip(CHANNELS, analysis.lateral_colour(bench, heights, list(CHANNELS)).T,
                       strict=True):  # fmt: skip
        right.plot(heights, 1e3 * off, color=CHANNELS[nm], lw=2, label=f"{nm:.0f} nm")
    right.set(title="Where the colours land", xlabel="mm off the axis", ylabel="outward, µm")
    right.legend(frameon=False)


def astigmatism(figure: Figure) -> None:
    """Two fans of one point that do not meet, and both foci over the field."""
    bench = bench_of(PETZVAL, focus_m=2.2)
    left, right = figure.subplots(1, 2)
    _two_fans(left, light_of(bench, 12.0), (-2, 1))
    film(left, "Two fans of rays of a point, 12 mm off the axis")
    _two_foci(right, bench, 15.0)


def cylinder(figure: Figure) -> None:
    """Two fans of a point on the axis, and its spots on three films."""
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.3))
    light = light_of(bench_of(WEAK, f_stop=2, focus_m=2.2))
    _two_fans(left, light, (-1.8, 1.8), ("level fan", "upright fan"))
    film(left, "Two fans of rays of a point on the axis")
    spot = analysis.spot(light, (GREEN,), (1.0,), grid=40)
    for k, dz in enumerate((-0.97, 0, 0.97)):
        moved = 1e3 * spot.moved(dz).points
        right.plot(moved[:, 0] + 1200 * k, moved[:, 1], ".", ms=2, color="0.2", rasterized=True)
        right.text(1200 * k, -620, f"film {dz:+g} mm" if dz else "between", ha="center")
    right.set(title="Its image on three films: a line, a disc, a line", aspect="equal")
    right.set_ylim(-750, 500)
    right.set_axis_off()


def _two_fans(axes: Axes, light: analysis.Pencil, z: tuple[float, float],
              names: tuple[str, str] = ("sagittal fan", "tangential fan")) -> None:  # fmt: skip
    for axis, (name, colour) in enumerate(zip(names, (SAGITTAL, TANGENTIAL), strict=True)):
        near_film(axes, light, fan(light, axis, 9), z, [colour] * 9, axis)
        axes.plot([], [], color=colour, label=name)
    axes.legend(frameon=False, loc="upper right")


def _two_foci(axes: Axes, bench: analysis.Bench, most_mm: float) -> None:
    """Sagittal and tangential foci over the field."""
    curve = analysis.field_curvature(bench, np.linspace(0, most_mm, 31))
    axes.plot(curve.sagittal, curve.height_mm, color=SAGITTAL, lw=2, label="sagittal focus")
    axes.plot(curve.tangential, curve.height_mm, color=TANGENTIAL, lw=2, label="tangential focus")
    film(axes, "Both foci over the field")
    axes.margins(x=0.1)
    axes.set_ylabel("mm off the axis")
    axes.legend(frameon=False)


def field_curvature(figure: Figure) -> None:
    """Fans of five points, and both foci over the field."""
    left, right = figure.subplots(1, 2)
    bench = bench_of(CANON, f_stop=2, focus_m=2.2)
    for height in (0, 4, 8, 11, 13):
        light = light_of(bench, height)
        at = fan(light, 1, 5)
        rays = light.trace(at, GREEN)
        z = (-0.6, 0.6)
        off = np.stack([light.on_film(rays.at(bench.film_z + dz))[:, 1] for dz in z], 1)
        for line in off:  # heights of a fan are exaggerated, those of the points are not
            left.plot(z, height + 4 * line, color=mpl.colormaps["viridis"](height / 15), lw=1)
    film(left, "Rays of five points: the foci lie on a curve")
    left.set_ylabel("mm off the axis")
    _two_foci(right, bench, 14.0)


def distortion(figure: Figure) -> None:
    """A square grid through three lenses."""
    shown = (
        ("barrel", bench_of(ZOOM, zoom_mm=14.5, f_stop=8, focus_m=5.6)),
        ("pincushion", bench_of(ZOOM, zoom_mm=29, f_stop=8, focus_m=13)),
        ("fisheye", bench_of(FISHEYE, f_stop=8, focus_m=3)),
    )
    for axes, (name, bench) in zip(figure.subplots(1, 3), shown, strict=True):
        heights = np.linspace(0, 21.6, 61)
        found = analysis.distortion(bench, heights)
        flat = np.tan(np.radians(np.minimum(found.angle_deg, 84)))
        flat *= heights[1] / flat[1]
        reach = np.interp(18.0, heights, flat)  # what the middle of an edge shows of the wall
        for k in np.linspace(-1, 1, 13):
            line = np.linspace(-1.6, 1.6, 201) * reach
            across, along = np.full_like(line, k * reach), line
            for x, y in ((across, along), (along, across)):
                r = np.maximum(np.hypot(x, y), 1e-9)
                scale = np.interp(r, flat, heights, right=np.nan) / r
                axes.plot(scale * x, scale * y, color="#1f4fd6", lw=1)
        axes.set(title=name, aspect="equal", xlim=(-18, 18), ylim=(-12, 12), xticks=[], yticks=[])


def vignetting(figure: Figure) -> None:
    """Light of three points through the lens, and the pupil that each sees."""
    left, right = figure.subplots(1, 2, width_ratios=(2, 1))
    bench = bench_of(CANON, f_stop=0.95)
    bench.plot(left)
    left.set_title("The rims of the lens stop rays of points off the axis")
    for height, colour in ((0.0, "#1f77b4"), (9.0, "#d95f02"), (17.0, "#7b3294")):
        outline = analysis.pupil_outline(bench, height)
        closed = np.concatenate([outline, outline[:1]])
        right.plot(*closed.T, color=colour, lw=2, label=f"{height:g} mm off")
    right.set(title="The pupil seen from the film", aspect="equal")
    right.set_axis_off()
    right.legend(frameon=False, loc="center", fontsize=8)


def flares(figure: Figure) -> None:
    """The ways of the two brightest ghosts through the lens."""
    ghosts = Ghosts(bench_of(BIOTAR, f_stop=4), 11.0)
    for axes, ghost in zip(figure.subplots(1, 2), ghosts.all, strict=False):
        images.lens(axes, ghost_section(ghosts, ghost))
        far, near = ghost.surfaces[:2]
        axes.set_title(f"Reflected by surface {far}, then by surface {near}")


#: Each diagram's topic, and the function that draws it.
DIAGRAMS: dict[str, tuple[str, Callable[[Figure], None]]] = {
    "spherical": ("Rays through the rim cross the axis before those through the centre", spherical),
    "coma": ("Rings of the pupil land on the film as circles, displaced along a tail", coma),
    "axial_colour": ("Red, green and blue rays cross the axis at different places", axial_colour),
    "lateral_colour": (
        "Red, green and blue rays of one point land beside each other",
        lateral_colour,
    ),
    "field_curvature": ("The foci of five points lie on a curve, not on the film", field_curvature),
    "astigmatism": (
        "Two fans of one point's rays come to a focus one after the other",
        astigmatism,
    ),
    "cylinder": ("Level and upright rays of a point on the axis focus apart", cylinder),
    "distortion": ("A square grid through a barrel, a pincushion and a fisheye", distortion),
    "vignetting": ("Rims of the lens stop part of the light of points off the axis", vignetting),
    "flares": ("Light of two ghosts is reflected twice inside the lens", flares),
}

if __name__ == "__main__":
    main()
