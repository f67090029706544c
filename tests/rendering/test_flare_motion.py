"""Ghosts while something moves: a frame's are the mean of those of its moments, as of any light.

Each case must fail to be that mean if the shutter is open for an instant: otherwise it would show
nothing.
Moments are the middles of equal parts of the exposure, so that there is no chance but that of the
paths: what differs is held against the light.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.rendering.session import Session
from tests.support.pictures.blur import Case, case
from tests.support.scene import scenes
from tests.support.scene.motion_scenes import OPEN, TIME, turn

LENS = "tessar-50mm-f2.8"
SIZE = (6, 4)  # few lines, so that each sees much of what is drawn
MOMENTS, PATHS = 9, 16000.0
SAME, OTHER = 0.075, 0.12  # of the light
Pictures = NDArray[np.float64]


def camera(**changes: Any) -> dg.Camera:
    return dg.Camera(**{"lens": LENS, "f_stop": 4.0, "focus_distance": 3.0, **changes})


def across(first: Any, last: Any) -> dg.Keys:
    return dg.keys([(TIME - OPEN, first), (TIME + OPEN, last)])


def lamp(place: Any = None) -> dg.Scene:
    """A lamp above the middle of the frame, or on a way."""
    scene = dg.Scene(time=TIME)
    fixed = scenes.at(0.15, 0.25, -2)
    scene.add_light(dg.PointLight((1e5, 9e4, 8e4)), fixed if place is None else place)
    return scene


def passing() -> dg.Scene:
    """A lamp that crosses the frame, slantwise."""
    return lamp(across(scenes.at(-1.8, 0.4, -2), scenes.at(1.9, -0.3, -2)))


def moving_lamp() -> Case:
    return case(passing(), camera(), OPEN)


def moving_camera() -> Case:
    pose = across(turn(-30, (0, 1, 0.3)), scenes.at(0.1, 0, 0.2) @ turn(34, (0, 1, 0)))
    return case(lamp(), camera(transform=pose), OPEN)


def far() -> dg.Scene:
    """A lamp so far away that it does not matter where in the body the pupil is."""
    scene = dg.Scene(time=TIME)
    scene.add_light(dg.PointLight((1e9, 9e8, 8e8)), scenes.at(15, 25, -200))
    return scene


def moving_lens(**over_time: Any) -> Callable[[], Case]:
    return lambda: case(far(), camera(**over_time), OPEN)


def rolling(order: str) -> Callable[[], Case]:
    """Each line has the ghosts of its own moments: those of a passing lamp slant."""

    def make() -> Case:
        lines = SIZE[1] if order == "top" else SIZE[0]
        line = OPEN / lines
        begin = TIME - OPEN / 2
        index = np.arange(lines) if order == "top" else np.arange(lines)[::-1]

        def window(t: float) -> Any:
            there = (index == int((t - begin) / line)) * float(lines)
            return there[:, None] if order == "top" else there[None, :]

        roll = dg.RollingShutter(order, line_time=line)
        made = case(passing(), camera(), OPEN, window)
        return replace(made, camera=camera(shutter_time=line, rolling_shutter=roll))

    return make


def curve() -> Case:
    """A shutter that opens late and closes slowly."""
    points = [(0.0, 0.0), (0.3, 0.2), (0.5, 1.0), (1.0, 0.0)]
    begin = TIME - OPEN / 2
    made = case(
        passing(),
        camera(shutter_curve=points),
        OPEN,
        lambda t: float(np.interp((t - begin) / OPEN, *np.array(points).T)),
    )
    still = made.still
    return replace(made, still=lambda t: (still(t)[0], still(t)[1].with_(shutter_curve=None)))


def leaf() -> Case:
    """The iris is the shutter: at each moment ghosts have the shape of what is open of it."""
    points = [(0.0, 0.0), (0.4, 1.0), (0.7, 1.0), (1.0, 0.0)]
    begin = TIME - OPEN / 2
    made = case(passing(), camera(shutter_type="leaf", shutter_curve=points), OPEN)
    still = made.still

    def stopped(t: float) -> tuple[dg.Scene, dg.Camera]:
        radius = max(float(np.interp((t - begin) / OPEN, *np.array(points).T)), 0.02)
        scene, eye = still(t)
        return scene, eye.with_(f_stop=4.0 / radius, shutter_type=None, shutter_curve=None)

    return replace(made, still=stopped)


CASES: dict[str, Callable[[], Case]] = {
    "lamp": moving_lamp,
    "camera": moving_camera,
    "iris": moving_lens(f_stop=across(2.8, 16.0)),
    "curve": curve,
    "leaf": leaf,
}


def two_singlets(folder: Path) -> str:
    """A zoom of two lenses, the second with the iris before it: six ghosts."""
    glass = {"nd": 1.5168, "vd": 64.2}

    def position(efl: float, gap: float, to_film: float) -> dict[str, Any]:
        return {"name": f"{efl:g}", "efl_mm": efl, "gaps": {"1": gap, "4": to_film}}

    facts = {
        "schema": "daguerre-lens/0.1",
        "name": "two singlets",
        "nominal": {"efl_mm": 56.168, "f_number": 4.0},
        "coating": "uncoated",
        "surfaces": [
            {
                "kind": "spherical",
                "radius": -120,
                "thickness": 3,
                "glass": glass,
                "semi_diameter": 14,
            },
            {"kind": "spherical", "radius": 64, "thickness": 35, "semi_diameter": 14},
            {"kind": "stop", "radius": None, "thickness": 5, "semi_diameter": 9},
            {
                "kind": "spherical",
                "radius": 60,
                "thickness": 6,
                "glass": glass,
                "semi_diameter": 12,
            },
            {"kind": "spherical", "radius": -45, "thickness": 84.490, "semi_diameter": 12},
        ],
        "configurations": [position(56.168, 35, 84.490), position(77.540, 15, 98.005)],
    }
    (folder / "zoom.json").write_text(json.dumps(facts))
    return str(folder / "zoom.json")


def drawn(
    scene: dg.Scene, eye: dg.Camera, seed: int, paths: float = 12 * PATHS, fine: int = 1
) -> tuple[Pictures, float]:
    """A picture of the exposure, not over H0 but in its own unit, and H0.

    It is drawn in finer pixels where a moving lens needs them: its states are as many as they ask.
    """
    width, height = SIZE
    session = Session(
        scene,
        eye,
        resolution=(width * fine, height * fine),
        filter="box",
        flare=paths,
        light_paths="off",
        seed=seed,
    )
    session.draw(0, 1)
    h0 = float(session.metadata["h0"])
    flare = session.frame().flare
    assert flare is not None
    picture = flare.astype(np.float64) * h0
    return picture.reshape(height, fine, width, fine, 3).mean((1, 3)), h0


def mean_of_stills(made: Case, moments: int) -> Pictures:
    begin, end = made.interval
    total: Any = 0.0
    for i in range(moments):
        t = begin + (i + 0.5) / moments * (end - begin)
        weight = np.broadcast_to(made.window(t), SIZE[::-1])[..., None]
        if weight.max() > 0:
            total = total + weight * drawn(*made.still(t), i, PATHS)[0] / moments
    return np.asarray(total)


def difference(a: Pictures, b: Pictures) -> float:
    """Difference as a share of the light of b."""
    return float(np.abs((a - b).sum(2)).sum() / b.sum())


def check(made: Case, moments: int = MOMENTS, same: float = SAME, fine: int = 1) -> None:
    wanted = mean_of_stills(made, moments)
    moving, _ = drawn(made.scene, made.camera, 100, fine=fine)
    frozen, _ = drawn(*made.still(0.5 * sum(made.interval)), 200)
    assert difference(moving, wanted) < same
    assert difference(frozen, wanted) > OTHER


@pytest.mark.parametrize("name", CASES)
def test_ghosts_are_the_mean_of_those_of_all_moments(name: str) -> None:
    check(CASES[name]())


@pytest.mark.parametrize("order", ["top", "right"])
def test_lines_in_turn_have_the_ghosts_of_their_own_moments(order: str) -> None:
    check(rolling(order)(), 18, 0.15)  # of each still one line counts: a few hundred paths


def test_ghosts_of_a_zoom_are_those_of_all_its_positions(tmp_path: Path) -> None:
    zoom = dg.keys([(0.8, 56.5), (1.2, 77.0)])
    made = moving_lens(lens=two_singlets(tmp_path), f_stop=8.0, focus_distance=6.0, zoom=zoom)()
    check(made, fine=4)


def in_a_mirror() -> Case:
    """A lamp that goes by behind the camera, and is seen in a mirror before it."""
    scene = dg.Scene(time=TIME)
    points, faces = scenes.quad(0.4)
    chrome = dg.Material(dg.Conductor((1, 1, 1), alpha=0))
    scene.add_instance(scene.add_mesh(points, faces), chrome, scenes.at(0, 0, -1))
    path = across(scenes.at(-0.6, 0.4, 0.5), scenes.at(0.7, 0.3, 0.5))
    scene.add_light(dg.SphereLight((1e6, 1e6, 1e6), 0.02), path)
    return case(scene, camera(), OPEN)


@pytest.mark.slow
def test_ghosts_of_a_lamp_that_passes_in_a_mirror_are_those_of_all_moments() -> None:
    check(in_a_mirror())


def test_what_passes_before_a_lamp_takes_its_ghosts_for_its_share_of_the_time() -> None:
    light = []
    for width in (0.0, 0.25, 0.5):  # of the way that it goes while the shutter is open
        scene = lamp(scenes.at(0.2, 0.3, -2))
        if width:
            points, faces = scenes.quad(0.5 * width * 0.6)
            black = dg.Material(dg.Diffuse((0, 0, 0)))
            near, step = np.array([0.18, 0.27, -1.8]), np.array([0.6, 0, 0])
            path = across(scenes.at(*(near - step)), scenes.at(*(near + step)))
            scene.add_instance(scene.add_mesh(points, faces), black, path)
        eye = camera(shutter_time=OPEN)
        light.append(np.mean([drawn(scene, eye, seed, 40000.0)[0].sum() for seed in range(3)]))
    assert light[0] > 0
    assert light[1] / light[0] == pytest.approx(0.75, abs=0.02)
    assert light[2] / light[0] == pytest.approx(0.5, abs=0.02)
