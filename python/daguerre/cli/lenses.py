"""``daguerre lenses`` and ``daguerre lens``: the library, and one lens on the bench."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from daguerre.errors import UsageError

from .flags import option

if TYPE_CHECKING:
    from daguerre.lenses import Lens

#: the wavelength of the helium d line, at which lenses are specified, nm
DESIGN_NM = 587.56


def lenses(json: Annotated[bool, option("--json", help="As a JSON list.")] = False) -> int:
    """Lists the lenses of the library: name, year, focal length, f-stop, format, source."""
    from dataclasses import asdict
    from json import dumps

    from daguerre.lenses.library import entries

    if json:
        print(dumps([{**asdict(e), "source": e.patent} for e in entries()], indent=2))
        return 0
    rows = [
        (e.name, f"{e.year or ''}", e.focal_length, f"f/{e.f_number:.3g}", e.format, e.patent)
        for e in entries()
    ]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        print(
            "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        )
    return 0


def lens(
    name: Annotated[str, typer.Argument(metavar="NAME|FILE", help="Of the library, or a file.")],
    json: Annotated[bool, option("--json", help="As one JSON object, lengths in mm.")] = False,
    plot: Annotated[
        Path | None,
        option(
            "--plot",
            metavar="FILE.svg|png|pdf",
            help="Drawing with rays; .png, .pdf: extra `plot`.",
        ),
    ] = None,
    wavelength: Annotated[
        float, option("--wavelength", metavar="NM", help="Wavelength, nm [587.56].")
    ] = DESIGN_NM,
) -> int:
    """Shows a lens: its table, first-order properties (mm), and a drawing on request."""
    from json import dumps

    from daguerre import lenses as library
    from daguerre.io.atomic import check_writable, write_bytes
    from daguerre.lenses.plot import FORMATS, check_available, picture

    if plot is not None:
        suffix = plot.suffix.lower()
        if suffix not in FORMATS:
            raise UsageError(
                f"--plot: wanted a name ending in {' or '.join(FORMATS)}, got {str(plot)!r}"
            )
        check_available(suffix)
        check_writable(plot)
    item = library.load(name)
    order = asdict(item.first_order(wavelength))
    if plot is not None:
        write_bytes(plot, picture(item, plot.suffix.lower()))
    if json:
        print(dumps(_facts(item, order), indent=2))
        return 0
    print(item)
    print(f"at {wavelength:g} nm, lengths in mm, z = 0 at the first vertex")
    for key, value in order.items():
        if key != "wavelength_nm":
            print(f"  {key.replace('_', ' '):22} {_show(value)}")
    return 0


def _facts(item: Lens, order: dict[str, Any]) -> dict[str, Any]:
    names = ("kind", "radius", "thickness", "semi_diameter", "glass", "stop", "derived")
    surfaces = [{name: getattr(s, name) for name in names} for s in item.surfaces]
    return {
        "name": item.name,
        "source": item.patent,
        "note": item.note,
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
