"""Chooses the texels on which the patterns of a material are computed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.blender.raster import Raster, rasterized
from daguerre.shading.materialx.graph import Constant, Graph, Link, Node

from .canvas import TRIAL, Canvas, SurfaceCanvas, UvCanvas
from .surfaces import ATLAS, MaterialFaces
from .texture_nodes import ACTIVE

Array = NDArray[Any]
#: Longer side of the smallest and the largest canvas.
LEAST, MOST = 64, 2048
#: Least side of an atlas, so that room is left between its charts.
_LEAST_ATLAS = 512
#: Side of the raster that tells whether a map overlaps itself, and the share that may.
_PROBE, _OVERLAP = 256, 0.005
#: Patterns that are computed.
PATTERNS = tuple(
    f"ShaderNodeTex{name}"
    for name in ("Noise", "Voronoi", "WhiteNoise", "Wave", "Gradient", "Magic", "Brick", "Checker")
)
#: Patterns that have coordinates 0 without a link, not the surface's coordinates.
_UNPLACED = ("ShaderNodeTexWhiteNoise",)
_COORDINATES, _GEOMETRY = "ShaderNodeTexCoord", "ShaderNodeNewGeometry"
_ON_SURFACE = ("Generated", "Object")


@dataclass(frozen=True)
class Reads:
    """Coordinates that the patterns of a material read.

    Attributes:
        patterns: Whether there are any that need texels.
        surface: Whether they need places on the surface.
        world: Whether they need places in the world.
        primvars: Maps of texture coordinates.
    """

    patterns: bool = False
    surface: bool = False
    world: bool = False
    primvars: tuple[str, ...] = ()


def reads_of(graph: Graph) -> Reads:
    """Coordinates that the patterns of a graph read."""
    placed = [node for node in graph.nodes.values() if _is_placed_by_surface(node)]
    outputs = set(_outputs(graph))
    on_surface = any((_COORDINATES, name) in outputs for name in _ON_SURFACE)
    world = (_GEOMETRY, "Position") in outputs or any(
        ".object_matrix" in node.inputs for node in graph.nodes.values()
    )
    patterns = any(node.kind in PATTERNS for node in graph.nodes.values())
    space = bool(placed) or on_surface or world
    return Reads(patterns or on_surface or world, space, world, tuple(_primvars(graph, outputs)))


def _is_placed_by_surface(node: Node) -> bool:
    """Whether nothing is linked to the coordinates of a pattern."""
    if node.kind not in PATTERNS or node.kind in _UNPLACED:
        return False
    dimensions = [node.inputs.get(f".{name}_dimensions") for name in ("noise", "voronoi")]
    flat = any(isinstance(one, Constant) and one.value == "1D" for one in dimensions)
    return not flat and not isinstance(node.inputs.get("Vector"), Link)


def _outputs(graph: Graph) -> Iterator[tuple[str, str]]:
    """Kinds of nodes, and the outputs of theirs that are read."""
    for node in graph.nodes.values():
        for one in node.inputs.values():
            if isinstance(one, Link) and one.node in graph.nodes:
                yield graph.nodes[one.node].kind, one.output


def _primvars(graph: Graph, outputs: set[tuple[str, str]]) -> dict[str, None]:
    found: dict[str, None] = {}
    if (_COORDINATES, "UV") in outputs:
        found[ACTIVE] = None
    for node in graph.nodes.values():
        if node.kind == "ShaderNodeUVMap":
            name = node.inputs.get(".uv_map")
            found[str(name.value) if isinstance(name, Constant) and name.value else ACTIVE] = None
        elif node.kind == "ShaderNodeTexImage" and not isinstance(node.inputs.get("Vector"), Link):
            found[ACTIVE] = None
    return found


def side_of(need: float, most: int, atlas: bool) -> int:
    """Longer side of a canvas, a power of two.

    Args:
        need: Texels that are wanted, per texel and axis of the trial.
        most: Largest side that memory allows.
        atlas: Whether the canvas lies on an atlas.
    """
    least = _LEAST_ATLAS if atlas else LEAST
    wanted = TRIAL * need if np.isfinite(need) else MOST
    side = 1 << int(np.ceil(np.log2(max(wanted, 1.0))))
    return int(max(min(side, MOST, most), min(least, most)))


def canvas_of(reads: Reads, surface: MaterialFaces, side: int) -> Canvas | None:
    """Canvas of a surface; None: there is nothing to lie on.

    Args:
        reads: Coordinates that are read on it.
        surface: The surface.
        side: Rows or columns, whichever are more.
    """
    if not len(surface.triangles):
        return None
    primvar = reads.primvars[0] if reads.primvars else ACTIVE
    span = _span(surface, primvar)
    if not reads.surface and len(reads.primvars) <= 1:
        return None if span is None else UvCanvas(surface, primvar, span, _size(span, side))
    if span is not None and primvar not in surface.flat:
        surface.flat[primvar] = _is_flat(surface, primvar, span)
    if span is None or not surface.flat[primvar]:
        primvar, span = ATLAS, np.array([[0.0, 0.0], [1.0, 1.0]])
    raster = _raster(surface, primvar, span, _size(span, side))
    return SurfaceCanvas(surface, primvar, span, raster)


def _span(surface: MaterialFaces, primvar: str) -> Array | None:
    """Least and largest texture coordinates; None: missing or not finite."""
    if surface.layer(primvar) is None:
        return None
    corners = surface.uv(primvar).reshape(-1, 2).astype(np.float64)
    span = np.stack([corners.min(axis=0), corners.max(axis=0)])
    return span if np.isfinite(span).all() and (span[1] - span[0]).min() > 0 else None


def _size(span: Array, side: int) -> tuple[int, int]:
    """Rows and columns in the ratio of the range of coordinates."""
    width, height = span[1] - span[0]
    longer = max(width, height)
    across, up = (max(round(side * one / longer), min(side, 16)) for one in (width, height))
    return up, across


def _is_flat(surface: MaterialFaces, primvar: str, span: Array) -> bool:
    """Whether a map does not overlap itself, and leaves no face out."""
    if np.mean(surface.uv_areas(primvar) <= 1e-12) > _OVERLAP:
        return False
    return _raster(surface, primvar, span, _size(span, _PROBE)).overlap <= _OVERLAP


def _raster(surface: MaterialFaces, primvar: str, span: Array, size: tuple[int, int]) -> Raster:
    corners = (surface.uv(primvar).astype(np.float64) - span[0]) / (span[1] - span[0])
    corners[:, :, 1] = 1 - corners[:, :, 1]
    return rasterized(corners * np.array([size[1], size[0]]), size)
