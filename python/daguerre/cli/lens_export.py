"""``daguerre lens NAME --export FILE``: the lens as polynomials, in another program's language."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.errors import UsageError

from .quantities import sensor_mm

if TYPE_CHECKING:
    from daguerre.lenses import Lens

DEFAULT_DEGREE = 7


def check_export(path: Path | None, degree: int | None, sensor: str | None) -> None:
    """Says what is wrong before anything is computed."""
    if path is None:
        for flag, given in (("--degree", degree), ("--sensor", sensor)):
            if given is not None:
                raise UsageError(f"{flag}: wanted with --export FILE")
        return
    from daguerre.export import check_suffix
    from daguerre.io.atomic import check_writable

    check_suffix(path, "--export")
    check_writable(path)


def write_export(
    item: Lens, path: Path, degree: int | None, sensor: str | None, setting: dict[str, Any]
) -> None:
    """Fits the lens and writes the file; one line to stderr says how good the fit is."""
    from daguerre.polynomial import fit

    fitted = fit(
        item,
        DEFAULT_DEGREE if degree is None else degree,
        film=None if sensor is None else sensor_mm("--sensor", sensor),
        f_stop=setting.get("f_stop"),
        focus=setting.get("focus_m", math.inf),
        focus_by=setting["by"],
        zoom=setting.get("zoom_mm"),
    )
    fitted.save(path)
    error = fitted.error
    print(
        f"{path}: degree {fitted.degree}, direction {error.direction_rad[0]:.2g} rad RMS, "
        f"{error.direction_rad[1]:.2g} at most; {error.film_um[0]:.2g} um RMS on the film",
        file=sys.stderr,
    )
