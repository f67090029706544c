"""Wave, Gradient, Magic, Brick and Checker textures as nodes.

Source: Blender 5.0 Manual, "Texture Nodes".
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from daguerre.blender.patterns import simple
from daguerre.blender.patterns.fractals import Octaves
from daguerre.shading.channels import Value, broadcast
from daguerre.shading.evaluate import Arguments

from .outputs import Outputs
from .pattern_nodes import Pattern, averaged

#: Waves of one unit of coordinates.
_WAVES = 20 / (2 * np.pi)
#: Texels of a wave, of a cell with sharp edges, and of the width of mortar.
_SMOOTH, _SHARP, _MORTAR = 12.0, 32.0, 3.0
#: Most texels of a brick's unit.
_MOST = 256.0
_GREY = ("Color", "Fac")


def _grey(value: Value) -> Mapping[str, Value]:
    return {"Color": broadcast(value, 3), "Fac": value}


def wave(given: Arguments) -> Mapping[str, Value]:
    """Wave Texture."""
    pattern = Pattern(given)
    sockets, point = pattern.sockets, pattern.point()
    if point is None:
        return averaged(sockets, _GREY)
    pattern.measure(point, _SMOOTH * _WAVES)
    kind, detail = sockets.text("wave_type", "BANDS"), pattern.detail
    direction = sockets.text(f"{kind.lower()}_direction", "X")
    profile = sockets.text("wave_profile", "SIN")
    names = ("Phase Offset", "Distortion", "Detail Roughness", "Detail Scale")

    def apply(*values: Any) -> list[Any]:
        phase, distortion, roughness, scale = values[3:]
        octaves = Octaves(detail, roughness)
        how = simple.Wave(kind == "RINGS", direction, profile, phase, distortion, octaves, scale)
        return [simple.wave(list(values[:3]), how)]

    return _grey(pattern.computed(apply, 1, point, *(sockets.one(name) for name in names)))


def gradient(given: Arguments) -> Mapping[str, Value]:
    """Gradient Texture."""
    pattern = Pattern(given)
    point, kind = pattern.point(), pattern.sockets.text("gradient_type", "LINEAR")
    if point is None:
        return averaged(pattern.sockets, _GREY)
    pattern.measure(point, _SHARP)
    return _grey(pattern.computed(lambda *v: [simple.gradient(list(v), kind)], 1, point))


def magic(given: Arguments) -> Mapping[str, Value]:
    """Magic Texture; before Blender 5.2 the scale acts after coordinates are wrapped."""
    import bpy

    pattern, scaled = Pattern(given), bpy.app.version >= (5, 2)
    sockets, point = pattern.sockets, pattern.point(scaled=scaled)
    if point is None:
        return averaged(sockets, _GREY)
    scale: Value = (1.0,) if scaled else sockets.one("Scale")
    depth = int(sockets.setting("turbulence_depth", 2))
    pattern.measure(sockets.math.multiply(point, scale), 2 * _SMOOTH)

    def apply(*values: Any) -> list[Any]:
        return simple.magic(list(values[:3]), values[3], values[4], depth)

    color = pattern.computed(apply, 3, point, scale, sockets.one("Distortion"))
    mean = sockets.math.multiply(sockets.math.dot(color, (1.0, 1.0, 1.0)), (1 / 3,))
    return {"Color": color, "Fac": mean}


def brick(given: Arguments) -> Mapping[str, Value]:
    """Brick Texture."""
    pattern = Pattern(given)
    sockets, point = pattern.sockets, pattern.point()
    if point is None:
        return averaged(sockets, _GREY)
    mortar = max(sockets.number("Mortar Size"), 0.0)
    pattern.measure(point, min(max(_MORTAR / mortar if mortar else 0.0, _SHARP), _MOST))
    offset, squash = sockets.setting("offset", 0.5), sockets.setting("squash", 1.0)
    rows = int(sockets.setting("offset_frequency", 2)), int(sockets.setting("squash_frequency", 2))
    names = ("Mortar Size", "Mortar Smooth", "Bias", "Brick Width", "Row Height")

    def apply(*values: Any) -> list[Any]:
        size, smooth, bias, width, height = values[3:]
        wall = simple.Bricks(size, smooth, bias, width, height, offset, rows[0], squash, rows[1])
        return list(simple.bricks(list(values[:3]), wall))

    tint, share = pattern.computed(apply, 2, point, *(sockets.one(name) for name in names))
    math = sockets.math
    bricks = math.mix(sockets.value("Color1"), sockets.value("Color2"), (tint,))
    return Outputs(
        {
            "Color": lambda: math.mix(bricks, sockets.value("Mortar"), (share,)),
            "Fac": lambda: (share,),
        }
    )


def checker(given: Arguments) -> Mapping[str, Value]:
    """Checker Texture."""
    pattern = Pattern(given)
    sockets, point = pattern.sockets, pattern.point()
    colors = sockets.value("Color2"), sockets.value("Color1")
    if point is None:
        sockets.note("the pattern is replaced by its mean")
        return {"Color": sockets.math.mix(*colors, (0.5,)), "Fac": (0.5,)}
    pattern.measure(point, _SHARP)
    first = pattern.computed(lambda *v: [simple.checker(list(v))], 1, point)
    return {"Color": sockets.math.mix(*colors, first), "Fac": first}
