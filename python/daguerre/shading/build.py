"""Material of a graph, at one time or over time."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from daguerre.files.json_item import short
from daguerre.motion.values import Keys, keys
from daguerre.scene.materials import Gltf, Material
from daguerre.shading.materialx.graph import Constant, Graph, Link

from . import gltf_pbr, preview_surface
from .assemble import Assembler
from .bake import Baker
from .channels import UnsupportedError
from .evaluate import Arguments, Context, Evaluator
from .open_pbr import open_pbr_surface
from .operations import OPERATIONS
from .standard_surface import standard_surface
from .surface import GltfInputs
from .texture_nodes import file_of
from .textures import Packer
from .walks import moving_nodes, names_before

if TYPE_CHECKING:
    from daguerre.shading.images import Images

#: Default primvar of texture coordinates, and nodes that read images.
_DEFAULT_SET = "st"
_IMAGES = ("UsdUVTexture", "image", "tiledimage", "gltf_image", "gltf_colorimage", "gltf_normalmap")
#: Most times at which a material that moves is evaluated.
_MAX_TIMES = 1024
#: Pieces between two keys where a material does not change evenly, and the tolerance of even.
_PIECES, _EVEN = 8, 1e-6
#: Kinds of surfaces that are supported.
SURFACES = (
    "UsdPreviewSurface",
    "standard_surface",
    "open_pbr_surface",
    "gltf_pbr",
    "surface_unlit",
)
_GREY = GltfInputs(base_color=(0.18, 0.18, 0.18))


class Builder:
    """Makes materials from graphs.

    Args:
        images: Source of pictures, receives textures.
        baker: Computes pictures.
        metres_per_unit: Length of a scene unit, m.
    """

    def __init__(self, images: Images, baker: Baker, metres_per_unit: float) -> None:
        self._images = images
        self._baker = baker
        self._surfaces: dict[str, Callable[[Arguments], GltfInputs]] = {
            "UsdPreviewSurface": preview_surface.preview_surface,
            "standard_surface": lambda given: standard_surface(given, metres_per_unit),
            "open_pbr_surface": lambda given: open_pbr_surface(given, metres_per_unit),
            "gltf_pbr": lambda given: gltf_pbr.gltf_pbr(given, metres_per_unit),
            "surface_unlit": gltf_pbr.surface_unlit,
        }

    def material(self, graph: Graph, name: str, context: Context) -> Material:
        """Material of a graph; fields that change have keys over time."""
        if graph.displaced:
            context.notes.add("displacement of a material is not supported")
        moving = moving_nodes(graph)
        first = Evaluator(graph, OPERATIONS, context)
        packer = Packer(self._images, self._baker, uv_sets(graph))
        assembler = Assembler(packer, self._baker)
        try:
            rest = assembler.material(self._surface(first, context), name, whole=bool(moving))
        except UnsupportedError as error:
            context.notes.add(f"shading: {error} is not supported: the material is grey")
            return assembler.material(replace(_GREY), name)
        if not moving:
            return rest
        kept = first.still(moving)

        def at(time_s: float) -> Material:
            then = replace(context, time_s=time_s)
            evaluator = Evaluator(graph, OPERATIONS, then, kept)
            return assembler.material(self._surface(evaluator, then), name, whole=True)

        return over_time(rest, at, _times(graph), context)

    def _surface(self, evaluator: Evaluator, context: Context) -> GltfInputs:
        given = evaluator.surface()
        if given is None:
            context.notes.add("a material without a surface is grey")
            return replace(_GREY)
        reader = self._surfaces.get(given.node.kind)
        if reader is None:
            context.notes.add(f"surface {short(given.node.kind)} is not supported: it is grey")
            return replace(_GREY)
        return reader(given)


def uv_sets(graph: Graph) -> tuple[str, ...]:
    """Primvars of texture coordinates that a material reads, in the order of their sets."""
    found: dict[str, None] = {}
    for name in names_before(graph, preview_surface.IGNORED):
        node = graph.nodes[name]
        placed = {"st", "texcoord"} & node.inputs.keys()
        if node.kind in _IMAGES and not placed:
            found[_DEFAULT_SET] = None
        elif node.kind == "texcoord":
            index = node.inputs.get("index")
            numbers = index.value if isinstance(index, Constant) else (0.0,)
            number = int(numbers[0]) if isinstance(numbers, tuple) else 0
            found[f"st{number}" if number else "st"] = None
        elif node.kind.endswith(("_float2", "_vector2", "_texcoord")) or node.type == "vector2":
            read = node.inputs.get("varname", node.inputs.get("geomprop"))
            if isinstance(read, Constant) and isinstance(read.value, str) and read.value:
                found[read.value] = None
    return tuple(found)


def picture_files(graph: Graph) -> dict[str, str]:
    """Paths of the pictures that a material reads, each with the place that names it."""
    nodes = [graph.nodes[name] for name in names_before(graph, preview_surface.IGNORED)]
    found = {file_of(node): node.place for node in nodes if node.kind in _IMAGES}
    return {path: place for path, place in found.items() if path is not None}


def vertex_colors(graph: Graph) -> bool:
    """Whether a material reads the colours of the vertices (``displayColor``)."""
    for name in names_before(graph, preview_surface.IGNORED):
        node = graph.nodes[name]
        read = node.inputs.get("varname", node.inputs.get("geomprop"))
        if node.kind == "geomcolor":
            return True
        if isinstance(read, Constant) and read.value in ("displayColor", "displayOpacity"):
            return True
    return False


def _times(graph: Graph) -> list[float]:
    """Times of all keys; a step also has a time just before each key."""
    found: set[float] = set()
    for node in graph.nodes.values():
        for given in node.inputs.values():
            if isinstance(given, Link) or not isinstance(given.value, Keys):
                continue
            times = [float(time) for time in given.value.times]
            found.update(times)
            if given.value.interpolation == "step":
                found.update(float(np.nextafter(time, -np.inf)) for time in times[1:])
    return sorted(found)


def over_time(
    rest: Material, at: Callable[[float], Material], times: Sequence[float], context: Context
) -> Material:
    """Material with keys in the fields that change; textures stay as at the scene's time."""
    if len(times) > _MAX_TIMES:
        context.notes.add(f"a material with more than {_MAX_TIMES} keys keeps only some of them")
        times = [times[i] for i in np.linspace(0, len(times) - 1, _MAX_TIMES).astype(int)]
    known = {time: _numbers(at(time)) for time in times}
    for a, b in itertools.pairwise(times):
        middle = 0.5 * (a + b)
        if not a < middle < b or len(known) > _MAX_TIMES:
            continue
        if not _even(known[a], known[b], _numbers(at(middle))):
            inside = (a + (b - a) * i / _PIECES for i in range(1, _PIECES))
            known |= {time: _numbers(at(time)) for time in inside}
    changed: dict[str, Any] = {}
    ordered = sorted(known)
    assert isinstance(rest.kind, Gltf)
    for name, value in _numbers(rest).items():
        row = [known[time][name] for time in ordered]
        if any(entry != row[0] for entry in row) or row[0] != value:
            moves = isinstance(value, float | tuple) and len(ordered) > 1
            if moves and name not in _FIXED:
                changed[name] = keys(zip(ordered, row, strict=True))
            elif any(entry != row[0] for entry in row):
                context.notes.add(f"a material's '{name}' keeps its value at the scene's time")
    return replace(rest, kind=replace(rest.kind, **changed))


#: Fields that may be infinite, which keys cannot be.
_FIXED = ("attenuation_distance",)


def _numbers(material: Material) -> dict[str, Any]:
    kind = material.kind
    return {field.name: getattr(kind, field.name) for field in fields(kind)}


def _even(a: dict[str, Any], b: dict[str, Any], middle: dict[str, Any]) -> bool:
    for name, value in middle.items():
        if isinstance(value, float | tuple) and name not in _FIXED:
            mean = (np.asarray(a[name]) + np.asarray(b[name])) / 2
            if np.abs(mean - np.asarray(value)).max() > _EVEN:
                return False
    return True
