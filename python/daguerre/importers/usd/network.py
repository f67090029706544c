"""Graph of shading nodes from a network of USD.

Source: OpenUSD, UsdShade; names of MaterialX's definitions in ``info:id`` (ND_image_color3) lose
their prefix and types.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, Protocol

from pxr import Gf, Sdf, Tf, Usd, UsdShade

from daguerre.errors import InputError
from daguerre.files.json_item import short
from daguerre.files.notes import Notes
from daguerre.importers.usd.anchored import anchored
from daguerre.motion.values import Keys
from daguerre.shading.materialx.graph import MAX_NODES, Constant, Graph, Link, Node

#: Most connections from an input through node graphs.
_MAX_HOPS = 1000
#: Render contexts, the preferred first.
_CONTEXTS = ("mtlx", "")
_TYPES = {
    **{"float": "float", "half": "float", "double": "float", "int": "integer", "bool": "boolean"},
    **{"float2": "vector2", "texCoord2f": "vector2", "float3": "vector3", "vector3f": "vector3"},
    **{"normal3f": "vector3", "point3f": "vector3", "float4": "vector4"},
    **{"color3f": "color3", "color3h": "color3", "color4f": "color4", "color4h": "color4"},
}
_VECTORS = (
    Gf.Vec2f,
    Gf.Vec3f,
    Gf.Vec4f,
    Gf.Vec2d,
    Gf.Vec3d,
    Gf.Vec4d,
    Gf.Vec2h,
    Gf.Vec3h,
    Gf.Vec4h,
)


class Clock(Protocol):
    """Time of a stage, as in :mod:`daguerre.importers.usd.values`."""

    def value(self, attribute: object) -> Any:
        """Value of an attribute: a constant, or keys over time."""


class Networks:
    """Reads networks.

    Args:
        known: Names of the nodes that are supported.
        clock: Time of the stage.
        notes: Receives notes on unsupported content.
    """

    def __init__(self, known: Collection[str], clock: Clock, notes: Notes) -> None:
        self._known = known
        self._clock = clock
        self._notes = notes

    def graph(self, material: UsdShade.Material) -> Graph | None:
        """Graph of a material; None: no surface.

        Raises:
            InputError: A value is wrong, or connections never end; the message names the prim.
        """
        surface = self._terminal(material, "surface")
        if surface is None:
            return None
        nodes: dict[str, Node] = {}
        waiting = [surface]
        while waiting:
            shader = waiting.pop()
            name = str(shader.GetPath())
            if name in nodes:
                continue
            if len(nodes) >= MAX_NODES:
                raise InputError(f"{name}: too many shading nodes: the limit is {MAX_NODES}")
            nodes[name] = self._node(shader)
            stage = shader.GetPrim().GetStage()
            for value in nodes[name].inputs.values():
                if isinstance(value, Link) and value.node not in nodes:
                    waiting.append(UsdShade.Shader(stage.GetPrimAtPath(value.node)))
        other = self._terminal(material, "displacement")
        # A preview surface has an input for it, which its reader looks at.
        displaced = other is not None and other.GetPath() != surface.GetPath()
        return Graph(nodes, str(surface.GetPath()), displaced)

    def _terminal(self, material: UsdShade.Material, name: str) -> UsdShade.Shader | None:
        """Shader of an output of a material.

        Supported shaders come first, then the order of render contexts.
        """
        first = None
        for context in _CONTEXTS:
            attribute = material.GetPrim().GetAttribute(
                f"outputs:{context}:{name}" if context else f"outputs:{name}"
            )
            if attribute:
                found = self._source(attribute)
                if isinstance(found, Link):
                    prim = material.GetPrim().GetStage().GetPrimAtPath(found.node)
                    shader = UsdShade.Shader(prim)
                    if self._kind_of(prim) in self._known:
                        return shader
                    first = first or shader
        return first

    def _node(self, shader: UsdShade.Shader) -> Node:
        prim = shader.GetPrim()
        outputs = shader.GetOutputs()
        kind_of = _TYPES.get(str(outputs[0].GetTypeName()), "") if outputs else ""
        inputs: dict[str, Constant | Link] = {}
        for given in shader.GetInputs():
            found = self._source(given.GetAttr())
            if found is not None:
                inputs[str(given.GetBaseName())] = found
        return Node(self._kind_of(prim), kind_of, inputs, str(prim.GetPath()))

    def _kind_of(self, prim: Usd.Prim) -> str:
        """Kind of a shader; for another language, such as MDL, its name there."""
        identifier = prim.GetAttribute("info:id").Get()
        if identifier:
            return self._kind(str(identifier))
        for name in prim.GetAuthoredPropertyNames():
            if name.startswith("info:") and name.endswith(":subIdentifier"):
                return str(prim.GetAttribute(name).Get() or "")
        return "without an id"

    def _kind(self, identifier: str) -> str:
        """Name of the node's definition: the longest known beginning of a MaterialX name."""
        if not identifier.startswith("ND_"):
            return identifier
        words = identifier[3:].split("_")
        for count in range(len(words), 0, -1):
            name = "_".join(words[:count])
            if name in self._known:
                return name
        return identifier

    def _source(self, attribute: Usd.Attribute) -> Constant | Link | None:
        """Follows connections through node graphs to a shader or a value."""
        stage, first = attribute.GetPrim().GetStage(), attribute
        for _ in range(_MAX_HOPS):
            targets = attribute.GetConnections()
            if not targets:
                return self._constant(attribute)
            target = targets[0]
            prim = stage.GetPrimAtPath(target.GetPrimPath())
            if prim and prim.IsA(UsdShade.Shader) and target.name.startswith("outputs:"):
                return Link(str(prim.GetPath()), target.name[len("outputs:") :])
            following = stage.GetAttributeAtPath(target) if prim else None
            if not following:
                self._notes.add("a connection of a material to a missing node is left out")
                return self._constant(attribute)
            attribute = following
        raise InputError(f"{first.GetPath()}: connections form a cycle")

    def _constant(self, attribute: Usd.Attribute) -> Constant | None:
        if not attribute or not attribute.HasValue():
            return None
        try:
            value = self._value(attribute)
        except Tf.ErrorException:
            return None
        space = str(attribute.GetColorSpace()) if attribute.HasColorSpace() else ""
        if isinstance(value, Sdf.AssetPath):
            return Constant(_absolute(attribute, value), space)
        if isinstance(value, str):
            return Constant(value)
        if isinstance(value, Keys):
            return Constant(value, space)
        numbers = _numbers(value)
        if numbers is None:
            self._notes.add(f"an input of type {short(str(attribute.GetTypeName()))} is left out")
            return None
        colored = str(attribute.GetTypeName()).startswith("color")
        return Constant(numbers, space or (_space_of_prim(attribute) if colored else ""))

    def _value(self, attribute: Usd.Attribute) -> Any:
        if attribute.ValueMightBeTimeVarying():
            if str(attribute.GetTypeName()) not in _TYPES:
                self._notes.add("a name or file of a material that changes keeps its first value")
                return attribute.Get(Usd.TimeCode.EarliestTime())
            moving = self._clock.value(attribute)
            if not isinstance(moving, Keys) or isinstance(moving.values[0], float | int | tuple):
                return moving
            rows = tuple(_numbers(value) for value in moving.values)
            if all(row is not None for row in rows):
                return Keys(moving.times, rows, moving.interpolation)
            return attribute.Get(Usd.TimeCode.EarliestTime())
        return attribute.Get(Usd.TimeCode.EarliestTime())


def _numbers(value: Any) -> tuple[float, ...] | None:
    if isinstance(value, bool | int | float):
        return (float(value),)
    if isinstance(value, _VECTORS) or (isinstance(value, tuple) and len(value) <= 4):
        return tuple(float(number) for number in value)
    if hasattr(value, "shape") and value.shape in ((2,), (3,), (4,)):
        return tuple(float(number) for number in value)
    return None


def _absolute(attribute: Usd.Attribute, value: Sdf.AssetPath) -> str:
    """Path of an asset: resolved, or relative to the layer that names it (UDIM, missing files)."""
    if value.resolvedPath or not value.path:
        return str(value.resolvedPath)
    for spec in attribute.GetPropertyStack(Usd.TimeCode.EarliestTime()):
        if spec.HasInfo("default") or spec.HasInfo("timeSamples"):
            return anchored(spec.layer, value.path)
    return str(value.path)


def _space_of_prim(attribute: Usd.Attribute) -> str:
    """Colour space from ``colorSpace:name`` of a prim, or of the nearest ancestor that has it."""
    prim = attribute.GetPrim()
    while prim and not prim.IsPseudoRoot():
        found = prim.GetAttribute("colorSpace:name")
        if found and found.HasAuthoredValue():
            return str(found.Get() or "")
        prim = prim.GetParent()
    return ""
