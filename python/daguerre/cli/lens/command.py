"""``daguerre lens``: one lens on the bench, its numbers, its data sheet, its PSF."""

from __future__ import annotations

import math
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from daguerre.cli.console import note
from daguerre.cli.drawings import check_drawing
from daguerre.cli.flags.groups import option
from daguerre.errors import InputError, UsageError
from daguerre.units import SENSORS, TYPED_D_LINE_NM, angle_deg, distance_m, f_number, length_mm

from .export import Export
from .flare import Flare

if TYPE_CHECKING:
    from daguerre.analysis import Bench
    from daguerre.lenses import Lens

FOCUS_BY = ("best", "paraxial")
BENCH, FILES = "On the bench", "Files written"


def lens(
    name: Annotated[str, typer.Argument(metavar="NAME|FILE", help="Library name or lens file.")],
    json: Annotated[
        bool, option("--json", help="Print all numbers as one JSON object, mm.")
    ] = False,
    plot: Annotated[
        Path | None,
        option(
            "--plot",
            "-o",
            metavar="FILE.svg|png|pdf",
            help="Data sheet of one page; with --psf its pictures. Extra `plot`.",
            panel=FILES,
        ),
    ] = None,
    drawing: Annotated[
        Path | None,
        option(
            "--drawing",
            metavar="FILE.svg|png|pdf",
            help="Section with rays of three fields; .png, .pdf: extra `plot`.",
            panel=FILES,
        ),
    ] = None,
    export: Annotated[
        Path | None,
        option(
            "--export",
            metavar="FILE.osl|c|glsl|py|json",
            help="The lens as polynomials: OSL for Blender's camera, C, GLSL, NumPy, data.",
            panel=FILES,
        ),
    ] = None,
    degree: Annotated[
        int | None,
        option(
            "--degree",
            metavar="N",
            help="Degree of the exported polynomials, odd, 1 to 13 [7].",
            panel=FILES,
        ),
    ] = None,
    sensor: Annotated[
        str | None,
        option(
            "--sensor",
            metavar="WxH|" + "|".join(SENSORS),
            help="Size of the film for --export and --flare, mm [the lens's format].",
            panel=FILES,
        ),
    ] = None,
    blades: Annotated[
        int | None,
        option(
            "--blades",
            metavar="N",
            help="Blades of the exported lens's iris; 0 is round [0].",
            panel=FILES,
        ),
    ] = None,
    blade_rotation: Annotated[
        str | None,
        option(
            "--blade-rotation",
            metavar="DEG",
            help="Rotation of the exported lens's iris blades, degrees [0].",
            panel=FILES,
        ),
    ] = None,
    blade_curvature: Annotated[
        float | None,
        option(
            "--blade-curvature",
            metavar="C",
            help="Curvature of its iris blades, -1 to 1; 1 is round [0].",
            panel=FILES,
        ),
    ] = None,
    psf: Annotated[
        str | None,
        option(
            "--psf",
            metavar="FIELD,DISTANCE",
            help="Point spread function: image height (mm) or angle (deg), distance (m) or inf.",
            panel=BENCH,
        ),
    ] = None,
    through_focus: Annotated[
        bool,
        option("--through-focus", help="Show the PSF on nine films around the focus.", panel=BENCH),
    ] = False,
    flare: Annotated[
        str | None,
        option(
            "--flare",
            metavar="ANGLE",
            help="Ghosts of light from this angle (deg), brightest first; --drawing draws one, "
            "--plot all on the film.",
            panel=BENCH,
        ),
    ] = None,
    ghost: Annotated[
        str | None,
        option(
            "--ghost",
            metavar="I,J",
            help="Surfaces of the ghost that --drawing shows [the brightest].",
            panel=BENCH,
        ),
    ] = None,
    cover_glass: Annotated[
        str | None,
        option(
            "--cover-glass",
            metavar="MM,GAP[,INDEX]",
            help="Cover glass before the sensor, for --flare: thickness, gap (mm), index.",
            panel=BENCH,
        ),
    ] = None,
    sensor_reflectance: Annotated[
        float | None,
        option(
            "--sensor-reflectance",
            metavar="R",
            help="Reflectance of the sensor, 0 to 1, for --flare [0].",
            panel=BENCH,
        ),
    ] = None,
    veiling_glare: Annotated[
        bool,
        option(
            "--veiling-glare",
            help="Print the veiling glare of a black patch in a white world: ghosts and scatter.",
            panel=BENCH,
        ),
    ] = False,
    zoom: Annotated[
        str | None, option("--zoom", metavar="MM", help="Focal length of a zoom, mm.", panel=BENCH)
    ] = None,
    focus: Annotated[
        str | None,
        option("--focus", metavar="M", help="Focus distance, m from the pupil [inf].", panel=BENCH),
    ] = None,
    f_stop: Annotated[
        str | None,
        option("--f-stop", metavar="N", help="F-stop as engraved [wide open].", panel=BENCH),
    ] = None,
    focus_by: Annotated[
        str,
        option(
            "--focus-by",
            metavar="best|paraxial",
            help="Focus at the smallest spot on the axis, or of rays close to it [best].",
            panel=BENCH,
        ),
    ] = "best",
    wavelength: Annotated[
        float,
        option(
            "--wavelength",
            metavar="NM",
            help=f"Wavelength of the first-order data, nm [{TYPED_D_LINE_NM}].",
        ),
    ] = TYPED_D_LINE_NM,
) -> int:
    """Shows a lens: its table and first-order data (mm); data sheet, section and PSF on request."""
    from daguerre import lenses as library
    from daguerre.analysis import set_up

    for flag, path in (("--plot", plot), ("--drawing", drawing)):
        check_drawing(flag, path, plotted=flag == "--plot")
    polynomials = Export(degree, sensor, blades, blade_rotation, blade_curvature)
    (polynomials if flare is None else replace(polynomials, sensor=None)).check(export)
    ghosts = Flare(flare, ghost, cover_glass, sensor_reflectance, sensor)
    if focus_by not in FOCUS_BY:
        raise UsageError(f"--focus-by: wanted {' or '.join(FOCUS_BY)}, got {focus_by!r}")
    if through_focus and psf is None:
        raise UsageError("--through-focus: needs --psf FIELD,DISTANCE")
    point = None if psf is None else _point(psf)
    item = library.load(name)
    for text in item.notes:
        note(text)
    setting = _setting(zoom, focus, f_stop)
    if export is not None:
        polynomials.write(item, export, {**setting, "by": focus_by})
        return 0

    def bench() -> Bench:
        return set_up(item, by="best" if focus_by == "best" else "paraxial", **setting)

    if ghosts.wanted:
        return ghosts.show(bench(), plot=plot, drawing=drawing, json=json)
    if veiling_glare:
        from .glare import show_glare

        return show_glare(bench(), json=json)
    if drawing is not None:
        _write_drawing(bench(), drawing)
    if point is not None:
        from .psf import show_psf

        return show_psf(bench(), *point, plot=plot, json=json, through_focus=through_focus)
    if plot is not None or json:
        _write_figures(item, bench(), plot, wavelength, json=json)
    if not json:
        _print(item if not setting else bench().lens, wavelength)
    return 0


def _setting(zoom: str | None, focus: str | None, f_stop: str | None) -> dict[str, Any]:
    out: dict[str, Any] = {}
    if zoom is not None:
        out["zoom_mm"] = length_mm("--zoom", zoom)
    if focus is not None:
        out["focus_m"] = distance_m("--focus", focus)
    if f_stop is not None:
        out["f_stop"] = f_number("--f-stop", f_stop)
    return out


def _point(text: str) -> tuple[float, bool, float]:
    """Field, whether it is an angle (deg), distance (m)."""
    field, comma, distance = text.partition(",")
    if not comma:
        raise UsageError(f"--psf: wanted FIELD,DISTANCE such as 10mm,inf or 15deg,3, got {text!r}")
    is_angle = field.strip().lower().endswith(("deg", "rad"))
    value = angle_deg("--psf", field) if is_angle else length_mm("--psf", field)
    metres = distance_m("--psf", distance)
    if not metres > 0 or not math.isfinite(value):
        raise UsageError(f"--psf: wanted a field and a distance above 0, got {text!r}")
    return value, is_angle, metres


def _write_drawing(bench: Bench, path: Path) -> None:
    from daguerre.files.atomic import write_bytes
    from daguerre.plots.lens_file import picture

    write_bytes(path, picture(bench, path.suffix.lower()))


def _write_figures(
    item: Lens, bench: Bench, plot: Path | None, wavelength: float, *, json: bool
) -> None:
    """Figures are made once, for the page and for the JSON."""
    from daguerre.analysis.figures import figures

    made = figures(bench)
    if plot is not None:
        from daguerre.files.atomic import write_bytes
        from daguerre.plots.sheet import page

        write_bytes(plot, page(made, plot.suffix.lower()[1:]))
    if json:
        from json import dumps

        from daguerre.analysis.facts import facts

        order = asdict(item.first_order(wavelength))
        # JSON has no NaN or infinity: null.
        print(dumps(_finite({**_facts(item, order), "bench": facts(made)}), indent=2))


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _print(item: Lens, wavelength: float) -> None:
    try:
        order = asdict(item.first_order(wavelength))
    except ValueError as error:
        raise InputError(f"{item.source}: {error}") from None
    print(item)
    print(f"at {wavelength:g} nm, lengths in mm, z = 0 at the first vertex")
    for key, value in order.items():
        if key != "wavelength_nm":
            print(f"  {key.replace('_', ' '):22} {_show(value)}")


def _facts(item: Lens, order: dict[str, Any]) -> dict[str, Any]:
    names = ("kind", "radius", "thickness", "semi_diameter", "glass", "stop", "derived")
    surfaces = [{name: getattr(s, name) for name in names} for s in item.surfaces]
    return {
        "name": item.name,
        "source": item.patent,
        "note": item.note,
        "notes": list(item.notes),
        **order,
        "first_order": order,
        "nominal": asdict(item.nominal),
        "image_z": item.image_z,
        "surfaces": surfaces,
    }


def _show(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key} {_show(inner)}" for key, inner in value.items())
    return f"{value:.6g}" if isinstance(value, float) else str(value)
