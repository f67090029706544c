"""KHR_draco_mesh_compression: the mesh that was packed, or one clear error."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daguerre.errors import InputError
from daguerre.files import extras
from daguerre.importers.gltf import reader as gltf
from tests.support.formats.make_gltf import Builder

NAME = "KHR_draco_mesh_compression"
# A wavy sheet of 9 x 7 vertices.
_U, _V = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 1, 7)))
POSITIONS = np.stack([_U, _V, 0.1 * np.sin(6 * _U)], axis=1).astype(np.float32)
UV = np.stack([_U, _V], axis=1)
SHADES = (np.stack([_U, _V, _U * _V, _U**2], axis=1) * 255).astype(np.uint8)
_FIRST = (np.arange(6)[:, None] * 9 + np.arange(8)).ravel()
TRIANGLES = (_FIRST[:, None] + [0, 1, 10, 0, 10, 9]).reshape(-1, 3).astype(np.uint32)
IDS = {"POSITION": 3, "TEXCOORD_0": 1, "COLOR_0": 0}


def stream(*, preserve_order: bool = True) -> bytes:
    draco = pytest.importorskip("DracoPy", reason="needs the extra compression")
    data: bytes = draco.encode(
        POSITIONS,
        TRIANGLES,
        quantization_bits=14,
        preserve_order=preserve_order,
        tex_coord=UV,
        colors=SHADES,
    )
    return data


def ids(data: bytes) -> dict[str, int]:
    """Identity of each attribute in a stream, by Draco's types (0 position, 2 colour, 3 uv)."""
    draco = pytest.importorskip("DracoPy", reason="needs the extra compression")
    names = {0: "POSITION", 2: "COLOR_0", 3: "TEXCOORD_0"}
    return {names[a["attribute_type"]]: a["unique_id"] for a in draco.decode(data).attributes}


def sheet(data: bytes, identities: dict[str, int], *, required: bool = True) -> Builder:
    b = Builder()

    def claim(component: int, kind: str, count: int, **more: Any) -> int:
        return b.add(
            "accessors", {"componentType": component, "type": kind, "count": count, **more}
        )

    attributes = {
        "POSITION": claim(5126, "VEC3", 63),
        "TEXCOORD_0": claim(5126, "VEC2", 63),
        "COLOR_0": claim(5121, "VEC4", 63, normalized=True),
    }
    extension = {NAME: {"bufferView": b.view(data), "attributes": identities}}
    b.mesh(attributes, indices=claim(5123, "SCALAR", 288), extensions=extension)
    b.node(mesh=0)
    b.json["extensionsUsed"] = [NAME]
    b.json["extensionsRequired"] = [NAME] if required else []
    return b


@pytest.mark.parametrize("preserve_order", [True, False])
def test_a_sheet_is_what_was_packed(tmp_path: Path, preserve_order: bool) -> None:
    data = stream(preserve_order=preserve_order)
    mesh = gltf.read(sheet(data, ids(data)).glb(tmp_path / "a.glb")).meshes[0]
    assert mesh.uv is not None
    assert mesh.colors is not None
    order = np.rint(np.asarray(mesh.uv) * [8, 6]).astype(int) @ [1, 9]  # vertices may be shuffled
    np.testing.assert_allclose(mesh.positions, POSITIONS[order], atol=1e-4)
    np.testing.assert_allclose(mesh.uv, UV[order], atol=1e-6)
    np.testing.assert_allclose(np.asarray(mesh.colors) * 255, SHADES[order], atol=1e-3)

    def turned(triangles: Any) -> list[list[int]]:
        return sorted(np.roll(t, -int(np.argmin(t))).tolist() for t in triangles)

    assert turned(order[np.asarray(mesh.indices)]) == turned(TRIANGLES)


def test_without_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    path, hint = tmp_path / "a.glb", re.escape(extras.hint("DracoPy"))
    b = sheet(b"not looked at", IDS, required=False)
    with pytest.raises(InputError, match=rf"{NAME}: needs the package DracoPy.*{hint}"):
        gltf.read(b.glb(path))
    b.json["extensionsRequired"] = [NAME]
    with pytest.raises(InputError, match=rf"extensionsRequired\[0\]: .*DracoPy.*{hint}"):
        gltf.read(b.glb(path))
    b = sheet(b"not looked at", IDS, required=False)
    for accessor, values in ((0, POSITIONS), (1, UV.astype("<f4")), (2, SHADES)):
        b.json["accessors"][accessor]["bufferView"] = b.view(values.tobytes())
    b.json["accessors"][3]["bufferView"] = b.view(TRIANGLES.astype("<u2").tobytes())
    read = gltf.read(b.glb(path))
    np.testing.assert_array_equal(read.meshes[0].indices, TRIANGLES)
    assert any(
        "uncompressed data are used: KHR_draco" in w and "(1 use)" in w for w in read.warnings
    )


P = r"meshes\[0\]\.primitives\[0\]\."


@pytest.mark.parametrize(
    ("accessor", "change", "message"),
    [
        (0, {"count": 64}, P + r"attributes\.POSITION: wrong shape .* \(64, 3\), got \(63, 3\)"),
        (3, {"count": 291}, P + r"indices: wrong shape .* \(291, 1\), got \(288, 1\)"),
        (2, {"type": "VEC3"}, P + r"attributes\.COLOR_0: wrong shape .* \(63, 3\), got \(63, 4\)"),
        (0, {"count": 1 << 40}, P + r"attributes\.\w+: too large: wanted at most 8 GiB"),
        (3, {"count": 1 << 40}, P + r"indices: too large: wanted at most 8 GiB"),
        (0, {"componentType": 5123}, P + r"attributes\.POSITION: the unpacked data do not fit"),
    ],
)
def test_what_does_not_fit_is_named(
    tmp_path: Path, accessor: int, change: dict[str, Any], message: str
) -> None:
    data = stream()
    b = sheet(data, ids(data))
    b.json["accessors"][accessor] |= change
    with pytest.raises(InputError, match=message):
        gltf.read(b.glb(tmp_path / "a.glb"))


def test_wrong_identity_mode_or_sharing(tmp_path: Path) -> None:
    data, path = stream(), tmp_path / "a.glb"
    b = sheet(data, ids(data) | {"POSITION": 77})
    with pytest.raises(InputError, match=r"attributes\.POSITION: no such attribute .* got 77"):
        gltf.read(b.glb(path))
    b = sheet(data, ids(data))
    b.json["meshes"][0]["primitives"][0]["mode"] = 6
    with pytest.raises(InputError, match=P + "mode: wanted 4 or 5"):
        gltf.read(b.glb(path))
    b = sheet(data, ids(data))
    first = b.json["meshes"][0]["primitives"][0]
    b.json["meshes"][0]["primitives"].append(first)  # the same again is one mesh
    assert len(gltf.read(b.glb(path)).meshes) == 1
    other = {NAME: first["extensions"][NAME] | {"bufferView": b.view(data)}}
    b.json["meshes"][0]["primitives"].append(first | {"extensions": other})
    with pytest.raises(
        InputError, match="an accessor of compressed data can belong to only one primitive"
    ):
        gltf.read(b.glb(path))


def test_damaged_streams_end_in_a_scene_or_one_error(tmp_path: Path) -> None:
    data, path = stream(preserve_order=False), tmp_path / "a.glb"
    rng, errors, identities = np.random.default_rng(2), 0, ids(data)
    for step in range(300):
        bad = bytearray(data)
        for place in rng.integers(0, len(bad), rng.integers(1, 4)):
            bad[place] = rng.integers(256)
        cut = bytes(bad if step % 5 else bad[: 1 + step * len(bad) // 300])
        try:
            gltf.read(sheet(cut, identities).glb(path))
        except InputError:
            errors += 1
    assert errors > 60
