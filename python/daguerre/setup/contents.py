"""Parts of a scene by name: nodes under the names that ``focus_on`` and catchers take."""

from __future__ import annotations

from typing import Any

from daguerre.scene.scene import Scene


def contents(scene: Scene) -> dict[str, Any]:
    """Lists nodes, materials, lamps and other names of cameras.

    Returns:
        ``nodes``: Name, number of ``instances`` including descendants (0: no catcher), and
        ``position_m`` (None: unknown) of each. ``material_names``: "" is a material without a
        name. ``lamps``: ``name``, ``kind`` and ``position_m``. ``camera_aliases``: Other names of
        cameras.
    """
    names = dict.fromkeys([*scene.nodes, *scene.node_positions])
    return {
        "nodes": [_node(scene, name) for name in names],
        "material_names": [material.name for material in scene.materials],
        "lamps": [
            {"name": light.name, "kind": type(light).__name__, "position_m": world[:3, 3].tolist()}
            for light, world in scene.lights
        ],
        "camera_aliases": dict(scene.camera_aliases),
    }


def _node(scene: Scene, name: str) -> dict[str, Any]:
    place = scene.node_positions.get(name)
    return {
        "name": name,
        "instances": len(scene.nodes.get(name, ())),
        "position_m": None if place is None else place.tolist(),
    }
