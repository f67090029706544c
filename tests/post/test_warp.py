"""Pictures through maps: the way back, OpenCV, bands, windows, lenses."""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre import lenses
from daguerre.analysis.bench import set_up
from daguerre.convolution.rows import Rows
from daguerre.distortion import BrownConrady, Equidistant, OpenCVFisheye, Stereographic
from daguerre.distortion.lens import LensDistortion
from daguerre.errors import UsageError
from daguerre.post import run, tiles
from daguerre.post.effects.distortion import CHANNEL_NM, point_map
from daguerre.post.picture import Canvas
from daguerre.post.warp import Warp
from tests.distortion.test_distortion import ALL, MODELS
from tests.post.test_post import planes, post, read, write

SIZE = (640, 420)
FOCAL = (430.0, 450.0)
CENTRE = (310.0, 215.0)


def soft(width: int, height: int) -> np.ndarray:
    y, x = np.mgrid[:height, :width]
    waves = [np.sin(x / 23 + 1) * np.cos(y / 19), np.sin(y / 17 - x / 29), np.cos(x / 31) + y / 900]
    return (np.stack(waves, 2) * 0.5 + 1).astype(np.float32)


def places(place, canvas: Canvas) -> np.ndarray:
    """Where each pixel's light lies, index coordinates, as the core has it: (H, W, 2)."""
    moved = Warp.of(canvas, place).core.displacements(canvas.width, 0, canvas.height)
    return moved.astype(np.float64) + np.stack(np.meshgrid(
        np.arange(canvas.width), np.arange(canvas.height)), axis=2)  # fmt: skip


def lens_model(name: str, pitch_mm: float) -> tuple[LensDistortion, tuple[float, float]]:
    model = LensDistortion(set_up(lenses.load(name)), 400 * pitch_mm)
    return model, (model.focal_length_mm / pitch_mm,) * 2


@pytest.mark.parametrize("model", [*MODELS, "lens"], ids=str)
def test_distorted_and_straightened_is_where_it_was(model):
    focal = FOCAL
    if model == "lens":
        model, focal = lens_model("canon-ef-11-24mm-f4", 0.05)
    canvas = Canvas(*SIZE)
    bent = point_map(model, focal, CENTRE)
    straight = point_map(model, focal, CENTRE, inverse=True)
    to_ideal = places(bent, canvas)  # for each pixel of the bent picture
    back = straight(to_ideal.reshape(-1, 2) + 0.5).reshape(to_ideal.shape) - 0.5
    pixels = np.stack(np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1])), axis=2)
    known = np.isfinite(to_ideal).all(axis=2)
    assert known.mean() > 0.7
    assert np.abs(back - pixels)[known].max() < 1e-3  # px
    again = places(straight, canvas)
    inside = np.isfinite(again).all(axis=2)
    there = bent(again[inside] + 0.5) - 0.5
    assert np.nanmax(np.abs(there - pixels[inside])) < 1e-3


def test_opencv_has_the_same_maps_and_pictures():
    cv2 = pytest.importorskip("cv2", reason="opencv-python-headless is not installed")
    width, height = SIZE
    matrix = np.array([[FOCAL[0], 0, CENTRE[0] - 0.5], [0, FOCAL[1], CENTRE[1] - 0.5], [0, 0, 1]])
    image = soft(*SIZE)
    numbers = np.array([-0.2, 0.05, 0.001, -0.002, 0.01])
    x, y = cv2.initUndistortRectifyMap(matrix, numbers, None, matrix, SIZE, cv2.CV_32FC1)
    model = BrownConrady(*numbers)
    ours = places(point_map(model, FOCAL, CENTRE, inverse=True), Canvas(*SIZE))
    assert np.abs(ours - np.stack([x, y], 2)).max() < 2e-4
    theirs = cv2.remap(image, x, y, cv2.INTER_LINEAR)
    found = dg.post.undistort(
        image, model, focal_px=FOCAL, centre=CENTRE, filter="linear", antialias=False
    )
    assert np.abs(found - theirs)[2:-2, 2:-2].max() < 1e-3  # OpenCV may count in 1/32 px
    fisheye = OpenCVFisheye(-0.02, 0.01, -0.003, 0.0004)
    k = np.array([-0.02, 0.01, -0.003, 0.0004])
    x, y = cv2.fisheye.initUndistortRectifyMap(matrix, k, np.eye(3), matrix, SIZE, cv2.CV_32FC1)
    ours = places(point_map(fisheye, FOCAL, CENTRE, inverse=True), Canvas(*SIZE))
    assert np.abs(ours - np.stack([x, y], 2)).max() < 2e-4
    assert (width, height) == SIZE


@pytest.mark.parametrize("model", [BrownConrady(-0.2, 0.03), Stereographic(), ALL], ids=str)
def test_a_picture_comes_back(model):
    image = soft(*SIZE)
    scaled = {"focal_px": FOCAL, "centre": CENTRE, "scale": 0.8}
    bent = dg.post.distort(image, model, **scaled)
    back = dg.post.undistort(bent, model, **scaled)
    middle = (slice(100, -100), slice(150, -150))
    assert np.abs(bent - image)[middle].max() > 0.1
    assert np.abs(back - image)[middle].max() < 2e-3
    assert np.array_equal(image, soft(*SIZE))  # the argument is as it was


@pytest.mark.parametrize(
    "name",
    [
        "distortion:model=equisolid,inverse=1,scale=0.4",
        "distortion:k1=-0.3,k2=0.05,p1=0.002",
        "distortion:model=lens,lens=canon-ef-11-24mm-f4,inverse=1",
    ],
)
@pytest.mark.parametrize("block", [7, 64])
def test_bands_are_the_whole_picture_bit_for_bit(tmp_path, monkeypatch, name, block):
    given = planes(230, 130)
    window = {
        "dataWindow": (np.array([3, -5], np.int32), np.array([132, 224], np.int32)),
        "displayWindow": (np.array([0, 0], np.int32), np.array([139, 219], np.int32)),
    }
    source = write(tmp_path / "in.exr", given, **window)
    word = name + ",sensor=36x24" + ("" if "lens" in name else ",focal_length=14")
    assert post(source, "-o", tmp_path / "whole.exr", "--effect", word) == 0
    monkeypatch.setattr(tiles, "BLOCK", block)
    monkeypatch.setattr(run, "BLOCK", block)
    assert post(source, "-o", tmp_path / "bands.exr", "--effect", word) == 0
    whole, bands = read(tmp_path / "whole.exr")[0], read(tmp_path / "bands.exr")[0]
    for channel in given:
        assert np.array_equal(whole[channel], bands[channel]), channel
    assert not np.array_equal(whole["R"], given["R"])
    assert set(np.unique(whole["object_id"])) <= {0, *np.unique(given["object_id"])}


def test_only_what_is_needed_is_read():
    canvas = Canvas(640, 4000)
    warp = Warp.of(canvas, point_map(BrownConrady(-0.1), (4000, 4000), canvas.center))
    begin, end = warp.reads(Rows(1024, 1280))
    assert end - begin < 256 + 120


def test_a_window_inside_a_picture_is_a_part_of_it():
    full = Canvas(*SIZE)
    part = Canvas(200, 100, corner=(50, 70), full_size=SIZE)
    place = point_map(BrownConrady(-0.2), FOCAL, full.center)
    whole, cut = places(place, full), places(place, part)
    assert np.abs(cut + np.array([50, 70]) - whole[70:170, 50:250]).max() < 2e-4


def test_the_model_s_end_is_exact_and_said(tmp_path, capsys):
    canvas = Canvas(*SIZE)
    model = BrownConrady(-0.5)  # turns back at sqrt(2/3)
    found = places(point_map(model, FOCAL, CENTRE, inverse=True), canvas)
    x, y = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    radius = np.hypot((x - CENTRE[0]) / FOCAL[0], (y - CENTRE[1]) / FOCAL[1])
    assert np.array_equal(np.isfinite(found).all(axis=2), radius <= np.sqrt(2 / 3) - 1e-8)
    source = write(tmp_path / "in.exr", planes())
    word = "distortion:k1=-0.5,fx=30,inverse=1"
    assert dg.cli.main(["post", str(source), "-o", str(source), "--effect", word]) == 0
    assert (
        "pixels where the distortion model is not defined are set to 0" in capsys.readouterr().err
    )
    assert read(source)[0]["A"][0, 0] == 0


SQUEEZED = "model=lens,lens=schneider-anamorphic-60mm,focus=3m,sensor=24.9x20.7,lateral_colour=0"


def test_an_anamorphic_lens_bends_files_and_straightens_them(tmp_path, capsys):
    image = soft(120, 100)
    channels = dict(zip("RGB", np.moveaxis(image, 2, 0).copy(), strict=True))
    channels["motion.U"] = np.ones((100, 120), np.float32)
    source = write(tmp_path / "in.exr", channels)
    bent, back = tmp_path / "bent.exr", tmp_path / "back.exr"
    for one, other, inverse in ((source, bent, 0), (bent, back, 1)):
        word = f"distortion:{SQUEEZED},inverse={inverse}"
        assert dg.cli.main(["post", str(one), "-o", str(other), "--effect", word]) == 0
    assert (
        "motion.U: the other coordinate is missing, so the values are moved with the pixels"
        in capsys.readouterr().err
    )
    first, middle, last = (read(path)[0]["G"] for path in (source, bent, back))
    inner = np.s_[10:-10, 12:-12]
    assert np.abs(middle - first)[inner].max() > 0.05
    assert np.abs(last - first)[inner].max() < 0.02


def test_the_axis_is_where_the_file_says(tmp_path):
    """A sensor moved to the right and up sees it to the left and below: nothing moves there."""
    offset = np.array([5000, 3000], np.float32)
    source = write(tmp_path / "in.exr", planes(100, 120), sensorCenterOffset=offset)
    for effect in (f"distortion:{SQUEEZED}", "distortion:k1=-0.3,focal_length=20,sensor=24.9x20.7"):
        st = tmp_path / "st.exr"
        assert post(source, "-o", tmp_path / "out.exr", "--effect", f"{effect},stmap={st}") == 0
        found = read(st)[0]
        x, y = np.meshgrid(np.arange(120) + 0.5, np.arange(100) + 0.5)
        moved = np.hypot(found["R"] * 120 - x, (1 - found["G"]) * 100 - y)
        still = np.unravel_index(np.nanargmin(moved), moved.shape)
        pitch = 24.9 / 120
        assert still[1] == pytest.approx(59.5 - 5 / pitch, abs=1.5)
        assert still[0] == pytest.approx(49.5 + 3 / pitch, abs=1.5)


def test_a_lens_bends_each_colour_its_own_way():
    image = np.ones((400, 600, 3), np.float32) * (np.arange(600) % 50 < 25)[None, :, None]
    bench = set_up(lenses.load("canon-ef-11-24mm-f4"))
    colours = [LensDistortion(bench, 22.0, nm) for nm in CHANNEL_NM]
    focal = colours[0].focal_length_mm / 0.06
    bent = dg.post.distort(image, colours, focal_px=focal)
    for c, model in enumerate(colours):
        one = dg.post.distort(image, model, focal_px=focal)
        assert np.array_equal(bent[:, :, c], one[:, :, c])
    assert np.abs(bent[:, :, 0] - bent[:, :, 2]).max() > 0.05


@pytest.mark.parametrize(
    ("word", "message"),
    [
        ("model=division,k3=1,fx=9", "wanted a coefficient of division (k1, k2), got k3"),
        ("model=equisolid,k1=1,fx=9", "wanted a coefficient of equisolid (it has none), got k1"),
        ("k4=1,fx=9", "wanted a coefficient of brown-conrady (k1, k2, k3, p1, p2), got k4"),
        ("model=lens,sensor=36x24", "distortion: model=lens needs a lens"),
        ("k1=0.1", "focal_length: the file has none"),
        ("k1=0.1,fx=0", "fx: wanted a number of px of at least 0.001"),
        ("k1=0.1,fx=9,filter=nearest", "filter: wanted one of cubic, linear"),
    ],
)
def test_bad_values(tmp_path, capsys, word, message):
    source = write(tmp_path / "in.exr", planes())
    assert post(source, "-o", source, "--effect", f"distortion:{word}") == 2
    assert message in capsys.readouterr().err


def test_bad_arrays():
    with pytest.raises(UsageError, match=r"shape \(H, W, C\)"):
        dg.post.distort(np.ones((3, 3)), BrownConrady(), focal_px=1)
    with pytest.raises(UsageError, match=r"shape \(H, W, C\)"):
        dg.post.vignette(np.full((3, 3, 3), "a"))


def test_few_pixels():
    for size in [(1, 1), (1, 40), (17, 3)]:
        image = np.ones((*size, 3), np.float32)
        bent = dg.post.distort(image, Equidistant(), focal_px=1000)
        assert bent == pytest.approx(image)
