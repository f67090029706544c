"""Glass: the section of the lens with the light of one point of the picture, and its spread."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre import lenses
from daguerre.analysis import pencil, point_spread, set_up
from daguerre.analysis.bench import Bench
from daguerre.analysis.pencils import Pencil
from daguerre.errors import UsageError
from daguerre.plots.lens_section import draw, section, to_svg
from daguerre.rendering.session import Session

from .lens_list import about
from .sight import depth_m

#: Width of the spread's picture, px.
PIXELS = 48


def drawing_of(name: str) -> dict[str, Any]:
    """Drawing and facts of a lens of the library."""
    lens = lenses.load(name)
    order = lens.first_order()
    return {
        "name": name,
        "svg": draw(lens),
        "focal_length_mm": order.efl,
        "f_stop": order.f_number,
        "about": about(name),
    }


def glass_at(session: Session, x: float, y: float) -> dict[str, Any]:
    """Section with the rays of a pixel's point, and the spread of its light.

    Args:
        session: Session with a camera that sees the point.
        x: Pixel of the whole picture, from the left.
        y: Pixel of the whole picture, from the top.

    Returns:
        ``svg``: The section. ``spread``: 48 x 48 values of 0 to 255, as in the picture.
        ``width_um``: Width of the spread on the film. ``pixel_um``: Pixel pitch. ``distance_m``:
        Distance of the point; None: infinity.

    Raises:
        UsageError: The lens has no surfaces, or none of the point's light arrives.
    """
    setup = session.prepared.setup
    lens, glass = setup.lens, setup.lens.glass
    if glass is None or lens.focus_distance_m is None:
        raise UsageError(f"section: wanted a lens with surfaces and an iris, got {lens.name}")
    bench = set_up(glass.lens, f_stop=lens.f_stop, focus_m=lens.focus_distance_m)
    size, pixels = setup.frame_size_mm, setup.resolution
    right = (x / pixels[0] - 0.5) * size[0] + setup.shift_mm[0]
    up = (0.5 - y / pixels[1]) * size[1] + setup.shift_mm[1]
    film = (-right, -up)  # the image is upside down
    distance = 1e3 * depth_m(session, -_lit(bench, film, None).direction)  # the camera's axes
    light = _lit(bench, film, distance)
    drawn = [pencil(bench, -math.hypot(*film), distance_mm=distance)]
    half = max(bench.field_mm, 0.5 * math.hypot(*size))
    spread = point_spread(light, pixels=PIXELS)
    return {
        "svg": to_svg(section(bench.lens, bench.film_z, half, [one for one in drawn if one])),
        "spread": _upright(spread.image, light),
        "width_um": 2e3 * spread.half_mm,
        "pixel_um": 1e3 * size[0] / pixels[0],
        "distance_m": distance / 1e3 if math.isfinite(distance) else None,
    }


def _lit(bench: Bench, film: tuple[float, float], distance_mm: float | None) -> Pencil:
    found = pencil(bench, film, distance_mm=distance_mm)
    if found is None:
        raise UsageError("section: no light from this point reaches the film; choose another point")
    return found


def _upright(image: NDArray[np.float64], light: Pencil) -> list[int]:
    """Turns a spread from its sagittal and tangential axes to the picture's axes."""
    n = len(image)
    # A row of the picture runs right, a column down; on the film both are turned over.
    middle = (n - 1) / 2
    rows, columns = np.mgrid[:n, :n] - middle
    x, y = -columns, rows
    r = light.radial
    across = x * r[1] - y * r[0]
    along = x * r[0] + y * r[1]
    at = np.rint(np.stack([along, across]) + middle).astype(int)
    inside = ((at >= 0) & (at < n)).all(axis=0)
    turned = np.where(inside, image[tuple(np.clip(at, 0, n - 1))], 0.0)
    shown = np.sqrt(turned / max(float(turned.max()), 1e-30))  # as bright as the eye sees it
    return [int(v) for v in np.rint(255 * shown).ravel()]
