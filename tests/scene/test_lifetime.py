"""The core reads numpy arrays in place: they live as long as it looks, and nobody changes them."""

from __future__ import annotations

import gc
import sys

import numpy as np

import daguerre as dg
from daguerre.checks import as_readonly, freeze_in_place
from daguerre.rendering.session import Session
from daguerre.setup.scene import build
from tests.support.scene import scenes


def _arrays() -> dict[str, np.ndarray]:
    """A rippled sheet with everything that a mesh can carry, and its picture."""
    n = 24
    y, x = np.mgrid[0:n, 0:n].astype(np.float32) / (n - 1)
    positions = np.stack([4 * x - 2, 4 * y - 2, 0.3 * np.sin(9 * x)], axis=2).reshape(-1, 3)
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    a, b, c, d = corner, corner + 1, corner + n + 1, corner + n
    normals = np.tile(np.float32([0, 0, 1]), (n * n, 1))
    picture = np.random.default_rng(1).integers(0, 256, (64, 64, 3), np.uint8)
    return {
        "positions": np.ascontiguousarray(positions, np.float32),
        "indices": np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]).astype("u4"),
        "normals": normals,
        "uv": np.ascontiguousarray(np.stack([x, y], axis=2).reshape(-1, 2)),
        "colors": np.ones((n * n, 4), np.float32),
        "picture": picture,
    }


def _scene(arrays: dict[str, np.ndarray]) -> dg.Scene:
    arrays = dict(arrays)
    scene = dg.Scene()
    picture = scene.add_texture(arrays.pop("picture"), srgb=True)
    slot = dg.TextureSlot(picture)
    mesh = scene.add_mesh(**arrays)
    scene.add_instance(mesh, dg.Material(dg.Gltf(base_color_texture=slot, metallic=0)))
    scene.add_camera("Camera", dg.Camera(transform=scenes.at(0, 0, 5)))
    scene.set_environment(color=(1, 1, 1))
    return scene


def _picture(session: Session) -> np.ndarray:
    session.draw(0, 2)
    return session.frame().rgb


def test_arrays_that_were_deleted_or_overwritten_still_render_the_same_bits() -> None:
    wanted = _picture(Session(_scene(_arrays()), resolution=(48, 32)))
    arrays = _arrays()
    scene = _scene(arrays)
    session = Session(scene, resolution=(48, 32))
    for values in arrays.values():
        values[:] = 0
    scene.meshes.clear()
    scene.textures.clear()
    del arrays, values
    gc.collect()
    littered = [np.full(300_000, 255, np.uint8) for _ in range(100)]  # over what was freed
    assert np.array_equal(_picture(session), wanted)
    assert len(littered) == 100


def test_the_core_keeps_arrays_and_lets_them_go() -> None:
    scene = _scene(_arrays())
    mesh, texture = scene.meshes[0], scene.textures[0]
    arrays = [mesh.positions, mesh.indices, mesh.normals, mesh.uv, mesh.colors, texture.pixels]
    before = [sys.getrefcount(a) for a in arrays]
    core = build(scene)
    during = [sys.getrefcount(a) for a in arrays]
    assert all(n > m for n, m in zip(during, before, strict=True))  # not copied
    del core
    assert [sys.getrefcount(a) for a in arrays] == before


def test_a_scene_keeps_no_array_that_its_maker_can_change() -> None:
    mine = _arrays()
    scene = _scene(mine)
    for name in ("positions", "indices", "normals", "uv", "colors"):
        kept = getattr(scene.meshes[0], name)
        assert not kept.flags.writeable
        assert not np.shares_memory(kept, mine[name])
    assert not np.shares_memory(scene.textures[0].pixels, mine["picture"])
    once = freeze_in_place(mine["positions"].copy())
    assert as_readonly(once) is once
    view = mine["positions"][:]
    view.flags.writeable = False
    assert as_readonly(view) is not view  # its base may still change
