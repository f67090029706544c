"""``daguerre lens``: a lens on the bench, its numbers, data sheet and PSF."""

from __future__ import annotations

import math
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from daguerre.camera.parameters.bench import F_STOP, FOCUS, ZOOM, focus_by
from daguerre.cli import console
from daguerre.cli.console import note
from daguerre.cli.drawings import write_drawing
from daguerre.cli.flags.from_table import made_of
from daguerre.cli.flags.groups import option, with_flags
from daguerre.cli.flags.setting import BENCH, BenchFlags
from daguerre.errors import InputError
from daguerre.parameters.table import Table
from daguerre.units import TYPED_D_LINE_NM

from .export import FileFlags
from .flare import FlareFlags
from .psf import PsfFlags

if TYPE_CHECKING:
    from daguerre.analysis import Bench
    from daguerre.lenses import Lens
    from daguerre.lenses.setting import By

_SETTING = Table(
    *(ZOOM, FOCUS, F_STOP),
    focus_by("Focus criterion: smallest spot on the axis, or rays near the axis", "best"),
)


@made_of(_SETTING, panel=BENCH)
class SettingFlags(BenchFlags):
    """Setting of the lens; without flags, wide open and focused at infinity."""

    @property
    def by(self) -> By:
        """Focus criterion."""
        return self.focus_by or "best"

    def given_mm(self) -> dict[str, Any]:
        """Given zoom, focus and stop, by the names of the bench."""
        names = {"zoom": "zoom_mm", "focus_distance": "focus_m", "f_stop": "f_stop"}
        return {names[name]: value for name, value in self.given().items() if name in names}


@with_flags(files=FileFlags, psf=PsfFlags, flare=FlareFlags, setting=SettingFlags)
def lens(
    name: Annotated[str, typer.Argument(metavar="LENS", help="Library name or lens file.")],
    *,
    json: Annotated[
        bool, option("--json", help="Print all numbers as one JSON object, lengths in mm.")
    ] = False,
    files: FileFlags,
    psf: PsfFlags,
    flare: FlareFlags,
    veiling_glare: Annotated[
        bool,
        option(
            "--veiling-glare",
            help="Print the veiling glare index: light that ghosts and scatter put onto a black "
            "patch in a white world.",
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
    """Shows the surfaces and first-order data of a lens, in mm.

    Flags write a data sheet, a section, a PSF, a list of ghosts or the lens as polynomials.
    """
    from daguerre import lenses as library
    from daguerre.analysis import set_up
    from daguerre.lenses.engraved import stop_remark
    from daguerre.lenses.stop_size import check_stop_size

    files.check(film_serves=flare.wanted)
    flare.check()
    setting.check()
    psf.check()
    item = library.load(name)
    check_stop_size(item)
    for text in item.notes:
        note(text)
    if told := stop_remark(item, **setting.given_mm()):
        note(told)
    if files.export is not None:
        files.write(item, files.export, {**setting.given_mm(), "by": setting.by})
        return 0

    def bench() -> Bench:
        return set_up(item, by=setting.by, **setting.given_mm())

    if flare.wanted:
        return flare.show(bench(), files, json=json)
    if veiling_glare:
        from .glare import show_glare

        return show_glare(bench(), json=json)
    if files.drawing is not None:
        _write_drawing(bench(), files.drawing)
    if psf.wanted:
        return psf.show(bench(), plot=files.plot, json=json)
    if files.plot is not None or json:
        _write_figures(item, bench(), files.plot, wavelength, json=json)
    if not json:
        _print(bench().lens if setting.given_mm() else item, wavelength)
    return 0


def _write_drawing(bench: Bench, path: Path) -> None:
    from daguerre.plots.lens_file import picture

    write_drawing(path, picture(bench, path.suffix.lower()))


def _write_figures(
    item: Lens, bench: Bench, plot: Path | None, wavelength: float, *, json: bool
) -> None:
    """Makes the figures once, for the page and for JSON."""
    from daguerre.analysis.figures import data_sheet

    made = data_sheet(bench)
    if plot is not None:
        from daguerre.plots.sheet import page

        write_drawing(plot, page(made, plot.suffix.lower()[1:]))
    if json:
        from json import dumps

        from daguerre.analysis.facts import facts

        order = asdict(item.first_order(wavelength))
        # JSON has no NaN or infinity: null.
        console.show(dumps(_finite({**_facts(item, order), "bench": facts(made)}), indent=2))


def _finite(value: object) -> Any:
    if isinstance(value, dict):
        return {key: _finite(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _print(item: Lens, wavelength: float) -> None:
    from daguerre.lenses.agreement import agreement
    from daguerre.lenses.focusing import focusing
    from daguerre.lenses.image_circle import stated_half_image

    try:
        order = asdict(item.first_order(wavelength))
    except InputError as error:
        raise InputError(f"{item.source}: {error}") from None
    console.show(item)
    console.show(f"at {wavelength:g} nm, lengths in mm, z = 0 at the first vertex")
    for key, value in order.items():
        if key != "wavelength_nm":
            console.show(f"  {key.replace('_', ' '):22} {_show(value)}")
    if (half := stated_half_image(item, item.first_order())) is not None:
        console.show(f"  {'image circle':22} {_show(2 * half)}")
    console.show(f"focusing: {focusing(item)}")
    if (product := item.product) is not None:
        console.show(f"the product: {product}")
    found = agreement(item)
    if found is not None:
        console.show(found)


def _facts(item: Lens, order: dict[str, Any]) -> dict[str, Any]:
    from daguerre.lenses.agreement import agreement
    from daguerre.lenses.focusing import focusing

    found = agreement(item)
    names = ("kind", "radius", "thickness", "semi_diameter", "glass", "stop")
    marks = ("derived", "widened_from", "fitted")
    surfaces = [
        {name: getattr(s, name) for name in names + marks}
        | {"dispersion": None if s.dispersion is None else asdict(s.dispersion)}
        for s in item.surfaces
    ]
    return {
        "name": item.name,
        "source": item.patent,
        "note": item.note,
        "notes": list(item.notes),
        **order,
        "first_order": order,
        "nominal": asdict(item.nominal),
        "focusing": asdict(focusing(item)),
        "product": None if item.product is None else asdict(item.product),
        "image_z": item.image_z,
        "surfaces": surfaces,
        "agreement": None if found is None else asdict(found),
    }


def _show(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key} {_show(inner)}" for key, inner in value.items())
    return f"{value:.6g}" if isinstance(value, float) else str(value)
