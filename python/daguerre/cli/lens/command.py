"""``daguerre lens``: one lens on the bench, its numbers, its data sheet, its PSF."""

from __future__ import annotations

import math
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from daguerre.cli.console import note
from daguerre.cli.drawings import check_drawing
from daguerre.cli.flags.from_table import made_of
from daguerre.cli.flags.groups import option, with_flags
from daguerre.cli.flags.setting import F_STOP, FOCUS, ZOOM, BenchFlags, focus_by
from daguerre.errors import InputError, UsageError
from daguerre.parameters.table import Table
from daguerre.units import TYPED_D_LINE_NM, angle_deg, distance_m, length_mm

from .export import FILES, Export
from .flare import Flare

if TYPE_CHECKING:
    from daguerre.analysis import Bench
    from daguerre.lenses import Lens
    from daguerre.lenses.setting import By

BENCH = "On the bench"
_SETTING = Table(
    *(ZOOM, FOCUS, F_STOP),
    focus_by("Focus at the smallest spot on the axis, or of rays close to it", "best"),
)


@made_of(_SETTING, panel=BENCH)
class SettingFlags(BenchFlags):
    """How the lens is set; without flags wide open and focused at infinity."""

    @property
    def by(self) -> By:
        """How it is focused."""
        return self.focus_by or "best"

    def given_mm(self) -> dict[str, Any]:
        """Zoom, focus and stop that were given, by the names of the bench."""
        names = {"zoom": "zoom_mm", "focus_distance": "focus_m", "f_stop": "f_stop"}
        return {names[name]: value for name, value in self.given().items() if name in names}


@with_flags(polynomials=Export, setting=SettingFlags)
def lens(
    name: Annotated[str, typer.Argument(metavar="NAME|FILE", help="Library name or lens file.")],
    *,
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
    polynomials: Export,
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
    setting: SettingFlags,
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
    polynomials.check(export, film_serves=flare is not None)
    ghosts = Flare(flare, ghost, cover_glass, sensor_reflectance, polynomials.film)
    setting.check()
    if through_focus and psf is None:
        raise UsageError("--through-focus: needs --psf FIELD,DISTANCE")
    point = None if psf is None else _point(psf)
    item = library.load(name)
    for text in item.notes:
        note(text)
    if export is not None:
        polynomials.write(item, export, {**setting.given_mm(), "by": setting.by})
        return 0

    def bench() -> Bench:
        return set_up(item, by=setting.by, **setting.given_mm())

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
        _print(bench().lens if setting.given_mm() else item, wavelength)
    return 0


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
    except InputError as error:
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
