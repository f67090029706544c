"""Restores light lost to clipping from a light meter or a matt ball."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from daguerre.color.spectra import luminance_of_rgb
from daguerre.errors import InputError

from .grey import Shading
from .latlong import FloatArray, centres, cosine_weights, luminance, solid_angles
from .sun import DIAMETER_DEG, Sun


def ground_illuminance(light: NDArray[np.float32]) -> float:
    """Illuminance of the ground under an environment, lux if that is in cd/m2."""
    height, width = light.shape[:2]
    return float(luminance(light).sum(axis=1) @ cosine_weights(width, height))


def by_illuminance(sun: Sun, rest: NDArray[np.float32], lux: float) -> Sun:
    """Solves for the sun, with the colour of D65, that gives the metered illuminance of the ground.

    Args:
        sun: Sun, for its direction.
        rest: Environment without the sun, cd/m2.
        lux: Metered illuminance of the open ground, lux.

    Raises:
        InputError: The sun is below the horizon, or the light without it exceeds the reading.
    """
    sky = ground_illuminance(rest)
    if sun.direction[1] < math.sin(math.radians(1)):
        raise InputError(
            f"--illuminance: wanted a sun at least 1 degree above the horizon, so that it lights "
            f"the ground, got {sun.elevation_deg:.1f} degrees; use --grey"
        )
    if not lux > sky:
        raise InputError(
            f"--illuminance: wanted more than the {sky:.4g} lux of the map without its sun, "
            f"got {lux:g} lux"
        )
    facing = (lux - sky) / sun.direction[1]
    return _solved(sun, np.full(3, facing), "illuminance")


def by_grey_ball(sun: Sun, rest: NDArray[np.float32], shading: Shading) -> Sun:
    """Solves for the sun that, with the rest of the environment, explains a matt ball; by channel.

    Reflectance and exposure of the ball need not be known: its irradiance is
    k (E_rest(n) + E_sun max(n . s, 0)), linear in k and k E_sun.

    Raises:
        InputError: The ball shows no sun in this direction.
    """
    direction = np.array(sun.direction)
    shadow = _irradiance(rest, shading.normals)
    facing = np.maximum(shading.normals @ direction, 0)
    found = np.zeros(3)
    for c in range(3):
        columns = np.stack([shadow[:, c], facing], axis=1)
        factor, amount = np.linalg.lstsq(columns, shading.irradiance[:, c], rcond=None)[0]
        if factor <= 0 or amount <= 0:
            raise InputError(
                "--grey: the ball is not brighter toward the sun of the map (azimuth "
                f"{sun.azimuth_deg:.0f}, elevation {sun.elevation_deg:.0f} degrees); check "
                "--grey-direction"
            )
        found[c] = amount / factor
    return _solved(sun, found, "grey")


def _solved(sun: Sun, illuminance: FloatArray, way: str) -> Sun:
    red, green, blue = (float(v) for v in illuminance)
    # A clipped sun looks larger than it is.
    diameter = DIAMETER_DEG if sun.clipped else sun.diameter_deg
    return replace(sun, illuminance=(red, green, blue), diameter_deg=diameter, solved=way)


def shared(sun: Sun, rest: NDArray[np.float32]) -> Sun:
    """Sets the sun's share of the light of all directions."""
    height, width = rest.shape[:2]
    others = float(luminance(rest).sum(axis=1) @ solid_angles(width, height))
    return replace(sun, share=sun.lux / (sun.lux + others))


def _irradiance(light: NDArray[np.float32], normals: FloatArray) -> FloatArray:
    """Irradiance by an environment of surfaces with normals (N, 3), shape (N, 3)."""
    from .panorama import resized

    small = resized(light, min(light.shape[1], 128), min(light.shape[0], 64))
    height, width = small.shape[:2]
    toward = centres(width, height).reshape(-1, 3)
    weighed = (small * solid_angles(width, height)[:, None, None]).reshape(-1, 3)
    return np.concatenate(
        [np.maximum(part @ toward.T, 0) @ weighed for part in np.array_split(normals, 16)]
    )


def clipped_facts(light: NDArray[np.float32], clipped: NDArray[np.bool_]) -> dict[str, float]:
    """Share of the sphere that is clipped, its position, and the lower limit of its light."""
    height, width = light.shape[:2]
    angles = solid_angles(width, height)[:, None] * clipped
    total = float((luminance(light) * solid_angles(width, height)[:, None]).sum())
    toward = np.einsum("hw,hwc->c", angles, centres(width, height))
    length = float(np.linalg.norm(toward))
    x, y, z = toward / max(length, 1e-30)
    energy = (light * angles[..., None]).sum(axis=(0, 1)) @ luminance_of_rgb()
    return {
        "share": float(angles.sum() / (4 * math.pi)),
        "azimuth_deg": math.degrees(math.atan2(x, -z)),
        "elevation_deg": math.degrees(math.asin(min(max(y, -1), 1))),
        "illuminance_at_least": float(energy),
        "light_share_at_least": float(energy) / max(total, 1e-30),
    }
