"""Where a lens stands before the arcade, and what film lies behind it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from daguerre.lenses import Lens
from daguerre.lenses.errors import LensError
from daguerre.lenses.library import Entry

#: Height of the plane of focus that is to fill the picture, m; see scenes/lens_scenes/arcade.py.
SUBJECT = 0.5
#: Nearest distance from the entrance pupil, m, and in focal lengths: large films keep away.
NEAREST, NEAREST_IN_FOCAL_LENGTHS = 0.3, 10.0
#: The picture fits into this, px.
WIDEST, HIGHEST = 300, 200
#: Nothing of the library's long ago has a film in its source: a plate of this half angle, degrees.
HALF_FIELD_DEG = 22.0


@dataclass(frozen=True)
class Place:
    """One lens before the scene.

    Attributes:
        lens: At the zoom that is shown, wide open.
        f_stop: Wide open.
        film_mm: Width and height.
        distance_m: From the entrance pupil to the plane of focus.
        resolution: px.
        size: px of what is shown: an anamorphic picture is stretched back.
    """

    lens: Lens
    f_stop: float
    film_mm: tuple[float, float]
    distance_m: float
    resolution: tuple[int, int]
    size: tuple[int, int]

    @property
    def focal_length_mm(self) -> float:
        """At which it stands, focused at infinity."""
        return abs(self.lens.first_order().efl)


def place(entry: Entry, lens: Lens) -> Place:
    """Distance that shows the subject large, but not nearer than the lens can focus."""
    if entry.efl_long_mm is not None:
        lens = lens.at_zoom(math.sqrt(entry.efl_mm * entry.efl_long_mm))
    order = lens.first_order()
    efl = abs(order.efl)
    film = film_of(entry, lens, efl)
    distance = 1e-3 * efl * (1 + 1e3 * SUBJECT / film[1])
    distance = max(distance, NEAREST, 1e-3 * NEAREST_IN_FOCAL_LENGTHS * efl)
    wide = film[0] * squeeze(lens) / film[1]
    height = min(HIGHEST, WIDEST / wide)
    size = round(wide * height), round(height)
    resolution = size[0], round(size[0] * film[1] / film[0])
    distance, near = _reachable(lens, distance)
    f_stop = 1.0005 * max(order.f_number, near.first_order().f_number)  # groups may narrow it
    return Place(lens, f_stop, film, distance, resolution, size)


def film_of(entry: Entry, lens: Lens, efl: float) -> tuple[float, float]:
    """The lens's own format; without one, 3:2 within the field that its source states."""
    if entry.format:
        width, height = (float(side) for side in entry.format.split("x"))
        return width, height
    half = math.radians((lens.nominal.full_field_deg or 2 * HALF_FIELD_DEG) / 2)
    fisheye = half > math.radians(75)
    circle = lens.nominal.image_circle_mm or 2 * efl * (half if fisheye else math.tan(half))
    return round(circle * 3 / math.sqrt(13), 1), round(circle * 2 / math.sqrt(13), 1)


def squeeze(lens: Lens) -> float:
    """How much wider the scene is than its image; 1: not anamorphic."""
    x = lens.nominal.efl_x_mm
    return abs(lens.first_order().efl) / x if x else 1.0


def _reachable(lens: Lens, distance: float) -> tuple[float, Lens]:
    """That distance, or by steps the first one beyond it, and the lens focused there."""
    for _ in range(40):
        try:
            return distance, lens.focused(distance).lens
        except LensError as error:
            if error.code != "lens-focus-near":
                raise
            distance *= 1.1
    raise SystemExit(f"{lens.name}: cannot focus at {distance:.1f} m")
