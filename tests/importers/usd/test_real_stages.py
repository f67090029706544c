"""Stages that others made; skipped where the folder with them is absent."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import daguerre as dg

DATA = Path(__file__).resolve().parents[4] / "shared" / "data"
pytestmark = pytest.mark.skipif(
    not (DATA / "scenes" / "toycar_race.usda").exists(),
    reason="../shared/data/scenes/toycar_race.usda is not here",
)


def _race(time: float) -> dg.Scene:
    return dg.load(DATA / "scenes/toycar_race.usda", time=time, allow_dirs=(DATA / "hdri",))


def test_the_race_has_its_camera_and_its_motion() -> None:
    scene = _race(12 / 24)
    camera = scene.camera("/World/Cam")
    assert (camera.focal_length, camera.sensor_size[0], camera.f_stop) == (85.0, 36.0, 2.0)
    assert camera.focus_distance == pytest.approx(0.62)
    assert (camera.iso, camera.exposure_f_stop) == (800.0, 2.0)
    assert camera.exposure_time == pytest.approx(1 / 48, rel=1e-6)
    assert scene.environment is not None
    assert scene.duration == pytest.approx(25 / 24)
    # 3.333 cm a frame along z, as the file says.
    before, after = (scene.at(t / 24).node_positions["World/Sedan"] for t in (12, 13))
    assert np.allclose(after - before, (0, 0, 0.0333333), atol=1e-6)


def test_wheels_turn_between_time_samples() -> None:
    scene = _race(12 / 24)
    (wheel, *_) = (name for name in scene.nodes if name.startswith("World/Sedan/asset/wheel1"))
    first = scene.nodes[wheel][0]
    turned = [scene.at(t / 24).instances[first].transform[:3, :3] for t in (12, 12.5, 13)]
    angles = [
        np.degrees(np.arccos((np.trace(a @ np.linalg.inv(b)) - 1) / 2))
        for a, b in zip(turned[1:], turned[:-1], strict=True)
    ]
    assert angles == pytest.approx([115.50124 / 2] * 2, abs=1e-3)


def test_it_is_drawn_with_the_exposure_that_it_states() -> None:
    scene = _race(12 / 24)
    frame = dg.render(scene, resolution=(48, 27), spp=4)
    assert np.isfinite(frame.rgb).all()
    camera = scene.camera()
    longer = dg.render(
        scene, camera.with_(exposure_time=2 * camera.exposure_time), resolution=(48, 27), spp=4
    )
    assert np.array_equal(frame.rgb, longer.rgb)  # exposure belongs to the development
    dark, light = (np.median(one.expose(seed=1).mosaic) for one in (frame, longer))
    assert light > 1.2 * dark


def test_a_picture_outside_of_the_folder_is_refused_by_its_prim() -> None:
    with pytest.raises(dg.InputError, match=r"/World/Night\.inputs:texture:file: leaves the"):
        dg.load(DATA / "scenes/toycar_race.usda")


@pytest.mark.parametrize("path", ["animated_cube_translation.usda", "mini_car_kit", "teapot"])
def test_each_other_stage_loads(path: str) -> None:
    top = DATA / "scenes" / path
    files = [top] if top.is_file() else [f for f in top.rglob("*.usd*") if f.is_file()]
    assert files
    for file in files:
        scene = dg.load(file, allow_dirs=(top,))
        assert scene.path == file
