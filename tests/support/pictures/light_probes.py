"""Photographs of balls and panoramas whose light is known, by formulas of their own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
from numpy.typing import NDArray

Array = NDArray[np.float64]
Light = Callable[[Array], Array]


def world(d: Array) -> Array:
    """Light of a smooth world without symmetries, RGB of directions (..., 3)."""
    x, y, z = np.moveaxis(d, -1, 0)
    red = 2 + x + 0.6 * y * z + 0.3 * np.sin(5 * x + 2 * y)
    green = 2 + 0.9 * y - 0.5 * x * z + 0.3 * np.cos(4 * z - 3 * x)
    blue = 2 - z + 0.4 * x * y + 0.3 * np.sin(6 * y + z)
    return np.stack([red, green, blue], axis=-1)


def grid(width: int, height: int) -> Array:
    """Directions of an environment's pixels: written out, not asked of the package."""
    azimuth = ((np.arange(width) + 0.5) / width * 2 - 1) * np.pi
    polar = (np.arange(height) + 0.5) / height * np.pi
    a, p = np.meshgrid(azimuth, polar)
    return np.stack([np.sin(p) * np.sin(a), np.cos(p), -np.sin(p) * np.cos(a)], axis=-1)


def rays(width: int, height: int, focal: float, fine: int) -> Array:
    """Unit rays of a pinhole along -z through fine x fine places of each pixel."""
    x = (np.arange(width * fine) + 0.5) / fine - width / 2
    y = height / 2 - (np.arange(height * fine) + 0.5) / fine
    px, py = np.meshgrid(x, y)
    d = np.stack([px, py, np.full_like(px, -focal)], axis=-1)
    return d / np.linalg.norm(d, axis=-1, keepdims=True)


def ball_picture(
    surface: Callable[[Array, Array], Array],
    size: tuple[int, int] = (480, 360),
    focal: float = 600.0,
    middle: tuple[float, float, float] = (0.15, -0.1, -5.0),
    radius: float = 1.0,
    background: float = 0.02,
) -> NDArray[np.float32]:
    """A ball before a dark wall: ``surface`` gives light by normal and by ray."""
    width, height = size
    d = rays(width, height, focal, 3)
    c = np.array(middle)
    along = d @ c
    under = along**2 - c @ c + radius**2
    hit = under > 0
    at = d * (along - np.sqrt(np.maximum(under, 0)))[..., None]
    normal = (at - c) / radius
    picture = np.full(d.shape, background)
    picture[hit] = surface(normal[hit], d[hit])
    return picture.reshape(height, 3, width, 3, 3).mean(axis=(1, 3)).astype(np.float32)


def mirror(light: Light) -> Callable[[Array, Array], Array]:
    """A perfect mirror in a world."""
    return lambda n, d: light(d - 2 * (n * d).sum(axis=-1, keepdims=True) * n)


def save(
    path: Path, numbers: NDArray[Any], exif: Mapping[str, Any] | None = None, orientation: int = 1
) -> Path:
    """A photograph as a camera writes it; float arrays are linear light."""
    kinds = {"uint8": oiio.UINT8, "uint16": oiio.UINT16, "float32": oiio.FLOAT}
    height, width = numbers.shape[:2]
    spec = oiio.ImageSpec(width, height, 3, kinds[str(numbers.dtype)])
    for name, value in (exif or {}).items():
        spec.attribute(name, value)
    spec.attribute("Orientation", orientation)
    if path.suffix == ".jpg":
        spec.attribute("Compression", "jpeg:98")
        spec.attribute("jpeg:subsampling", "4:4:4")
    out = oiio.ImageOutput.create(str(path))
    assert out.open(str(path), spec)
    assert out.write_image(np.ascontiguousarray(numbers))
    assert out.close()
    return path


def exposure(seconds: float, f_stop: float = 8.0, iso: int = 100) -> dict[str, Any]:
    """EXIF of an exposure."""
    return {"ExposureTime": seconds, "FNumber": f_stop, "Exif:PhotographicSensitivity": iso}
