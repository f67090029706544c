"""KHR_mesh_quantization: every type that it allows, and the transforms that undo it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daguerre.importers.gltf import reader as gltf
from tests.support.formats.make_gltf import Builder, png

WHOLE = {"i1": 127, "u1": 255, "i2": 32767, "u2": 65535}
EVERY = [(dtype, flag) for dtype in WHOLE for flag in (False, True)]


def load(b: Builder, tmp_path):
    b.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    return gltf.read(b.glb(tmp_path / "a.glb"))


def aligned(b: Builder, values, dtype: str, normalized: bool) -> int:
    """An accessor whose elements start at multiples of 4 bytes, as the extension wants."""
    rows = np.asarray(values, "<" + dtype)
    stride = -(-rows.shape[1] * rows.itemsize // 4) * 4
    data = b"".join(row.tobytes().ljust(stride, b"\xaa") for row in rows)
    accessor = b.accessor(rows, dtype, normalized=normalized)
    b.json["accessors"][accessor]["bufferView"] = b.view(data, byteStride=stride)
    return accessor


def decoded(values, dtype: str, normalized: bool):
    """The table of the extension, in double."""
    values = np.asarray(values, float)
    return np.maximum(values / WHOLE[dtype], -1) if normalized else values


def extremes(dtype: str, width: int):
    info = np.iinfo(dtype)
    rows = [info.min, info.max, WHOLE[dtype], 0, 1, info.max // 3]
    return np.array([np.roll(rows, k)[:width] for k in range(3)])


@pytest.mark.parametrize(("dtype", "normalized"), EVERY)
def test_positions_and_texture_coordinates(tmp_path, dtype, normalized):
    b = Builder()
    points, uv = extremes(dtype, 3), extremes(dtype, 2)
    attributes = {"POSITION": aligned(b, points, dtype, normalized)}
    for k in range(2):
        attributes[f"TEXCOORD_{k}"] = aligned(b, uv, dtype, normalized)
    b.mesh(attributes)
    b.node(mesh=0)
    scene = load(b, tmp_path)
    mesh = scene.meshes[0]
    assert mesh.positions == pytest.approx(decoded(points, dtype, normalized), rel=1e-7)
    for coordinates in (mesh.uv, mesh.uv1):
        assert coordinates == pytest.approx(decoded(uv, dtype, normalized), rel=1e-7)
    assert scene.warnings == []


@pytest.mark.parametrize("dtype", ["i1", "i2"])
def test_normals_and_tangents(tmp_path, dtype):
    b = Builder()
    whole = WHOLE[dtype]
    normals = [[0, 0, whole], [-whole - 1, 0, 0], [whole // 2, whole // 2, 0]]
    tangents = [[whole, 0, 0, whole], [0, whole // 3, 0, -whole], [0, 0, -whole - 1, -whole - 1]]
    b.mesh(
        {
            "POSITION": aligned(b, [[0, 0, 0], [9, 0, 0], [0, 9, 0]], "i1", False),
            "NORMAL": aligned(b, normals, dtype, True),
            "TANGENT": aligned(b, tangents, dtype, True),
        }
    )
    b.node(mesh=0)
    mesh = load(b, tmp_path).meshes[0]
    half = math.sqrt(0.5)
    assert mesh.normals == pytest.approx(np.array([[0, 0, 1], [-1, 0, 0], [half, half, 0]]))
    assert mesh.tangents.tolist() == [[1, 0, 0, 1], [0, 1, 0, -1], [0, 0, -1, -1]]


@pytest.mark.parametrize(("dtype", "normalized"), [e for e in EVERY if e[0][0] == "i"])
def test_displacements(tmp_path, dtype, normalized):
    b = Builder()
    delta = extremes(dtype, 3)
    b.mesh(
        {"POSITION": aligned(b, extremes("i1", 3), "i1", False)},
        targets=[{"POSITION": aligned(b, delta, dtype, normalized)}],
    )
    b.node(mesh=0, weights=[-0.5])
    wanted = extremes("i1", 3) - 0.5 * decoded(delta, dtype, normalized)
    assert load(b, tmp_path).meshes[0].positions == pytest.approx(wanted, rel=1e-6, abs=1e-5)


@settings(max_examples=25, deadline=None)
@given(st.sampled_from(EVERY), st.integers(0, 2**32 - 1))
def test_a_mesh_comes_back_from_any_grid(tmp_path_factory, kind, seed):
    """Packed by scale and offset, undone by the node and by the texture transform."""
    dtype, normalized = kind
    rng = np.random.default_rng(seed)
    low, high = decoded([np.iinfo(dtype).min, np.iinfo(dtype).max], dtype, normalized)

    def pack(values):
        """Integers, and the scale and the offset that undo them."""
        scale = float(np.ptp(values, axis=0).max()) / (high - low)
        offset = values.min(axis=0) - low * scale
        steps = WHOLE[dtype] if normalized else 1
        return np.round((values - offset) / scale * steps), scale, offset

    points, uv = rng.normal(size=(9, 3)) * 3 + 7, rng.random((9, 2)) * 5 - 2
    packed, scale, offset = pack(points)
    packed_uv, uv_scale, uv_offset = pack(uv)
    b = Builder()
    position, texcoord = (
        aligned(b, packed, dtype, normalized),
        aligned(b, packed_uv, dtype, normalized),
    )
    b.mesh({"POSITION": position, "TEXCOORD_1": texcoord}, material=0)
    undo = {"offset": uv_offset.tolist(), "scale": [uv_scale] * 2, "texCoord": 1}
    texture = {"index": 0, "texCoord": 7, "extensions": {"KHR_texture_transform": undo}}
    b.add("materials", {"pbrMetallicRoughness": {"baseColorTexture": texture}})
    b.image(png(np.zeros((2, 2, 3), np.uint8)))
    b.node(mesh=0, scale=[scale] * 3, translation=offset.tolist())
    scene = load(b, tmp_path_factory.mktemp("grid"))
    assert scene.warnings == []
    (instance,), mesh = scene.instances, scene.meshes[0]
    world = mesh.positions @ instance.transform[:3, :3].T + instance.transform[:3, 3]
    step = (high - low) / (2**8 - 1 if dtype[1] == "1" else 2**16 - 1)
    assert world == pytest.approx(points, abs=1.01 * scale * step)
    slot = scene.materials[0].kind.base_color_texture
    a, b_, c, d, e, f = slot.transform
    found = mesh.uv1 @ np.array([[a, b_], [d, e]]).T + (c, f)
    assert slot.uv_set == 1
    assert found == pytest.approx(uv, abs=1.01 * uv_scale * step)


def test_the_texture_transform_of_the_specification(tmp_path):
    """Its example: "only the lower left quadrant of the image, rotated clockwise by 90 degrees"."""
    b = Builder()
    corners = [[0, 0], [1, 0], [1, 1], [0, 1]]  # of the surface: top left, and on clockwise
    b.mesh(
        {
            "POSITION": b.accessor([[u, -v, 0] for u, v in corners]),
            "TEXCOORD_0": b.accessor(corners),
        },
        indices=b.accessor([0, 2, 1, 0, 3, 2], "u1"),
        material=0,
    )
    transform = {"offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5]}
    texture = {"index": 0, "extensions": {"KHR_texture_transform": transform}}
    b.add("materials", {"emissiveTexture": texture})
    b.image(png(np.zeros((2, 2, 3), np.uint8)))
    b.node(mesh=0)
    a, b_, c, d, e, f = load(b, tmp_path).materials[0].kind.emissive_texture.transform
    found = [(a * u + b_ * v + c, d * u + e * v + f) for u, v in corners]
    # Seen turned clockwise, the picture's bottom left is at the surface's top left, and so on.
    wanted = [(0, 1), (0, 0.5), (0.5, 0.5), (0.5, 1)]
    assert np.array(found) == pytest.approx(np.array(wanted), abs=1e-9)
