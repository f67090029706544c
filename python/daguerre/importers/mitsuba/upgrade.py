"""Translates names of Mitsuba before 2.0 to current names, by the rules of Mitsuba's loader.

Properties in camelCase get underscores, the colour of ``diffuse`` is its ``reflectance``, and
offsets and scales of texture coordinates become a transform.

Source: Mitsuba 3, ``transform_upgrade`` (include/mitsuba/core/parser.h, documentation).
"""

from __future__ import annotations

import re

import numpy as np

from .node import Node, Property

_HUMP = re.compile(r"(?<=[a-z])([A-Z]+)")
_SCALES = ("uscale", "vscale")
_OFFSETS = ("uoffset", "voffset")


def upgraded(node: Node) -> None:
    """Replaces old names of an object."""
    for item in node.properties:
        item.name = underscored(item.name)
    if node.plugin == "diffuse" and node.has("diffuse_reflectance") and not node.has("reflectance"):
        renamed = node.find("diffuse_reflectance")
        assert renamed is not None
        renamed.name = "reflectance"
    if any(node.has(name) for name in (*_SCALES, *_OFFSETS)):
        _as_transform(node)


def underscored(name: str) -> str:
    """Name with underscores: ``toWorld`` is ``to_world``, ``intIOR`` is ``int_ior``."""
    return _HUMP.sub(lambda hump: "_" + hump[1].lower(), name)


def _as_transform(node: Node) -> None:
    """Scale after offset of texture coordinates, as item transform."""
    scale = [node.number(name, 1.0) for name in _SCALES]
    offset = [node.number(name, 0.0) for name in _OFFSETS]
    matrix = np.diag([*scale, 1.0, 1.0])
    matrix[:2, 3] = np.multiply(scale, offset)
    old = [item for item in node.properties if item.name in (*_SCALES, *_OFFSETS)]
    for item in old:
        node.properties.remove(item)
        item.entry.used = False
    parts = [item.entry for item in old[1:]]
    node.properties.append(Property("to_uv", "transform", matrix, old[0].entry, parts))
