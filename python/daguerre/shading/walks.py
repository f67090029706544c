"""Walks through a graph of shading nodes that need no values."""

from __future__ import annotations

from daguerre.motion.values import Keys
from daguerre.shading.materialx.graph import Constant, Graph, Link


def names_before(graph: Graph, ignored: frozenset[str]) -> list[str]:
    """Names of the nodes that the surface uses, but not by the ignored inputs.

    Those of the colour come first, then those of the other inputs in the order of their names.
    """
    surface = graph.nodes.get(graph.surface)
    if surface is None:
        return []
    links = [
        one.node
        for name, one in sorted(surface.inputs.items(), key=_color_first)
        if isinstance(one, Link) and name not in ignored
    ]
    order: dict[str, None] = {}
    waiting = links[::-1]
    while waiting:
        name = waiting.pop()
        node = graph.nodes.get(name)
        if node is None or name in order:
            continue
        order[name] = None
        inner = [one.node for one in node.inputs.values() if isinstance(one, Link)]
        waiting += inner[::-1]
    return list(order)


def _color_first(item: tuple[str, Constant | Link]) -> tuple[bool, str]:
    return item[0] not in ("diffuseColor", "base_color"), item[0]


def moving_nodes(graph: Graph) -> frozenset[str]:
    """Names of the nodes that have keys among their inputs, or depend on one that has."""
    users: dict[str, list[str]] = {}
    waiting = []
    for name, node in graph.nodes.items():
        for one in node.inputs.values():
            if isinstance(one, Link):
                users.setdefault(one.node, []).append(name)
            elif isinstance(one.value, Keys):
                waiting.append(name)
    found: set[str] = set()
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += users.get(name, [])
    return frozenset(found)
