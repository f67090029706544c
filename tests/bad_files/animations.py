"""Animations."""

from __future__ import annotations

from typing import Any

import numpy as np

from tests.support.formats.make_gltf import Builder

from .bases import full
from .case import Case, Change, drawn, floats, put, scenes

BAD: dict[str, tuple[Change, str]] = {
    "target node": (put("animations.0.channels.0.target.node", 50), r"target\.node: index out of"),
    "channel sampler": (put("animations.0.channels.0.sampler", 1), r"sampler: index out of range"),
    "interpolation": (put("animations.0.samplers.0.interpolation", "SINE"), r"interpolation: unkn"),
    "keys": (
        lambda b: floats(b.json["animations"][0]["samplers"][0]["input"], 1, -1.0)(b),
        r"samplers\[0\]\.input: key time 1: times must increase, got 0 then -1",
    ),
    "key NaN": (
        lambda b: floats(b.json["animations"][0]["samplers"][0]["input"], 0, float("nan"))(b),
        r"samplers\[0\]\.input: key time 0: wanted finite",
    ),
    "key values": (
        lambda b: b.json["animations"][0]["samplers"][0].update(interpolation="CUBICSPLINE"),
        r"output: wrong number of key values: wanted 6 \(CUBICSPLINE\), got 2",
    ),
    "key value of length 0": (
        lambda b: floats(b.json["animations"][0]["samplers"][0]["output"], 3, 0.0)(b),
        r"samplers\[0\]\.output: key value 0: wanted a quaternion of length 1",
    ),
    "key value type": (
        put("animations.0.channels.0.target.path", "scale"),
        r"output: wrong accessor type: wanted VEC3, got VEC4",
    ),
    "animations is an object": (put("animations", {}), r"animations: wrong type"),
    "channels missing": (put("animations.0.channels", ...), r"animations\[0\]\.channels: missing"),
    "samplers missing": (put("animations.0.samplers", ...), r"animations\[0\]\.samplers: missing"),
    "target missing": (put("animations.0.channels.0.target", ...), r"target: missing"),
    "target is null": (put("animations.0.channels.0.target", None), r"target: wrong type"),
    "path is a number": (put("animations.0.channels.0.target.path", 3), r"path: "),
    "path missing": (put("animations.0.channels.0.target.path", ...), r"path: missing"),
    "sampler is text": (put("animations.0.channels.0.sampler", "0"), r"sampler: wrong type"),
    "input out of range": (put("animations.0.samplers.0.input", 99), r"input: index out of range"),
    "input missing": (put("animations.0.samplers.0.input", ...), r"input: missing"),
    "output is null": (put("animations.0.samplers.0.output", None), r"output: wrong type"),
    "interpolation is 1": (put("animations.0.samplers.0.interpolation", 1), r"interpolation: "),
    "target is the camera": (put("animations.0.channels.0.target.node", -1), r"node: index out of"),
}


def film(pointer: str, keys: Any, values: Any, mode: str = "LINEAR") -> Change:
    """Animates what a pointer leads to; the shutter is open from -1/96 to 1/96 s."""

    def change(b: Builder) -> None:
        times, output = b.accessor(keys), b.accessor(values)
        sampler = {"input": times, "output": output, "interpolation": mode}
        extension = {"KHR_animation_pointer": {"pointer": pointer}}
        target = {"path": "pointer", "extensions": extension}
        channel = {"sampler": 0, "target": target}
        b.add("animations", {"samplers": [sampler], "channels": [channel]})

    return change


def _spline(w: float) -> list[list[float]]:
    """A key of a turn, without tangents."""
    return [[0, 0, 0, 0], [0, 0, 0, w], [0, 0, 0, 0]]


_MANY = np.arange(1_000_000)
#: Wrong at another moment than that of the scene, while the shutter is open.
LATER: dict[str, tuple[Change, str]] = {
    "a spline through no rotation": (
        film("/nodes/0/rotation", [-1, 1], [*_spline(1), *_spline(-1)], "CUBICSPLINE"),
        r"samplers\[0\]\.output: the rotation at .* has length 0",
    ),
    "a field of view too wide": (
        film("/cameras/0/perspective/yfov", [0, 1e-3], [1, 4]),
        r"cameras\[0\]\.perspective\.yfov: out of range: wanted less than pi",
    ),
    "a factor out of range": (
        film("/materials/0/alphaCutoff", [0, 1e-3], [0, -1]),
        r"materials\[0\]\.alphaCutoff: out of range: wanted at least 0, got -",
    ),
    "a light below nothing": (
        film("/extensions/KHR_lights_punctual/lights/0/intensity", [0, 1e-3], [0, -1]),
        r"lights\[0\]\.intensity: out of range: wanted at least 0, got -",
    ),
    "a camera without direction": (
        film("/nodes/2/scale", [0, 1e-3, 1], [[1, 1, 1], [0, 0, 0], [0, 0, 0]]),
        r"nodes\[2\]: the node scales its camera by 0 at",
    ),
    "a place beyond all bounds": (
        film("/nodes/0/translation", [0, 1e-3], [[0, 0, 0], [1e30, 0, 0]]),
        r"nodes\[0\]: world transform: wanted numbers below 1e\+18",
    ),
    "spline values that overflow": (
        film("/nodes/0/translation", [-1, 1], [[3e38, 0, 0]] * 6, "CUBICSPLINE"),
        r"nodes\[0\]: world transform: wanted numbers below 1e\+18",
    ),
}
#: Repaired, with a warning that counts.
REPAIRED: dict[str, tuple[Change, str]] = {
    "a million keys": (
        film("/nodes/0/translation", _MANY * 2.0**-26, _MANY.repeat(3).reshape(-1, 3) % 50),
        "instance 'tri' has .* keys while the shutter is open; at most 1024 are used",
    ),
    "quaternions of another length": (
        film("/nodes/0/rotation", [0, 1], [[0, 0, 0, 3], [0, 0, 1, 1]]),
        r"a key quaternion whose length is not 1 is normalized \(2 uses\)",
    ),
    "a scale through nothing": (
        film("/nodes/0/scale", [-1, 1], [[1, 1, 1], [-1, -1, -1]]),
        "",
    ),
    "a scale that jumps to nothing": (
        film("/nodes/0/scale", [0, 1e-3], [[1, 1, 1], [0, 0, 0]], "STEP"),
        "",
    ),
    "keys before the file begins and a jump": (
        film("/nodes/0/translation", [-9, 0], [[0, 0, 0], [9, 0, 0]], "STEP"),
        "",
    ),
}
CASES: list[Case] = [
    *scenes("animation", BAD, full),
    *scenes("animation-later", LATER, full),
    *drawn("animation", REPAIRED, full),
]
