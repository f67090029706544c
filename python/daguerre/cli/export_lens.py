"""``daguerre export-lens``: a lens as a profile for lensfun."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from daguerre.camera.parameters import CAMERA
from daguerre.errors import UsageError
from daguerre.parameters.table import Table
from daguerre.units import SENSORS, sensor_mm

from . import console
from .flags.from_table import TableFlags, made_of
from .flags.groups import option, with_flags

_FRAME = replace(
    CAMERA["sensor_size"],
    meaning="Size of the sensor that the profile is for, mm",
    kind="value",
    flags=("--sensor",),
    metavar="WxH|" + "|".join(SENSORS),
    panel=None,
    parse=sensor_mm,
    tells_default=False,
    default_words="the lens's format",
)


@made_of(Table(_FRAME))
class FrameFlags(TableFlags):
    """Parameters of ``export.lensfun_profile``."""


@with_flags(flags=FrameFlags)
def export_lens(
    name: Annotated[str, typer.Argument(metavar="LENS", help="Library name or lens file.")],
    *,
    flags: FrameFlags,
    output: Annotated[
        Path | None, option("-o", "--output", metavar="FILE.xml", help="Profile to write.")
    ] = None,
) -> int:
    """Writes a profile of a lens for lensfun, with which photo editors correct photographs.

    It has distortion and lateral colour by focal length, and vignetting by f-stop, focal length and
    distance. The residuals are printed and written into the file.
    """
    from daguerre.export.lensfun.fitting import SUFFIXES, lensfun_profile, save_lensfun
    from daguerre.export.lensfun.xml import remarks
    from daguerre.files.atomic import check_writable
    from daguerre.files.formats import check_written

    if output is None:
        raise UsageError("export-lens: wanted LENS -o FILE.xml, got no -o")
    check_written(output, SUFFIXES)
    check_writable(output)
    made = lensfun_profile(name, **flags.given())
    save_lensfun(made, output)
    for line in remarks(made):
        console.show(line)
    console.note(f"wrote {output}")
    return 0
