"""Reads glTF 2.0 as a scene: joins container, nodes, meshes, materials and cameras.

Start reading here; each other module of this folder reads one part of glTF. A fault in a file
raises an ``InputError`` with the file, the JSON path, the wanted value and the value found.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable
from functools import partial
from pathlib import Path

import numpy as np

from daguerre.checks import short
from daguerre.errors import InputError, MismatchError, UsageError
from daguerre.files.budget import Budget
from daguerre.files.json_item import Item
from daguerre.files.notes import Notes, Silence
from daguerre.files.uris import Folder
from daguerre.scene.scene import Scene
from daguerre.scene.transforms import without_scale

from .accessors import Accessors
from .animation import Animations
from .cameras import read_camera
from .catchers import mark_catcher
from .extensions import check_extensions
from .file import Document, load_buffers, open_document
from .images import Images
from .instancing import instance_transforms
from .lights import light_items, read_light
from .materials import read_material, read_materials
from .meshes import Meshes
from .moving import MotionReader
from .nodes import Placed, Tree, unique_names
from .placing import Placing
from .poses import Poses
from .skins import Skins
from .textures import Textures
from .variants import Variants

# Limit of entries in all lists of ``Scene.nodes``, which grow quadratically with nesting.
_MAX_NODE_ENTRIES = 4_000_000
# Least limit of vertices that morphs, skins and nodes of zero scale copy; grows with the file.
_MAX_COPIES = 1 << 24
_BYTES_PER_COPY = 4


def read(
    path: str | os.PathLike[str],
    *,
    time: float = 0.0,
    scene_index: int | None = None,
    variant: str | None = None,
    allow_dirs: Iterable[str | os.PathLike[str]] = (),
    animated: bool = False,
) -> Scene:
    """Reads a .glb or .gltf file.

    A .glb may also contain the exact scene of Daguerre (``scene/packed``), at time 0 s. It is read
    instead of the glTF content, unless a time, a scene, a variant or animation is requested.

    Args:
        path: The file.
        time: Time at which animations are evaluated, s.
        scene_index: Index of the scene in the file; default: the file's default scene.
        variant: Name of a variant of the materials (KHR_materials_variants); default: none.
        allow_dirs: Folders for buffers and images, in addition to the file's own.
        animated: Whether other moments of the animation will be drawn, too.

    Returns:
        The scene; ``warnings`` has notes on unsupported content.

    Raises:
        InputError: The file cannot be read or is invalid.
    """
    if not math.isfinite(time):
        raise UsageError(f"time: wanted a finite number of seconds, got {time}")
    if not isinstance(variant, str | None):
        raise UsageError(f"{path}: variant: wanted one name, got {short(variant)}")
    file = Path(path)
    # Huge finite numbers may overflow in between; results are checked.
    with np.errstate(all="ignore"):
        document, notes = open_document(file, Folder(file, allow_dirs)), Notes()
        if document.packed is not None:
            needs_gltf = animated or time != 0 or (variant, scene_index) != (None, None)
            found = _packed(document.packed, file, notes, needs_gltf=needs_gltf)
            if found is not None:
                return found
        return _GltfReader(file, float(time), variant, document, notes).read(scene_index)


def _packed(chunk: memoryview, path: Path, notes: Notes, *, needs_gltf: bool) -> Scene | None:
    """Reads the exact scene; None, with a note, if another version wrote it or ``needs_gltf``."""
    if needs_gltf:
        notes.add(
            "the exact scene is stored for the time of its export only: plain glTF is read instead"
        )
        return None
    from daguerre.scene.packed.chunk import scene_of

    try:
        return scene_of(chunk, path)
    except MismatchError as error:
        notes.add(f"exact scene: {error}: plain glTF is read instead")
        return None


class _GltfReader:
    def __init__(
        self, path: Path, time: float, variant: str | None, document: Document, notes: Notes
    ) -> None:
        self.notes = notes
        self.scene = Scene(path=path, time=time)
        self.document = document
        self.root = self.document.root
        check_extensions(self.root, self.notes)
        if self.document.trailing:
            self.notes.add("a byte after the stated end of the file", self.document.trailing)
        buffers = load_buffers(self.document)
        self.accessors = Accessors(self.root, buffers)
        # Animations change the JSON, so they come before all other parts.
        self.animations = Animations(self.root, self.accessors, time, self.notes)
        self.scene.set_clock(self.animations.duration)
        self.tree = Tree(self.root)
        self.poses = Poses(self.tree, self.animations)
        skins = Skins(self.root, self.accessors, self.tree, self.poses, self.notes)
        limit = max(_MAX_COPIES, sum(map(len, buffers)) // _BYTES_PER_COPY)
        unshared = Budget(limit, "vertices that are not shared")
        variants = Variants(self.root, variant)
        for name in variants.names:
            self.scene.add_variant(name)
        self.meshes = Meshes(
            self.root,
            self.accessors,
            self.animations,
            skins,
            variants,
            self.scene,
            unshared,
            self.notes,
        )
        self.placing = Placing(self.scene, unshared, self.notes)
        self.moving = MotionReader(self.root, self.animations, self.poses, time)
        self.cameras = self.root.list_of("cameras")
        self.lights = light_items(self.root)
        self.names = unique_names(self.tree, self.meshes.items, self.cameras)

    def read(self, scene_index: int | None) -> Scene:
        scene = self.scene
        images = Images(self.document, self.accessors)
        textures = Textures(self.root, images.same, images.missing, self.notes)
        materials = read_materials(self.root, textures, self.notes)
        images.decode(textures.plans, scene)
        read_moment = partial(read_material, textures=textures.silenced(), notes=Silence())
        for index, material in enumerate(materials):
            scene.add_material(material, motion=self.moving.material(index, read_moment))
        placed = self.tree.place(self.tree.roots(self._scene_item(scene_index)))
        firsts = []
        for node in placed:
            firsts.append(len(scene.instances))
            self._node(node)
        self._collect(placed, [*firsts, len(scene.instances)])
        for node in placed:
            mark_catcher(scene, self.names[node.index], self.tree.items[node.index])
        scene.note(*self.notes.sentences())
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
            self.notes.add("the file has no scene: all nodes are shown")
            return None
        return scenes[0]

    def _node(self, placed: Placed) -> None:
        item, name = self.tree.items[placed.index], self.names[placed.index]
        position = placed.world[:3, 3].copy()
        self.scene.add_node(name, position, motion=self.moving.position(placed.index))
        mesh, camera = item.get("mesh"), item.get("camera")
        light = item.extension("KHR_lights_punctual")
        shown = placed.visible or self.poses.blinks(placed.index)
        if mesh is not None and shown:
            self._mesh(item, placed, name)
        if camera is not None:
            self._camera(self.cameras[camera.index(len(self.cameras), "cameras")], placed, name)
        if light is not None and shown:
            chosen = self.lights[light.need("light").index(len(self.lights), "lights")]
            self._light(chosen, placed, name)

    def _mesh(self, node: Item, placed: Placed, name: str) -> None:
        instances = instance_transforms(node, self.accessors, self.notes)
        world = placed.world
        for part in self.meshes.parts(node):
            worlds = world[None] if instances is None else world @ instances
            if part.in_world:
                worlds = np.eye(4)[None]
                if instances is not None:
                    self.notes.add("a mesh that a skin moves is shown once, not at its instances")
            moves = self.moving.instances(
                placed.index, None if part.in_world else instances, worlds, rigid=part.in_world
            )
            self.placing.add(node, part.mesh, part.material, worlds, name, moves)

    def _camera(self, item: Item, placed: Placed, name: str) -> None:
        node, rigid = self.tree.items[placed.index], without_scale(placed.world)
        if rigid is None:
            node.fail("the node scales its camera by 0")
        camera = read_camera(item, rigid, self.notes)
        if camera is not None:
            camera = self.moving.camera(camera, item, node)
            self.scene.add_camera(name, camera, alias=item.name())

    def _light(self, item: Item, placed: Placed, name: str) -> None:
        light = read_light(item, name)
        motion = self.moving.light(partial(read_light, name=name), item, placed.index)
        rigid = without_scale(placed.world)
        if motion is not None:
            current, transform = motion.at(self.scene.time)
            self.scene.add_light(current, transform, motion=motion)
        elif rigid is None:
            self.notes.add("a light whose node is scaled to zero is left out")
        else:
            self.scene.add_light(light, rigid)

    def _collect(self, placed: list[Placed], firsts: list[int]) -> None:
        """Groups instances of each node and its descendants, which are contiguous."""
        left = _MAX_NODE_ENTRIES
        for place, node in enumerate(placed):
            first, last = firsts[place], firsts[node.end]
            left -= last - first
            if left < 0:
                self.notes.add("the name of a node deep in the tree selects its own meshes only")
                last = firsts[place + 1]
            self.scene.group_instances(self.names[node.index], range(first, last))
