"""``daguerre sensor``: one sensor in numbers and curves."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from . import console
from .drawings import check_drawing, write_drawing
from .flags.groups import option

if TYPE_CHECKING:
    from daguerre.sensors import Sensor


def sensor(
    name: Annotated[str, typer.Argument(metavar="SENSOR", help="Library name or sensor file.")],
    json: Annotated[bool, option("--json", help="Print all numbers as one JSON object.")] = False,
    plot: Annotated[
        Path | None,
        option(
            "--plot",
            "-o",
            metavar="FILE.svg|png|pdf",
            help="Write a one-page plot of quantum efficiency, dynamic range and signal to noise "
            "(needs extra `plot`).",
        ),
    ] = None,
) -> int:
    """Shows the data of a sensor.

    It prints size, quantum efficiency, full well, and figures at each ISO.
    """
    from daguerre.sensors import load
    from daguerre.sensors.facts import facts

    check_drawing("--plot", plot)
    item = load(name)
    if plot is not None:
        from daguerre.plots.sensor import page

        write_drawing(plot, page(item, plot.suffix.lower()[1:]))
    if json:
        from json import dumps

        from .lens.command import _finite

        console.show(dumps(_finite(facts(item)), indent=2))
    elif plot is None:
        _print(item, facts(item))
    return 0


def _print(item: Sensor, numbers: dict[str, Any]) -> None:
    columns, rows = item.resolution
    console.show(f"{item.name}: {item.make} {item.model}, {item.pattern.name}, {columns} x {rows}")
    console.show(f"source: {item.source}")
    if item.note:
        console.show(f"note: {item.note}")
    if numbers["basis"]:
        console.show(f"known: {numbers['basis']}")
    for kind in ("measured", "fitted", "assumed"):
        for text in numbers[kind]:
            if ":" in text:  # the others are named in the line above
                console.show(f"{kind}: {text}")
    peaks = ", ".join(f"{k} {v:.3g}" for k, v in numbers["peak_quantum_efficiency"].items())
    made = ", ".join(f"{k} {v:.0f}" for k, v in numbers["electrons_per_lux_s"].items())
    dark = item.dark_current
    lines = {
        "size": f"{item.size[0]:.4g} x {item.size[1]:.4g} mm, pitch {item.pixel_pitch:g} um",
        "peak efficiency": peaks,
        "D65, e- per lux s": made,
        "full well": f"{item.full_well:g} e-",
        "speed by saturation": f"ISO {item.saturation_iso:.3g} (ISO 12232: 78 / H)",
        "range": f"ISO {item.iso_range[0]:g} .. {item.iso_range[1]:g}, base {item.base_iso:g}",
        "digital": f"{item.bit_depth} bits, black {item.black_level} DN",
        "dark current": f"{dark.rate:g} e-/s at {dark.temperature:g} C, x2 in {dark.doubling:g} K",
        "PRNU, DSNU": f"{item.prnu:.2%}, {item.dsnu:g} e-",
        "hot pixels": f"{item.hot_pixels.share:.2g} of all, {item.hot_pixels.rate:g} e-/s",
    }
    for key, value in lines.items():
        console.show(f"  {key:20} {value}")
    console.show("      ISO    DN/e-  read e-   most e-  range EV  SNR 18 %, dB")
    for row in numbers["by_iso"]:
        _print_iso(row)


def _print_iso(row: dict[str, float]) -> None:
    console.show(
        f"  {row['iso']:7.0f} {row['gain_dn_per_e']:8.3g} {row['read_noise_e']:8.2f} "
        f"{row['saturation_e']:9.0f} {row['dynamic_range_stops']:9.1f} {row['grey_snr_db']:13.1f}"
    )
