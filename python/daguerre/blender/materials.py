"""Materials of Blender, each added to the scene once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from functools import partial
from math import isqrt
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes, Silence
from daguerre.scene.materials import Diffuse, Gltf, Material
from daguerre.scene.scene import Scene
from daguerre.shading.arithmetic import Arithmetic
from daguerre.shading.assemble import Assembler
from daguerre.shading.bake import Baker
from daguerre.shading.channels import Texel, UnsupportedError, Value, VertexColor, numbers_of
from daguerre.shading.evaluate import Context, Evaluator
from daguerre.shading.materialx.graph import Graph
from daguerre.shading.surface import GltfInputs
from daguerre.shading.textures import Packer

from .meshes import Needs
from .shading.canvas import TRIAL, Canvas, UvCanvas
from .shading.closures import Closure
from .shading.network import Networks
from .shading.operations import operations
from .shading.painting import LEAST, Reads, canvas_of, reads_of, side_of
from .shading.pictures import Pictures
from .shading.surfaces import ATLAS, MaterialFaces
from .shading.texture_nodes import ACTIVE
from .shading.tree import Tree
from .shading.uv_size import uv_size

if TYPE_CHECKING:
    import bpy


#: Most texels of all canvases on which patterns are computed; a canvas may have at most 1 / _SHARE
#: of the texels left.
MAX_TEXELS, _SHARE = 1 << 25, 8
#: Most bytes of the pictures for the patterns of a material.
_LIMIT = 1 << 30
#: Colour of surfaces without a material in Blender.
_PLAIN = (0.8, 0.8, 0.8)
_BLACK: Value = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class _Made:
    """A material of the scene, and the layers that its meshes must have."""

    index: int
    uv_sets: tuple[str, ...] = ()
    colors: str | None = None


class Materials:
    """The materials of a Blender file.

    Texture coordinates of Blender have (0, 0) at the bottom left. Meshes must hold (u, 1 - v), as
    the renderer's (0, 0) is the top left; transforms of textures are converted here.

    Args:
        scene: Receives materials and textures.
        notes: Receives notes on unsupported content.
    """

    def __init__(self, scene: Scene, notes: Notes) -> None:
        self._scene = scene
        self._notes = notes
        self._pictures = Pictures(scene, notes)
        self._baker = Baker(notes)
        self._cache: dict[Any, Any] = {}
        self._made: dict[str | None, _Made] = {}
        self._painted: dict[Any, _Made] = {}
        self._graphs: dict[str, Graph | None] = {}
        self._read: dict[str, Reads] = {}
        self._texels = MAX_TEXELS

    def index(self, material: bpy.types.Material | None) -> int:
        """Index of a material (``bpy.types.Material``) in the scene; None: a plain grey material.

        Raises:
            InputError: A tree of nodes or a picture is wrong; the message names the node.
        """
        return self._of(material).index

    def uv_sets(self, material: bpy.types.Material | None) -> tuple[str, ...]:
        """Names of the UV layers that a mesh must hold as sets 0 and 1.

        An empty name is the layer that is active for rendering.
        """
        return _names(self._of(material).uv_sets)

    def color_attribute(self, material: bpy.types.Material | None) -> str | None:
        """Name of the colours of vertices that the base colour is multiplied with.

        An empty name is the attribute that is active for rendering. None: no colours; the mesh
        must hold none then, as the renderer always multiplies with them.
        """
        return _name(self._of(material).colors)

    def needs(self, material: bpy.types.Material | None) -> Needs:
        """Layers that a mesh with a material must hold."""
        return Needs(self.uv_sets(material), self.color_attribute(material))

    def binding(
        self, material: bpy.types.Material | None, world: NDArray[np.float64]
    ) -> Any | None:
        """Key of a material's dependencies besides the mesh; None: it is the same on all meshes.

        Args:
            material: ``bpy.types.Material`` or None.
            world: World from mesh in Blender's frame, shape (4, 4).
        """
        if material is None or material.node_tree is None:
            return None
        reads = self._reads(material)
        if not reads.patterns:
            return None
        return str(material.name_full), np.asarray(world).tobytes() if reads.world else b""

    def painted(self, material: bpy.types.Material, surface: MaterialFaces) -> tuple[int, Needs]:
        """Index of a material with patterns computed for a surface, and the layers that it reads.

        Raises:
            InputError: A tree of nodes or a picture is wrong; the message names the node.
        """
        made = self._paint(material, surface) or self._of(material)
        return made.index, Needs(_names(made.uv_sets), _name(made.colors))

    def _paint(self, material: bpy.types.Material, surface: MaterialFaces) -> _Made | None:
        """Bakes the patterns of a material; None: the surface has no room for them."""
        reads = self._reads(material)
        trial = canvas_of(reads, surface, TRIAL)
        most = isqrt(self._texels // _SHARE)
        if trial is None or most < LEAST:
            return None
        alike = str(material.name_full), trial.mapping
        if isinstance(trial, UvCanvas) and alike in self._painted:
            return self._painted[alike]
        with self._pictures.silent():
            self._closure(material, surface, Baker(Silence(), _LIMIT, trial))
        atlas = trial.mapping.primvar == ATLAS
        canvas = canvas_of(reads, surface, side_of(trial.need, most, atlas))
        assert canvas is not None
        height, width = canvas.size
        self._texels -= height * width
        self._notes.add(
            f"the patterns of a material are baked to textures of {width} x {height} texels"
        )
        self._painted[alike] = made = self._make(material, surface, canvas)
        return made

    def _reads(self, material: bpy.types.Material) -> Reads:
        """Coordinates that patterns read, found once: each object asks for them."""
        key = str(material.name_full)
        if key not in self._read:
            graph = self._graph(material)
            self._read[key] = Reads() if graph is None else reads_of(graph)
        return self._read[key]

    def _graph(self, material: bpy.types.Material) -> Graph | None:
        """Nodes of a material, read once."""
        key = str(material.name_full)
        if key not in self._graphs:
            self._graphs[key] = Networks(self._notes).graph(material)
        return self._graphs[key]

    def _of(self, material: bpy.types.Material | None) -> _Made:
        key = None if material is None else str(material.name_full)
        if key not in self._made:
            self._made[key] = self._plain() if material is None else self._make(material)
        return self._made[key]

    def _plain(self) -> _Made:
        return _Made(self._scene.add_material(Material(Diffuse(_PLAIN))))

    def _make(
        self,
        material: bpy.types.Material,
        on: MaterialFaces | None = None,
        canvas: Canvas | None = None,
    ) -> _Made:
        if material.node_tree is None:
            return _Made(self._scene.add_material(_displayed(material)))
        baker = self._baker if canvas is None else Baker(self._notes, _LIMIT, canvas)
        try:
            look = _look(self._closure(material, on, baker))
            return self._assembled(look, str(material.name), baker)
        except UnsupportedError as error:
            self._notes.add(f"shading: {error} is not supported: the material is grey")
            return self._assembled(GltfInputs(base_color=_PLAIN), str(material.name), baker)

    def _assembled(self, surface: GltfInputs, name: str, baker: Baker) -> _Made:
        """Adds the material of a surface."""
        sets = tuple(dict.fromkeys(_layers(surface, Texel)))
        if len(sets) > 2:
            self._notes.add("a material reads more than two UV layers")
        colors = next(iter(_layers(surface, VertexColor)), None)
        assembler = Assembler(Packer(self._pictures, baker, sets), baker)
        made = assembler.material(surface, name)
        return _Made(self._scene.add_material(made), sets, colors)

    def _closure(
        self, material: bpy.types.Material, on: MaterialFaces | None, baker: Baker
    ) -> Closure:
        """Scattering and emission of a material's surface; black if it has none."""
        graph = self._graph(material)
        if graph is None:
            baker.notes.add("a material without a surface is black")
            return Closure()
        math = Arithmetic(baker)
        context = Context(
            self._pictures, baker.notes, math, time_s=self._scene.time, cache=self._cache
        )
        evaluator = Evaluator(graph, operations(partial(_unit, material, on)), context)
        return Tree(graph, evaluator, math).surface()


def _unit(material: bpy.types.Material | None, on: MaterialFaces | None, primvar: str) -> float:
    """Length of one unit of texture coordinates, in units of the scene."""
    length = None if on is None else on.length(primvar)
    return uv_size(material) if length is None else length


def _names(uv_sets: tuple[str, ...]) -> tuple[str, ...]:
    return tuple("" if name == ACTIVE else name for name in uv_sets[:2])


def _name(colors: str | None) -> str | None:
    return "" if colors == ACTIVE else colors


def _displayed(material: bpy.types.Material) -> Material:
    """Material without nodes: the values that Blender shows in its workbench."""
    r, g, b = (min(max(float(c), 0.0), 1.0) for c in material.diffuse_color[:3])
    kind = Gltf(
        (r, g, b),
        metallic=float(material.metallic),
        roughness=float(material.roughness),
        double_sided=True,
    )
    return Material(kind, name=str(material.name))


def _look(closure: Closure) -> GltfInputs:
    """Surface with emission and opacity."""
    surface = closure.surface
    if surface is None:
        surface = GltfInputs(
            base_color=_BLACK, specular=(0.0,), roughness=(1.0,), double_sided=True
        )
    numbers = numbers_of(closure.cover)
    is_whole = numbers is not None and numbers[0] >= 1
    mode = "opaque" if is_whole else "blend"
    return replace(surface, emissive=closure.emission, alpha=closure.cover[:1], alpha_mode=mode)


def _layers(surface: GltfInputs, kind: type[Texel | VertexColor]) -> Iterator[str]:
    """Layers that the pictures, or the colours of vertices, of a surface are read by, in order."""
    for field in fields(surface):
        value = getattr(surface, field.name)
        for channel in value if isinstance(value, tuple) else ():
            if isinstance(channel, Texel) and kind is Texel:
                yield channel.mapping.primvar
            elif isinstance(channel, VertexColor) and kind is VertexColor:
                yield channel.primvar
