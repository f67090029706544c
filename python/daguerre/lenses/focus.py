"""Focuses a lens by moving the groups that its file gives, or else the whole lens."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from daguerre.argument_checks import guarded

from .configurations import Configuration
from .errors import LensError, reported
from .lens import DESIGN_WAVELENGTH_NM, Lens
from .setting import LensSetting
from .zoom import Position, Zoom, bracket, positions

#: Groups may move beyond infinity by this share of their travel, as in real lenses.
BEYOND = 0.2


@guarded
@dataclass(frozen=True)
class Focused:
    """A lens focused on a plane of the scene, and its film. Lengths in mm, z in the lens frame.

    Attributes:
        lens: Lens with the gaps of this focus.
        film_z_mm: Position of the film.
        efl_mm: Focal length at this focus; moving groups change it, and so the framing (breathing).
        entrance_pupil_z: Position of the centre of the entrance pupil.
    """

    lens: Lens
    film_z_mm: float
    efl_mm: float
    entrance_pupil_z: float


@dataclass(frozen=True)
class Path:
    """Gaps of a lens from focus at infinity (0) to the nearest position that is printed (1).

    Fitted positions continue beyond 1. If all positions are fitted, the last is at 1, and the film
    stays where the lens is sharp at infinity: no gap changes there.
    """

    lens: Lens  # at infinity
    changes: list[dict[int, float]]  # of gaps, mm, at equal steps of the way
    printed: int  # changes from 0 to 1
    fitted: bool  # whether no near position is printed

    @property
    def end(self) -> float:
        """Way to the nearest focus."""
        return (len(self.changes) - 1) / (self.printed - 1)

    @property
    def grid(self) -> list[float]:
        """Ways at which a search for the focus begins, first those beyond infinity."""
        way = [-BEYOND, -BEYOND / 8, *np.linspace(0, 1, 2 * self.printed + 3)]
        more = len(self.changes) - self.printed
        return [*way, *np.linspace(1, self.end, 2 * more + 3)[1:]] if more else way

    def at(self, way: float) -> Lens:
        """Lens at one position of this path, 0 to ``end``."""
        step = 1 / (self.printed - 1)
        k = min(max(int(way / step), 0), len(self.changes) - 2)
        share = way / step - k
        gaps = {}
        for i, first in self.changes[k].items():
            change = first + share * (self.changes[k + 1][i] - first)
            gap = (self.lens.surfaces[i].thickness or 0.0) + change
            gaps[i] = float(max(gap, 0.0) if i + 1 < len(self.lens.surfaces) else gap)
        return self.lens.with_gaps(gaps)

    def with_film(self, z: float) -> Path:
        """Returns this path with the film elsewhere."""
        gap = {len(self.lens.surfaces) - 1: z - self.lens.vertices[-1]}
        return replace(self, lens=self.lens.with_gaps(gap))


def focused(lens: Lens, setting: LensSetting) -> Focused:
    """Focuses a lens; see ``Lens.focused``."""
    if setting.zoom_mm is not None:
        lens = Zoom(lens).at(setting.zoom_mm)
    if not setting.focus_m > 0:
        raise LensError(
            f"{lens.source}: focus distance: wanted a positive number of metres, "
            f"got {setting.focus_m}",
            "lens-focus-near",
        )
    path = path_of(lens)
    # The f-stop is defined at infinity: the iris stays when moving groups change the focal length.
    narrowed = 1.0
    if setting.f_stop is not None and path is not None:
        narrowed = setting.f_stop / lens.first_order().f_number
    sharp = _sharp(setting, narrowed)
    with reported(lens.source):
        if path is None or (path.fitted and math.isinf(setting.focus_m)):
            return _done(lens, _whole(lens, setting))
        if path.fitted:
            path = path.with_film(_whole(lens, replace(setting, focus_m=math.inf)))
        moved = _solved(path, sharp, setting)
        return _done(moved, sharp(moved))


def closest_focus_m(lens: Lens, *, from_sensor: bool = False) -> float:
    """Closest distance in focus, m: the end of its groups' travel, or 1:1 if the whole lens moves.

    Args:
        lens: Lens at its zoom.
        from_sensor: Whether the distance begins at the sensor, not at the entrance pupil.
    """
    path = path_of(lens)
    if path is None:
        with reported(lens.source):
            return float(lens.prescription.closest_focus_m(from_sensor))
    return _nearest(path.at(path.end), from_sensor=from_sensor)


def path_of(lens: Lens) -> Path | None:
    """Path of the groups at the lens's zoom position; None: the whole lens moves.

    A file without a configuration at infinity gives no start of the path, so the whole lens moves.
    """
    found = positions(lens)
    if not found or all(c.at_infinity for c in lens.configurations):
        return None
    if lens.zoom_mm is None:
        low, high, share = found[0], found[0], 0.0
    else:
        low, high, share = bracket(lens, lens.zoom_mm)
    ways = [(p, near) for p in (low, high) if (near := _near(lens, p, found))]
    if not ways:
        return None
    known = [_waypoints(position, near) for position, near in ways]
    nearest = max((near for _, near in ways), key=len)
    printed = sum(not c.fitted for c in nearest)
    base = Zoom(lens).at(lens.zoom_mm) if lens.zoom_mm is not None else lens.with_gaps(low.gaps)
    first, last = known[0], known[-1]
    count = max(len(first), len(last))
    changes = []
    for way in np.linspace(0, 1, count):
        a, b = _along(first, way), _along(last, way)
        changes.append({i: (1 - share) * a[i] + share * b[i] for i in low.gaps})
    path = Path(base, changes, 1 + (printed or len(nearest)), not printed)
    return path if printed else path.with_film(image_z(base, -math.inf))


def _near(lens: Lens, position: Position, found: list[Position]) -> list[Configuration]:
    """Configurations for near objects that the file gives at this zoom, the nearest last."""
    near = [c for c in lens.configurations if not c.at_infinity]
    mine = [c for c in near if max(found, key=lambda p: c.like(p.configuration)) == position]
    return sorted(mine, key=lambda c: -c.distance_mm)


def _waypoints(position: Position, near: list[Configuration]) -> list[dict[int, float]]:
    """Changes of the gaps from infinity to the nearest focus."""
    zero = dict.fromkeys(position.gaps, 0.0)
    return [zero, *({i: c.gaps.get(i, g) - g for i, g in position.gaps.items()} for c in near)]


def _along(points: list[dict[int, float]], way: float) -> dict[int, float]:
    grid = np.linspace(0, 1, len(points))
    return {i: float(np.interp(way, grid, [p[i] for p in points])) for i in points[0]}


def image_z(lens: Lens, object_z: float) -> float:
    """Position of the paraxial image of an object plane, mm; infinite if not behind the lens.

    Newton's x x' = f f'. For an anamorphic lens, halfway between the images of its two sections.
    """
    orders = [lens.prescription.first_order(DESIGN_WAVELENGTH_NM)]
    if not lens.prescription.is_axially_symmetric:
        orders.append(lens.prescription.first_order(DESIGN_WAVELENGTH_NM, "x"))
    images = []
    for f in orders:
        focal2 = f.efl * (f.front_principal_z - f.front_focal_z)
        x = f.front_focal_z - object_z
        images.append(f.back_focal_z + focal2 / x if x > 0 else math.inf)
    return float(np.mean(images))


def _sharp(setting: LensSetting, narrowed: float) -> Callable[[Lens], float]:
    """Returns a function that gives the sharp film position, for a lens with its table's film.

    narrowed: Ratio of the f-stop to the f-stop of the open lens.
    """

    def film(lens: Lens) -> float:
        pupil = lens.first_order().entrance_pupil.z
        start = lens.image_z if setting.from_sensor else pupil
        object_z = start - 1e3 * setting.focus_m
        if setting.focus_by == "paraxial":
            return image_z(lens, object_z)
        stop = narrowed * lens.first_order().f_number
        best, _ = lens.prescription.best_focus(stop, (pupil - object_z) * 1e-3, False)
        return float(best)

    return film


def _whole(lens: Lens, setting: LensSetting) -> float:
    """Position of the film when the whole lens moves."""
    distance_m, from_sensor = setting.focus_m, setting.from_sensor
    film = float(lens.prescription.film_position(distance_m, from_sensor))
    if setting.focus_by == "best":
        stop = setting.f_stop or lens.first_order().f_number
        return float(lens.prescription.best_focus(stop, distance_m, from_sensor)[0])
    if lens.prescription.is_axially_symmetric:
        return film
    for _ in range(60):  # for far objects the film position matters little: this converges fast
        start = film if from_sensor else lens.first_order().entrance_pupil.z
        film, before = image_z(lens, start - 1e3 * distance_m), film
        if abs(film - before) < 1e-10:
            break
    return film


def _solved(path: Path, sharp: Callable[[Lens], float], setting: LensSetting) -> Lens:
    """Lens at the position of the path at which the image lies on the film."""

    def miss(way: float) -> float:
        lens = path.at(way)
        return sharp(lens) - lens.image_z

    grid = path.grid
    values = [miss(way) for way in grid]
    for k in (*range(2, len(grid) - 1), 1, 0):  # beyond infinity only if not before
        if values[k] == 0 or values[k] * values[k + 1] < 0:
            return path.at(_root(miss, grid[k], grid[k + 1], values[k], values[k + 1]))
    if values[-1] < 0:  # beyond infinity, as the file's own film is a little off: the film moves
        return path.at(0.0)
    nearest = _nearest(path.at(path.end), from_sensor=setting.from_sensor)
    raise LensError(
        f"{path.lens.source}: focus distance: wanted {nearest:.4g} m or more (the nearest "
        f"possible), got {setting.focus_m:.4g} m",
        "lens-focus-near",
    )


def _nearest(lens: Lens, *, from_sensor: bool) -> float:
    """Object distance with the paraxial image on the film, m."""
    order = lens.first_order()
    focal2 = order.efl * (order.front_principal_point - order.front_focal_point)
    object_z = order.front_focal_point - focal2 / (lens.image_z - order.back_focal_point)
    start = lens.image_z if from_sensor else order.entrance_pupil.z
    return (start - object_z) * 1e-3


def _root(function: Callable[[float], float], a: float, b: float, fa: float, fb: float) -> float:
    """A root between a and b, by the Illinois form of the rule of false position."""
    for _ in range(80):
        if fa == 0 or abs(b - a) < 1e-14:
            return a
        middle = (a * fb - b * fa) / (fb - fa) if math.isfinite(fa - fb) else (a + b) / 2
        value = function(middle)
        if abs(value) < 1e-10:
            return middle
        if value * fb < 0:
            a, fa = b, fb
        else:
            fa /= 2
        b, fb = middle, value
    return b


def _done(lens: Lens, film_z: float) -> Focused:
    order = lens.first_order()
    if not math.isfinite(film_z):
        raise LensError(
            f"{lens.source}: focus: the lens forms no image behind itself", "lens-focus-near"
        )
    return Focused(lens, film_z, order.efl, order.entrance_pupil.z)
