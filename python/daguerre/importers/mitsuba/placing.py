"""Places shapes: their meshes, materials and instances.

Shapes of one file share its mesh, and instances of a shape group share the group's meshes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.files.json_item import clean
from daguerre.scene.media import Medium
from daguerre.scene.transforms import FLAT, ranks

from .charts import chart_of
from .context import Context
from .curves import CURVES, add_curves
from .look import Appearance, Chart
from .materials import Glow, Materials, Sides
from .media import Media
from .mesh_files import FILES, MeshFiles
from .node import Node, leave_out
from .shapes import inward, primitive_mesh
from .spectra import emitted_rgb
from .textures import Textures

Matrix = NDArray[np.float64]


class Placing:
    """Adds shapes to a scene.

    Args:
        context: File, scene, unit and notes.
        materials: Makes materials.
        media: Makes media.
        textures: Reads radiance.
    """

    def __init__(
        self, context: Context, materials: Materials, media: Media, textures: Textures
    ) -> None:
        self._context, self._scene, self._notes = context, context.scene, context.notes
        self._materials, self._media, self._textures = materials, media, textures
        self._files = MeshFiles(context)
        self._meshes: dict[tuple[int, str], tuple[int, Matrix] | None] = {}
        self._primitives: dict[tuple[str, bool], int] = {}
        self._names: dict[str, int] = {}

    def add(self, node: Node) -> None:
        """Adds a shape of the scene; groups are added by their instances."""
        if node.plugin == "shapegroup":
            return
        if node.plugin == "merge":
            node.use()
            for inner in node.nested("shape"):
                self.add(inner)
        elif node.plugin == "instance":
            self._instance(node)
        elif node.plugin in CURVES:
            node.use()
            self._curves(node)
        else:
            self._shape(node, self._context.world, "")

    def _instance(self, node: Node) -> None:
        """Places all shapes of a group."""
        group = node.nested_one("shape")
        if group is None:
            node.fail("needs a reference to a shape group")
        if group.plugin != "shapegroup":
            node.fail(f"wanted a shape group, got a shape {group.plugin[:40]!r}")
        node.use()
        pose = self._context.world @ node.transform()
        name = self._named(node, pose)
        for inner in group.nested("shape"):
            if inner.plugin in ("instance", "shapegroup", *CURVES):
                what = f"a shape {inner.plugin!r} in a shape group is left out"
                leave_out(inner, self._notes, what)
            else:
                self._shape(inner, pose, name)

    def _curves(self, node: Node) -> None:
        place = self._context.world @ node.transform()
        mesh = add_curves(node, self._context)
        if mesh is None:
            return
        name = self._named(node, np.eye(4))
        self._scene.add_instance(mesh, self._material(node, Chart(), place), name=name)

    def _shape(self, node: Node, pose: Matrix, name: str) -> None:
        """Adds a shape in the space of a pose; ``name``: of its instance, or empty."""
        local = node.transform()
        bsdf = node.nested_one("bsdf")
        look = Appearance() if bsdf is None else self._materials.look(bsdf)
        made = self._mesh(node, look.attribute)
        if made is None:
            return
        mesh, inner = made
        placed = pose @ local @ inner
        if ranks(placed[None, :3, :3])[0] < 3:
            self._notes.add(f"a shape that is {FLAT} is left out")
            return
        name = name or self._named(node, placed)
        chart = Chart()
        if look.reliefs:
            chart = chart_of(self._scene.meshes[mesh], self._context.mirror @ placed)
        material = self._material(node, chart, placed)
        self._scene.add_instance(mesh, material, placed, name=name)

    def _mesh(self, node: Node, attribute: str) -> tuple[int, Matrix] | None:
        """Mesh of a shape, and the transform of the shape's parameters; None: left out."""
        key = (id(node), attribute)
        if key not in self._meshes:
            node.use()
            self._meshes[key] = self._read(node, attribute)
        return self._meshes[key]

    def _read(self, node: Node, attribute: str) -> tuple[int, Matrix] | None:
        if node.plugin in FILES:
            found = self._files.mesh(node, attribute)
            return None if found is None else (found, np.eye(4))
        primitive = primitive_mesh(node)
        if primitive is None:
            leave_out(node, self._notes, f"a shape {node.plugin[:40]!r} is left out")
            return None
        key = (node.plugin, inward(node))
        if key not in self._primitives:
            mesh = primitive.mesh
            self._primitives[key] = self._scene.add_mesh(
                mesh.positions, mesh.triangles, mesh.normals, mesh.uv, name=node.plugin
            )
        return self._primitives[key], primitive.inner

    def _named(self, node: Node, place: Matrix) -> str:
        """Adds a node to the scene; returns its name."""
        base = clean(node.id or node.plugin)
        name = base
        while name in self._names:
            self._names[base] += 1
            name = f"{base}.{self._names[base]}"
        self._names[name] = 1
        self._scene.add_node(name, place[:3, 3].copy())
        return name

    # Materials ------------------------------------------------------------------------------------

    def _material(self, node: Node, chart: Chart, local: Matrix) -> int:
        """Material of a shape; ``local``: scene from its mesh."""
        bsdf = node.nested_one("bsdf")
        emitter = node.nested_one("emitter")
        glow = Glow() if emitter is None else self._glow(emitter)
        sides = Sides(self._side(node, "interior", local), self._side(node, "exterior", local))
        return self._materials.index(bsdf, chart, glow, sides, emits=emitter is not None)

    def _side(self, node: Node, name: str, local: Matrix) -> Medium | None:
        found = node.find(name)
        if found is None:
            return None
        if not isinstance(found.value, Node) or found.value.kind != "medium":
            found.wrong("a medium")
        found.take()
        read = self._media.inside if name == "interior" else self._media.medium
        return read(found.value, local)

    def _glow(self, emitter: Node) -> Glow:
        """Light from a surface."""
        if emitter.plugin != "area":
            name = emitter.plugin[:40]
            leave_out(emitter, self._notes, f"an emitter {name!r} of a shape is left out")
            return Glow()
        emitter.skip("sampling_weight")
        radiance, texture = self._textures.tint(emitter, "radiance", 1.0, most=1e30)
        return Glow(emitted_rgb(radiance), texture)
