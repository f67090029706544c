"""``daguerre lens --psf``: one point of light, its figures, its pictures."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.errors import InputError

if TYPE_CHECKING:
    from daguerre.analysis import Bench, Pencil

STEPS = 9  # films of a series through focus


def show_psf(
    bench: Bench,
    field: float,
    is_angle: bool,
    distance_m: float,
    *,
    plot: Path | None,
    json: bool,
    through_focus: bool,
) -> int:
    """Prints figures of the PSF, and writes its pictures.

    Args:
        bench: The lens.
        field: Image height, mm, or angle, degrees.
        is_angle: Which of them it is.
        distance_m: Distance of the point, m, or inf.
        plot: File of the pictures, or None.
        json: One JSON object rather than lines.
        through_focus: On a series of films.
    """
    from daguerre.analysis.through_focus import series

    light = _light(bench, field, is_angle, distance_m)
    made = series(light, STEPS if through_focus else 1)
    if plot is not None:
        from daguerre.files.atomic import write_bytes
        from daguerre.plots.through_focus import pictures

        write_bytes(plot, pictures(light, made, plot.suffix.lower()[1:]))
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

        print(dumps({**where, "films": rows}, indent=2))
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
        raise InputError(f"{bench.lens.name}: --psf: no light arrives from {field:g} {unit}")
    return light


def _print(where: dict[str, Any], rows: list[dict[str, Any]]) -> None:
    distance, focus = where["distance_m"], where["focus_m"]
    print(
        f"{where['name']}, f/{where['f_stop']:.3g}, focused at "
        f"{'infinity' if focus is None else f'{focus:g} m'}: a point "
        f"{'infinitely far' if distance is None else f'at {distance:g} m'}, "
        f"{where['angle_deg']:.2f} deg off the axis, {where['height_mm']:.3f} mm on the film"
    )
    head = ("film mm", "RMS um", "50 % um", "80 % um", "width um", "MTF 20/mm S", "T", "by")
    print("  ".join(f"{name:>8}" for name in head))
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
        print("  ".join(f"{cell:>{max(8, len(h))}}" for cell, h in zip(cells, head, strict=True)))
