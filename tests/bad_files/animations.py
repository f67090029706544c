"""Animations."""

from __future__ import annotations

from .bases import full
from .case import Case, Change, floats, put, scenes

BAD: dict[str, tuple[Change, str]] = {
    "target node": (put("animations.0.channels.0.target.node", 50), r"target\.node: index out of"),
    "channel sampler": (put("animations.0.channels.0.sampler", 1), r"sampler: index out of range"),
    "interpolation": (put("animations.0.samplers.0.interpolation", "SINE"), r"interpolation: unkn"),
    "keys": (
        lambda b: floats(b.json["animations"][0]["samplers"][0]["input"], 1, -1.0)(b),
        r"samplers\[0\]\.input: key time 1: wanted times that rise strictly, got 0 then -1",
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
CASES: list[Case] = scenes("animation", BAD, full)
