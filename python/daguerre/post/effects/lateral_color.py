"""Lateral chromatic aberration: magnification differs by colour, so that edges get fringes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.cached import cached_property
from daguerre.distortion import Distortion, Radial
from daguerre.distortion.model import FloatArray
from daguerre.distortion.monotone import SAMPLES, Monotone
from daguerre.errors import UsageError
from daguerre.post.array import on_array
from daguerre.post.effect import Effect, Step, Values
from daguerre.post.optics import LENS, SENSOR, axis
from daguerre.post.parameter import Parameter
from daguerre.post.picture import Canvas, Image
from daguerre.post.warp import Warp
from daguerre.post.warp_step import FILTER, WarpStep, how

from .distortion import CHANNEL_NM, lens_models, point_map

MAX_RADIUS = 2.0  # half diagonals


@dataclass(frozen=True)
class Magnification(Radial):
    """Scales the radius by 1 + size + growth r^2; r is 1 in the corners."""

    size: float
    growth: float

    @cached_property
    def _rule(self) -> Monotone:
        return Monotone(
            lambda r: r * (1 + self.size + self.growth * r * r), np.linspace(0, MAX_RADIUS, SAMPLES)
        )

    def _bent(self, radius: FloatArray) -> FloatArray:
        return self._rule(radius)

    def _straight(self, radius: FloatArray) -> FloatArray:
        return self._rule.inverse(radius)


@dataclass(frozen=True)
class Between(Distortion):
    """Maps image points of a lens in one colour to its image points in another colour."""

    one: Distortion
    other: Distortion

    def _distorted(self, points: FloatArray) -> FloatArray:
        return self.other.distort(self.one.undistort(points))

    def _ideal(self, points: FloatArray) -> FloatArray:
        return self.one.distort(self.other.undistort(points))


def _make(canvas: Canvas, values: Values) -> Step:
    if len(canvas.colors) < 3:
        raise UsageError(f"{canvas.where}: lateral-colour: wanted R, G and B, got grey")
    half = 0.5 * math.hypot(*canvas.full_size)
    unit = half, half
    if values["model"] == "lens":
        models, unit = _of_lens(canvas, values)
    else:
        models = [
            Magnification(values[f"{color}"] / 100, values[f"{color}_corner"] / 100)
            for color in ("red", "blue")
        ]
    red, blue = (
        Warp.of(canvas, point_map(m, unit, axis(canvas, values), inverse=values["inverse"]))
        for m in models
    )
    same = Warp.of(canvas, lambda points: points)
    return WarpStep(canvas, [red, same, blue], forward=lambda points: points, **how(values))


def _of_lens(canvas: Canvas, values: Values) -> tuple[list[Distortion], tuple[float, float]]:
    """Models of red and blue relative to a lens's green, and their focal lengths, px."""
    (red, green, blue), focal_px = lens_models(canvas, values, CHANNEL_NM)
    return [Between(green, red), Between(green, blue)], focal_px


LATERAL_COLOR = Effect(
    "lateral-colour",
    "lateral chromatic aberration of red and blue against green, or its removal",
    (
        Parameter(
            "model", "source of the magnifications: numbers or a lens", kind="choice",
            default="numbers", choices=("numbers", "lens"),
        ),
        Parameter("red", "magnification of red over green", "%", 0.0, low=-50, high=50),
        Parameter("red_corner", "further magnification of red in the corners, as r^2", "%", 0.0,
                  low=-30, high=30),
        Parameter("blue", "magnification of blue over green", "%", 0.0, low=-50, high=50),
        Parameter("blue_corner", "further magnification of blue in the corners, as r^2", "%", 0.0,
                  low=-30, high=30),
        SENSOR,
        *LENS,
        *FILTER,
        Parameter("inverse", "remove the effect instead", kind="flag", default=False),
    ),
    _make,
)  # fmt: skip


@guarded(arrays=False)
def lateral_colour(image: Image, **parameters: object) -> Image:
    """Adds lateral chromatic aberration: red and blue are scaled relative to green.

    Args:
        image: Scene-linear picture, shape (H, W, 3), or (H, W, 4) with alpha, which is not changed.
        **parameters: Parameters of the effect ``lateral-colour``: ``red``, ``blue`` (percent larger
            than green), ``red_corner``, ``blue_corner`` (percent more in the corners, growing as
            r^2); or ``model="lens"`` with ``lens``, ``focus`` (m), ``zoom`` (mm), ``sensor``
            (mm, mm).
    """
    return on_array(LATERAL_COLOR, image, parameters)


@guarded(arrays=False)
def remove_lateral_colour(image: Image, **parameters: object) -> Image:
    """Removes the effect of :func:`lateral_colour` with the same parameters."""
    return on_array(LATERAL_COLOR, image, {**parameters, "inverse": True})
