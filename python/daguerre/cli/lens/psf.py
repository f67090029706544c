"""``daguerre lens --psf``: the point spread function in figures and pictures."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.cli import console
from daguerre.cli.drawings import write_drawing
from daguerre.cli.flags.from_table import TableFlags, made_of
from daguerre.cli.flags.setting import BENCH
from daguerre.errors import InputError, UsageError
from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table
from daguerre.units import angle_deg, distance_m, length_mm

if TYPE_CHECKING:
    from daguerre.analysis import Bench, Pencil

STEPS = 9  # film positions of a series through focus


def _point(flag: str, text: str) -> tuple[float, bool, float]:
    """Parses field, whether it is an angle (deg), and distance (m)."""
    field, comma, distance = text.partition(",")
    if not comma:
        raise UsageError(f"{flag}: wanted FIELD,DISTANCE such as 10mm,inf or 15deg,3, got {text!r}")
    is_angle = field.strip().lower().endswith(("deg", "rad"))
    value = angle_deg(flag, field) if is_angle else length_mm(flag, field)
    metres = distance_m(flag, distance)
    if not metres > 0 or not math.isfinite(value):
        raise UsageError(f"{flag}: wanted a field and a distance above 0, got {text!r}")
    return value, is_angle, metres


# fmt: off
_PSF = Table(
    Parameter(
        "psf", "Point spread function at this image height (mm) or angle (deg) and distance (m, or "
        "inf)",
        flags=("--psf",), metavar="FIELD,DISTANCE", parse=_point,
    ),
    Parameter(
        "through_focus", "Show the PSF at nine film positions around the focus", kind="flag",
        flags=("--through-focus",),
    ),
)
# fmt: on


@made_of(_PSF, panel=BENCH)
class PsfFlags(TableFlags):
    """Flags of ``--psf``."""

    psf: str | None

    def check(self) -> None:
        """Checks the values, and that ``--through-focus`` is not given alone.

        Raises:
            UsageError: The message names the flag.
        """
        given = self.given()
        if given.get("through_focus") and "psf" not in given:
            raise UsageError("--through-focus needs --psf FIELD,DISTANCE")

    @property
    def wanted(self) -> bool:
        """Whether ``--psf`` is given."""
        return self.psf is not None

    def show(self, bench: Bench, *, plot: Path | None, json: bool) -> int:
        """Prints figures of the PSF, and writes its pictures."""
        from daguerre.analysis.through_focus import series

        given = self.given()
        field, is_angle, distance_m = given["psf"]
        light = _light(bench, field, is_angle, distance_m)
        made = series(light, STEPS if given.get("through_focus") else 1)
        if plot is not None:
            from daguerre.plots.through_focus import pictures

            write_drawing(plot, pictures(light, made, plot.suffix.lower()[1:]))
        rows = [step.facts for step in made]
        where = {
            "name": bench.lens.name,
            "f_stop": bench.f_stop,
            "film_z": bench.film_z,
            "focus_m": None if math.isinf(bench.focus_mm) else bench.focus_mm / 1e3,
            "height_mm": float(light.film[1]),
            "angle_deg": math.degrees(light.angle),
            "distance_m": None if math.isinf(distance_m) else distance_m,
        }
        if json:
            from json import dumps

            console.show(dumps({**where, "films": rows}, indent=2))
        else:
            _print(where, rows)
        return 0


def _light(bench: Bench, field: float, is_angle: bool, distance_m: float) -> Pencil:
    from daguerre.analysis import film_heights, pencil

    height = float(film_heights(bench, [field])[0]) if is_angle else field
    light = None
    if math.isfinite(height):
        light = pencil(bench, height, distance_mm=1e3 * distance_m)
    if light is None:
        unit = "degrees off the axis" if is_angle else "mm of image height"
        raise InputError(
            f"{bench.lens.name}: --psf: wanted a field from which light reaches the film, "
            f"got {field:g} {unit}"
        )
    return light


def _print(where: dict[str, Any], rows: list[dict[str, Any]]) -> None:
    distance, focus = where["distance_m"], where["focus_m"]
    console.show(
        f"{where['name']}, f/{where['f_stop']:.3g}, focused at "
        f"{'infinity' if focus is None else f'{focus:g} m'}: a point "
        f"{'infinitely far' if distance is None else f'at {distance:g} m'}, "
        f"{where['angle_deg']:.2f} deg off the axis, {where['height_mm']:.3f} mm on the film"
    )
    head = ("film mm", "RMS um", "50 % um", "80 % um", "width um", "MTF 20/mm S", "T", "by")
    console.show("  ".join(f"{name:>8}" for name in head))
    for row in rows:
        sagittal, tangential = row["mtf_20_per_mm"]
        cells = (
            f"{row['film_mm']:+.4f}",
            f"{1e3 * row['rms_mm']:.2f}",
            f"{1e3 * row['radius_50_mm']:.2f}",
            f"{1e3 * row['radius_80_mm']:.2f}",
            f"{1e3 * max(row['width_mm']):.2f}",
            f"{sagittal:.3f}",
            f"{tangential:.3f}",
            "waves" if row["diffraction"] else "rays",
        )
        console.show(
            "  ".join(f"{cell:>{max(8, len(h))}}" for cell, h in zip(cells, head, strict=True))
        )
