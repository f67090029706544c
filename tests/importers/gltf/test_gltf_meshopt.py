"""EXT_meshopt_compression and KHR_meshopt_compression: what is unpacked is what was packed."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daguerre.errors import InputError
from daguerre.importers.gltf import reader as gltf
from tests.support.formats.make_gltf import Builder

STREAMS = {
    key: bytes.fromhex(text)
    for key, text in json.loads((Path(__file__).parents[2] / "data/meshopt.json").read_text())[
        "streams"
    ].items()
}
# The packed data: 40 elements each, and the 56 triangles of a grid of 8 x 5 vertices.
STEP = np.arange(40)
TURN = 2 * np.pi * STEP / 40
POSITIONS = np.stack([STEP % 8, STEP // 8, (STEP % 8) * (STEP // 8)], axis=1).astype("<f4") / 8
SHORTS = np.stack([STEP * STEP * 7, 60000 - STEP * 333, 0 * STEP, 0 * STEP + 5], axis=1).astype(
    "<u2"
)
WAVES = np.stack([np.sin(STEP / 5), np.exp2(-STEP / 4)], axis=1).astype("<f4")
_FIRST = (np.arange(4)[:, None] * 8 + np.arange(7)).ravel()
TRIANGLES = _FIRST[:, None] + [0, 1, 9, 0, 9, 8]
NORMALS = np.stack([0.8 * np.cos(TURN), 0.8 * np.sin(TURN), np.where(STEP % 2, 0.6, -0.6)], axis=1)
QUATERNIONS = np.stack([0 * TURN, 0 * TURN, np.sin(TURN / 2), np.cos(TURN / 2)], axis=1)
COLORS = np.stack([STEP / 39, 1 - STEP / 39, 0 * STEP + 0.5, STEP % 2], axis=1)


def pack(b: Builder, key: str, count: int, stride: int, *, name: str = "KHR", **more: Any) -> int:
    """A bufferView of a stream, on a buffer without bytes of its own."""
    extension = {"buffer": 0, "byteStride": stride, "count": count, "mode": "ATTRIBUTES", **more}
    index = b.view(STREAMS[key])
    view = b.json["bufferViews"][index]
    extension |= {"byteOffset": view["byteOffset"], "byteLength": view["byteLength"]}
    view |= {"buffer": 1, "byteOffset": 0, "byteLength": count * stride}
    view["extensions"] = {f"{name}_meshopt_compression": extension}
    b.json["buffers"] = [{"byteLength": len(b.binary)}, {"byteLength": 1 << 20}]
    b.json["extensionsRequired"] = b.json["extensionsUsed"] = [f"{name}_meshopt_compression"]
    return index


def accessor(b: Builder, view: int, kind: str, component: int, count: int, **more: Any) -> int:
    value = {"bufferView": view, "type": kind, "componentType": component, "count": count, **more}
    return b.add("accessors", value)


def grid(name: str = "KHR", positions: str = "positions v0", indices: str = "TRIANGLES") -> Builder:
    b = Builder()
    points = accessor(b, pack(b, positions, 40, 12, name=name), "VEC3", 5126, 40)
    where = pack(b, indices.lower(), 168, 4, name=name, mode=indices)
    b.mesh({"POSITION": points}, indices=accessor(b, where, "SCALAR", 5125, 168))
    b.node(mesh=0)
    return b


def attribute(tmp_path: Path, key: str, stride: int, form: dict[str, Any], **more: Any) -> Any:
    """A packed attribute as a mesh of the scene has it."""
    b = grid()
    view = pack(b, key, 40, stride, **more)
    b.json["bufferViews"][view]["byteStride"] = stride
    made = accessor(b, view, count=40, **form["accessor"])
    b.json["meshes"][0]["primitives"][0]["attributes"][form["attribute"]] = made
    return getattr(gltf.read(b.glb(tmp_path / "a.glb")).meshes[0], form["field"])


@pytest.mark.parametrize("name", ["KHR", "EXT"])
@pytest.mark.parametrize("positions", ["positions v0", "positions v1"])
@pytest.mark.parametrize("indices", ["TRIANGLES", "INDICES"])
def test_a_grid_is_what_was_packed(tmp_path: Path, name: str, positions: str, indices: str) -> None:
    mesh = gltf.read(grid(name, positions, indices).glb(tmp_path / "a.glb")).meshes[0]
    np.testing.assert_array_equal(mesh.positions, POSITIONS)
    wanted, got = TRIANGLES.reshape(-1, 3), np.asarray(mesh.indices)
    if indices == "TRIANGLES":  # this mode may start a triangle at another of its corners
        wanted = np.stack([np.roll(t, -t.argmin()) for t in wanted])
        got = np.stack([np.roll(t, -t.argmin()) for t in got])
    np.testing.assert_array_equal(got, wanted)


@pytest.mark.parametrize("version", ["v0", "v1"])
def test_deltas_of_two_and_four_bytes(tmp_path: Path, version: str) -> None:
    wave = {"attribute": "TEXCOORD_0", "field": "uv"}
    wave |= {"accessor": {"kind": "VEC2", "component": 5126}}
    np.testing.assert_array_equal(attribute(tmp_path, f"waves {version}", 8, wave), WAVES)
    color = {"attribute": "COLOR_0", "field": "colors"}
    color |= {"accessor": {"kind": "VEC4", "component": 5123, "normalized": True}}
    got = attribute(tmp_path, f"shorts {version}", 8, color)
    np.testing.assert_array_equal(np.rint(got * 65535), SHORTS)


@pytest.mark.parametrize(("stride", "component", "error"), [(4, 5120, 0.02), (8, 5122, 0.001)])
def test_octahedral_filter(tmp_path: Path, stride: int, component: int, error: float) -> None:
    form = {"attribute": "NORMAL", "field": "normals"}
    form |= {"accessor": {"kind": "VEC3", "component": component, "normalized": True}}
    got = attribute(tmp_path, f"normals {stride}", stride, form, filter="OCTAHEDRAL")
    np.testing.assert_allclose(got, NORMALS, atol=error)


@pytest.mark.parametrize(("stride", "component", "error"), [(4, 5121, 0.008), (8, 5123, 0.0005)])
def test_color_filter(tmp_path: Path, stride: int, component: int, error: float) -> None:
    form = {"attribute": "COLOR_0", "field": "colors"}
    form |= {"accessor": {"kind": "VEC4", "component": component, "normalized": True}}
    got = attribute(tmp_path, f"colors {stride}", stride, form, filter="COLOR")
    np.testing.assert_allclose(got, COLORS, atol=error)


def test_exponential_filter(tmp_path: Path) -> None:
    b = grid()
    view = pack(b, "exponential", 40, 12, filter="EXPONENTIAL")
    b.json["accessors"][0]["bufferView"] = view
    mesh = gltf.read(b.glb(tmp_path / "a.glb")).meshes[0]
    np.testing.assert_allclose(mesh.positions, POSITIONS * 100 / 3, rtol=1e-4)


def test_quaternion_filter_drives_an_animation(tmp_path: Path) -> None:
    b = grid()
    view = pack(b, "quaternions", 40, 8, filter="QUATERNION")
    turns = accessor(b, view, "VEC4", 5122, 40, normalized=True)
    times = b.accessor(np.arange(40))
    target = {"sampler": 0, "target": {"node": 0, "path": "rotation"}}
    b.add("animations", {"samplers": [{"input": times, "output": turns}], "channels": [target]})
    b.json["buffers"][0]["byteLength"] = len(b.binary)
    path = b.glb(tmp_path / "a.glb")
    for frame in (0, 7, 19, 39):
        world = gltf.read(path, time=frame).instances[0].transform
        c, s = np.cos(TURN[frame]), np.sin(TURN[frame])
        np.testing.assert_allclose(world[:2, :2], [[c, -s], [s, c]], atol=3e-4)


def test_bytes_of_a_fallback_are_not_read(tmp_path: Path) -> None:
    b = grid()
    fallback = {"KHR_meshopt_compression": {"fallback": True}}
    b.json["buffers"][1] |= {"uri": "absent.bin", "extensions": fallback}
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert len(scene.meshes[0].positions) == 40
    assert not scene.warnings


VIEW = r"bufferViews\[0\]"
EXTENSION = VIEW + r"\.extensions\.KHR_meshopt_compression"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"count": 39}, VIEW + r"\.byteLength: wanted count x byteStride = 468, got 480"),
        ({"count": 2**40}, VIEW + r"\.byteLength: wanted count x byteStride"),
        ({"byteStride": 6}, EXTENSION + r"\.byteStride: does not fit mode and filter"),
        ({"filter": "QUATERNION"}, EXTENSION + r"\.byteStride: .* wanted 8, got 12"),
        ({"mode": "TRIANGLES"}, EXTENSION + r"\.byteStride: .* wanted 2, 4, got 12"),
        ({"mode": "MAGIC"}, EXTENSION + r"\.mode: unknown value"),
        ({"buffer": 1}, r"buffers\[1\]\.uri: missing"),
        ({"byteLength": 100}, EXTENSION + r": meshopt attributes: "),
        ({"byteOffset": 8}, EXTENSION + r": meshopt attributes: header: wanted 160 or 161"),
        ({"byteLength": 1 << 20}, EXTENSION + r": beyond its buffer"),
    ],
)
def test_what_does_not_fit_is_named(tmp_path: Path, change: dict[str, Any], message: str) -> None:
    b = grid()
    b.json["bufferViews"][0]["extensions"]["KHR_meshopt_compression"] |= change
    with pytest.raises(InputError, match=message):
        gltf.read(b.glb(tmp_path / "a.glb"))


def test_claims_of_terabytes_end_at_once(tmp_path: Path) -> None:
    b = grid()
    view = b.json["bufferViews"][0]
    view["byteLength"] = 12 << 40
    view["extensions"]["KHR_meshopt_compression"]["count"] = 1 << 40
    with pytest.raises(
        InputError, match=r"0\]: too many bytes of unpacked bufferViews: the limit is 8589934592"
    ):
        gltf.read(b.glb(tmp_path / "a.glb"))
    view["byteLength"] = 12 << 28
    view["extensions"]["KHR_meshopt_compression"]["count"] = 1 << 28
    with pytest.raises(InputError, match=EXTENSION + ": meshopt attributes: truncated"):
        gltf.read(b.glb(tmp_path / "a.glb"))


def test_damaged_streams_end_in_a_scene_or_one_error(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    b = grid(positions="positions v1")
    intact, errors = bytes(b.binary), 0
    for _ in range(400):
        b.binary[:] = intact
        for place in rng.integers(0, len(intact), rng.integers(1, 4)):
            b.binary[place] = rng.integers(256)
        try:
            gltf.read(b.glb(tmp_path / "a.glb"))
        except InputError:
            errors += 1
    assert errors > 100
