"""Reads blend shapes: weighted offsets of points, with shapes in between."""

from __future__ import annotations

import numpy as np
from pxr import UsdSkel

from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.motion.values import Keys
from daguerre.scene.over_time.shapes import BlendShape, BlendShapes
from daguerre.scene.over_time.surfaces import Array

from .primvars import as_rows
from .values import Clock


def read_blend_shapes(
    query: UsdSkel.SkinningQuery,
    animation: UsdSkel.AnimQuery,
    count: int,
    clock: Clock,
    notes: Notes,
) -> BlendShapes | None:
    """Reads the blend shapes of a mesh with ``count`` points; None if nothing animates them.

    Raises:
        InputError: A shape does not fit the mesh.
    """
    channels = [str(name) for name in animation.GetBlendShapeOrder()]
    source = UsdSkel.Animation(animation.GetPrim())
    weights = clock.value(
        source.GetBlendShapeWeightsAttr(), lambda v: np.asarray(v, np.float64), large=True
    )
    stated = weights.values[0] if isinstance(weights, Keys) else weights
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
    indices = clock.integers(shape.GetPointIndicesAttr())
    points = indices if len(indices) else None
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


def _offsets(value: object, count: int, where: str) -> Array:
    rows = None if value is None else as_rows(value, 3)
    if rows is None or len(rows) != count:
        got = "others" if rows is None else str(len(rows))
        raise InputError(f"{where}: wanted {count} finite offsets, got {got}")
    return rows
