"""Materials of a stage: UsdPreviewSurface and MaterialX, from USD's networks or ``.mtlx`` files.

Texture coordinates: primvars of USD have (0, 0) at the bottom left. Meshes must hold (s, 1 - t), as
the renderer's (0, 0) is the top left; transforms of textures are converted here.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

from pxr import Sdf, Usd, UsdShade

from daguerre.errors import InputError
from daguerre.files.json_item import short
from daguerre.files.notes import Notes
from daguerre.files.reading import is_input
from daguerre.scene.materials import Gltf, Material
from daguerre.scene.scene import Scene
from daguerre.shading.arithmetic import Arithmetic
from daguerre.shading.bake import Baker
from daguerre.shading.build import SURFACES, Builder, picture_files, uv_sets, vertex_colors
from daguerre.shading.evaluate import Context
from daguerre.shading.images import Images
from daguerre.shading.materialx.document import Document, read
from daguerre.shading.materialx.graph import Graph
from daguerre.shading.operations import OPERATIONS

from .mtlx_arcs import bound_path, material_in_document
from .network import Clock, Networks

#: Names of the primvars that a surface has.
PrimvarNames = Collection[str]
_EMPTY = Graph({})


class Materials:
    """The materials of a stage.

    Args:
        scene: Receives materials and textures.
        images: The pictures of the stage.
        clock: Values of attributes over time.
        notes: Receives notes on unsupported content.
        metres_per_unit: Length of a scene unit, m.
    """

    def __init__(
        self,
        scene: Scene,
        images: Images,
        clock: Clock,
        notes: Notes,
        metres_per_unit: float = 1.0,
    ) -> None:
        self._scene = scene
        self._notes = notes
        self._images = images
        baker = Baker(notes)
        self._arithmetic = Arithmetic(baker)
        self._builder = Builder(images, baker, metres_per_unit)
        self._networks = Networks({*OPERATIONS, *SURFACES}, clock, notes)
        self._documents: dict[Path, Document] = {}
        self._graphs: dict[str, tuple[str, Graph]] = {}
        self._indices: dict[tuple[object, ...], int] = {}
        self._cache: dict[object, object] = {}

    def index(self, material: UsdShade.Material, has: PrimvarNames) -> int:
        """Index of a material in the scene; it is added once.

        Args:
            material: The material.
            has: Names of the surface's primvars; reads of other primvars give their fallback.

        Raises:
            InputError: A value, a picture or a document is wrong; the message names it.
        """
        return self.index_at(material.GetPrim().GetStage(), material.GetPath(), has)

    def index_at(self, stage: Usd.Stage, path: Sdf.Path, has: PrimvarNames) -> int:
        """Index of the material at a path, also from a ``.mtlx`` file alone."""
        key, graph = self._graph(stage, path)
        sets, colored = uv_sets(graph), vertex_colors(graph)
        names = frozenset(has)
        read = names & {*sets, "displayColor", "displayOpacity"} if colored else names & {*sets}
        known = (key, read)
        if known not in self._indices:
            context = Context(
                self._images, self._notes, self._arithmetic, names, self._scene.time, self._cache
            )
            if len(sets) > 2:
                self._notes.add("a material that reads more than two sets of coordinates")
            self._images.prefetch(picture_files(graph))
            made = self._builder.material(graph, str(path.name), context)
            self._indices[known] = self._scene.add_material(made)
        return self._indices[known]

    def displayed(
        self,
        color: Sequence[float] | None = None,
        opacity: float | Sequence[float] | None = None,
    ) -> int:
        """Index of the material of ``displayColor`` and ``displayOpacity``.

        Args:
            color: Constant colour, linear Rec.709; None: the colours of the mesh (``colors``).
            opacity: Constant opacity; a list: the mesh's (``colors``, fourth channel).
        """
        r, g, b = (1.0,) * 3 if color is None else (min(max(float(c), 0.0), 1.0) for c in color)
        varies = opacity is not None and not isinstance(opacity, float | int)
        alpha = 1.0 if opacity is None or varies else min(max(float(opacity), 0.0), 1.0)  # type: ignore[arg-type]
        mode = "blend" if varies or alpha < 1 else "opaque"
        key = ("displayed", r, g, b, alpha, mode)
        if key not in self._indices:
            kind = Gltf((r, g, b), alpha, metallic=0.0, roughness=0.5, alpha_mode=mode)
            self._indices[key] = self._scene.add_material(Material(kind, name="displayColor"))
        return self._indices[key]

    def uv_sets(self, material: UsdShade.Material) -> tuple[str, ...]:
        """Names of the primvars of texture coordinates: set 0, set 1, and further sets."""
        return self.uv_sets_at(material.GetPrim().GetStage(), material.GetPath())

    def uv_sets_at(self, stage: Usd.Stage, path: Sdf.Path) -> tuple[str, ...]:
        """Primvars of texture coordinates of the material at a path."""
        return uv_sets(self._graph(stage, path)[1])

    def has(self, stage: Usd.Stage, path: Sdf.Path) -> bool:
        """Whether there is a material at a path, of the stage or of a ``.mtlx`` file."""
        return bool(stage.GetPrimAtPath(path)) or self._graph(stage, path)[1] is not _EMPTY

    def prefetch(self, stage: Usd.Stage, path: Sdf.Path) -> None:
        """Begins to decode the pictures of the material at a path."""
        self._images.prefetch(picture_files(self._graph(stage, path)[1]))

    def reads_vertex_colors(self, stage: Usd.Stage, path: Sdf.Path) -> bool:
        """Whether a mesh with this material must have ``displayColor`` as its ``colors``.

        Other meshes must have none, as the renderer multiplies every material with them.
        """
        return vertex_colors(self._graph(stage, path)[1])

    @staticmethod
    def bound_path(prim: Usd.Prim) -> Sdf.Path | None:
        """Target of the nearest direct binding, where USD's search finds no prim; or None."""
        return bound_path(prim)

    def _graph(self, stage: Usd.Stage, path: Sdf.Path) -> tuple[str, Graph]:
        """Graph of the material at a path, and a key that equal materials share."""
        name = str(path)
        if name not in self._graphs:
            prim = stage.GetPrimAtPath(path)
            material = UsdShade.Material(prim) if prim else None
            graph = self._networks.graph(material) if material else None
            if graph is not None:
                self._graphs[name] = name, graph
            else:
                self._graphs[name] = self._graph_in_document(stage, path)
        return self._graphs[name]

    def _graph_in_document(self, stage: Usd.Stage, path: Sdf.Path) -> tuple[str, Graph]:
        found = material_in_document(stage, path)
        if found is None:
            return str(path), _EMPTY
        asset, name = found
        file = self._images.resolve(str(path), asset)
        if not is_input(file):
            self._notes.add("a MaterialX document that is missing is left out")
            return str(path), _EMPTY
        if file not in self._documents:
            self._documents[file] = read(file, self._notes)
        graph = self._documents[file].graph(name)
        if graph is None:
            raise InputError(f"{path}: no material {short(name)} in {file}")
        return f"{file}#{name}", graph
