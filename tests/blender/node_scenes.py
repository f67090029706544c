"""Node trees of tests: what Daguerre's material shines, and what Cycles renders."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

import daguerre as dg
from daguerre.blender.materials import Materials
from daguerre.files.notes import Notes
from daguerre.scene.materials import Gltf
from tests.support.blender import blender_pictures

SIZE = 8
CD_PER_W = 683.0
Array = NDArray[Any]


def emptied() -> None:
    """Empties Blender."""
    bpy.ops.wm.read_factory_settings(use_empty=True)


def _with_nodes(owner: Any) -> None:
    """Gives a material or a world its nodes, which Blender 5 and later do by themselves."""
    if owner.node_tree is None:
        owner.use_nodes = True


def picture(name: str, pixels: Array, space: str = "Non-Color", *, floats: bool = True) -> Any:
    """Image of pixels (H, W, 4), row 0 on top."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=floats)
    image.colorspace_settings.name = space
    image.pixels.foreach_set(np.ascontiguousarray(pixels[::-1], np.float32).ravel())
    image.update()
    return image


def random_picture(name: str, seed: int, low: float = 0.0, high: float = 1.0) -> Any:
    """Opaque image of random numbers."""
    pixels = np.ones((SIZE, SIZE, 4))
    pixels[:, :, :3] = np.random.default_rng(seed).uniform(low, high, (SIZE, SIZE, 3))
    return picture(name, pixels)


class Tree:
    """A material with a tree of nodes.

    Attributes:
        material: The material.
        nodes: Its nodes.
        links: Its links.
    """

    def __init__(self, name: str = "M") -> None:
        self.material = bpy.data.materials.new(name)
        _with_nodes(self.material)
        self.nodes, self.links = self.material.node_tree.nodes, self.material.node_tree.links
        self.nodes.clear()
        self.output = self.nodes.new("ShaderNodeOutputMaterial")

    def node(self, kind: str, inputs: dict[Any, Any] | None = None, **properties: Any) -> Any:
        """A new node; inputs by name or number are values, or sockets to link."""
        node = self.nodes.new(f"ShaderNode{kind}")
        for key, value in properties.items():
            setattr(node, key, value)
        for key, value in (inputs or {}).items():
            socket = next((s for s in node.inputs if key == s.identifier), None)
            socket = node.inputs[key] if socket is None else socket
            if isinstance(value, bpy.types.NodeSocket):
                self.links.new(value, socket)
            elif socket.type == "RGBA" and len(value) == 3:
                socket.default_value = (*value, 1.0)
            else:
                socket.default_value = value
        return node

    def surface(self, shader: Any) -> None:
        """Links a shader to the surface."""
        self.links.new(shader.outputs[0], self.output.inputs["Surface"])

    def shine(self, socket: Any) -> None:
        """Emits a value."""
        self.surface(self.node("Emission", {"Color": socket}))

    def texture(self, image: Any, **properties: Any) -> Any:
        """Image texture whose texels are squares."""
        properties = {"interpolation": "Closest", **properties}
        return self.node("TexImage", image=image, **properties)


class Read:
    """A material as it comes into a scene."""

    def __init__(self, material: Any) -> None:
        self.notes, self.scene = Notes(), dg.Scene()
        self.materials = Materials(self.scene, self.notes)
        self.index = self.materials.index(material)
        self.material = self.scene.materials[self.index]
        kind = self.material.kind
        assert isinstance(kind, Gltf)
        self.kind = kind

    @property
    def sentences(self) -> list[str]:
        """Notes."""
        return self.notes.sentences()

    def pixels(self, slot: Any) -> Array:
        """Texels of a texture (H, W, C)."""
        return np.asarray(self.scene.textures[slot.texture].pixels)

    def shines(self) -> Array:
        """Emission in Blender's units: (3,), or (H, W, 3) if it is a picture."""
        factor = np.array(self.kind.emissive) / CD_PER_W
        slot = self.kind.emissive_texture
        if slot is None:
            return factor
        pixels = self.pixels(slot)
        assert pixels.dtype == np.float32
        return pixels[:, :, :3] * factor


def stage(material: Any, light: float = 0.0, size: int = SIZE) -> None:
    """A square with the material, seen from above by a camera without perspective."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.cycles.samples = 1
    scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01
    world = bpy.data.worlds.new("World")
    _with_nodes(world)
    background = next(n for n in world.node_tree.nodes if n.bl_idname == "ShaderNodeBackground")
    background.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    background.inputs["Strength"].default_value = light
    scene.world = world
    bpy.ops.mesh.primitive_plane_add(size=2)
    bpy.context.object.data.materials.append(material)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 2.0
    camera.location = (0, 0, 5)
    scene.collection.objects.link(camera)
    scene.camera = camera


def cycles(folder: Path, samples: int = 1) -> Array:
    """Picture of the stage by Cycles (H, W, 3), row 0 on top."""
    bpy.context.scene.cycles.samples = samples
    return np.asarray(blender_pictures.drawn(folder / "cycles.exr"))
