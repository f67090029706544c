"""Curves and colour ramps as tables, which Blender's own functions fill.

Between the rows values are linear, so that ramps and curves with straight pieces are exact.

Source: Blender Python API 5.0, ``bpy.types.CurveMapping`` and ``ColorRamp``.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import bpy


Table = tuple[float, ...]
_STEPS = 1025
#: Width of a jump between two rows.
_JUMP = 1e-6
#: Ends of curves; beyond 0 .. 1 they are straight.
_FAR = (-100.0, 100.0)


def table_of(node: bpy.types.Node) -> dict[str, Table]:
    """Rows ``.x``, and ``.r``, ``.g``, ``.b`` and ``.a`` of a node's ramp or curves, if it has."""
    if node.bl_idname == "ShaderNodeValToRGB":
        return _ramp(node.color_ramp)
    if node.bl_idname == "ShaderNodeRGBCurve":
        return _curves(node.mapping, [(3, 0), (3, 1), (3, 2)])
    if node.bl_idname == "ShaderNodeVectorCurve":
        return _curves(node.mapping, [(0,), (1,), (2,)])
    if node.bl_idname == "ShaderNodeFloatCurve":
        return _curves(node.mapping, [(0,)])
    return {}


def _ramp(ramp: bpy.types.ColorRamp) -> dict[str, Table]:
    stops = np.array([float(one.position) for one in ramp.elements])
    edges = np.concatenate([stops, stops - _JUMP, stops + _JUMP])
    rows = np.unique(np.clip(np.concatenate([np.linspace(0, 1, _STEPS), edges]), 0, 1))
    colors = np.array([tuple(ramp.evaluate(float(x))) for x in rows])
    return {".x": _table(rows), **{f".{c}": _table(colors[:, i]) for i, c in enumerate("rgba")}}


def _curves(mapping: bpy.types.CurveMapping, chains: list[tuple[int, ...]]) -> dict[str, Table]:
    """Tables of chains of curves: the values of the first pass through the second."""
    mapping.initialize()
    points = [float(p.location[0]) for curve in mapping.curves for p in curve.points]
    low, high = min(0.0, *points), max(1.0, *points)
    inner = np.concatenate([np.linspace(low, high, _STEPS), points])
    rows = np.unique(np.concatenate([inner, _FAR]))
    found = {".x": _table(rows)}
    for name, chain in zip("rgb", chains, strict=False):
        found[f".{name}"] = tuple(_chained(mapping, chain, float(x)) for x in rows)
    return found


def _chained(mapping: bpy.types.CurveMapping, chain: tuple[int, ...], x: float) -> float:
    for index in chain:
        x = float(mapping.evaluate(mapping.curves[index], x))
    return x


def _table(values: Iterable[float]) -> Table:
    return tuple(float(value) for value in values)
