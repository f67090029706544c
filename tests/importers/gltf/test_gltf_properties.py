"""Generated scenes: valid ones come out as they went in; changed ones end in an InputError."""

from __future__ import annotations

import copy
import json
import struct
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from daguerre.errors import InputError
from daguerre.importers.gltf import reader as gltf
from tests.bad_files.bases import full, moving, seen
from tests.support.formats.make_gltf import COMPONENTS, TYPES, Builder, glb_bytes

QUIET = settings(
    max_examples=60,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
MANY = settings(QUIET, max_examples=3000, derandomize=False)
#: CPU time of one file.
LIMIT_S = 5.0

# Valid files -------------------------------------------------------------------------------------


def strided(b: Builder, values: np.ndarray, stride: int, offset: int) -> int:
    """An accessor whose elements stand ``stride`` bytes apart, ``offset`` into the view."""
    size = values.dtype.itemsize * values.shape[1]
    data = bytearray(b"\xaa" * (offset + stride * len(values)))
    for i, row in enumerate(values):
        data[offset + i * stride : offset + i * stride + size] = row.tobytes()
    view = b.view(bytes(data), byteStride=stride)
    kind = values.dtype.str[1:]
    return b.add(
        "accessors",
        {
            "bufferView": view,
            "byteOffset": offset,
            "componentType": COMPONENTS[kind],
            "count": len(values),
            "type": TYPES[values.shape[1]],
        },
    )


def made_sparse(b: Builder, accessor: int, places: list[int], values: np.ndarray) -> None:
    """Single elements of an accessor are others."""
    b.json["accessors"][accessor]["sparse"] = {
        "count": len(places),
        "indices": {
            "bufferView": b.view(struct.pack(f"<{len(places)}H", *places)),
            "componentType": 5123,
        },
        "values": {"bufferView": b.view(values.astype("<f4").tobytes())},
    }


@st.composite
def meshes(draw: st.DrawFn) -> tuple[Builder, np.ndarray, np.ndarray]:
    """A mesh of any layout, and the positions and triangles that it has."""
    b, count = Builder(), draw(st.integers(3, 12))
    number = st.floats(-1e6, 1e6, width=32)
    numbers = draw(st.lists(number, min_size=3 * count, max_size=3 * count))
    positions = np.array(numbers, "<f4").reshape(count, 3)
    stride = 4 * draw(st.integers(3, 20))
    use = strided(b, positions, stride, 4 * draw(st.integers(0, 5)))
    if draw(st.booleans()):
        places = sorted(draw(st.sets(st.integers(0, count - 1), min_size=1)))
        values = np.arange(3 * len(places), dtype="<f4").reshape(-1, 3)
        made_sparse(b, use, places, values)
        positions = positions.copy()
        positions[places] = values
    corner = st.integers(0, count - 1)
    corners = draw(st.lists(st.tuples(corner, corner, corner), min_size=1, max_size=9))
    triangles = np.array(corners, "<u4")
    width = draw(st.sampled_from(["u1", "u2", "u4"]))
    b.mesh({"POSITION": use}, indices=b.accessor(triangles.reshape(-1, 1), width))
    return b, positions, triangles


@QUIET
@given(made=meshes())
def test_meshes_come_out_as_they_went_in(tmp_path: Path, made: Any) -> None:
    b, positions, triangles = made
    b.node(mesh=0)
    mesh = gltf.read(b.glb(tmp_path / "a.glb")).meshes[0]
    np.testing.assert_array_equal(mesh.positions, positions)
    np.testing.assert_array_equal(mesh.indices, triangles)


@QUIET
@given(parents=st.lists(st.integers(0, 100), max_size=20), data=st.data())
def test_trees_place_their_leaves(tmp_path: Path, parents: list[int], data: Any) -> None:
    """Node i + 1 hangs below node ``parents[i]`` or a root; the world is the product on the way."""
    b = Builder()
    b.mesh({"POSITION": b.accessor([[0, 0, 0], [1, 0, 0], [0, 1, 0]])})
    steps = [data.draw(st.tuples(*[st.integers(-9, 9)] * 3)) for _ in range(len(parents) + 1)]
    scales = [data.draw(st.sampled_from([-2, 0.5, 1, 3])) for _ in steps]
    nodes: list[dict[str, Any]] = [
        {"mesh": 0, "translation": list(t), "scale": [s] * 3}
        for t, s in zip(steps, scales, strict=True)
    ]
    worlds = [_local(steps[0], scales[0])]
    for i, parent in enumerate(parents):
        chosen = parent % (i + 1)
        nodes[chosen].setdefault("children", []).append(i + 1)
        worlds.append(worlds[chosen] @ _local(steps[i + 1], scales[i + 1]))
    b.json |= {"nodes": nodes, "scenes": [{"nodes": [0]}], "scene": 0}
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    got = sorted(np.round(i.transform, 6).tolist() for i in scene.instances)
    assert got == sorted(np.round(w, 6).tolist() for w in worlds)


def _local(step: tuple[int, ...], scale: float) -> np.ndarray:
    m = np.diag([scale, scale, scale, 1.0])
    m[:3, 3] = step
    return m


FACTORS = st.fixed_dictionaries(
    {},
    optional={
        "metallicFactor": st.floats(0, 1),
        "roughnessFactor": st.floats(0, 1),
        "baseColorFactor": st.lists(st.floats(0, 1), min_size=4, max_size=4),
    },
)
MATERIALS = st.fixed_dictionaries(
    {},
    optional={
        "pbrMetallicRoughness": FACTORS,
        "emissiveFactor": st.lists(st.floats(0, 1), min_size=3, max_size=3),
        "alphaMode": st.sampled_from(["OPAQUE", "MASK", "BLEND"]),
        "alphaCutoff": st.floats(0, 10),
        "doubleSided": st.booleans(),
        "name": st.text(max_size=8),
        "extras": st.dictionaries(st.text(max_size=3), st.integers() | st.none(), max_size=3),
        "extensions": st.fixed_dictionaries(
            {},
            optional={
                "KHR_materials_ior": st.fixed_dictionaries({"ior": st.floats(1, 1e6)}),
                "KHR_materials_transmission": st.fixed_dictionaries(
                    {"transmissionFactor": st.floats(0, 1)}
                ),
                "VENDOR_thing": st.just({}),
            },
        ),
    },
)


@QUIET
@given(material=MATERIALS)
def test_materials_come_out_as_they_went_in(tmp_path: Path, material: dict[str, Any]) -> None:
    b = full()
    b.json["materials"] = [material]
    kind: Any = gltf.read(b.glb(tmp_path / "a.glb")).materials[0].kind
    factors = material.get("pbrMetallicRoughness", {})
    assert kind.metallic == factors.get("metallicFactor", 1)
    assert kind.roughness == factors.get("roughnessFactor", 1)
    assert (*kind.base_color, kind.base_alpha) == tuple(factors.get("baseColorFactor", [1] * 4))
    assert kind.alpha_mode == material.get("alphaMode", "OPAQUE").lower()
    assert kind.double_sided == material.get("doubleSided", False)


# One change --------------------------------------------------------------------------------------

ANY = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**70), 2**70),
    st.integers(-3, 12),
    st.floats(allow_nan=False, allow_infinity=False),
    st.text(max_size=6),
    st.sampled_from(["VEC3", "MAT4", "pointer", "/nodes/0/weights/0", "..", "data:,x"]),
    st.just([]),
    st.just({}),
    st.lists(st.integers(-2, 9), max_size=17),
    st.dictionaries(st.text(max_size=3), st.integers(), max_size=2),
)
SOURCES = [make().document() for make in (full, moving, seen)]
BINARIES = [bytes(make().binary) for make in (full, moving, seen)]


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The ways to every value of a document."""
    found = [path] if path else []
    pairs = value.items() if isinstance(value, dict) else enumerate(value)
    for key, child in pairs:
        if isinstance(child, (dict, list)):
            found += places(child, (*path, key))
        else:
            found.append((*path, key))
    return found


PLACES = [places(document) for document in SOURCES]


def ends_well(path: Path) -> None:
    """A scene, or an InputError that names the file; soon."""
    started = time.process_time()
    complaint = f"{path}: "
    try:
        gltf.read(path)
    except InputError as error:
        complaint = str(error)
    assert complaint.startswith(f"{path}: ")
    assert len(complaint) < 1000
    assert time.process_time() - started < LIMIT_S


def _change_value(folder: Path, data: Any) -> None:
    which = data.draw(st.integers(0, len(SOURCES) - 1))
    document = copy.deepcopy(SOURCES[which])
    for way in data.draw(st.lists(st.sampled_from(PLACES[which]), min_size=1, max_size=2)):
        holder: Any = document
        try:
            for key in way[:-1]:
                holder = holder[key]
            holder[way[-1]] = copy.deepcopy(data.draw(ANY))  # `ANY` may hand out one object twice
        except (TypeError, KeyError, IndexError):
            pass  # the first change took the way to the second
    path = folder / "b.glb"
    path.write_bytes(glb_bytes(json.dumps(document).encode(), BINARIES[which]))
    ends_well(path)


def _change_bytes(folder: Path, data: Any) -> None:
    which = data.draw(st.integers(0, len(SOURCES) - 1))
    raw = bytearray(glb_bytes(json.dumps(SOURCES[which]).encode(), BINARIES[which]))
    for _ in range(data.draw(st.integers(1, 4))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    (folder / "b.glb").write_bytes(raw)
    ends_well(folder / "b.glb")


@QUIET
@given(data=st.data())
def test_changed_values_end_well(tmp_path: Path, data: Any) -> None:
    _change_value(tmp_path, data)


@QUIET
@given(data=st.data())
def test_changed_bytes_end_well(tmp_path: Path, data: Any) -> None:
    _change_bytes(tmp_path, data)


@pytest.mark.slow
@MANY
@given(data=st.data())
def test_many_changed_values_end_well(tmp_path: Path, data: Any) -> None:
    _change_value(tmp_path, data)


@pytest.mark.slow
@MANY
@given(data=st.data())
def test_many_changed_bytes_end_well(tmp_path: Path, data: Any) -> None:
    _change_bytes(tmp_path, data)
