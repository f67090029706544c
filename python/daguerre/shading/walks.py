"""Walks through a graph of shading nodes that need no values."""

from __future__ import annotations

from daguerre.motion.values import Keys
from daguerre.shading.materialx.graph import Graph, Link


def names_before(graph: Graph, ignored: frozenset[str]) -> list[str]:
    """Names of the nodes that the surface uses, but not by the ignored inputs.

    Nodes of the colour come first, then nodes of the other inputs in the order of their names.
    """
    surface = graph.nodes.get(graph.surface)
    if surface is None:
        return []
    links = [
        value.node
        for name in sorted(surface.inputs, key=_color_first)
        if isinstance(value := surface.inputs[name], Link) and name not in ignored
    ]
    order: dict[str, None] = {}
    waiting = links[::-1]
    while waiting:
        name = waiting.pop()
        node = graph.nodes.get(name)
        if node is None or name in order:
            continue
        order[name] = None
        inner = [value.node for value in node.inputs.values() if isinstance(value, Link)]
        waiting += inner[::-1]
    return list(order)


def _color_first(name: str) -> tuple[bool, str]:
    return name not in ("diffuseColor", "base_color"), name


def moving_nodes(graph: Graph) -> frozenset[str]:
    """Names of the nodes that have keys among their inputs, or depend on a node with keys."""
    users: dict[str, list[str]] = {}
    waiting = []
    for name, node in graph.nodes.items():
        for value in node.inputs.values():
            if isinstance(value, Link):
                users.setdefault(value.node, []).append(name)
            elif isinstance(value.value, Keys):
                waiting.append(name)
    found: set[str] = set()
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += users.get(name, [])
    return frozenset(found)
