"""Whether two scenes show the same: of one file, one read at a time and the other moved there."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

import daguerre as dg


def differences(a: Any, b: Any, where: str, tolerance: float = 1e-6) -> list[str]:
    """Paths of what differs."""
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        size = max(1.0, float(np.abs(a).max(initial=0)))
        fits = a.shape == b.shape and np.allclose(a, b, rtol=0, atol=tolerance * size)
        return [] if fits else [where]
    if dataclasses.is_dataclass(a) and type(a) is type(b):
        names = [f.name for f in dataclasses.fields(a) if f.name != "motion"]
        return [d for n in names for d in differences(getattr(a, n), getattr(b, n), f"{where}.{n}")]
    if isinstance(a, list | tuple) and isinstance(b, list | tuple) and len(a) == len(b):
        return [
            d
            for i, (x, y) in enumerate(zip(a, b, strict=True))
            for d in differences(x, y, f"{where}[{i}]")
        ]
    if isinstance(a, dict) and isinstance(b, dict) and a.keys() == b.keys():
        return [d for k in a for d in differences(a[k], b[k], f"{where}.{k}")]
    if isinstance(a, float) and isinstance(b, float):
        return [] if a == b or abs(a - b) <= tolerance * max(1.0, abs(a)) else [where]
    return [] if a == b else [where]


def scene_differences(a: dg.Scene, b: dg.Scene) -> list[str]:
    """Differences of all lists."""
    parts = ("meshes", "materials", "instances", "lights", "cameras", "environment")
    more = ("node_positions", "nodes", "time", "duration")
    return [d for p in (*parts, *more) for d in differences(getattr(a, p), getattr(b, p), p)]
