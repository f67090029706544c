"""Motion vectors through distortions and STMaps: closed forms, and motion rendered by a lens."""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre import lenses
from daguerre.analysis.bench import set_up
from daguerre.convolution.rows import Rows
from daguerre.distortion import BrownConrady, Equisolid
from daguerre.distortion.lens import LensDistortion
from daguerre.post.effects.distortion import point_map
from daguerre.post.effects.stmap import stmap
from daguerre.post.motion_map import MotionMap
from daguerre.post.picture import Band, Canvas
from daguerre.post.warp import Warp
from daguerre.post.warp_step import WarpStep
from tests.post.test_post import post, read, write
from tests.support.scene.motion_scenes import TIME, card, move

WIDTH, HEIGHT = 120, 90
CENTRE, FOCAL = (60.0, 45.0), (100.0, 100.0)
NAMES = ("motion.U", "motion.V")
BARREL = BrownConrady(k1=-0.25, k2=0.04)


def pixels() -> np.ndarray:
    """Middles of pixels, (H, W, 2)."""
    return np.stack(np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5), axis=2)


def mapped(
    motion: np.ndarray, place, forward, *, names: tuple[str, ...] = NAMES, **values: float
) -> np.ndarray:
    """Motion (H, W, 2) after a map; NaN where nothing of the source is seen."""
    canvas = Canvas(WIDTH, HEIGHT, colors=("Y",), planes=names)
    step = WarpStep(
        canvas, [Warp.of(canvas, place)], filter="cubic", antialias=True, forward=forward,
        motion=values,
    )  # fmt: skip
    planes = {name: motion[:, :, k].astype(np.float32) for k, name in enumerate(names)}
    image = np.ones((HEIGHT, WIDTH, 1), np.float32)
    out = step.apply(Band(Rows(0, HEIGHT), image, planes), Rows(0, HEIGHT))
    found = np.stack([out.planes[name] for name in names], axis=2)
    return np.where(out.image > 0.5, found, np.nan)


def both(model, **how: float):
    maps = [point_map(model, FOCAL, CENTRE, inverse=inverse, **how) for inverse in (False, True)]
    return maps[0], maps[1]


@pytest.mark.parametrize("model", [BARREL, Equisolid()], ids=["barrel", "fisheye"])
@pytest.mark.parametrize("inverse", [False, True])
def test_uniform_motion_ends_where_the_map_puts_its_end(model, inverse):
    place, forward = both(model)[:: -1 if inverse else 1]
    step = np.array([17.3, -9.1])
    found = mapped(np.broadcast_to(step, (HEIGHT, WIDTH, 2)), place, forward)
    start = pixels().reshape(-1, 2)
    wanted = (forward(place(start) + step) - start).reshape(found.shape)
    known = np.isfinite(found).all(axis=2)
    assert known.mean() > 0.6
    assert np.abs(found - wanted)[known].max() < 1e-3
    assert np.abs(wanted - step)[known].max() > 3  # there is something to be seen


def test_a_sheared_picture_has_sheared_motion():
    """Maps of lenses have symmetric derivatives; this one has not."""
    shear = np.array([[1.1, 0.3], [-0.05, 0.9]])
    back, middle = np.linalg.inv(shear), np.add(CENTRE, 0.013)
    motion = np.broadcast_to(np.array([6.0, 2.0]), (HEIGHT, WIDTH, 2))

    def place(points):
        return (points - CENTRE) @ shear.T + middle

    def forward(points):
        return (points - middle) @ back.T + CENTRE

    for known in (forward, None):
        found = mapped(motion, place, known)
        wanted = np.broadcast_to(back @ (6.0, 2.0), found.shape)
        inside = np.isfinite(found).all(axis=2)
        assert inside.mean() > 0.6
        assert np.abs(found - wanted)[inside].max() < 2e-4


def test_a_turn_about_the_centre_stays_one_through_a_round_lens():
    angle = np.radians(10)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    spin = (pixels() - CENTRE) @ (turn - np.eye(2)).T
    found = mapped(spin, *both(BARREL))
    off = np.abs(found - spin)[np.isfinite(found).all(axis=2)]
    # The nearest pixel's motion is that of a place up to 0.7 px away.
    assert off.max() < 1.2 * 0.71 * angle
    assert abs(np.nanmean(found - spin)) < 0.01


def test_what_stands_still_stays_so_and_what_is_unknown_too():
    motion = np.zeros((HEIGHT, WIDTH, 2))
    motion[:, 60:] = np.nan
    found = mapped(motion, *both(BARREL))
    assert (found[40:50, 5:50] == 0).all()
    assert np.isnan(found[40:50, 70:]).all()


def test_motion_that_counts_upward_or_from_the_last_frame():
    maps, flow = both(BARREL), np.broadcast_to(np.array([12.0, 7.0]), (HEIGHT, WIDTH, 2))
    wanted = mapped(flow, *maps)
    up = mapped(flow * (1, -1), *maps, v_up=True)
    assert np.allclose(up * (1, -1), wanted, atol=1e-5, equal_nan=True)
    other = mapped(flow * -0.1, *maps, motion_scale=-10)
    assert np.allclose(other * -10, wanted, atol=1e-4, equal_nan=True)
    back = mapped(flow, *maps, names=("motion_back.U", "motion_back.V"))
    assert np.array_equal(back, wanted, equal_nan=True)


def test_ends_that_a_lens_does_not_show_are_unknown_and_counted():
    canvas = Canvas(WIDTH, HEIGHT, colors=("Y",), planes=NAMES)
    place, forward = both(BrownConrady(k1=-0.4))
    motion = MotionMap(canvas, forward)
    planes = {"motion.U": np.full((HEIGHT, WIDTH), 900.0), "motion.V": np.zeros((HEIGHT, WIDTH))}
    found = motion.turned(planes, Warp.of(canvas, place), Rows(0, HEIGHT))
    assert np.isnan(found["motion.U"]).all()
    assert motion.remarks() == [
        f"{WIDTH * HEIGHT} motion vectors that end outside the map's result are set to NaN"
    ]


def test_an_stmap_turns_motion_to_first_order(tmp_path):
    step = np.array([0.4, -0.3])
    exact = mapped(np.broadcast_to(step, (HEIGHT, WIDTH, 2)), *both(BARREL))
    st = stmap(BARREL, (WIDTH, HEIGHT), focal_px=100.0)
    channels = {"R": st[:, :, 0].copy(), "G": st[:, :, 1].copy()}
    map_file = write(tmp_path / "map.exr", channels)
    channels = {c: np.ones((HEIGHT, WIDTH), np.float32) for c in "RGB"}
    channels |= {n: np.full((HEIGHT, WIDTH), step[k], np.float32) for k, n in enumerate(NAMES)}
    source = write(tmp_path / "in.exr", channels)
    assert post(source, "-o", tmp_path / "out.exr", "--effect", f"stmap:file={map_file}") == 0
    planes = read(tmp_path / "out.exr")[0]
    found = np.stack([planes[name] for name in NAMES], axis=2)
    inner = np.isfinite(exact).all(axis=2)
    assert np.abs(found - exact)[inner].max() < 0.004
    assert np.abs(exact - step)[inner].max() > 0.1


def test_motion_of_a_pinhole_bent_is_that_of_the_lens():
    """A wall slides across at the distance in focus; both motions are ground truth."""
    lens, distance = "canon-ef-15mm-f2.8-fisheye", 2.0
    scene = dg.Scene(time=TIME)
    slide = dg.keys([(TIME + t, move(5 * t, -2.5 * t, -distance)) for t in (-1, 1)])
    card(scene, slide, size=30)
    bench = set_up(lenses.load(lens), f_stop=22, focus_m=distance, by="paraxial")
    model = LensDistortion(bench, 22.0)
    ideal = dg.Camera(lens="pinhole", focal_length=model.focal_length_mm, shutter_time=0)
    real = dg.Camera(lens=lens, f_stop=22, focus_distance=distance, shutter_time=0)
    straight, bent = (
        dg.render(scene, camera, resolution=(WIDTH, HEIGHT), spp=1, gt_time="mid", motion=True)
        for camera in (ideal, real)
    )
    focal = model.focal_length_mm / 36 * WIDTH
    maps = [point_map(model, (focal, focal), CENTRE, inverse=i) for i in (False, True)]
    found = mapped(straight.motion, *maps)
    known = np.isfinite(found).all(axis=2)
    assert known.mean() > 0.4
    assert np.abs(found - bent.motion)[known].max() < 5e-4
    assert np.abs(straight.motion - bent.motion)[known].max() > 2
