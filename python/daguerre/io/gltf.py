"""glTF 2.0 into a scene: the page where container, nodes, meshes, materials and cameras meet.

Start here; each step has a file of its own beside this one (``gltf_*.py``). Whatever is wrong in
a file ends as one ``InputError`` that names file, JSON path, what was wanted and what was got.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError, UsageError
from daguerre.materials import Gltf, Material
from daguerre.scene import Scene

from .gltf_accessors import Accessors
from .gltf_animation import poses_at
from .gltf_cameras import read_camera
from .gltf_extensions import check_extensions
from .gltf_file import load_buffers, open_document
from .gltf_lights import light_items, read_light
from .gltf_materials import read_materials
from .gltf_meshes import Meshes
from .gltf_nodes import Placed, Tree, unique_names, without_scale
from .gltf_textures import Textures
from .json_item import Item
from .notes import Notes
from .uris import Folder

# Entries in all lists of ``Scene.nodes`` together: a deep chain of meshes would need the square.
_MAX_NODE_ENTRIES = 4_000_000


def read(
    path: str | os.PathLike[str],
    *,
    time: float = 0.0,
    scene_index: int | None = None,
    allow_dirs: Iterable[str | os.PathLike[str]] = (),
) -> Scene:
    """Reads a .glb or .gltf file.

    Args:
        path: The file.
        time: Moment at which animations are evaluated, s.
        scene_index: Which scene of the file; absent: its default.
        allow_dirs: Folders besides the file's own from which buffers and images may come.

    Returns:
        The scene; ``warnings`` says what was not understood.

    Raises:
        InputError: The file is unreadable or invalid.
    """
    if not math.isfinite(time):
        raise UsageError(f"time: wanted a finite number of seconds, got {time}")
    file = Path(path)
    # Absurd but finite numbers may overflow on the way; results are checked where they matter.
    with np.errstate(all="ignore"):
        return _Reader(file, float(time), Folder(file, allow_dirs)).read(scene_index)


class _Reader:
    def __init__(self, path: Path, time: float, folder: Folder) -> None:
        self.notes = Notes()
        self.scene = Scene(path=path, time=time)
        self.document = open_document(path, folder)
        self.root = self.document.root
        check_extensions(self.root, self.notes)
        if self.document.trailing:
            self.notes.add("a byte behind the stated end of the file", self.document.trailing)
        self.accessors = Accessors(self.root, load_buffers(self.document))
        self.tree = Tree(self.root)
        self.meshes = Meshes(self.root, self.accessors, self.scene, self.notes)
        self.cameras = self.root.list_of("cameras")
        self.lights = light_items(self.root)
        self.skins = self.root.list_of("skins")
        self.names = unique_names(self.tree, self.meshes.items, self.cameras)
        self._default_material: int | None = None

    def read(self, scene_index: int | None) -> Scene:
        scene = self.scene
        textures = Textures(self.document, self.accessors, self.notes)
        scene.materials = read_materials(self.root, textures, self.notes)
        textures.decode(scene)
        poses = poses_at(self.root, self.accessors, len(self.tree.items), scene.time, self.notes)
        placed = self.tree.place(self.tree.roots(self._scene_item(scene_index)), poses)
        firsts = []
        for position in placed:
            firsts.append(len(scene.instances))
            self._node(position)
        self._collect(placed, [*firsts, len(scene.instances)])
        scene.warnings = self.notes.sentences()
        return scene

    def _scene_item(self, index: int | None) -> Item | None:
        scenes = self.root.list_of("scenes")
        chosen = self.root.get("scene")
        if index is not None:
            if not 0 <= index < len(scenes):
                raise InputError(
                    f"{self.root.file}: scenes: wanted an index in 0 .. {len(scenes) - 1}, "
                    f"got {index}"
                )
            return scenes[index]
        if chosen is not None:
            return scenes[chosen.index(len(scenes), "scenes")]
        if not scenes:
            self.notes.add("the file names no scene: all its nodes are shown")
            return None
        return scenes[0]

    def _node(self, placed: Placed) -> None:
        item, name = self.tree.items[placed.index], self.names[placed.index]
        self.scene.node_positions[name] = placed.world[:3, 3].copy()
        mesh, camera = item.get("mesh"), item.get("camera")
        skin, light = item.get("skin"), item.extension("KHR_lights_punctual")
        if skin is not None:
            skin.index(len(self.skins), "skins")
            self.notes.add("a mesh with a skin is shown in its rest pose")
        if mesh is not None:
            for part, material in self.meshes.parts(mesh.index(len(self.meshes.items), "meshes")):
                self._instance(part, material, placed.world, name)
        if camera is not None:
            self._camera(self.cameras[camera.index(len(self.cameras), "cameras")], placed, name)
        if light is not None:
            chosen = self.lights[light.need("light").index(len(self.lights), "lights")]
            self._light(chosen, placed, name)

    def _instance(
        self, mesh: int, material: int | None, world: NDArray[np.float64], name: str
    ) -> None:
        if material is None:
            if self._default_material is None:
                self._default_material = self.scene.add_material(Material(Gltf(), name="default"))
            material = self._default_material
        self._note_missing_uv(mesh, material)
        rank = _rank(world[:3, :3])
        if rank < 2:  # scale 0 is how files hide things (glTF 2.0, 3.5.3)
            self.notes.add("a mesh that its node scales to nothing is left out")
            return
        if rank == 2:  # squashed flat: no inverse, so the world's vertices are written down
            flat = self.scene.meshes[mesh]
            points = flat.positions @ world[:3, :3].T + world[:3, 3]
            mesh = self.scene.add_mesh(
                points, flat.indices, None, flat.uv, uv1=flat.uv1, colors=flat.colors, name=name
            )
            world = np.eye(4)
        self.scene.add_instance(mesh, material, world, name=name)

    def _note_missing_uv(self, mesh: int, material: int) -> None:
        kind = self.scene.materials[material].kind
        arrays = (self.scene.meshes[mesh].uv, self.scene.meshes[mesh].uv1)
        for key, slot in vars(kind).items():
            if key.endswith("_texture") and slot is not None and arrays[slot.uv_set] is None:
                self.notes.add("a textured mesh lacks the texture coordinates that it needs")
                return

    def _camera(self, item: Item, placed: Placed, name: str) -> None:
        rigid = without_scale(placed.world)
        if rigid is None:
            self.tree.items[placed.index].fail(
                "wanted a transform that leaves its camera a direction, got a scale of 0"
            )
        camera = read_camera(item, rigid, self.notes)
        if camera is not None:
            self.scene.add_camera(name, camera)
            if item.name():
                self.scene.camera_aliases.setdefault(item.name(), name)

    def _light(self, item: Item, placed: Placed, name: str) -> None:
        light = read_light(item, name)
        rigid = without_scale(placed.world)
        if rigid is None:
            self.notes.add("a light whose node is scaled to nothing is left out")
            return
        self.scene.add_light(light, rigid)

    def _collect(self, placed: list[Placed], firsts: list[int]) -> None:
        """Instances of each node and its descendants: one run of numbers, as parents come first."""
        left = _MAX_NODE_ENTRIES
        for position, node in enumerate(placed):
            first, last = firsts[position], firsts[node.end]
            left -= last - first
            if left < 0:
                self.notes.add("a node too deep in the tree stands for its own meshes only")
                last = firsts[position + 1]
            self.scene.nodes[self.names[node.index]] = list(range(first, last))


def _rank(linear: NDArray[np.float64]) -> int:
    """Dimensions that a transform leaves; 2 also where its float determinant would vanish."""
    volume, size = abs(float(np.linalg.det(linear))), float(np.abs(linear).max())
    if volume > 1e-30 and volume > 1e-12 * size**3:
        return 3
    rank = int(np.linalg.matrix_rank(linear, tol=1e-12 * size))
    return min(rank, 2) if volume <= 1e-30 else rank
