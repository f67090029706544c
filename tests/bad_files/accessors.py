"""Buffers, views and accessors: offsets, counts, strides, sparse ones."""

from __future__ import annotations

import struct
from typing import Any

from tests.support.formats.make_gltf import Builder

from .bases import full
from .case import Case, Change, both, put, scenes

BIG = 2**40


def stride(b: Builder) -> None:
    b.json["bufferViews"][b.json["accessors"][0]["bufferView"]]["byteStride"] = 8


def sparse(places: tuple[int, ...] = (0, 2), **members: Any) -> Change:
    def change(b: Builder) -> None:
        b.json["accessors"][0]["sparse"] = {
            "count": 2,
            "indices": {"bufferView": b.view(bytes(places)), "componentType": 5121},
            "values": {"bufferView": b.view(struct.pack("<6f", *range(6)))},
        } | members

    return change


S = "accessors.0.sparse."

BAD: dict[str, tuple[Change, str]] = {
    "buffer is longer": (
        put("buffers", [{"byteLength": 10**6}]),
        r"buffers\[0\]\.byteLength: the binary chunk is too short: wanted 1000000 bytes, got",
    ),
    "buffer length negative": (put("buffers", [{"byteLength": -4}]), r"byteLength: out of range"),
    "buffer without uri": (
        put("buffers", [{"byteLength": 4}, {"byteLength": 4}]),
        r"buffers\[1\]\.uri: missing",
    ),
    "view beyond buffer": (
        put("bufferViews.0.byteLength", 10**9),
        r"bufferViews\[0\]: beyond its buffer \(\d+ bytes\): wanted .* got 0 \+ 1000000000",
    ),
    "view offset negative": (put("bufferViews.0.byteOffset", -4), r"byteOffset: out of range"),
    "view offset huge": (put("bufferViews.0.byteOffset", BIG), r"bufferViews\[0\]: beyond its bu"),
    "view without buffer": (put("bufferViews.0.buffer", 1), r"\.buffer: index out of range"),
    "stride 0": (
        put("bufferViews.0.byteStride", 0),
        r"byteStride: out of range: wanted 1 \.\. 252",
    ),
    "stride too small": (
        stride,
        r"bufferViews\[\d\]\.byteStride: too small for accessors\[0\]: wan",
    ),
    "accessor beyond view": (
        put("accessors.0.count", 4),
        r"accessors\[0\]: beyond its bufferView \(bufferViews\[0\]\): wanted at most 36 bytes, g",
    ),
    "accessor of 2^40": (put("accessors.0.count", BIG), r"accessors\[0\]: beyond its bufferView"),
    "accessor of 10^40": (put("accessors.0.count", 10**40), r"accessors\[0\]: beyond its buffer"),
    "accessor of -1": (put("accessors.0.count", -1), r"accessors\[0\]\.count: out of range"),
    "accessor of 0": (put("accessors.0.count", 0), r"count: out of range: wanted at least 1"),
    "accessor offset": (put("accessors.0.byteOffset", 10**30), r"accessors\[0\]: beyond its buff"),
    "zeros of 2^40": (
        lambda b: (
            b.json["accessors"][0].update(count=BIG) or b.json["accessors"][0].pop("bufferView")
        ),
        r"accessors\[0\]\.count: too large without a bufferView",
    ),
    "accessor view out of range": (put("accessors.0.bufferView", 99), r"bufferView: index out of"),
    "component type": (
        put("accessors.0.componentType", 5124),
        r"componentType: unknown value: wan",
    ),
    "accessor type": (put("accessors.0.type", "VEC5"), r"accessors\[0\]\.type: unknown value: wan"),
    "no type": (put("accessors.0.type", ...), r"accessors\[0\]\.type: missing"),
    "normalized is 1": (
        put("accessors.0.normalized", 1),
        r"normalized: wrong type: wanted true or",
    ),
    "sparse out of range": (
        sparse(places=[0, 3]),
        r"sparse\.indices: index out of range: wanted 0",
    ),
    "sparse falls": (sparse(places=[2, 0]), r"sparse\.indices: indices must increase"),
    "sparse count": (sparse(count=4), r"sparse\.count: out of range: wanted 1 \.\. 3, got 4"),
    "sparse too short": (sparse(count=3), r"sparse\.indices: beyond its bufferView"),
    "sparse of 2^40": (sparse(count=BIG), r"sparse\.count: out of range"),
    "sparse of 0": (sparse(count=0), r"sparse\.count: out of range"),
    "sparse is a list": (put("accessors.0.sparse", []), r"sparse: wrong type"),
    "sparse without indices": (both(sparse(), put(S + "indices", ...)), r"indices: missing"),
    "sparse without values": (both(sparse(), put(S + "values", ...)), r"values: missing"),
    "sparse of floats": (
        both(sparse(), put(S + "indices.componentType", 5126)),
        r"sparse\.indices\.componentType: unknown value",
    ),
    "sparse view out of range": (
        both(sparse(), put(S + "values.bufferView", 99)),
        r"sparse\.values\.bufferView: index out of range",
    ),
    "sparse values beyond": (
        both(sparse(), put(S + "values.byteOffset", 20)),
        r"sparse\.values: beyond its bufferView",
    ),
    "sparse offset 2^64": (
        both(sparse(), put(S + "indices.byteOffset", 2**64)),
        r"sparse\.indices: beyond its bufferView",
    ),
    "byteOffset -1": (put("accessors.0.byteOffset", -1), r"byteOffset: out of range"),
    "byteOffset 0.5": (put("accessors.0.byteOffset", 0.5), r"byteOffset: wrong type"),
    "byteOffset one over": (put("accessors.0.byteOffset", 1), r"accessors\[0\]: beyond its"),
    "byteOffset 2^63": (put("accessors.0.byteOffset", 2**63), r"accessors\[0\]: beyond its"),
    "byteOffset 2^64": (put("accessors.0.byteOffset", 2**64), r"accessors\[0\]: beyond its"),
    "count 2^31": (put("accessors.0.count", 2**31), r"accessors\[0\]: beyond its"),
    "count 2^32": (put("accessors.0.count", 2**32), r"accessors\[0\]: beyond its"),
    "count 2^63": (put("accessors.0.count", 2**63), r"accessors\[0\]: beyond its"),
    "count 1e300": (put("accessors.0.count", 1e300), r"accessors\[0\]: beyond its"),
    "count is text": (put("accessors.0.count", "3"), r"count: wrong type"),
    "count is missing": (put("accessors.0.count", ...), r"count: missing"),
    "component is missing": (put("accessors.0.componentType", ...), r"componentType: missing"),
    "component is a list": (put("accessors.0.componentType", [5126]), r"componentType: wrong type"),
    "component 5126.5": (put("accessors.0.componentType", 5126.5), r"componentType: wrong type"),
    "type is a number": (put("accessors.0.type", 3), r"accessors\[0\]\.type: unknown value"),
    "type is a list": (put("accessors.0.type", ["VEC3"]), r"accessors\[0\]\.type: wrong type"),
    "accessors is null": (put("accessors", None), r"accessors: wrong type"),
    "accessor is null": (put("accessors.0", None), r"accessors\[0\]: wrong type"),
    "view is a string": (put("bufferViews.0", "v"), r"bufferViews\[0\]: wrong type"),
    "view length 0": (put("bufferViews.0.byteLength", 0), r"beyond its bufferView .*most 0 bytes"),
    "view length 2^40": (put("bufferViews.0.byteLength", BIG), r"bufferViews\[0\]: beyond its"),
    "view length 2^64": (put("bufferViews.0.byteLength", 2**64), r"bufferViews\[0\]: beyond"),
    "view length missing": (put("bufferViews.0.byteLength", ...), r"byteLength: missing"),
    "view buffer -1": (put("bufferViews.0.buffer", -1), r"buffer: index out of range"),
    "stride 1000": (put("bufferViews.0.byteStride", 1000), r"byteStride: out of range"),
    "stride 2^40": (put("bufferViews.0.byteStride", BIG), r"byteStride: out of range"),
    "stride -12": (put("bufferViews.0.byteStride", -12), r"byteStride: out of range"),
    "stride is text": (put("bufferViews.0.byteStride", "12"), r"byteStride: wrong type"),
    "stride runs over": (put("bufferViews.0.byteStride", 252), r"accessors\[0\]: beyond its"),
    "buffer length 2^40": (put("buffers.0.byteLength", BIG), r"buffers\[0\]\.byteLength: "),
    "buffer length 0": (
        put("buffers.0.byteLength", 0),
        r"bufferViews\[0\]: beyond its buffer \(0 bytes",
    ),
    "buffer length text": (put("buffers.0.byteLength", "1"), r"byteLength: wrong type"),
    "buffer is null": (put("buffers", [None]), r"buffers\[0\]: wrong type"),
    "zeros of 2^31": (
        both(put("accessors.0.count", 2**31), put("accessors.0.bufferView", ...)),
        r"accessors\[0\]\.count: too large without a bufferView",
    ),
}

CASES: list[Case] = scenes("accessor", BAD, full)
