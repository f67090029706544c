"""Materials of Blender, each added to the scene once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Any

from daguerre.files.notes import Notes
from daguerre.io.shading.arithmetic import Arithmetic
from daguerre.io.shading.assemble import Assembler
from daguerre.io.shading.bake import Baker
from daguerre.io.shading.channels import Texel, UnsupportedError, Value, VertexColor, numbers_of
from daguerre.io.shading.evaluate import Context, Evaluator
from daguerre.io.shading.surface import Surface
from daguerre.io.shading.textures import Packer
from daguerre.scene.materials import Diffuse, Gltf, Material
from daguerre.scene.scene import Scene

from .meshes import Needs
from .shading.closures import Closure
from .shading.network import Networks
from .shading.operations import operations
from .shading.pictures import Pictures
from .shading.texture_nodes import ACTIVE
from .shading.tree import Tree
from .shading.uv_size import uv_size

#: Colour of surfaces without a material in Blender.
_PLAIN = (0.8, 0.8, 0.8)
_BLACK: Value = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class _Made:
    """A material of the scene, and what its meshes must hold."""

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
        self._math = Arithmetic(self._baker)
        self._cache: dict[Any, Any] = {}
        self._made: dict[str | None, _Made] = {}

    def index(self, material: Any) -> int:
        """Index of a material (``bpy.types.Material``) in the scene; None: a plain grey one.

        Raises:
            InputError: A tree of nodes or a picture is wrong; the message names the node.
        """
        return self._of(material).index

    def uv_sets(self, material: Any) -> tuple[str, ...]:
        """Names of the UV layers that a mesh must hold as sets 0 and 1.

        An empty name is the layer that is active for rendering.
        """
        return tuple("" if name == ACTIVE else name for name in self._of(material).uv_sets[:2])

    def color_attribute(self, material: Any) -> str | None:
        """Name of the colours of vertices that the base colour is multiplied with.

        An empty name is the attribute that is active for rendering. None: no colours; the mesh
        must hold none then, as the renderer always multiplies with them.
        """
        name = self._of(material).colors
        return "" if name == ACTIVE else name

    def needs(self, material: Any) -> Needs:
        """Layers that a mesh with a material must hold."""
        return Needs(self.uv_sets(material), self.color_attribute(material))

    def _of(self, material: Any) -> _Made:
        key = None if material is None else str(material.name_full)
        if key not in self._made:
            self._made[key] = self._plain() if material is None else self._make(material)
        return self._made[key]

    def _plain(self) -> _Made:
        return _Made(self._scene.add_material(Material(Diffuse(_PLAIN))))

    def _make(self, material: Any) -> _Made:
        if material.node_tree is None:
            return _Made(self._scene.add_material(_displayed(material)))
        try:
            surface = _surface(self._closure(material))
            return self._assembled(surface, str(material.name))
        except UnsupportedError as error:
            self._notes.add(f"shading: {error} is not supported: the material is grey")
            return self._assembled(Surface(base_color=_PLAIN), str(material.name))

    def _assembled(self, surface: Surface, name: str) -> _Made:
        """Adds the material of a surface."""
        sets = tuple(dict.fromkeys(_layers(surface, Texel)))
        if len(sets) > 2:
            self._notes.add("a material reads more than two UV layers")
        colors = next(iter(_layers(surface, VertexColor)), None)
        assembler = Assembler(Packer(self._pictures, self._baker, sets), self._baker)
        made = assembler.material(surface, name)
        return _Made(self._scene.add_material(made), sets, colors)

    def _closure(self, material: Any) -> Closure:
        """Scattering and emission of a material's surface; black if it has none."""
        graph = Networks(self._notes).graph(material)
        if graph is None:
            self._notes.add("a material without a surface is black")
            return Closure()
        context = Context(
            self._pictures, self._notes, self._math, time_s=self._scene.time, cache=self._cache
        )
        nodes = operations(partial(uv_size, material))
        evaluator = Evaluator(graph, nodes, context)
        return Tree(graph, evaluator, self._math).surface()


def _displayed(material: Any) -> Material:
    """Material without nodes: the values that Blender shows in its workbench."""
    r, g, b = (min(max(float(c), 0.0), 1.0) for c in material.diffuse_color[:3])
    kind = Gltf(
        (r, g, b),
        metallic=float(material.metallic),
        roughness=float(material.roughness),
        double_sided=True,
    )
    return Material(kind, name=str(material.name))


def _surface(closure: Closure) -> Surface:
    """Surface with emission and opacity."""
    surface = closure.surface
    if surface is None:
        surface = Surface(base_color=_BLACK, specular=(0.0,), roughness=(1.0,), double_sided=True)
    numbers = numbers_of(closure.cover)
    is_whole = numbers is not None and numbers[0] >= 1
    mode = "opaque" if is_whole else "blend"
    return replace(surface, emissive=closure.emission, alpha=closure.cover[:1], alpha_mode=mode)


def _layers(surface: Surface, kind: type[Texel | VertexColor]) -> Iterator[str]:
    """Layers that the pictures, or the colours of vertices, of a surface are read by, in order."""
    for field in fields(surface):
        value = getattr(surface, field.name)
        for channel in value if isinstance(value, tuple) else ():
            if isinstance(channel, Texel) and kind is Texel:
                yield channel.mapping.primvar
            elif isinstance(channel, VertexColor) and kind is VertexColor:
                yield channel.primvar
