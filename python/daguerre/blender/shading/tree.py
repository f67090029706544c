"""Walks a tree of shaders from its ends to the surface."""

from __future__ import annotations

from dataclasses import replace

from daguerre.errors import InputError
from daguerre.shading.arithmetic import Arithmetic
from daguerre.shading.evaluate import Evaluator
from daguerre.shading.materialx.graph import Graph, Link

from .closures import Closure, added, is_diffuse, is_mirror, mixed
from .shaders import SHADERS, other
from .sockets import Sockets

_MIX, _ADD = "ShaderNodeMixShader", "ShaderNodeAddShader"
_PAIR = ("Shader", "Shader_001")
#: Nodes that give the share of light that an interface reflects.
_FRESNEL = ("ShaderNodeFresnel", "ShaderNodeLayerWeight")


class Tree:
    """Closures of the shaders of a graph; each is read once, without recursion.

    Args:
        graph: The graph.
        evaluator: Values of its nodes.
        math: Arithmetic between values.
    """

    def __init__(self, graph: Graph, evaluator: Evaluator, math: Arithmetic) -> None:
        self._graph = graph
        self._evaluator = evaluator
        self._math = math
        self._done: dict[str, Closure] = {}

    def surface(self) -> Closure:
        """Closure of the surface.

        Raises:
            InputError: Shaders are linked in a circle; the message names the node.
        """
        waiting, entered = [self._graph.surface], set[str]()
        while waiting:
            name = waiting[-1]
            missing = [one for one in self._before(name) if one not in self._done]
            if name not in self._done and missing:
                if name in entered:
                    place = self._graph.nodes[name].place
                    raise InputError(f"{place}: wanted links without a cycle, got one")
                entered.add(name)
                waiting += missing
                continue
            waiting.pop()
            if name not in self._done:
                self._done[name] = self._closure(name)
        return self._done[self._graph.surface]

    def _before(self, name: str) -> list[str]:
        """Names of the shaders that a node joins."""
        node = self._graph.nodes[name]
        if node.kind not in (_MIX, _ADD):
            return []
        return [one.node for key in _PAIR if isinstance(one := node.inputs.get(key), Link)]

    def _closure(self, name: str) -> Closure:
        given = self._evaluator.arguments(name)
        assert given is not None  # links lead to nodes of the graph
        sockets = Sockets(given)
        if given.node.kind in (_MIX, _ADD):
            return self._joined(sockets)
        return SHADERS.get(given.node.kind, other)(sockets)

    def _joined(self, sockets: Sockets) -> Closure:
        pair = []
        for key in _PAIR:
            link = sockets.given.node.inputs.get(key)
            pair.append(self._done[link.node] if isinstance(link, Link) else Closure())
        a, b = pair
        if sockets.given.node.kind == _ADD:
            found, exact = added(self._math, a, b)
            if not exact:
                sockets.note("a sum of shaders is not exact: one of them scatters light")
            return found
        share = self._math.fraction(sockets.one("Fac"))
        found, exact = mixed(self._math, a, b, share)
        if not exact:
            sockets.note("two kinds of shaders become one with mixed parameters")
        if self._by_fresnel(sockets) and found.surface is not None:
            found = self._rising(a, b, found)
        return found

    def _by_fresnel(self, sockets: Sockets) -> bool:
        link = sockets.given.node.inputs.get("Fac")
        return isinstance(link, Link) and self._graph.nodes[link.node].kind in _FRESNEL

    def _rising(self, a: Closure, b: Closure, found: Closure) -> Closure:
        """Gloss over diffuse light by Fresnel's share, which rises to 1 at grazing angles."""
        under, gloss, both = a.surface, b.surface, found.surface
        if under is None or gloss is None or both is None:
            return found
        if not (is_diffuse(under) and is_mirror(gloss)):
            return found
        color = self._math.multiply(both.specular_color, both.specular)
        lit = replace(both, base_color=under.base_color, specular=(1.0,), specular_color=color)
        return replace(found, surface=lit)
