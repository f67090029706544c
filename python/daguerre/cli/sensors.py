"""``daguerre sensors``: the library."""

from __future__ import annotations

from typing import Annotated

from . import console
from .flags.groups import option


def sensors(json: Annotated[bool, option("--json", help="Print a JSON list.")] = False) -> int:
    """Lists the sensors of the library.

    Columns: name, size, resolution, pixel pitch, pattern, base ISO, bits, camera.
    """
    from json import dumps

    from daguerre.sensors import load, names

    library = [load(name) for name in names()]
    if json:
        from daguerre.sensors.facts import facts

        console.show(dumps([facts(sensor) for sensor in library], indent=2))
        return 0
    rows = [
        (
            sensor.name,
            f"{sensor.size[0]:.3g} x {sensor.size[1]:.3g} mm",
            f"{sensor.resolution[0]} x {sensor.resolution[1]}",
            f"{sensor.pixel_pitch:g} um",
            sensor.pattern.name,
            f"ISO {sensor.base_iso:g}",
            f"{sensor.bit_depth} bits",
            f"{sensor.make} {sensor.model}",
        )
        for sensor in library
    ]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        console.show(
            "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        )
    return 0
