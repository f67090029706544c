"""Pictures of motion that can be written down, and what other renderers show wrongly."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.scene.materials import Gltf
from tests.support.pictures.blur import ALPHA
from tests.support.pictures.statistical import Reference, differences
from tests.support.scene import scenes
from tests.support.scene.motion_scenes import ball, dark, move, pinhole, turn

Picture = NDArray[np.float64]
WHITE = Gltf(base_color=(1, 1, 1), unlit=True)
WIDTH, HEIGHT = 24, 16
# Rays from the camera alone: light paths would find most of the light without asking where things
# are at the time of a ray.
SMALL: dict[str, Any] = {
    "resolution": (WIDTH, HEIGHT),
    "filter": "box",
    "max_depth": 3,
    "light_paths": "off",
}
BATCHES = 6
SAMPLES = 256
#: Half of what a film of 36 x 24 behind 36 mm sees at a distance of 1.
HALF_X, HALF_Y = 0.5, 1 / 3


def eye(**values: Any) -> dg.Camera:
    """A pinhole of that view, at the origin, looking along -z."""
    return pinhole(**({"focal_length": 36.0, "shutter_time": 1.0} | values))


def square(scene: dg.Scene, size: float, transform: Any, material: Any = WHITE) -> None:
    """A square of half a side ``size``, facing +z."""
    points, faces = scenes.quad(size)
    scene.add_instance(scene.add_mesh(points, faces), material, transform)


def pictures(scene: dg.Scene, camera: dg.Camera, spp: int = SAMPLES) -> Picture:
    """Independent pictures, (BATCHES, H, W, 3); the scene's time is 0."""
    scene.time = 0.0
    frames = (dg.render(scene, camera, spp=spp, seed=i, **SMALL) for i in range(BATCHES))
    return np.array([frame.rgb for frame in frames], np.float64)


def differs(found: Picture, wanted: Picture) -> list[str]:
    """Differences from a known picture (H, W) of black and white; empty: none.

    Where light falls so rarely that no sample met it, the known variance of chance stands in for
    the one that was not seen; sums over fine points are good to 1e-3.
    """
    known = np.repeat(wanted[:, :, None], 3, axis=2)
    chance = known / SAMPLES / BATCHES + 1e-3**2
    return differences(found, Reference(known, chance, 1000), alpha=ALPHA)


def slide(begin: tuple[float, float, float], end: tuple[float, float, float]) -> dg.Keys:
    """A straight way from one end of the exposure to the other."""
    return dg.keys([(-0.5, move(*begin)), (0.5, move(*end))])


# A translating edge is the CDF of the opening ---------------------------------------------------


CURVES: dict[str, tuple[Any, list[tuple[float, float]]]] = {
    "box": ("box", [(0, 1), (1, 1)]),
    "trapezoid": (("trapezoid", 0.7), [(0, 0), (0.3, 1), (0.7, 1), (1, 0)]),
    "points": ([(0, 0.2), (0.2, 1), (0.5, 0), (1, 0.6)], [(0, 0.2), (0.2, 1), (0.5, 0), (1, 0.6)]),
}


def passed(nodes: list[tuple[float, float]]) -> Picture:
    """Light on a film over which the edge of a white sheet has gone from left to right, (H, W).

    The edge is at the fraction u of the width at the fraction u of the time; what it has passed
    sees light from then on. Box filter: the mean over the width of a pixel.
    """
    u = (np.arange(WIDTH * 1000) + 0.5) / (WIDTH * 1000)
    opening = np.interp(u, *np.array(nodes).T)
    later = (opening.sum() - np.cumsum(opening) + 0.5 * opening) / len(u)
    return np.tile(later.reshape(WIDTH, 1000).mean(axis=1), (HEIGHT, 1))


def seen(scene: dg.Scene) -> float:
    """A sheet whose right edge runs over the frame at a distance of 3 m."""
    square(scene, 10, slide((-10 - 3 * HALF_X, 0, -3), (-10 + 3 * HALF_X, 0, -3)))
    return 1.0


def mirrored(scene: dg.Scene) -> float:
    """The same sheet 1 m behind the camera, in a mirror 3 m before it."""
    square(scene, 10, move(0, 0, -3), dg.Conductor((1, 1, 1), 0.0))
    square(scene, 10, slide((-10 - 7 * HALF_X, 0, 1), (-10 + 7 * HALF_X, 0, 1)))
    return 1.0


def shadowed(scene: dg.Scene) -> float:
    """The shadow of a sheet behind the camera goes off a wall; the sun is straight behind."""
    square(scene, 10, move(0, 0, -3), dg.Diffuse((0.5, 0.5, 0.5)))
    black = dg.Diffuse((0, 0, 0))
    square(scene, 10, slide((10 - 3 * HALF_X, 0, 1), (10 + 3 * HALF_X, 0, 1)), black)
    scene.add_light(dg.DirectionalLight((4, 4, 4)))
    return 0.5 * 4 / math.pi


@pytest.mark.parametrize("curve", CURVES)
@pytest.mark.parametrize("how", [seen, mirrored, shadowed])
def test_a_translating_edge_is_the_cdf_of_the_shutter(curve, how):
    scene = dark()
    level = how(scene)
    given, nodes = CURVES[curve]
    found = pictures(scene, eye(shutter_curve=given))
    assert differs(found, level * passed(nodes)) == []
    other = CURVES["box" if curve != "box" else "points"][1]
    assert differs(found, level * passed(other)) != []


# A rotating bar --------------------------------------------------------------------------------


@pytest.mark.parametrize("turns", [0.2, 1.0, 12.25])
def test_a_rotating_bar(turns):
    """Each point sees the bar for the share of the time in which it lies under it."""
    scene = dark()
    points, faces = scenes.quad(1)
    bar = scene.add_mesh(points * (0.8, 0.1, 1), faces)
    # it begins at 15 degrees when the shutter opens
    base = move(0, 0, -3) @ turn(15)
    scene.add_instance(bar, WHITE, dg.spin((0, 0, 1), turns, transform=base, time=-0.5))
    found = pictures(scene, eye())
    assert differs(found, _bar(15, 15 + 360 * turns)) == []
    assert differs(1.03 * found, _bar(15, 15 + 360 * turns)) != []


def _bar(begin: float, end: float, fine: int = 8) -> Picture:
    """A bar of 1.6 x 0.2 m 3 m away between two angles (degrees), by a sum over fine points."""
    y, x = np.mgrid[0 : HEIGHT * fine, 0 : WIDTH * fine] + 0.5
    x = 3 * HALF_X * (2 * x / (WIDTH * fine) - 1)
    y = 3 * HALF_Y * (1 - 2 * y / (HEIGHT * fine))
    total = np.zeros_like(x)
    steps = 1009  # a prime: of many turns, none has the angles of another
    for k in range(steps):
        a = math.radians(begin + (k + 0.5) / steps * (end - begin))
        along, aside = x * math.cos(a) + y * math.sin(a), y * math.cos(a) - x * math.sin(a)
        total += (np.abs(along) < 0.8) & (np.abs(aside) < 0.1)
    return np.asarray((total / steps).reshape(HEIGHT, fine, WIDTH, fine).mean(axis=(1, 3)))


# Still parts stay as they are ------------------------------------------------------------------


@pytest.mark.parametrize("kind", [dg.Diffuse((0.7, 0.7, 0.7)), dg.Conductor((0.9, 0.9, 0.9), 0.2)])
def test_a_ball_that_spins_looks_still(kind):
    spun, still = dark(), dark()
    for scene, pose in (
        (spun, dg.spin((0, 1, 0), 3.3, transform=move(0, 0, -3))),
        (still, move(0, 0, -3)),
    ):
        points, faces, normals = scenes.sphere(48, 0.8)
        scene.add_instance(scene.add_mesh(points, faces, normals), kind, pose)
        scene.add_light(dg.DirectionalLight((3, 3, 3)), turn(-50, (1, 0.5, 0)))
        scene.set_environment(color=(0.3, 0.3, 0.3))
    found = pictures(spun, eye(), 64)
    assert differences(found, pictures(still, eye(), 64), alpha=ALPHA) == []
    assert differences(found, 1.02 * pictures(still, eye(), 64), alpha=ALPHA) != []


def sums(found: Picture) -> tuple[float, float]:
    """Sum over the frame, px, and its standard error."""
    totals = found.mean(axis=3).sum(axis=(1, 2))
    return float(totals.mean()), float(totals.std(ddof=1) / math.sqrt(len(totals)))


WAYS: dict[str, Callable[[], Any]] = {
    "straight": lambda: slide((-0.6, -0.3, -3), (0.6, 0.2, -3)),
    "turning": lambda: dg.keys(
        [(-0.5, move(-0.5, 0, -3)), (0.5, move(0.5, 0, -3) @ turn(170))],
    ),
    "spinning": lambda: dg.spin((0, 0, 1), 5.2, (0.3, 0.2, 0), move(0, 0, -3)),
    "still": lambda: move(0.2, 0.1, -3),
}


@pytest.mark.parametrize("lens", ["pinhole", "thin"])
@pytest.mark.parametrize("way", WAYS)
def test_the_sum_of_a_picture_does_not_move(way, lens):
    """0.4 x 0.4 m of white across the axis: (36 mm / 3 m)^2, in pixels of 1.5 mm."""
    scene = dark()
    square(scene, 0.2, WAYS[way]())
    focus = {} if lens == "pinhole" else {"f_stop": 1.0, "focus_distance": 2.5}
    found, error = sums(pictures(scene, eye(lens=lens, **focus)))
    assert found == pytest.approx((0.4 * 36 / 3 / 1.5) ** 2, abs=5 * error)
    assert error < 0.02 * found


# Interpolations ---------------------------------------------------------------------------------


@pytest.mark.parametrize("degrees", [5.0, 170.0])
@pytest.mark.parametrize("how", ["linear", "twist", "slerp", "decomposed"])
def test_interpolations_agree_for_small_turns_and_differ_for_large(how, degrees):
    """Lerped matrices shrink: their area is s^2 + (1-s)^2 + 2 s (1-s) cos of the turn.

    Its mean over s is (2 + cos) / 3. A rotation keeps every area.
    """
    scene = dark()
    ends = move(0, 0, -3), move(0, 0, -3) @ turn(degrees)
    keys = dg.keys([(-0.5, ends[0]), (0.5, ends[1])], interpolation=how)
    square(scene, 0.6, keys)
    found, error = sums(pictures(scene, eye()))
    whole = (1.2 * 36 / 3 / 1.5) ** 2
    share = (2 + math.cos(math.radians(degrees))) / 3 if how == "linear" else 1.0
    assert found == pytest.approx(share * whole, abs=5 * error)
    assert error < 0.01 * whole


# Rolling shutters -------------------------------------------------------------------------------


@pytest.mark.parametrize("order", ["top", "bottom", "left", "right"])
def test_a_rolling_shutter_slants_what_runs_across_its_lines(order):
    """A bar at 8 px/s, lines read in 1 s: it leans by 8 px over the height of the frame."""
    rows = order in ("top", "bottom")
    lines = HEIGHT if rows else WIDTH
    exposure, speed = 1 / lines, 8.0
    duration = 1 + exposure - 1 / lines  # from the first line to the last
    pixel = 3 * 2 * HALF_X / WIDTH  # m at the distance of the bar
    points, faces = scenes.quad(1)
    scene = dark()
    bar = scene.add_mesh(points * ((pixel, 4, 1) if rows else (4, pixel, 1)), faces)
    way = 0.5 * speed * duration * pixel
    ends = [(-way, 0, -3), (way, 0, -3)] if rows else [(0, way, -3), (0, -way, -3)]
    path = [(s * duration / 2, move(*p)) for s, p in zip((-1, 1), ends, strict=True)]
    scene.add_instance(bar, WHITE, dg.keys(path))
    roll = dg.RollingShutter(order, readout_time=1.0)
    picture = pictures(scene, eye(shutter_time=exposure, rolling_shutter=roll)).mean(axis=(0, 3))
    if not rows:
        picture = picture.T
    assert picture.sum(axis=1) == pytest.approx(np.full(lines, 2.0), rel=0.05)
    place = (picture * (np.arange(picture.shape[1]) + 0.5)).sum(axis=1) / picture.sum(axis=1)
    turn_of_line = np.arange(lines) if order in ("top", "left") else np.arange(lines)[::-1]
    middle = (turn_of_line + 0.5) / lines * duration - duration / 2
    assert place == pytest.approx(0.5 * picture.shape[1] + speed * middle, abs=0.05)


# Faults of others ------------------------------------------------------------------------------


@pytest.mark.parametrize("axis", [(0, 0, 1), (0, 1, 0), (1, 2, 3)])
def test_what_turns_by_170_degrees_on_its_way_goes_straight(axis):
    """pbrt-v4#206 swings it about the camera. A small ball marks where its origin goes."""
    scene = dark()
    path = dg.keys([(-0.5, move(-1.3, 0, -3)), (0.5, move(1.3, 0, -3) @ turn(170, axis))])
    ball(scene, WHITE, path, radius=0.12)
    found = pictures(scene, eye()).mean(axis=(0, 3))
    middle = found[HEIGHT // 2 - 1 : HEIGHT // 2 + 1].sum()
    assert middle == pytest.approx(found.sum())
    thirds = found[:, 3:-3].sum(axis=0).reshape(3, -1).sum(axis=1)  # the same time in each
    assert thirds == pytest.approx(np.full(3, thirds.mean()), rel=0.06)


@pytest.mark.parametrize("how", ["decomposed", "twist", "slerp", "spin"])
def test_a_small_thing_far_from_its_pivot_is_seen_at_mid_shutter(how):
    """4 cm, 100 m from the pivot, turning 3.5 degrees; pbrt-v4's bounds lose it in the middle.

    It runs 6.1 m; the camera sees 0.5 m of that, and the quad on each point for 0.04 / 6.1 of
    the time.
    """
    scene = dark()
    points, faces = scenes.quad(0.02)
    mesh = scene.add_mesh(points + np.array([100, 0, 0]), faces)
    home = move(-100, 0, -0.5)
    if how == "spin":
        path: Any = dg.spin((0, 0, 1), 3.5 / 360, transform=home)
    else:
        ends = [(0.5 * s, home @ turn(1.75 * s)) for s in (-1, 1)]
        path = dg.keys(ends, interpolation=how)
    scene.add_instance(mesh, WHITE, path)
    found, error = sums(pictures(scene, eye(), 1024))
    # it is in the frame, 1/3 m high, while it runs so far, and covers its area meanwhile
    area = (0.04 * 36 / 0.5 / 1.5) ** 2
    share = 2 * 0.5 * HALF_Y / (100 * math.radians(3.5))
    assert found == pytest.approx(area * share, abs=5 * error)
    assert error < 0.08 * found
