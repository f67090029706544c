"""Ground truth as means over the rays that expose each pixel: through every kind of lens."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenEXR
import pytest

import daguerre as dg
from daguerre.camera.projection import Projection
from daguerre.camera.rolling_shutter import RollingShutter
from daguerre.cli import main
from daguerre.errors import UsageError
from daguerre.rendering.truth import GroundTruth
from tests.rendering.test_truth import FPS, PINHOLE, SIZE, at, drifting, truth, turned, wall
from tests.support.scene import scenes

MODEL = Projection("kannala_brandt", SIZE, (30.0, 30.0), None, (0.05, -0.01, 0, 0))
LENS = "double-gauss-50mm-f2"
KINDS = {
    "pinhole": PINHOLE,
    "thin": dg.Camera(lens="thin", f_stop=2.0, focus_distance=4.0),
    "thick": dg.Camera(lens=LENS, lens_model="thick", focus_distance=4.0),
    "exact": dg.Camera(lens=LENS, lens_model="exact", focus_distance=4.0),
    "polynomial": dg.Camera(lens=LENS, lens_model="polynomial", focus_distance=4.0),
    "tilted": dg.Camera(lens="thin", f_stop=2.0, focus_distance=4.0, tilt=(3.0, 0.0)),
    "projection": dg.Camera(projection=MODEL, f_stop=2.0, focus_distance=4.0),
}


def seen(camera: dg.Camera, scene: dg.Scene, gt_lens: str = "mean", rays: int = 256) -> dict:
    camera = camera.with_(shutter_time=0.0)
    made = GroundTruth(scene, camera, SIZE, (0, 0, *SIZE), "mid", gt_lens, rays)
    return made.planes(motion=False)


@pytest.mark.parametrize("kind", KINDS)
def test_in_focus_the_mean_is_the_chief_ray(kind: str) -> None:
    camera, scene = KINDS[kind], wall(at(z=-4))
    mean, chief = seen(camera, scene), seen(camera, scene, "chief")
    met = (mean["coverage.Y"] == 1) & (chief["depth.Z"] > 0)
    assert met.mean() > 0.9
    np.testing.assert_allclose(mean["depth.Z"][met], 4, rtol=1e-5)
    for name in ("P.X", "P.Y"):
        pixel = np.abs(np.gradient(chief[name])[name == "P.X"])[met].max()
        # Tilted, only one line of the wall is in focus: the blur's middle is its chief ray's.
        assert np.abs(mean[name] - chief[name])[met].max() < 0.06 * pixel


@pytest.mark.parametrize("kind", ["exact", "polynomial"])
def test_vignetting_darkens_nothing(kind: str) -> None:
    camera = KINDS[kind].with_(focus_distance=1.0, f_stop=2.0)
    planes = seen(camera, wall(at(z=-4)))
    light = dg.render(wall(at(z=-4)), camera, resolution=SIZE, spp=16, max_depth=1).rgb[..., 1]
    assert light[0, 0] < 0.7 * light[SIZE[1] // 2, SIZE[0] // 2]  # there is some
    np.testing.assert_allclose(planes["depth.Z"], 4, rtol=1e-5)
    np.testing.assert_array_equal(planes["coverage.Y"], 1)
    np.testing.assert_allclose(planes["N.Z"], 1)
    assert planes["distance.Z"].min() >= 4


def test_each_line_of_a_rolling_shutter_has_its_own_moment() -> None:
    line_time = 2e-3
    camera = KINDS["thin"].with_(
        fps=FPS, shutter_time=0.04, rolling_shutter=RollingShutter("top", line_time=line_time)
    )
    frame = truth(drifting((0, -1.0, 5.0)), camera, gt_time="mid", gt_lens="mean")
    lines = np.arange(SIZE[1])[:, None] - (SIZE[1] - 1) / 2
    depth = np.broadcast_to(4 - 5 * line_time * lines, SIZE[::-1])
    np.testing.assert_allclose(frame.aovs["depth.Z"], depth, rtol=1e-5)
    # The whole wall is at one depth, so motion is that of the chief rays, but for the pixel's area.
    chief = truth(drifting((0, -1.0, 5.0)), camera).motion
    np.testing.assert_allclose(frame.motion, chief, atol=0.02)


def test_motion_of_the_sky_and_of_what_is_hidden_then() -> None:
    sky = dg.Scene()
    sky.set_environment(color=(1, 1, 1))
    pan = KINDS["thin"].with_(
        fps=FPS, transform=dg.keys([(t, turned(2, 30 * t)) for t in (-1.0, 1.0)])
    )
    mean, chief = (truth(sky, pan, gt_lens=lens).motion for lens in ("mean", "chief"))
    np.testing.assert_allclose(mean, chief, atol=0.01)
    assert np.abs(chief).max() > 0.3
    scene = dg.Scene()
    shown = dg.keys([(0.0, True), (0.05, False)])
    scene.add_instance(scene.add_mesh(*scenes.quad(4)), transform=at(z=-4), shown=shown)
    frame = truth(scene, PINHOLE, gt_lens="mean")
    assert np.isnan(frame.motion).all()
    assert frame.metadata["motion_missing"] == SIZE[0] * SIZE[1]
    assert not np.isnan(frame.motion_back).any()


def test_means_are_the_same_each_time_and_with_few_rays_near_those_with_many() -> None:
    scene = wall(at(x=-4, z=-4))  # ends in the middle of the picture
    camera = KINDS["thin"].with_(focus_distance=0.6)
    few, again, many = (seen(camera, scene, rays=n) for n in (64, 64, 4096))
    for name, plane in few.items():
        np.testing.assert_array_equal(plane, again[name], err_msg=name)
    error = few["coverage.Y"] - many["coverage.Y"]
    partial = (many["coverage.Y"] > 0.01) & (many["coverage.Y"] < 0.99)
    assert partial.sum() > SIZE[1]
    assert 0.001 < error[partial].std() < 0.03  # 0.019; of random rays it would be 0.04


def test_files_say_how_and_merge_keeps_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from tests.support.formats.make_gltf import triangle

    monkeypatch.chdir(tmp_path)
    made = triangle()
    made.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.01}})
    made.node(camera=0, translation=[0, 0, 2.0])
    made.glb(tmp_path / "s.glb")
    flags = ["--res", "12x8", "--sky", "1,1,1", "--quiet", "--aov", "depth,coverage,motion"]
    flags += ["--gt-lens", "mean", "--gt-rays", "32", "--f-stop", "1"]
    for name, samples in (("a", "0:2"), ("b", "2:4")):
        assert main(["render", "s.glb", "-o", f"{name}.exr", "--samples", samples, *flags]) == 0
    assert main(["merge", "b.exr", "a.exr", "-o", "m.exr", "--quiet"]) == 0
    with OpenEXR.File("m.exr", separate_channels=True) as file:
        header, channels = dict(file.header()), file.channels()
        coverage = channels["coverage.Y"].pixels.copy()
        assert {"depth.Z", "motion.U", "motion.V"} <= set(channels)
    assert (header["daguerre:gt_lens"], header["daguerre:gt_rays"]) == ("mean", 32)
    assert header["daguerre:gt_time"] == "mid"
    assert coverage.min() == 0
    assert coverage.max() == 1
    assert ((coverage > 0) & (coverage < 1)).any()


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (
            ["--gt-lens", "meen", "--aov", "N"],
            "--gt-lens: wanted chief or mean, got 'meen' (did you mean",
        ),
        (["--gt-lens", "mean"], "--gt-lens needs ground truth to write"),
        (["--aov", "coverage"], "--aov coverage needs --gt-lens mean"),
        (["--gt-rays", "9", "--aov", "N"], "--gt-rays needs --gt-lens mean"),
        (["--gt-lens", "mean", "--gt-rays", "0", "--aov", "N"], "--gt-rays: wanted 1 .. 65536"),
    ],
)
def test_what_is_refused(
    flags: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["render", "s.glb", "-o", "a.exr", *flags]) == 2
    assert message in capsys.readouterr().err


def test_python_refuses_it_too() -> None:
    with pytest.raises(UsageError, match="gt_lens: wanted chief or mean, got 3"):
        truth(wall(at(z=-4)), gt_lens=3)
    with pytest.raises(UsageError, match="gt_rays: wanted a whole number"):
        truth(wall(at(z=-4)), gt_lens="mean", gt_rays="many")
