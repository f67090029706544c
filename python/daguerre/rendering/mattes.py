"""Mattes of a picture: names of the film's objects, and their coverage."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

import daguerre._core as _core
from daguerre.frame.cryptomatte import Cryptomatte, hash_of
from daguerre.scene.lights import PointLight, SphereLight
from daguerre.scene.scene import Scene

#: Names for objects without a name.
UNNAMED, LIGHT = "unnamed", "light"


def matte_facts(scene: Scene, layers: Sequence[str], ranks: int) -> dict[str, Any] | None:
    """Names of a film's objects, as plain values that are stored with its sums.

    Args:
        scene: The scene.
        layers: Layers, see ``frame.cryptomatte.LAYERS``.
        ranks: Number of names to keep for each pixel.

    Returns:
        ``ranks``, and for each of ``layers`` its ``names`` and the index of the name of each object
        (``of``): instances first, then sphere lights. None: there are no layers.
    """
    made = {layer: _numbered(_NAMES[layer](scene)) for layer in layers}
    return {"ranks": ranks, "layers": made} if made else None


def _numbered(names: list[str]) -> dict[str, list[Any]]:
    numbers: dict[str, int] = {}
    of = [numbers.setdefault(name, len(numbers)) for name in names]
    return {"names": list(numbers), "of": of}


def _objects(scene: Scene) -> list[str]:
    return [i.name or scene.meshes[i.mesh].name or UNNAMED for i in scene.instances] + [
        light.name or LIGHT for light in _spheres(scene)
    ]


def _materials(scene: Scene) -> list[str]:
    names = [material.name or UNNAMED for material in scene.materials]
    return [names[i.material] for i in scene.instances] + [LIGHT for _ in _spheres(scene)]


def _assets(scene: Scene) -> list[str]:
    """Names of the topmost nodes: for each instance, the node with the most instances.

    A scene lists a node before its children, so the first of two equal nodes is the parent.
    """
    names = _objects(scene)
    size = [0] * len(names)
    for node, instances in scene.nodes.items():
        for i in instances:
            if len(instances) > size[i]:
                names[i], size[i] = node, len(instances)
    return names


_NAMES = {"object": _objects, "material": _materials, "asset": _assets}


def _spheres(scene: Scene) -> list[PointLight | SphereLight]:
    """Lights that the core draws as spheres, in its order."""
    return [
        light
        for light, _ in scene.lights
        if isinstance(light, SphereLight) or (isinstance(light, PointLight) and light.radius > 0)
    ]


def mattes_of(
    film: _core.Film, facts: Mapping[str, Any]
) -> tuple[dict[str, Cryptomatte], int, float]:
    """Mattes of a film.

    Args:
        film: A film with objects.
        facts: Result of ``matte_facts``.

    Returns:
        Mattes by layer, number of pixels with more names than ranks, and the largest coverage that
        is lost in any of these.
    """
    found: dict[str, Cryptomatte] = {}
    cut, most = 0, 0.0
    for layer, names in facts["layers"].items():
        hashes = np.array([hash_of(name) for name in names["names"]], np.uint32)
        of = np.asarray(names["of"], np.intp)
        ids, shares, pixels, left = film.ranked(hashes[of], facts["ranks"])
        manifest = dict(zip(names["names"], hashes.tolist(), strict=True))
        found[layer] = Cryptomatte(np.asarray(ids), np.asarray(shares), manifest)
        cut, most = max(cut, int(pixels)), max(most, float(left))
    return found, cut, most
