"""The six scenes of scenes/extensions.py: every extension that is read has its picture."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.importers.gltf.extensions import KNOWN
from tests.support.scene.example_scenes import make

ROOT = Path(__file__).resolve().parents[2]
SCENES = ("shelf", "glass", "octopus", "garden", "street", "packed", "street_on_the_map")
PACKAGES = ("DracoPy", "opengl_basisu")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    for package in PACKAGES:
        pytest.importorskip(package, reason="needs the extra compression")
    made = tmp_path_factory.mktemp("extensions")
    make("extensions", made)
    return made


def document(path: Path) -> dict[str, Any]:
    data = path.read_bytes()
    text: dict[str, Any] = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    return text


def test_together_they_use_every_extension_that_is_read(folder: Path) -> None:
    used: set[str] = set()
    for name in SCENES:
        text = document(folder / f"{name}.glb")
        used |= set(text["extensionsUsed"])
        plain = json.dumps(text)
        assert set(text.get("extensionsRequired", [])) <= set(text["extensionsUsed"])
        for extension in {*text["extensionsUsed"]} - {"KHR_mesh_quantization"}:  # no object of it
            assert f'"{extension}": {{' in plain, (name, extension)
    assert used == KNOWN


@pytest.mark.parametrize("name", SCENES)
def test_loads_without_a_warning_and_shows_something(folder: Path, name: str) -> None:
    scene = dg.load(folder / f"{name}.glb")
    assert scene.warnings == []
    assert list(scene.cameras) == ["Camera"]
    frame = dg.render(scene, spp=1, resolution=(32, 18), max_depth=4)
    assert np.isfinite(frame.rgb).all()
    assert (frame.rgb.max(axis=2) > 0.01).mean() > 0.5


def test_same_bytes_every_time(folder: Path, tmp_path: Path) -> None:
    for name in ("packed", "garden"):  # the two with encoders of others in them
        make("extensions", tmp_path, "--only", name)
        assert (tmp_path / f"{name}.glb").read_bytes() == (folder / f"{name}.glb").read_bytes()


def test_packed_meshes_are_what_was_packed(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "scenes"))
    from extensions import packed

    wanted = {"shell": packed._shell(), "urchin": packed._urchin(), "vase": packed._twisted_vase()}
    scene = dg.load(folder / "packed.glb")
    meshes = {mesh.name: mesh for mesh in scene.meshes}
    for name, shape in wanted.items():
        got = np.asarray(meshes[name].positions)
        np.testing.assert_array_equal(np.asarray(meshes[name].indices), shape.indices)
        low, high = shape.positions.min(0), shape.positions.max(0)
        half = (high - low).max() / 2
        np.testing.assert_allclose(got * half + (low + high) / 2, shape.positions, atol=2e-5 * half)


def test_the_octopus_moves_blinks_and_changes_colour(folder: Path) -> None:
    path = folder / "octopus.glb"
    still, blink, end = (dg.load(path, time=t) for t in (0.0, 2.0, 4.0))
    names = [[i.name for i in scene.instances if i.shown] for scene in (still, blink)]
    assert sum(n.startswith("lid") for n in names[0]) == 0
    assert sum(n.startswith("lid") for n in names[1]) == 2
    arms = [
        next(np.asarray(m.positions) for m in scene.meshes if m.name == "arms")
        for scene in (still, blink, end)
    ]
    assert np.linalg.norm(arms[1] - arms[0], axis=1).max() > 0.05
    np.testing.assert_allclose(arms[2], arms[0], atol=1e-5)
    skins = [
        next(m.kind.base_color for m in scene.materials if m.name == "skin")
        for scene in (still, blink)
    ]
    assert skins[0] != skins[1]


def test_the_shelf_has_its_variants(folder: Path) -> None:
    scene = dg.load(folder / "shelf.glb", variant="at sea")
    assert scene.variants == ["at sea", "in the woods"]
    plain = dg.load(folder / "shelf.glb")
    vases = [
        next(s.materials[i.material] for i in s.instances if i.name == "clearcoat").kind.base_color
        for s in (plain, scene)
    ]
    assert vases[0][0] > vases[0][2]
    assert vases[1][0] < vases[1][2]


def test_mosaics_have_a_stone_for_every_block(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "scenes"))
    from extensions import plants

    scene = dg.load(folder / "garden.glb")
    pixels = next(t.pixels for t in scene.textures if t.name == "mosaic3")
    wanted = np.rint(np.clip(plants.stones(3), 0, 1) * 255)
    for corner in (0, 3):
        np.testing.assert_allclose(pixels[corner::4, corner::4, :3], wanted, atol=1)
