"""Rigid animation of glTF: translation, rotation and scale of nodes at one moment.

Source: glTF 2.0 specification, chapter 3.11 and appendix C.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .gltf_accessors import Accessors
from .json_item import Item
from .notes import Notes

FloatArray = NDArray[np.float64]
_WIDTH = {"translation": 3, "rotation": 4, "scale": 3}
_MODES = ("LINEAR", "STEP", "CUBICSPLINE")


def poses_at(
    root: Item, accessors: Accessors, node_count: int, time: float, notes: Notes
) -> dict[tuple[int, str], FloatArray]:
    """What the animations of a file say at one time; all of them play, held at their ends.

    Args:
        root: The JSON object of the file.
        accessors: Its accessors.
        node_count: Number of nodes, for the check of targets.
        time: s.
        notes: What was not understood.

    Returns:
        (node, path) -> value, path being translation (3,), rotation (4,; x y z w) or scale (3,).
    """
    poses: dict[tuple[int, str], FloatArray] = {}
    for animation in root.list_of("animations"):
        samplers = list(animation.need("samplers"))
        for channel in animation.need("channels"):
            target = channel.need("target")
            sampler = samplers[channel.need("sampler").index(len(samplers), "samplers")]
            node, path = target.get("node"), target.need("path").text()
            if path == "weights":
                notes.add("an animation of morph targets is left out")
            elif path not in _WIDTH:
                notes.add("an animation of something other than a node's place is left out")
            elif node is not None:
                key = (node.index(node_count, "nodes"), path)
                if key in poses:
                    notes.add(f"a second animation of the same {path} replaces the first")
                poses[key] = _sample(sampler, accessors, path, time)
    return poses


def _sample(sampler: Item, accessors: Accessors, path: str, time: float) -> FloatArray:
    value: FloatArray
    mode_item = sampler.get("interpolation")
    mode = "LINEAR" if mode_item is None else mode_item.choice(_MODES)
    keys = _keys(sampler.need("input"), accessors)
    values = _values(sampler.need("output"), accessors, path, len(keys), mode)
    # Index of the key at or before `time`; the ends are held.
    i = int(np.clip(np.searchsorted(keys, time, side="right") - 1, 0, len(keys) - 1))
    last = i == len(keys) - 1 or time <= keys[0]
    if last or mode == "STEP":
        value = values[i, 1]
    else:
        span = keys[i + 1] - keys[i]
        s = (time - keys[i]) / span
        if mode == "CUBICSPLINE":
            value = _hermite(values[i], values[i + 1], s, span)
        elif path == "rotation":
            value = slerp(values[i, 1], values[i + 1, 1], s)
        else:
            value = (1 - s) * values[i, 1] + s * values[i + 1, 1]
    if path != "rotation":
        return value
    length = float(np.linalg.norm(value))
    if length < 1e-9:
        sampler.need("output").fail(f"the rotation at {time:g} s has length 0")
    return value / length


def _keys(use: Item, accessors: Accessors) -> FloatArray:
    if accessors.kind(use)[1] != 5126:
        use.fail("wrong accessor type: wanted key times of component type 5126 (float)")
    keys = accessors.floats(use, ("SCALAR",), "key time")[:, 0].astype(np.float64)
    falls = np.flatnonzero(np.diff(keys) <= 0)
    if falls.size:
        i = int(falls[0])
        use.fail(
            f"key time {i + 1}: wanted times that rise strictly, got {keys[i]:g} then "
            f"{keys[i + 1]:g}"
        )
    return keys


def _values(use: Item, accessors: Accessors, path: str, count: int, mode: str) -> FloatArray:
    """Shape (keys, 3, width): in-tangent, value, out-tangent; tangents are 0 without a spline."""
    width = _WIDTH[path]
    raw: NDArray[Any] = accessors.floats(use, (f"VEC{width}",), "key value")
    wanted = count * (3 if mode == "CUBICSPLINE" else 1)
    if len(raw) != wanted:
        use.fail(f"wrong number of key values: wanted {wanted} ({mode}), got {len(raw)}")
    values = np.zeros((count, 3, width))
    if mode == "CUBICSPLINE":
        values[:] = raw.reshape(count, 3, width)
    else:
        values[:, 1] = raw
    if path == "rotation":
        lengths = np.linalg.norm(values[:, 1], axis=1)
        bad = np.flatnonzero(lengths < 1e-9)
        if bad.size:
            use.fail(f"key value {bad[0]}: wanted a quaternion of length 1, got length 0")
        # A spline is defined on the values as they stand; the result is made a unit.
        if mode != "CUBICSPLINE":
            values[:, 1] /= lengths[:, None]
    return values


def slerp(a: FloatArray, b: FloatArray, s: float) -> FloatArray:
    """Spherical interpolation of unit quaternions the shorter way round (appendix C.4)."""
    cosine = float(a @ b)
    if cosine < 0:
        b, cosine = -b, -cosine
    angle = float(np.arccos(min(cosine, 1.0)))
    if angle < 1e-6:
        return (1 - s) * a + s * b
    return np.asarray((np.sin((1 - s) * angle) * a + np.sin(s * angle) * b) / np.sin(angle))


def _hermite(left: FloatArray, right: FloatArray, s: float, span: float) -> FloatArray:
    """Cubic spline between two keys (appendix C.5); tangents are per second."""
    s2, s3 = s * s, s * s * s
    return np.asarray(
        (2 * s3 - 3 * s2 + 1) * left[1]
        + span * (s3 - 2 * s2 + s) * left[2]
        + (3 * s2 - 2 * s3) * right[1]
        + span * (s3 - s2) * right[0]
    )
