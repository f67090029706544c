"""Finds the sun of an environment: one small source with a large share of the light."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color.spectra import luminance_of_rgb

from .latlong import FloatArray, centres, luminance, place, solid_angles

#: Angular diameter of the sun, degrees; 0.524 to 0.542 over the year.
DIAMETER_DEG = 0.533
#: Share of all light, integrated over the sphere, from which on a source counts.
LEAST_SHARE = 0.05
#: Largest diameter of a sun, unclipped and clipped; larger sources are windows or lamps.
MOST_DEG, MOST_CLIPPED_DEG = 10.0, 40.0
#: Edge of the sun, as a share of the highest luminance above the surroundings.
_EDGE = 0.02


@dataclass(frozen=True)
class Sun:
    """The sun, a small source of an environment.

    Attributes:
        direction: Unit vector toward the sun.
        illuminance: Illuminance of a surface that faces the sun, RGB, lux if the map is in cd/m2.
        diameter_deg: Angular diameter, degrees.
        share: Share of the light of all directions.
        clipped: Whether the sun is clipped in all photographs.
        solved: Source of restored light, ``illuminance`` or ``grey``; empty: not restored.
    """

    direction: tuple[float, float, float]
    illuminance: tuple[float, float, float]
    diameter_deg: float
    share: float = 0.0
    clipped: bool = False
    solved: str = ""

    @property
    def lux(self) -> float:
        """Illuminance of a surface that faces the sun, lux if the map is in cd/m2."""
        return float(luminance_of_rgb() @ self.illuminance)

    @property
    def elevation_deg(self) -> float:
        """Angle above the horizon, degrees."""
        return math.degrees(math.asin(self.direction[1]))

    @property
    def azimuth_deg(self) -> float:
        """Angle from -z toward +x, degrees."""
        return math.degrees(math.atan2(self.direction[0], -self.direction[2]))

    def facts(self) -> dict[str, Any]:
        """Returns the values for JSON."""
        return {
            "direction": [round(v, 6) for v in self.direction],
            "azimuth_deg": round(self.azimuth_deg, 4),
            "elevation_deg": round(self.elevation_deg, 4),
            "illuminance": self.lux,
            "illuminance_rgb": list(self.illuminance),
            "diameter_deg": round(self.diameter_deg, 4),
            "share": self.share,
            "clipped": self.clipped,
            "solved": self.solved,
        }


@dataclass(frozen=True)
class Taken:
    """The sun, and the environment without it, float32, shape (H, W, 3)."""

    sun: Sun
    rest: NDArray[np.float32]


def take_out(
    light: NDArray[np.float32], clipped: NDArray[np.bool_], seek_clipped: bool = False
) -> Taken | None:
    """Finds the sun and fills its area with the light around it; None: no sun.

    The sun's light and the rest add up to the original light.

    Args:
        light: Environment, shape (H, W, 3).
        clipped: Mask of clipped pixels, shape (H, W).
        seek_clipped: Whether the brightest clipped area is a sun, even with little light left.
    """
    height, width = light.shape[:2]
    found, toward = luminance(light), centres(width, height)
    angles = np.broadcast_to(solid_angles(width, height)[:, None], found.shape)
    total = float((found * angles).sum())
    if not total > 0:
        return None
    peak = np.unravel_index(_brightest(found, angles, clipped), found.shape)
    is_clipped = bool(clipped[peak])
    core = _connected(clipped, peak) if is_clipped else _half(found, peak)
    diameter = _diameter(float(angles[core].sum()))
    if diameter > (MOST_CLIPPED_DEG if is_clipped and seek_clipped else MOST_DEG):
        return None
    middle = _mean_direction(toward, angles * core)
    around = _ring(toward @ middle, diameter) & ~clipped
    if not around.any():
        return None
    fill = np.median(light[around], axis=0)
    place_ = _place(found, core, peak, float(luminance_of_rgb() @ fill), toward @ middle, diameter)
    rest = light.copy()
    rest[place_] = np.minimum(light[place_], fill)
    removed = (light.astype(np.float64) - rest) * angles[..., None]
    energy = removed.sum(axis=(0, 1))
    lux = float(luminance_of_rgb() @ energy)
    if lux < LEAST_SHARE * total and not (seek_clipped and is_clipped):
        return None
    direction = _mean_direction(toward, removed @ luminance_of_rgb())
    return Taken(_sun(direction, energy, diameter, lux / total, is_clipped), rest)


def _sun(
    direction: FloatArray, energy: FloatArray, diameter: float, share: float, clipped: bool
) -> Sun:
    x, y, z = (float(v) for v in direction)
    red, green, blue = (float(v) for v in energy)
    return Sun((x, y, z), (red, green, blue), diameter, share, clipped)


def _brightest(found: FloatArray, angles: FloatArray, clipped: NDArray[np.bool_]) -> int:
    """Index of the brightest pixel, within the clipped area with the most light, if any."""
    left, best, index = clipped.copy(), 0.0, int(found.argmax())
    for _ in range(64):
        if not left.any():
            break
        start = int(np.where(left, found, -1).argmax())
        part = _connected(left, np.unravel_index(start, left.shape))
        light = float((found * angles)[part].sum())
        if light > best:
            best, index = light, start
        left &= ~part
    return index


def _connected(mask: NDArray[np.bool_], start: Any) -> NDArray[np.bool_]:
    """Pixels of a mask connected with a start pixel; left and right edges are neighbours."""
    part = np.zeros_like(mask)
    part[start] = mask[start]
    count = 0
    while (now := int(part.sum())) != count:
        count = now
        for _ in range(8):
            grown = part | np.roll(part, 1, axis=1) | np.roll(part, -1, axis=1)
            grown[1:] |= part[:-1]
            grown[:-1] |= part[1:]
            part = grown & mask
    return part


def _half(found: FloatArray, peak: Any) -> NDArray[np.bool_]:
    """Pixels connected with the peak and at least half as bright."""
    return _connected(found >= 0.5 * found[peak], peak)


def _diameter(solid_angle: float) -> float:
    """Angular diameter of a cap with this solid angle, degrees."""
    return math.degrees(2 * math.acos(max(1 - solid_angle / math.tau, -1)))


def _mean_direction(toward: FloatArray, weights: FloatArray) -> FloatArray:
    total = np.einsum("hw,hwc->c", weights, toward)
    return np.asarray(total / max(float(np.linalg.norm(total)), 1e-30))


def _ring(cosine: FloatArray, diameter: float) -> NDArray[np.bool_]:
    """Mask of a source's surroundings, 3 to 7 degrees beyond its edge."""
    inner, outer = (math.cos(math.radians(diameter / 2 + beside)) for beside in (3.0, 7.0))
    return np.asarray((cosine < inner) & (cosine > outer))


def _place(
    found: FloatArray,
    core: NDArray[np.bool_],
    peak: Any,
    around: float,
    cosine: FloatArray,
    diameter: float,
) -> NDArray[np.bool_]:
    """Pixels of the source: its core, and its glow up to 3 degrees beyond its edge."""
    least = max(2 * around, around + _EDGE * (float(found[peak]) - around))
    near = cosine > math.cos(math.radians(diameter / 2 + 3.0))
    return _connected((found > least) & near | core, peak)


def with_disc(rest: NDArray[np.float32], sun: Sun) -> NDArray[np.float32]:
    """Returns the environment with the sun as a uniform disc of the sun's illuminance.

    A disc smaller than one and a half pixels gets that size.
    """
    height, width = rest.shape[:2]
    pixel = math.pi / height
    radius = max(math.radians(sun.diameter_deg) / 2, 0.75 * pixel)
    share = _coverage(np.array(sun.direction), width, height, radius)
    energy = float((share * solid_angles(width, height)[:, None]).sum())
    disc = share[..., None] * (np.array(sun.illuminance) / energy)
    return np.asarray(rest + disc, np.float32)


def _coverage(direction: FloatArray, width: int, height: int, radius: float) -> FloatArray:
    """Share of each pixel that lies within an angle (rad) of a direction, by 8 x 8 samples."""
    from .latlong import directions

    fine = 8
    share = np.zeros((height, width))
    middle = int(place(direction, width, height)[1])
    reach = math.ceil(radius / math.pi * height) + 1
    for row in range(max(middle - reach, 0), min(middle + reach + 1, height)):
        x = (np.arange(width * fine) + 0.5) / fine
        y = row + (np.arange(fine) + 0.5) / fine
        within = directions(width, height, *np.meshgrid(x, y)) @ direction > math.cos(radius)
        share[row] = within.reshape(fine, width, fine).mean(axis=(0, 2))
    return share
