"""Made-up lens flare from the highlights of a picture, for pictures without a scene.

After King 2000 (2D lens flare) and Chapman 2013 (Pseudo lens flare): each highlight makes spots on
the line through the middle of the picture, with the shape of the iris, and a ring around itself.
Positions, sizes and tints of the spots are made up. Their brightness is not: it follows from two
reflections at surfaces of the given reflectance. Light from outside the frame makes no flare.
``daguerre render --flare`` traces the ghosts of a real lens from all of the scene's light.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre._core import IrisShape, defocus, rounded_blur
from daguerre.argument_checks import guarded
from daguerre.convolution.rows import Rows
from daguerre.post.array import on_array
from daguerre.post.by_four_channels import by_four_channels
from daguerre.post.effect import Effect, Step, Values
from daguerre.post.iris import BLADES, iris_shape, outline
from daguerre.post.parameter import Parameter
from daguerre.post.picture import Band, Canvas, Image, RowSource, bands

SCAN = 256  # rows
LARGEST = 512  # px, size of the reduced picture in which flare is drawn


@dataclass(frozen=True)
class Ghost:
    """A ghost: one spot for each highlight.

    Attributes:
        place: Position relative to the middle of the picture, as a multiple of the highlight's.
        radius: Radius, in half diagonals of the picture.
        tint: Factors on R, G, B; their mean is 1.
    """

    place: float
    radius: float
    tint: NDArray[np.float32]


def ghosts(count: int, seed: int) -> list[Ghost]:
    """Makes up ghosts on both sides of the middle, small and large, with pale coating tints."""
    rng = np.random.default_rng(seed)
    found = []
    for k in range(count):
        tint = rng.uniform(0.4, 1.0, 3)
        side = -1 if k % 3 else 1
        found.append(
            Ghost(
                side * rng.uniform(0.15, 1.4),
                float(np.exp(rng.uniform(math.log(0.015), math.log(0.16)))),
                np.asarray(tint / tint.mean(), np.float32),
            )
        )
    return found


class _FakeFlare(Step):
    def __init__(self, canvas: Canvas, values: Values) -> None:
        self._canvas = canvas
        self._colors = len(canvas.colors) - canvas.alpha
        self._values = values
        self._iris = iris_shape(values)
        self._block = math.ceil(max(canvas.width, canvas.height) / LARGEST)
        self._flare: Image = np.zeros((1, 1, self._colors), np.float32)

    def prepare(self, source: RowSource) -> None:
        """Collects highlights in a small picture, and draws their flare there."""
        canvas, block = self._canvas, self._block
        height, width = (math.ceil(n / block) for n in (canvas.height, canvas.width))
        small = np.zeros((height, width, self._colors), np.float32)
        for band in bands(source, SCAN * block):
            light = np.nan_to_num(band.image[:, :, : self._colors], posinf=0, neginf=0)
            light = light * (light.max(axis=2, keepdims=True) > self._values["threshold"])
            y = np.arange(band.rows.begin, band.rows.end) // block
            columns = np.add.reduceat(light, np.arange(0, canvas.width, block), axis=1)
            np.add.at(small, y, columns)
        self._flare = self._drawn(small / np.float32(block**2))

    def _drawn(self, light: Image) -> Image:
        values = self._values
        height, width, _ = light.shape
        half = 0.5 * math.hypot(height, width)
        out = np.zeros_like(light)
        bounced = values["reflectance"] ** 2
        for ghost in ghosts(values["ghosts"], values["seed"]):
            spot = _spread(light, ghost.place, half * ghost.radius, self._iris)
            tint = ghost.tint if self._colors == 3 else np.ones(1, np.float32)
            out += bounced * tint * spot
        if values["halo"] > 0:
            ring = half * values["halo_radius"]
            disc = IrisShape.outline(outline(0, 0, 0))  # dust and scratches scatter to all sides
            outer, inner = (rounded_blur(scale * ring) for scale in (1.05, 0.95))
            whole, hole = (r * r * _spread(light, 1, r, disc) for r in (outer, inner))
            out += values["halo"] * (whole - hole) / (outer**2 - inner**2)
        return np.maximum(out, 0)  # rounding errors where the discs of the ring cancel

    def apply(self, band: Band, rows: Rows) -> Band:
        image = band.image.copy()
        y = (np.arange(rows.begin, rows.end) + 0.5) / self._block - 0.5
        x = (np.arange(image.shape[1]) + 0.5) / self._block - 0.5
        image[:, :, : self._colors] += _between(_between(self._flare, y, 0), x, 1)
        return band.with_image(image)


def _spread(light: Image, place: float, radius: float, iris: IrisShape) -> Image:
    """Light moved to a multiple of its position and spread to spots of a radius in px; same sum."""
    height, width, count = light.shape
    rim = math.ceil(radius * iris.outer_radius) + 2  # spots outside reach into the frame
    y, x = np.nonzero(light.max(axis=2) > 0)
    to_y = (y + 0.5 - 0.5 * height) * place + 0.5 * height - 0.5 + rim
    to_x = (x + 0.5 - 0.5 * width) * place + 0.5 * width - 0.5 + rim
    canvas = np.zeros((height + 2 * rim, width + 2 * rim, count), np.float32)
    left, top = np.floor(to_x).astype(int), np.floor(to_y).astype(int)
    for down in (0, 1):
        for right in (0, 1):
            share = np.abs(1 - down - (to_y - top)) * np.abs(1 - right - (to_x - left))
            row, column = top + down, left + right
            inside = (row >= 0) & (row < canvas.shape[0]) & (column >= 0)
            inside &= column < canvas.shape[1]
            amount = light[y[inside], x[inside]] * share[inside, None]
            np.add.at(canvas, (row[inside], column[inside]), amount.astype(np.float32))
    blur = np.full(canvas.shape[:2], -radius, np.float32)
    spread = by_four_channels(
        canvas, lambda four: np.asarray(defocus(four, blur, iris, (rim, rim + height)))
    )
    return spread[:, rim : rim + width]


def _between(small: Image, at: NDArray[Any], axis: int) -> Image:
    """Interpolates a picture linearly along one axis; edge values continue."""
    last = small.shape[axis] - 1
    at = np.clip(at, 0, last)
    low = np.minimum(np.floor(at).astype(int), max(last - 1, 0))
    part = (at - low).astype(np.float32)
    part = part[:, None, None] if axis == 0 else part[:, None]
    before, after = (np.take(small, np.minimum(low + k, last), axis=axis) for k in (0, 1))
    return np.asarray(before + part * (after - before), np.float32)


FAKE_FLARE = Effect(
    "fake-flare",
    "made-up lens flare (ghosts and a ring) from a picture's highlights",
    (
        Parameter("threshold", "value above which a pixel is a highlight", "", 4.0, low=0),
        Parameter(
            "reflectance", "reflectance of each of a ghost's two surfaces", "", 0.01, low=0, high=1
        ),
        Parameter("ghosts", "number of ghosts", "", 8, "whole", low=0, high=200),
        Parameter("halo", "share of a highlight's light in the ring", "", 0.0, low=0, high=1),
        Parameter(
            "halo_radius",
            "radius of the ring, in half diagonals",
            "",
            0.4,
            low=0.01,
            high=2,
        ),
        *BLADES,
        Parameter("seed", "random seed of the ghosts", "", 0, "whole", low=0, high=2**53),
    ),
    _FakeFlare,
)


@guarded(arrays=False)
def fake_flare(image: Image, **parameters: object) -> Image:
    """Adds made-up lens flare to a scene-linear picture, from its highlights.

    Args:
        image: Picture, shape (H, W, C): 1 or 3 colours; alpha, if present, is not changed.
        **parameters: Parameters of the effect ``fake-flare``: ``threshold``, ``reflectance``,
            ``ghosts``, ``halo``, ``halo_radius``, ``blades``, ``blade_rotation`` (deg),
            ``blade_curvature``, ``aperture_image``, ``seed``.

    Raises:
        UsageError: A parameter is wrong.
    """
    return on_array(FAKE_FLARE, image, parameters)
