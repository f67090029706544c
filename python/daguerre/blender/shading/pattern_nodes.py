"""Noise, White Noise and Voronoi textures: computed for each texel.

Patterns are functions of coordinates. Where these are known for each texel, so is the pattern;
else its mean stands for it, with a note.

Source: Blender 5.0 Manual, "Texture Nodes"; see :mod:`daguerre.blender.patterns` for formulas.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from daguerre.blender.patterns import hashes, voronoi
from daguerre.blender.patterns.blocks import in_blocks
from daguerre.blender.patterns.cells import METRICS
from daguerre.blender.patterns.fractals import FRACTALS, Octaves
from daguerre.blender.patterns.kept import PATTERNS
from daguerre.blender.patterns.noise import noise as noise_of
from daguerre.cached import cached_property
from daguerre.shading.channels import Channel, Coordinate, Value, broadcast, fit
from daguerre.shading.evaluate import Arguments
from daguerre.shading.materialx.graph import Constant

from .outputs import Outputs
from .sockets import Sockets

#: Octaves that Blender computes at most.
_MOST_DETAIL = 15.0
_MIDDLE: Value = (0.5,)
#: Octaves that a texture resolves.
_SEEN_DETAIL = 3.0
#: Texels of a cell of noise, of a cell with sharp edges, and of white noise.
_SMOOTH, _SHARP, _WHITE = 8.0, 16.0, 1.0


def vector_of(sockets: Sockets, unlinked: Value | None = None) -> Value | None:
    """Coordinates of a pattern; None: they are not known."""
    found = sockets.linked("Vector")
    if found is None and not sockets.is_linked("Vector"):
        canvas = sockets.math.baker.canvas
        found = unlinked if unlinked or canvas is None else canvas.vector("Generated")
    return found


class Pattern:
    """Reads inputs that all patterns share: coordinates and their number.

    Args:
        given: Inputs of the node.
        dimensions: Number of axes, "1D" .. "4D"; the last axis of "4D" and the axis of "1D" is
            ``W``.
    """

    def __init__(self, given: Arguments, dimensions: str = "3D") -> None:
        self.sockets = Sockets(given)
        self.axes = int(dimensions[0])
        self.canvas = self.sockets.math.baker.canvas

    def point(self, unlinked: Value | None = None, *, scaled: bool = True) -> Value | None:
        """Coordinates times the scale; None: they are not known for each texel.

        Args:
            unlinked: Coordinates without a link; default: "Generated".
            scaled: Whether they are multiplied with the scale.
        """
        found: Value = ()
        if self.axes > 1:
            vector = vector_of(self.sockets, unlinked)
            if vector is None:
                return None
            found = fit(vector, 3)[: min(self.axes, 3)]
        if self.axes in (1, 4):
            found = (*found, *self.sockets.one("W"))
        if self.canvas is not None:
            found = tuple(self.canvas.placed(channel) for channel in found)
        if any(isinstance(channel, Coordinate) for channel in found):
            return None
        if not scaled or not {"Scale", "=Scale"} & self.sockets.given.node.inputs.keys():
            return found
        return self.sockets.math.multiply(found, self.sockets.one("Scale"))

    def measure(self, point: Value, texels: float, detail: float = 0.0) -> None:
        """Notes how many texels a cell needs; octaves after the third are too small to count."""
        if self.canvas is None:
            return
        finer = 1.0
        if detail and "Lacunarity" in self.sockets.given.node.inputs:
            finer = max(self.sockets.number("Lacunarity"), 1.0) ** min(detail, _SEEN_DETAIL)
        self.canvas.measure(point, texels * finer)

    @cached_property
    def detail(self) -> float:
        """Number of octaves after the first."""
        return min(max(self.sockets.number("Detail"), 0.0), _MOST_DETAIL)

    def computed(
        self, function: Callable[..., Sequence[Any]], count: int, point: Value, *values: Value
    ) -> Value:
        """Results of a function of coordinates and of numbers, for each texel."""
        channels: list[Channel] = [*point, *(value[0] for value in values)]
        apply = PATTERNS.kept(in_blocks(function, len(point), count), self._identity(count))
        return self.sockets.math.baker.several(apply, count, *channels)

    def _identity(self, count: int) -> str:
        """Text of all that a pattern depends on besides its arguments."""
        node = self.sockets.given.node
        fixed = {k: one.value for k, one in node.inputs.items() if isinstance(one, Constant)}
        return f"{node.kind} {sorted(fixed.items())} {self.detail} {count}"


def averaged(sockets: Sockets, names: Sequence[str]) -> Mapping[str, Value]:
    """A middle value in place of each output, with a note."""
    sockets.note("the pattern is replaced by its mean")
    return {name: broadcast(_MIDDLE, 3 if name in _COLORS else 1) for name in names}


def unknown(given: Arguments) -> Mapping[str, Value]:
    """Gabor Texture: a middle value."""
    return averaged(Sockets(given), ("Value", "Phase", "Intensity"))


_COLORS = ("Color", "Position")


def noise(given: Arguments) -> Mapping[str, Value]:
    """Noise Texture."""
    pattern = Pattern(given, given.text(".noise_dimensions", "3D"))
    sockets, point = pattern.sockets, pattern.point()
    if point is None:
        return averaged(sockets, ("Fac", "Color"))
    fractal = FRACTALS[sockets.text("noise_type", "FBM")]
    detail, normalize = pattern.detail, sockets.flag("normalize")
    pattern.measure(point, _SMOOTH, detail)
    names = ("Roughness", "Lacunarity", "Offset", "Gain", "Distortion")

    def made(colored: bool) -> Value:
        def apply(*values: Any) -> list[Any]:
            roughness, lacunarity, offset, gain, distortion = values[pattern.axes :]
            octaves = Octaves(detail, np.maximum(roughness, 0), lacunarity, offset, gain, normalize)
            at = values[: pattern.axes]
            return noise_of(at, fractal, octaves, distortion, colored=colored)

        parameters = (sockets.one(name) for name in names)
        return pattern.computed(apply, 3 if colored else 1, point, *parameters)

    return Outputs({"Fac": lambda: made(False), "Color": lambda: made(True)})


def white_noise(given: Arguments) -> Mapping[str, Value]:
    """White Noise Texture; without a link its vector is 0."""
    pattern = Pattern(given, given.text(".noise_dimensions", "3D"))
    point = pattern.point((0.0, 0.0, 0.0))
    if point is None:
        return averaged(pattern.sockets, ("Value", "Color"))
    pattern.measure(point, _WHITE)
    at = point
    return Outputs(
        {
            "Value": lambda: pattern.computed(lambda *v: [hashes.of_numbers(*v)], 1, at),
            "Color": lambda: pattern.computed(lambda *v: hashes.color_of_numbers(v), 3, at),
        }
    )


_FEATURES = {"F1": voronoi.nearest, "F2": voronoi.second, "SMOOTH_F1": voronoi.smooth}
_VORONOI = ("Distance", "Color", "Position", "W", "Radius")


def voronoi_texture(given: Arguments) -> Mapping[str, Value]:
    """Voronoi Texture."""
    pattern = Pattern(given, given.text(".voronoi_dimensions", "3D"))
    sockets, point = pattern.sockets, pattern.point()
    if point is None:
        return averaged(sockets, _VORONOI)
    feature = sockets.text("feature", "F1")
    pattern.measure(point, _SHARP, pattern.detail)
    black: Value = (0.0, 0.0, 0.0)
    nothing = {"Distance": black[:1], "Color": black, "Position": black, "W": black[:1]}
    nothing["Radius"] = black[:1]
    if feature == "N_SPHERE_RADIUS":
        return Outputs(_kept(nothing) | {"Radius": lambda: _cells(pattern, point, _radius, 1)})
    if feature == "DISTANCE_TO_EDGE":
        return Outputs(_kept(nothing) | {"Distance": lambda: _cells(pattern, point, _edge, 1)})
    return Outputs(_kept(nothing) | _of_points(pattern, point, feature))


def _kept(values: Mapping[str, Value]) -> dict[str, Callable[[], Value]]:
    return {name: lambda value=value: value for name, value in values.items()}  # type: ignore[misc]


def _of_points(pattern: Pattern, point: Value, feature: str) -> dict[str, Callable[[], Value]]:
    """Outputs of the features that are about the nearest points."""
    axes, sockets = pattern.axes, pattern.sockets
    done: list[Value] = []

    def apply(at: list[Any], cells: voronoi.Cells) -> list[Any]:
        sharp = feature == "SMOOTH_F1" and not np.any(cells.smoothness)
        widest = cells.widest(axes) * np.float32(2 if feature == "F2" else 1)
        which = _FEATURES["F1" if sharp else feature]
        found = voronoi.fractal(at, cells, which, widest)
        return [found.distance, *found.color, *found.position]

    def all_() -> Value:
        if not done:
            done.append(_cells(pattern, point, apply, 4 + axes))
        return done[0]

    def position() -> Value:
        return sockets.math.divide(all_()[4:], sockets.one("Scale"))

    found: dict[str, Callable[[], Value]] = {
        "Distance": lambda: all_()[:1],
        "Color": lambda: all_()[1:4],
    }
    if axes > 1:
        found["Position"] = lambda: fit(position()[:3], 3)
    if axes in (1, 4):
        found["W"] = lambda: position()[-1:]
    return found


def _radius(at: list[Any], cells: voronoi.Cells) -> list[Any]:
    return [voronoi.sphere_radius(at, cells)]


def _edge(at: list[Any], cells: voronoi.Cells) -> list[Any]:
    return [voronoi.fractal_edge(at, cells)]


def _cells(
    pattern: Pattern, point: Value, function: Callable[[list[Any], Any], list[Any]], count: int
) -> Value:
    """Results of a function of coordinates and of the parameters of cells."""
    sockets, axes = pattern.sockets, pattern.axes
    detail, normalize = pattern.detail, sockets.flag("normalize")
    metric = METRICS[sockets.text("distance", "EUCLIDEAN")]
    names = ("Randomness", "Exponent", "Smoothness", "Roughness", "Lacunarity")

    def apply(*values: Any) -> list[Any]:
        randomness, exponent, smoothness, roughness, lacunarity = values[axes:]
        cells = voronoi.Cells(
            np.clip(randomness, 0, 1),
            metric,
            exponent,
            np.clip(smoothness / np.float32(2), 0, np.float32(0.5)),
            detail,
            np.clip(roughness, 0, 1),
            lacunarity,
            normalize,
        )
        return function(list(values[:axes]), cells)

    return pattern.computed(apply, count, point, *(sockets.one(name) for name in names))
