"""Mirror balls against a known world, by a camera at a finite distance."""

from __future__ import annotations

import math

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import InputError
from tests.support.pictures.light_probes import ball_picture, exposure, grid, mirror, save, world

MIDDLE = (0.15, -0.1, -5.0)
FOV = math.degrees(2 * math.atan(240 / 600))


def probe(path, **more):
    return dg.light_probe(path, ball="mirror", res=256, sun="off", **({"fov": FOV} | more))


def from_camera(middle=MIDDLE, yaw=0.0):
    """Angle of each pixel to the direction from ball to camera, degrees."""
    back = -np.array(middle) / np.linalg.norm(middle)
    a = math.radians(yaw)
    turned = (math.cos(a) * back[0] + math.sin(a) * back[2], back[1],
              -math.sin(a) * back[0] + math.cos(a) * back[2])  # fmt: skip
    return np.degrees(np.arccos(np.clip(grid(256, 128) @ turned, -1, 1)))


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    return save(tmp_path_factory.mktemp("ball") / "ball.exr", ball_picture(mirror(world)))


def test_unwrapped_is_the_world(ball):
    """Turns red with a mirrored direction, or without perspective."""
    made = probe(ball)
    truth, angle = world(grid(256, 128)), from_camera()
    off = np.abs(made.image / truth - 1)
    assert off[angle < 120].mean() < 0.003
    assert off[angle < 120].max() < 0.02
    assert off[angle < 145].mean() < 0.005
    assert 0 < made.facts["unseen_share"] < 0.08


def test_found_outline_and_given_outline_agree(ball):
    found = probe(ball).facts["balls"][0]
    x, y, radius = found["circle_px"]
    # A ball beside the axis is seen as an ellipse, a little outward of its middle.
    assert (x, y) == pytest.approx((258, 192), abs=1.2)
    assert radius == pytest.approx(600 * math.tan(math.asin(1 / np.linalg.norm(MIDDLE))), abs=0.6)
    given = probe(ball, circle=(x, y, radius))
    off = np.abs(given.image / world(grid(256, 128)) - 1)
    assert off[from_camera() < 120].mean() < 0.01


def test_pixels_count_from_their_middles(tmp_path):
    """Turns red with pixels read half a pixel off, in what is found and in what is unwrapped."""
    path = save(tmp_path / "axis.exr", ball_picture(mirror(world), middle=(0, 0, -5)))
    radius = 600 * math.tan(math.asin(1 / 5))
    found = probe(path).facts["balls"][0]["circle_px"]
    assert found == pytest.approx((240, 180, radius), abs=0.2)
    made = probe(path, circle=(240, 180, radius))
    off = made.image / world(grid(256, 128)) - 1
    front = from_camera((0, 0, -5)) < 100
    assert np.abs(off[front]).mean() < 0.001


def test_focal_length_by_exif(tmp_path):
    """43 mm over the diagonal of 43.27 mm, which is one of 600 px here."""
    codes = np.rint(255 * (ball_picture(mirror(world)) / 5) ** (1 / 2.2)).astype(np.uint8)
    exif = exposure(0.01) | {"Exif:FocalLength": 50.0, "Exif:FocalLengthIn35mmFilm": 43}
    made = probe(save(tmp_path / "ball.jpg", codes, exif), fov=None)
    assert made.facts["balls"][0]["focal_px"] == pytest.approx(600 * 43 / 43.267, rel=1e-3)


def test_perspective_is_needed_near_a_ball(ball):
    far = probe(ball, fov=0)
    off = np.abs(far.image / world(grid(256, 128)) - 1)
    assert off[from_camera() < 120].mean() > 0.02


def test_a_ball_seen_from_far_away_needs_none(tmp_path):
    picture = ball_picture(mirror(world), focal=60000, middle=(0, 0, -500))
    made = probe(save(tmp_path / "far.exr", picture), fov=0)
    off = np.abs(made.image / world(grid(256, 128)) - 1)
    assert off[from_camera((0, 0, -500)) < 120].mean() < 0.003


def test_two_sides_hide_photographer_and_rim(tmp_path):
    """Camera of yaw 90 looks along -x; each side has a dark photographer in its middle."""
    paths = []
    for yaw in (0.0, 90.0):
        a = math.radians(yaw)
        turn = np.array([[math.cos(a), 0, math.sin(a)], [0, 1, 0], [-math.sin(a), 0, math.cos(a)]])
        toward = -np.array(MIDDLE) / np.linalg.norm(MIDDLE)

        def seen(d, turn=turn, toward=toward):
            person = (d @ toward) > math.cos(math.radians(6))
            return np.where(person[..., None], 0.01, world(d @ turn.T))

        paths.append(save(tmp_path / f"{yaw:.0f}.exr", ball_picture(mirror(seen))))
    made = probe(paths, ball_direction=(0, 90), ev=(0, 0))
    off = np.abs(made.image / world(grid(256, 128)) - 1)
    assert off.mean() < 0.004
    assert off.max() < 0.06
    one = probe(paths[:1])
    assert np.abs(one.image / world(grid(256, 128)) - 1).max() > 0.3


def test_reflectance_and_rotation(ball):
    plain, made = probe(ball), probe(ball, reflectance=(0.5, 0.6, 0.8), rotate=90)
    moved = np.roll(plain.image, -64, axis=1) / (0.5, 0.6, 0.8)
    assert made.image[8:-8] == pytest.approx(moved[8:-8], rel=0.02)


def test_pitch_looks_up(tmp_path):
    a = math.radians(20)
    turn = np.array([[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]])
    assert (turn @ (0, 0, -1))[1] > 0
    picture = ball_picture(mirror(lambda d: world(d @ turn.T)))
    made = probe(save(tmp_path / "up.exr", picture), pitch=20)
    off = np.abs(made.image / world(grid(256, 128)) - 1)
    assert np.median(off) < 0.003


def test_a_ball_before_a_busy_wall_is_found(tmp_path):
    rng = np.random.default_rng(1)
    picture = ball_picture(mirror(world), background=-1)
    wall = np.kron(rng.uniform(0.3, 4, (18, 24, 3)), np.ones((20, 20, 1)))
    picture = np.where(picture < 0, wall, picture) * (1 + 0.02 * rng.normal(size=picture.shape))
    made = probe(save(tmp_path / "busy.exr", np.maximum(picture, 0).astype(np.float32)))
    assert made.facts["balls"][0]["circle_px"] == pytest.approx([258.6, 192.5, 122.6], abs=1.5)


@pytest.mark.parametrize("kind", ["noise", "ramp", "flat"])
def test_no_ball(tmp_path, kind):
    rng = np.random.default_rng(2)
    picture = {
        "noise": rng.uniform(0, 1, (240, 320, 3)),
        "ramp": np.broadcast_to(np.linspace(0, 1, 320)[None, :, None], (240, 320, 3)),
        "flat": np.ones((240, 320, 3)),
    }[kind].astype(np.float32)
    with pytest.raises(InputError, match=r"ball: wanted a clear round outline.*--circle"):
        probe(save(tmp_path / "none.exr", picture))
