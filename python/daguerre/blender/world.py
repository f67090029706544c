"""Reads the world of Blender as the light from infinity.

A background of one colour is a colour; an environment texture is its own picture, turned. Other
nodes are drawn by Cycles into a panorama (``world_bake.py``), where Blender lets us.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes
from daguerre.scene.scene import Scene

from .settings import LUMENS_PER_WATT
from .world_bake import baked
from .world_texture import environment_texture

if TYPE_CHECKING:
    import bpy

#: Largest value of a picture.
_MOST = 1e30


def set_world(scene: Scene, world: bpy.types.World | None, notes: Notes) -> None:
    """Sets the environment of a scene; without a world it is black.

    Args:
        scene: Receives the environment.
        world: Evaluated world.
        notes: Receives notes on unsupported content.
    """
    if world is None:
        return
    if world.node_tree is None:
        _set_color(scene, tuple(world.color), 1.0)
        return
    surface, volume = _output(world)
    if volume is not None:
        notes.add("the volume of a world is left out")
    if surface is None:
        return
    color, strength = surface.inputs.get("Color"), surface.inputs.get("Strength")
    plain = surface.bl_idname == "ShaderNodeBackground" and not strength.is_linked
    if plain and not color.is_linked:
        _set_color(scene, tuple(color.default_value)[:3], float(strength.default_value))
        return
    if plain:
        node = color.links[0].from_node
        picture = environment_texture(node, notes)
        if picture is not None:
            _set_picture(scene, picture, float(strength.default_value))
            return
    picture = baked(world, notes)
    if picture is not None:
        _set_picture(scene, picture, 1.0)


def _output(world: bpy.types.World) -> tuple[Any, Any]:
    """Nodes behind the surface and the volume of the active output of a world."""
    outputs = [n for n in world.node_tree.nodes if n.bl_idname == "ShaderNodeOutputWorld"]
    chosen = next((n for n in outputs if n.is_active_output), None)
    if chosen is None:
        return None, None
    links = [chosen.inputs[name].links for name in ("Surface", "Volume")]
    surface, volume = (found[0].from_node if found else None for found in links)
    return surface, volume


def _set_color(scene: Scene, color: tuple[float, ...], strength: float) -> None:
    red, green, blue = (min(max(0.0, c * strength * LUMENS_PER_WATT), _MOST) for c in color)
    if max(red, green, blue) > 0:
        scene.set_environment(color=(red, green, blue))


def _set_picture(scene: Scene, picture: NDArray[np.float32], strength: float) -> None:
    if strength > 0:
        clean = np.clip(np.nan_to_num(picture, nan=0.0), 0.0, _MOST).astype(np.float32)
        scene.set_environment(clean, scale=strength * LUMENS_PER_WATT)
