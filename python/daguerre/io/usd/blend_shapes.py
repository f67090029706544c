"""Reads blend shapes: weighted offsets of points, with shapes in between.

Source: OpenUSD, UsdSkel, "Blend Shapes": between the weights of two shapes in between, offsets are
interpolated; beyond the outermost ones they are extrapolated.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import UsdSkel

from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.files.value import Value
from daguerre.motion.values import at as value_at
from daguerre.motion.values import is_dynamic

from .primvars import Array, as_rows
from .values import Clock


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

    weights: Any
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


def read_blend_shapes(
    query: Any, animation: Any, count: int, clock: Clock, notes: Notes
) -> BlendShapes | None:
    """Reads the blend shapes of a mesh with ``count`` points; None if nothing animates them.

    Raises:
        InputError: A shape does not fit the mesh.
    """
    channels = [str(name) for name in animation.GetBlendShapeOrder()]
    source = UsdSkel.Animation(animation.GetPrim())
    weights = clock.value(source.GetBlendShapeWeightsAttr(), lambda v: np.asarray(v, np.float64))
    stated = weights.values[0] if is_dynamic(weights) else weights
    if weights is None or len(stated) != len(channels):
        notes.add("weights of blend shapes that differ in number from their names are left out")
        return None
    if not np.isfinite(stated).all():
        raise InputError(
            f"{clock.file}: {source.GetPath()}.blendShapeWeights: numbers must be finite"
        )
    stage = animation.GetPrim().GetStage()
    names = [str(name) for name in query.GetBlendShapeOrder()]
    shapes = []
    for name, path in zip(names, query.GetBlendShapeTargetsRel().GetTargets(), strict=False):
        prim = stage.GetPrimAtPath(path)
        if not prim or not prim.IsA(UsdSkel.BlendShape):
            notes.add("a blend shape is missing")
        elif name in channels:
            shapes.append(_read(UsdSkel.BlendShape(prim), channels.index(name), count, clock))
    return BlendShapes(weights, tuple(shapes)) if shapes else None


def _read(shape: UsdSkel.BlendShape, channel: int, count: int, clock: Clock) -> BlendShape:
    where = f"{clock.file}: {shape.GetPath()}"
    indices = shape.GetPointIndicesAttr().Get()
    points = None if indices is None or not len(indices) else np.asarray(indices, np.int64)
    if points is not None and not 0 <= points.min() <= points.max() < count:
        raise InputError(
            f"{where}.pointIndices: wanted 0 .. {count - 1}, got {points.min()} .. {points.max()}"
        )
    wanted = count if points is None else len(points)
    steps = {0.0: np.zeros((wanted, 3), np.float32)}
    steps[1.0] = _offsets(shape.GetOffsetsAttr().Get(), wanted, f"{where}.offsets")
    for between in shape.GetInbetweens():
        weight = float(between.GetWeight() or 0.0)
        if weight not in steps and np.isfinite(weight):
            steps[weight] = _offsets(
                between.GetOffsets(), wanted, f"{where}.{between.GetAttr().GetName()}"
            )
    order = sorted(steps)
    offsets = np.stack([steps[weight] for weight in order])
    return BlendShape(channel, points, np.array(order), offsets)


def _offsets(value: Any, count: int, where: str) -> Array:
    rows = None if value is None else as_rows(value, 3)
    if rows is None or len(rows) != count:
        got = "others" if rows is None else str(len(rows))
        raise InputError(f"{where}: wanted {count} finite offsets, got {got}")
    return rows
