"""Blend shapes: weighted offsets of points, with shapes in between.

Source: OpenUSD, UsdSkel, "Blend Shapes": between the weights of two shapes in between, offsets are
interpolated; beyond the outermost ones they are extrapolated.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import Value
from daguerre.motion.values import at as value_at
from daguerre.motion.values import is_dynamic

if TYPE_CHECKING:
    from daguerre.motion.values import Dynamic


Array = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class BlendShape(Value):
    """Offsets of a shape.

    Attributes:
        channel: Its place in the weights of the animation.
        points: Points that it shifts, shape (K,); None: all.
        steps: Weights of its offsets, rising, with 0 and 1 among them.
        offsets: Offsets at these weights, shape (S, K, 3).
    """

    channel: int
    points: NDArray[np.int64] | None
    steps: NDArray[np.float64]
    offsets: NDArray[np.float32]

    def offset(self, weight: float) -> Array:
        """Offsets at a weight, shape (K, 3)."""
        last = len(self.steps) - 2
        i = int(np.clip(np.searchsorted(self.steps, weight, side="right") - 1, 0, last))
        low, high = self.steps[i : i + 2]
        share = np.float32((weight - low) / (high - low))
        mixed: Array = (1 - share) * self.offsets[i] + share * self.offsets[i + 1]
        return mixed


@dataclass(frozen=True, eq=False)
class BlendShapes(Value):
    """Blend shapes of a mesh.

    Attributes:
        weights: Weights of the animation's channels, shape (W,), constant or over time.
        shapes: The shapes.
    """

    weights: NDArray[np.floating] | Dynamic
    shapes: tuple[BlendShape, ...]

    def shifted(self, points: Array, time_s: float) -> Array:
        """Points with the offsets at a time, s."""
        weights = np.asarray(value_at(self.weights, time_s), np.float64)
        made = points.copy()
        for shape in self.shapes:
            weight = float(weights[shape.channel])
            if weight:
                chosen: Any = slice(None) if shape.points is None else shape.points
                np.add.at(made, chosen, shape.offset(weight))
        return made

    def at(self, time_s: float) -> Any:
        """Weights at a time, s."""
        return value_at(self.weights, time_s)

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times at which weights have keys, s."""
        if not is_dynamic(self.weights):
            return []
        return [float(t) for t in self.weights.breaks(begin, end)]
