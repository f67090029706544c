"""Nodes, their transforms, and members of the wrong type."""

from __future__ import annotations

import numpy as np

from tests.support.formats.make_gltf import Builder

from .bases import full, seen
from .case import Case, Change, drawn, put, scenes


def ring(b: Builder) -> None:
    b.json["nodes"] += [{"children": [4]}, {"children": [3]}]


def long_ring(b: Builder) -> None:
    """A ring of ten thousand nodes."""
    first = len(b.json["nodes"])
    b.json["nodes"] += [{"children": [first + (i + 1) % 10_000]} for i in range(10_000)]


def chain(b: Builder) -> None:
    """The wall hangs below twenty thousand nodes."""
    first = len(b.json["nodes"])
    b.json["nodes"] += [{"children": [first + i + 1]} for i in range(20_000)]
    b.json["nodes"].append({"mesh": 0, "translation": [0, 0, -2]})
    b.json["scenes"][0]["nodes"].append(first)


def growing_chain(b: Builder) -> None:
    """Each node scales by ten: the world overflows."""
    first = len(b.json["nodes"])
    b.json["nodes"] += [{"children": [first + i + 1], "scale": [10, 10, 10]} for i in range(400)]
    b.json["nodes"].append({"mesh": 0})
    b.json["scenes"][0]["nodes"].append(first)


def crowd(b: Builder) -> None:
    """Deep nodes that all carry a mesh: their lists of descendants would need the square."""
    first = len(b.json["nodes"])
    b.json["nodes"] += [{"mesh": 0, "children": [first + i + 1]} for i in range(5000)]
    b.json["nodes"].append({"mesh": 0})
    b.json["scenes"][0]["nodes"].append(first)


def matrix(*rows: list[float]) -> Change:
    """The wall's node gets this linear map."""

    def change(b: Builder) -> None:
        m = np.eye(4)
        m[:3, :3] = rows
        m[2, 3] = -2
        b.json["nodes"][0] = {"mesh": 0, "matrix": m.T.ravel().tolist()}

    return change


Z = r"nodes\[0\]: world transform: wanted numbers below 1e\+18"

BAD: dict[str, tuple[Change, str]] = {
    "no asset": (put("asset", ...), r"asset: missing"),
    "version 1": (put("asset.version", "1.0"), r"asset\.version: unsupported: wanted glTF 2\.0"),
    "version is a number": (put("asset.version", 2.0), r"asset\.version: wrong type: wanted a str"),
    "min version": (put("asset.minVersion", "2.1"), r"asset\.minVersion: unsupported"),
    "version is text": (put("asset.version", "two"), r"asset\.version: wanted a version such as"),
    "nodes is an object": (put("nodes", {}), r"nodes: wrong type: wanted a list, got an object"),
    "node is a number": (put("nodes.1", 7), r"nodes\[1\]: wrong type: wanted an object, got 7"),
    "name is a list": (put("nodes.0.name", []), r"nodes\[0\]\.name: wrong type: wanted a string"),
    "mesh is a string": (put("nodes.0.mesh", "0"), r"nodes\[0\]\.mesh: wrong type: wanted an int"),
    "mesh is true": (put("nodes.0.mesh", True), r"nodes\[0\]\.mesh: wrong type: .* got True"),
    "mesh is 0.5": (put("nodes.0.mesh", 0.5), r"nodes\[0\]\.mesh: wrong type: .* got 0\.5"),
    "mesh is null": (put("nodes.0.mesh", None), r"nodes\[0\]\.mesh: wrong type: .* got None"),
    "mesh out of range": (
        put("nodes.0.mesh", 1),
        r"nodes\[0\]\.mesh: index out of range: wanted 0 \.\. 0 \(meshes\), got 1",
    ),
    "mesh is negative": (put("nodes.0.mesh", -1), r"nodes\[0\]\.mesh: index out of range: .* -1"),
    "mesh is huge": (put("nodes.0.mesh", 10**30), r"nodes\[0\]\.mesh: index out of range"),
    "camera out of range": (put("nodes.2.camera", 4), r"nodes\[2\]\.camera: index out of range"),
    "skin without skins": (put("nodes.0.skin", 0), r"skin: index out of range: there are no skins"),
    "scene out of range": (put("scene", 3), r"scene: index out of range: wanted 0 \.\. 0"),
    "scene node out of range": (put("scenes.0.nodes", [9]), r"scenes\[0\]\.nodes\[0\]: index out"),
    "scene node twice": (put("scenes.0.nodes", [0, 0]), r"nodes\[1\]: node 0 appears twice"),
    "scene node is a child": (
        put("scenes.0.nodes", [1]),
        r"scenes\[0\]\.nodes\[0\]: wanted a root node, but node 1 is a child of node 2",
    ),
    "child out of range": (put("nodes.2.children", [1, 8]), r"nodes\[2\]\.children\[1\]: index"),
    "two parents": (
        put("nodes.0.children", [1]),
        r"nodes\[2\]\.children\[0\]: node 1 is already a child of node 0",
    ),
    "own child": (
        put("nodes.1.children", [1]),
        r"nodes\[1\]\.children\[0\]: node 1 is already a child",
    ),
    "ring": (ring, r"nodes\[3\]: the node is its own ancestor"),
    "huge float": (put("nodes.0.translation", [1e999, 0, 0]), r"JSON: line 1, column \d+: wanted"),
    "huge integer": (
        put("nodes.0.translation", [10**400, 0, 0]),
        r"nodes\[0\]\.translation\[0\]: not finite",
    ),
    "overflow": (
        put("nodes.0.matrix", [*[1e38, 1e38, 0, 0] * 3, 1e38, 1e38, 0, 1]),
        r"nodes\[0\]: world transform: wanted numbers below 1e\+18, got 1e\+38",
    ),
    "translation too short": (
        put("nodes.0.translation", [1, 2]),
        r"nodes\[0\]\.translation: wrong length: wanted 3 numbers, got 2",
    ),
    "translation of strings": (
        put("nodes.0.translation", ["1", 2, 3]),
        r"nodes\[0\]\.translation\[0\]: wrong type: wanted a number, got '1'",
    ),
    "rotation of length 0": (
        put("nodes.0.rotation", [0, 0, 0, 0]),
        r"nodes\[0\]\.rotation: wanted a quaternion of length 1, got length 0",
    ),
    "matrix too short": (put("nodes.0.matrix", [1] * 15), r"matrix: wrong length: wanted 16"),
    "projective matrix": (put("nodes.0.matrix", [1] * 16), r"matrix: wanted 0, 0, 0, 1 as its la"),
    "animated matrix": (
        put("nodes.1.matrix", np.eye(4).ravel().tolist()),
        r"nodes\[1\]\.matrix: wanted either a matrix or",
    ),
    "long string": (put("asset.version", "x" * 10**6), r"'x{40}'\.\.\. \(1000000 long\)"),
    "long ring": (long_ring, r"nodes\[\d+\]: the node is its own ancestor"),
    "growing chain": (growing_chain, r"nodes\[\d+\]: world transform: wanted numbers below"),
    "children is a number": (put("nodes.2.children", 1), r"nodes\[2\]\.children: wrong type"),
    "child is null": (put("nodes.2.children", [None]), r"children\[0\]: wrong type"),
    "child is 1e300": (put("nodes.2.children", [1e300]), r"children\[0\]: index out of range"),
    "scenes is a string": (put("scenes", "all"), r"scenes: wrong type: wanted a list"),
    "scene is null": (put("scene", None), r"scene: wrong type"),
    "scene is true": (put("scene", True), r"scene: wrong type"),
    "scale is null": (put("nodes.0.scale", None), r"nodes\[0\]\.scale: wrong type"),
    "scale of lists": (put("nodes.0.scale", [[1], 1, 1]), r"nodes\[0\]\.scale\[0\]: wrong type"),
    "scale of 1e30": (put("nodes.0.scale", [1e30, 1, 1]), Z),
    "translation of 1e30": (put("nodes.0.translation", [1e30, 0, 0]), Z),
    "asset is null": (put("asset", None), r"asset: wrong type: wanted an object"),
    "extensions is a string": (put("nodes.0.extensions", "x"), r"extensions: wrong type"),
}

#: Transforms that are odd, and drawn all the same.
ODD: dict[str, tuple[Change, str]] = {
    "mirrored": (matrix([-1, 0, 0], [0, 1, 0], [0, 0, 1]), ""),
    "mirrored thrice": (matrix([-1, 0, 0], [0, -1, 0], [0, 0, -1]), ""),
    "sheared": (matrix([1, 5, 0], [0, 1, 0], [0, 3, 1]), ""),
    "flat": (matrix([1, 0, 0], [0, 1, 0], [0, 0, 0]), ""),
    "flat and turned": (matrix([1, 0, 1], [0, 1, 0], [1, 0, 1]), ""),
    "a line": (matrix([1, 0, 0], [0, 0, 0], [0, 0, 0]), r"scales to zero is left out"),
    "a point": (matrix([0, 0, 0], [0, 0, 0], [0, 0, 0]), r"scales to zero is left out"),
    "nearly flat": (matrix([1, 0, 0], [0, 1, 0], [0, 0, 1e-9]), ""),
    "nearly a line": (matrix([1, 0, 0], [0, 1e-14, 0], [0, 0, 1e-14]), ""),
    "small": (matrix([1e-8, 0, 0], [0, 1e-8, 0], [0, 0, 1e-8]), ""),
    "tiny": (matrix([1e-30, 0, 0], [0, 1e-30, 0], [0, 0, 1e-30]), ""),
    "denormal": (matrix([1e-310, 0, 0], [0, 1e-310, 0], [0, 0, 1e-310]), ""),
    "large": (matrix([1e9, 0, 0], [0, 1e9, 0], [0, 0, 1e9]), ""),
    "huge": (matrix([1e17, 0, 0], [0, 1e17, 0], [0, 0, 1e17]), ""),
    "uneven": (matrix([1e12, 0, 0], [0, 1e-12, 0], [0, 0, 1]), ""),
    "far away": (put("nodes.0.translation", [1e17, 0, 0]), ""),
    "rotation not of length 1": (put("nodes.0.rotation", [0, 0, 0, 7]), ""),
    "rotation tiny": (put("nodes.0.rotation", [0, 0, 0, 1e-8]), ""),
    "chain of 20000": (chain, ""),
    "crowd": (crowd, r"deep in the tree"),
    "camera mirrored": (put("nodes.1.scale", [-1, 1, 1]), ""),
    "camera small": (put("nodes.1.scale", [1e-12, 1e-12, 1e-12]), ""),
    "camera far away": (put("nodes.1.translation", [1e17, 1e17, 1e17]), ""),
    "float index": (put("nodes.0.mesh", 0.0), ""),
    "name of controls": (put("nodes.0.name", "\x00\x1b[31m\n\u202e"), ""),
    "name of a surrogate": (put("nodes.0.name", "\ud800"), ""),
    "name of a megabyte": (put("nodes.0.name", "x" * 10**6), ""),
}


CASES: list[Case] = [*scenes("node", BAD, full), *drawn("transform", ODD, seen)]
