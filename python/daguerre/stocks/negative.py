"""Exposed and developed film: densities, and printing or scanning them to a picture."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre._core import grain_pattern
from daguerre.argument_checks import guarded
from daguerre.checks import plain_light, whole
from daguerre.color.spectra import rgb_from_xyz
from daguerre.errors import InputError
from daguerre.exposure.expose import chosen_ev
from daguerre.exposure.lux_seconds import exposure_of_one
from daguerre.files.array_value import ArrayValue
from daguerre.frame.seen_by import seen_of
from daguerre.post.effects.grain import sharpness
from daguerre.sensors.fit import channels_from_xyz
from daguerre.sensors.iso_speed import white_lx_s

from .curve import GREY
from .spread import kernels
from .stock import Stock

if TYPE_CHECKING:
    from daguerre.development import Picture
    from daguerre.frame.frame import Frame

#: Density of middle grey on paper or in a slide, above white: -log10(0.18).
GREY_DENSITY = 0.745
_DARKEST = 1e-12  # smallest exposure, so that its logarithm is finite
_STRIPE = 128  # rows


@guarded
@dataclass(eq=False)
class Negative(ArrayValue, array="density"):
    """Developed film: a negative, or a slide from reversal stock.

    NumPy takes it for its ``density``.

    Attributes:
        density: Density of each layer, shape (H, W, C).
        stock: Film stock.
        metadata: Metadata of the frame.
    """

    density: NDArray[np.float32]
    stock: Stock
    metadata: dict[str, Any] = field(default_factory=dict)

    def __repr__(self) -> str:
        height, width = self.density.shape[:2]
        return f"<Negative {width}x{height}, {self.stock.name}>"

    def positive(self) -> NDArray[np.float32]:
        """Returns the print or slide in linear Rec.709, white 1, middle grey 0.18: (H, W, 3).

        The printer lights balance a print: middle grey in the light of the stock's balance becomes
        neutral.
        """
        out = np.empty((*self.density.shape[:2], 3), np.float32)
        matrix = _rgb_from_layers(self.stock)
        for row in range(0, len(out), _STRIPE):
            rows = slice(row, row + _STRIPE)
            out[rows] = self._light(self.density[rows]) @ matrix.T
        return out

    def _light(self, density: NDArray[np.float32]) -> NDArray[np.float64]:
        paper, light = self.stock.paper, np.empty(density.shape)
        for k, layer in enumerate(self.stock.layers):
            if self.stock.kind == "reversal" or paper is None:
                light[..., k] = 10 ** (layer.curve.least - density[..., k])
                continue
            grey = paper.exposure(paper.least + GREY_DENSITY)
            x = grey + layer.curve.density(GREY) - density[..., k]
            light[..., k] = 10 ** (paper.least - paper.density(x))
        return light

    def scan(self) -> Frame:
        """Returns a scene-linear frame of the light that made the densities, for any look.

        The curve is inverted, so light on the toe or shoulder is recovered with more noise. Grain
        stays.
        """
        from daguerre.frame.frame import Frame

        stock = self.stock
        unit = exposure_of_one(self.metadata, stock.iso) * stock.iso
        seen = np.empty(self.density.shape)
        for k, layer in enumerate(stock.layers):
            seen[..., k] = 10 ** layer.curve.exposure(self.density[..., k]) / unit
        rgb = (seen @ _rgb_from_layers(stock).T).astype(np.float32)
        return Frame(rgb=rgb, metadata={**self.metadata, "exposure_compensation": None})

    def develop(self, **look: object) -> Picture:
        """Develops the print or slide for a display; see ``daguerre.development.develop``."""
        from daguerre.development import develop

        return develop(self.shown(), **dict[str, Any](look))

    def shown(self) -> Frame:
        """Returns the print or slide as a frame, lit so that its white develops to white."""
        from daguerre.frame.frame import Frame

        facts = {**self.metadata, "luminance_exposure": white_lx_s(self.stock.iso)}
        facts["white_balance"] = facts["exposure_compensation"] = None
        return Frame(rgb=self.positive(), metadata=facts)


def exposed(stock: Stock, frame: Frame, ev: float | None, seed: int) -> Negative:
    """Exposes a stock; see ``Stock.expose``."""
    seed = whole(seed, "stock: seed", 0, 2**53)
    ev = chosen_ev(frame, ev)
    facts = {**frame.metadata, "isoSpeed": stock.iso, "stock": stock.name}
    facts["exposure_compensation"] = ev or None
    unit = exposure_of_one(frame.metadata, stock.iso) * 2.0**ev * stock.iso
    pitch = _pitch_um(frame)
    seen = layers_of(stock, frame)
    plain_light(seen, "frame")
    light = _spread(seen, kernels(stock, pitch))
    light *= np.float32(unit)
    np.log10(np.maximum(light, _DARKEST), out=light)
    for k, layer in enumerate(stock.layers):
        for row in range(0, len(light), _STRIPE):
            rows = slice(row, row + _STRIPE)
            light[rows, :, k] = layer.curve.density(light[rows, :, k])
    if stock.granularity > 0:
        _add_grain(light, stock, pitch, seed)
    return Negative(light, stock, facts)


def layers_of(stock: Stock, frame: Frame) -> NDArray[np.float32]:
    """Light on each layer, shape (H, W, C), at least 0; white in the stock's balance is 1.

    Uses the best data of the frame: this stock's channels, else bands, else XYZ by a fitted matrix.
    """
    seen = seen_of(frame, stock)
    matrix = (seen.channels / stock.white()[:, None]).astype(np.float32)
    with np.errstate(invalid="ignore"):  # NaN in the light is an error later
        return np.asarray(np.maximum(seen.planes @ matrix.T, np.float32(0)), np.float32)


def _spread(light: NDArray[np.float32], kernel: NDArray[np.float32] | None) -> NDArray[np.float32]:
    """Convolves light with the film's kernels, as if the light continued beyond the frame."""
    if kernel is None:
        return light
    from daguerre.convolution.convolve import convolve

    within = convolve(np.ones_like(light), kernel)
    out = convolve(light, kernel)
    out *= kernel.sum(axis=(0, 1), dtype=np.float64) / np.maximum(within, np.float32(1e-6))
    return np.maximum(out, 0)


def _rgb_from_layers(stock: Stock) -> NDArray[np.float64]:
    """Matrix from light on the layers to linear Rec.709, exact for white, shape (3, C)."""
    if len(stock.layers) == 1:
        return np.ones((3, 1))
    return np.asarray(rgb_from_xyz() @ np.linalg.inv(channels_from_xyz(stock)))


def _pitch_um(frame: Frame) -> float:
    pitch = frame.metadata.get("sensorPhotositePitch")
    if pitch is None:
        raise InputError("frame: sensorPhotositePitch (um) is missing from the metadata")
    return float(np.mean(pitch))


def _add_grain(density: NDArray[np.float32], stock: Stock, pitch: float, seed: int) -> None:
    """Adds grain noise: the variance of density is proportional to it (``Stock.grain_area``)."""
    height, width = density.shape[:2]
    area = stock.grain_area()
    radius = np.sqrt(area / np.pi) / pitch
    scale = np.log10(math.e) * area * sharpness(float(radius)) / pitch**2
    for k, layer in enumerate(stock.layers):
        for row in range(0, height, _STRIPE):
            rows = slice(row, min(row + _STRIPE, height))
            plane = density[rows, :, k]
            pattern = grain_pattern(0, row, width, len(plane), radius, seed, k)
            above = np.maximum(plane - layer.curve.least, 0)
            plane += np.sqrt(scale * above) * pattern
            np.maximum(plane, 0, out=plane)
