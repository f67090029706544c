"""Overscan: the picture keeps its bits, and what lies around it is what a larger sensor sees."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.camera.overscan import NONE, Overscan, check_overscan
from daguerre.cli import main
from daguerre.errors import UsageError
from daguerre.pictures.exr.reader import ExrReader
from daguerre.rendering.merging import merge
from daguerre.rendering.passes import pass_of
from daguerre.rendering.session import Session
from tests.post.test_post import post
from tests.support.formats.make_gltf import triangle
from tests.support.scene import scenes

SIZE = (24, 16)
OVER = (5, 3, 7, 4)  # left, top, right, bottom
INNER = np.s_[3 : 3 + 16, 5 : 5 + 24]
AT = scenes.at(0.2, 0.1, 1.0)
GAUSS = dg.Camera(
    lens="double-gauss-50mm-f2", f_stop=2.0, focus_distance=2.0, transform=AT, iso=100
)
PINCUSHION = dg.Projection("opencv", SIZE, (20.0, 20.5), (12.3, 7.1), (0.2, 0.02, -1e-3, 2e-3))
ROLLING = dg.RollingShutter("top", readout_time=0.01)
CASES: dict[str, tuple[dg.Camera, dict[str, Any]]] = {
    "pinhole": (dg.Camera(lens="pinhole", focal_length=30.0, transform=AT), {}),
    "thin, rolling": (
        dg.Camera(focal_length=30.0, focus_distance=2.0, transform=AT, rolling_shutter=ROLLING),
        {"light_paths": (300, 300)},
    ),
    "thick": (GAUSS.with_(lens_model="thick"), {}),
    "exact": (GAUSS, {"light_paths": (300, 300)}),
    "exact, wide filter": (GAUSS, {"filter": "gaussian:4"}),
    "exact, shifted": (GAUSS.with_(shift=(2.0, 1.0)), {"filter": "box"}),
    "polynomial": (GAUSS.with_(lens_model="polynomial"), {}),
    "flare and scatter": (GAUSS, {"flare": 2e4, "scatter": 2e3}),
    "projection": (
        dg.Camera(projection=PINCUSHION, f_stop=2.0, focus_distance=2.0, transform=AT),
        {"bands": 4},
    ),
    "sensor": (GAUSS.with_(sensor="ideal"), {}),
}


FLARE = pytest.param("flare and scatter", marks=pytest.mark.slow)


@pytest.fixture(scope="module")
def room() -> dg.Scene:
    return scenes.lamp_room()


def planes(frame: dg.Frame) -> dict[str, np.ndarray]:
    named = {
        name: getattr(frame, name)
        for name in ("rgb", "xyz", "alpha", "variance", "samples", "flare", "channels", "bands")
    }
    return {name: plane for name, plane in (named | frame.aovs).items() if plane is not None}


def without_inner(plane: np.ndarray) -> np.ndarray:
    around = np.ones(plane.shape[:2], bool)
    around[INNER] = False
    return plane[around]


@pytest.mark.parametrize("name", [FLARE if name == "flare and scatter" else name for name in CASES])
def test_the_picture_keeps_its_bits(name: str, room: dg.Scene) -> None:
    camera, options = CASES[name]
    how: dict[str, Any] = {"resolution": SIZE, "spp": 2, "aovs": True, "motion": True, **options}
    plain = dg.render(room, camera, **how)
    grown = dg.render(room, camera, overscan=OVER, **how)
    assert grown.metadata["crop"] == (-5, -3, 31, 20)
    assert grown.metadata["resolution"] == SIZE
    found = planes(grown)
    for plane, values in planes(plain).items():
        assert np.array_equal(values, found[plane][INNER], equal_nan=True), plane
    assert (without_inner(grown.samples) == 2).all()


def larger(camera: dg.Camera) -> dg.Camera:
    """The camera whose whole picture is the data window."""
    pitch = camera.sensor_size[0] / SIZE[0]
    width, height = SIZE[0] + 12, SIZE[1] + 7
    right, up = (7 - 5) / 2 * pitch, (3 - 4) / 2 * pitch
    if camera.projection is not None:
        p = camera.projection
        principal = (p.center[0] + 5, p.center[1] + 3)
        grown = dg.Projection(p.model, (width, height), p.focal, principal, p.parameters)
        return camera.with_(projection=grown, sensor_size=(width * pitch, height * pitch))
    return camera.with_(sensor_size=(width * pitch, height * pitch), shift=(right, up))


@pytest.mark.parametrize("name", ["pinhole", "exact", "polynomial", FLARE, "projection"])
def test_around_it_is_what_a_larger_sensor_sees(name: str, room: dg.Scene) -> None:
    camera, options = CASES[name]
    how: dict[str, Any] = {"spp": 64, "aovs": True, "filter": "box:0.5", **options}
    grown = dg.render(room, camera, resolution=SIZE, overscan=OVER, **how)
    whole = dg.render(room, larger(camera), resolution=(36, 23), seed=5, **how)
    scale = grown.metadata["camera"]["h0"] / whole.metadata["camera"]["h0"]
    assert scale == pytest.approx(1, rel=1e-3)
    difference, variance = grown.rgb - whole.rgb, grown.variance + whole.variance
    known = without_inner(variance) > 1e-7
    z = without_inner(difference)[known] / np.sqrt(without_inner(variance)[known])
    assert known.mean() > 0.3
    assert abs(z.mean()) < 4 / np.sqrt(len(z)) * 1.5
    # Less than of independent samples, as those of a pixel are stratified.
    assert 0.1 < np.median(np.abs(z)) < 0.8
    hit = without_inner(np.minimum(grown.alpha, whole.alpha)) == 1
    for axis, channel in ((1, "P.X"), (0, "P.Z")):  # in the right places: to a tenth of a pixel
        place = whole.aovs[channel]
        step = np.median(np.abs(np.gradient(place, axis=axis)[whole.alpha == 1]))
        off = np.abs(without_inner(grown.aovs[channel] - place))[hit]
        assert np.median(off) < 0.1 * step
    if grown.flare is not None:
        ghosts = [without_inner(f.flare).sum() for f in (grown, whole)]
        assert ghosts[0] == pytest.approx(ghosts[1], rel=0.1)


@pytest.mark.parametrize("name", ["pinhole", "exact", "projection"])
def test_ground_truth_around_it_is_that_of_a_larger_sensor(name: str, room: dg.Scene) -> None:
    camera = CASES[name][0]
    how: dict[str, Any] = {"spp": 1, "aovs": True, "gt_time": "mid", "light_paths": "off"}
    grown = dg.render(room, camera, resolution=SIZE, overscan=OVER, **how)
    whole = dg.render(room, larger(camera), resolution=(36, 23), **how)
    for channel in ("distance.Z", "P.X", "N.Y"):
        found = [without_inner(f.aovs[channel]) for f in (grown, whole)]
        np.testing.assert_allclose(*found, rtol=2e-4, atol=2e-4)


def test_light_paths_land_around_the_picture(room: dg.Scene) -> None:
    camera = dg.Camera(focal_length=20.0, f_stop=1.0, focus_distance=1.0, transform=AT)
    how: dict[str, Any] = {"resolution": SIZE, "overscan": OVER, "spp": 64}
    traced = dg.render(room, camera, technique="light", light_paths=(4000, 4000), **how)
    drawn = dg.render(room, camera, technique="camera", light_paths=(10, 10), **how)
    light, seen = (without_inner(f.rgb).mean() for f in (traced, drawn))
    assert light > 0.5 * seen > 0


def test_a_crop_may_reach_out_of_the_picture(room: dg.Scene) -> None:
    camera, _ = CASES["pinhole"]
    how: dict[str, Any] = {"resolution": SIZE, "overscan": OVER, "spp": 2, "light_paths": "off"}
    whole = dg.render(room, camera, **how)
    for box in ((-4, -2, 6, 8), (25, 0, 30, 10), (2, 3, 20, 9), (-5, -3, -1, -2)):
        part = dg.render(room, camera, crop=box, **how)
        x0, y0, x1, y1 = box
        cut = whole.rgb[y0 + 3 : y1 + 3, x0 + 5 : x1 + 5]
        assert np.array_equal(part.rgb, cut), box
    with pytest.raises(UsageError, match="crop"):
        dg.render(room, camera, crop=(-6, 0, 4, 4), **how)


@pytest.mark.parametrize("name", ["exact", FLARE])
def test_passes_add_and_go_on_to_the_same_bits(name: str, room: dg.Scene) -> None:
    camera, options = CASES[name]
    how: dict[str, Any] = {"resolution": SIZE, "overscan": OVER, **options}
    whole = dg.render(room, camera, spp=3, **how)
    passes = []
    for begin, end in ((1, 3), (0, 1)):
        session = Session(room, camera, **how)
        session.draw(begin, end)
        passes.append(pass_of(session))
    merged, _ = merge(passes)
    assert np.array_equal(merged.rgb, whole.rgb)
    resumed = Session(room, camera, **how)
    state = {part: words.copy() for part, words in passes[1].state.items()}
    resumed.set_state(state, passes[1].ranges)
    resumed.draw(1, 3)
    assert np.array_equal(resumed.frame().rgb, whole.rgb)
    other = Session(room, camera, **{**how, "overscan": 4})
    assert other.key["settings"] != resumed.key["settings"]


def test_adaptive_sampling_reaches_around_the_picture(room: dg.Scene) -> None:
    camera, _ = CASES["thin, rolling"]
    how: dict[str, Any] = {"resolution": SIZE, "overscan": OVER, "light_paths": (200, 200)}
    frame = dg.render(room, camera, noise=0.04, spp=256, **how)
    assert frame.metadata["noise"] <= 0.04
    assert frame.samples.min() >= 4
    assert frame.samples.max() > frame.samples.min()
    plain = dg.render(room, camera, spp=256, **how)
    for part in (np.s_[:3], np.s_[:, :5], INNER):
        assert frame.rgb[part].mean() == pytest.approx(plain.rgb[part].mean(), rel=0.12)


def test_diffraction_and_overscan(room: dg.Scene) -> None:
    camera = dg.Camera(focal_length=30.0, f_stop=16.0, focus_distance=2.0, transform=AT)
    how: dict[str, Any] = {"resolution": SIZE, "spp": 4, "light_paths": "off"}
    waves = dg.Diffraction(3, 1)
    frame = dg.render(room, camera, overscan=OVER, diffraction=waves, **how)
    plain = dg.render(room, camera, overscan=OVER, **how)
    assert frame.rgb.shape == (23, 36, 3)
    # The light of pixels of 1.5 mm stays where it is, but for a little of what is bright.
    assert np.abs(frame.rgb - plain.rgb).mean() < 0.02 * plain.rgb.mean()


def test_windows_of_files_and_pictures_without_overscan(tmp_path: Path, room: dg.Scene) -> None:
    frame = dg.render(room, GAUSS, resolution=SIZE, spp=1, overscan=OVER, aovs=True)
    plain = dg.render(room, GAUSS, resolution=SIZE, spp=1, aovs=True)
    frame.save(tmp_path / "a.exr")
    reader = ExrReader(tmp_path / "a.exr")
    assert (reader.corner, reader.width, reader.height) == ((-5, -3), 36, 23)
    assert (reader.full_corner, reader.full_size) == ((0, 0), SIZE)
    assert reader.facts["daguerre:overscan"] == "5,3,7,4"
    back = dg.load_frame(tmp_path / "a.exr")
    assert back.metadata["resolution"] == SIZE
    assert back.metadata["crop"] == (-5, -3, 31, 20)
    assert np.array_equal(back.rgb, frame.rgb)
    assert np.array_equal(back.without_overscan().rgb, plain.rgb)
    for ending in ("png", "tif", "jpg"):
        frame.save(tmp_path / f"a.{ending}")
        plain.save(tmp_path / f"b.{ending}")
        same = [oiio.ImageBuf(str(tmp_path / f"{n}.{ending}")).get_pixels() for n in "ab"]
        assert np.array_equal(same[0], same[1])
    assert frame.expose(seed=1).mosaic.shape == SIZE[::-1]
    assert dg.metering.meter(frame) == dg.metering.meter(plain)
    assert dg.development.develop(frame).pixels.shape == (16, 24, 3)
    inner = dg.render(room, GAUSS, resolution=SIZE, spp=1, overscan=OVER, crop=(-4, -2, 0, 5))
    with pytest.raises(UsageError, match="holds only overscan"):
        inner.save(tmp_path / "c.png")


def test_straightened_without_holes(tmp_path: Path) -> None:
    """A wall of lines through a pincushion: straight lines, as the pinhole draws them."""
    size = (96, 64)
    model = dg.Projection("opencv", size, (80.0, 82.0), (50.3, 30.1), (0.35, 0.1, -2e-3, 4e-3))
    bent = dg.Camera(projection=model, f_stop=None)
    ideal = dg.Projection("rectilinear", size, model.focal, model.principal)
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    for k in range(-9, 10):  # bars of a grid, far beyond the picture
        for turn in (0, 1):
            at = np.eye(4)
            at[:3, :3] = np.diag([0.03, 3.0, 1.0]) if turn else np.diag([3.0, 0.03, 1.0])
            at[1 - turn, 3], at[2, 3] = 0.2 * k, -2.0
            scene.add_instance(scene.add_mesh(*scenes.quad(1.0)), transform=at)
    pinhole = dg.render(
        scene, bent.with_(projection=ideal), resolution=size, spp=64, light_paths="off"
    )
    maps = dg.stmaps(bent, size)
    maps.save(undistort=tmp_path / "st.exr")
    straight = {}
    for name, overscan in (("none", None), ("undistort", "undistort")):
        frame = dg.render(
            scene, bent, resolution=size, spp=64, overscan=overscan, light_paths="off"
        )
        frame.save(tmp_path / f"{name}.exr")
        words = ["-o", tmp_path / "out.exr", "--effect", f"stmap:file={tmp_path / 'st.exr'}"]
        assert post(tmp_path / f"{name}.exr", *words) == 0
        straight[name] = dg.load_frame(tmp_path / "out.exr").without_overscan()
    empty = {name: (frame.rgb.max(axis=2) == 0).mean() for name, frame in straight.items()}
    assert empty["none"] > 0.1
    assert empty["undistort"] == 0
    off = np.abs(straight["undistort"].rgb - pinhole.rgb)
    assert np.sqrt((off**2).mean()) < 0.02
    assert np.abs(off.mean(axis=2)[[0, -1]]).mean() < 0.02  # at the edges, too
    assert maps.needed["undistort"] == check_overscan(frame.metadata["overscan"], size)


def test_undistort_needs_nothing_where_nothing_is_lost(room: dg.Scene) -> None:
    barrel = dg.Projection("opencv", SIZE, (20.0, 20.0), None, (-0.2, 0.02))
    session = Session(room, dg.Camera(projection=barrel, f_stop=None), resolution=SIZE,
                      overscan="undistort", light_paths="off")  # fmt: skip
    assert session.overscan == NONE
    assert any("none is needed" in note for note in session.notes)
    folds = dg.Projection("opencv", SIZE, (12.0, 12.0), None, (0.3, -0.35))
    with pytest.raises(UsageError, match=r"overscan undistort: impossible: .* at \("):
        dg.render(room, dg.Camera(projection=folds, f_stop=None), resolution=SIZE,
                  overscan="undistort")  # fmt: skip
    absurd = dg.Projection("opencv", SIZE, (12.0, 12.0), None, (9.0, 9.0))
    with pytest.raises(UsageError, match="px around a picture of 24 x 16"):
        dg.render(room, dg.Camera(projection=absurd, f_stop=None), resolution=SIZE,
                  overscan="undistort")  # fmt: skip


def test_what_is_asked_for() -> None:
    size = (200, 100)
    assert check_overscan(None, size) == NONE
    assert check_overscan(7, size) == check_overscan("7px", size) == Overscan(7, 7, 7, 7)
    assert check_overscan("10%", size) == Overscan(20, 10, 20, 10)
    assert check_overscan("1, 2,3px,4%", size) == Overscan(1, 2, 3, 4)
    assert check_overscan((1, 2, 3, 4), size) == Overscan(1, 2, 3, 4)
    assert check_overscan("undistort", size) is None
    assert Overscan(1, 2, 3, 4).region(size) == (-1, -2, 203, 104)
    for wrong in ("1,2", "undistrot", "-3", "1.5px", (1, 2, 3), -1, 1.5, "70000", "nan%"):
        with pytest.raises(UsageError, match="overscan"):
            check_overscan(wrong, size)


def test_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = triangle().glb(tmp_path / "a.glb")
    words = ["render", str(scene), "--res", "40x20", "--spp", "1", "--overscan"]
    file = tmp_path / "o.exr"
    maps = ["--export-raymap", str(tmp_path / "r.exr")]
    assert (
        main([*words, "10%", "-o", str(file), "--crop", "left=-4,top=-1,right=10,bottom=5", *maps])
        == 0
    )
    reader = ExrReader(file)
    assert (reader.corner, reader.width, reader.height) == ((-4, -1), 14, 6)
    assert ExrReader(tmp_path / "r.exr").corner == (-4, -2)
    lens = ["--lens", "canon-ef-11-24mm-f4", "--focus", "1"]
    assert main([*words, "undistort", "-o", str(file), *lens]) == 0
    assert "overscan (left, top, right, bottom)" in capsys.readouterr().err
    for wrong, word in (
        (["10%", "-o", "a.png"], ".exr"),
        (["undistrot", "-o", "a.exr"], "undistort"),
        (["2", "-o", "a.exr", "--crop", "left=0,top=0,right=43,bottom=5"], "--crop"),
        (["2", "-o", "a.exr", "--coco", "a.json"], "--coco"),
        (["2", "--export-raymap", "a.exr", "--coco", "a.json"], "--coco"),
    ):
        assert main([*words, *wrong]) == 2
        assert word in capsys.readouterr().err


def test_passes_of_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = triangle().glb(tmp_path / "a.glb")
    file, words = tmp_path / "o.exr", ["render", str(scene), "--res", "40x20"]
    whole, passes = tmp_path / "whole.exr", [tmp_path / f"{n}.exr" for n in "ab"]
    assert main([*words, "--spp", "3", "--overscan", "4", "-o", str(whole)]) == 0
    for path, samples in zip(passes, ("0:1", "1:3"), strict=True):
        assert main([*words, "--samples", samples, "--overscan", "4", "-o", str(path)]) == 0
    assert main(["merge", *map(str, passes), "-o", str(file)]) == 0
    merged = dg.load_frame(file)
    assert np.array_equal(merged.rgb, dg.load_frame(whole).rgb)
    assert merged.metadata["overscan"] == "4,4,4,4"
    assert main([*words, "--samples", "3:4", "--overscan", "5", "-o", str(file)]) == 0
    capsys.readouterr()
    assert main(["merge", str(passes[0]), str(file), "-o", str(whole)]) == 4
    assert "overscan (5,5,5,5, wanted 4,4,4,4)" in capsys.readouterr().err
