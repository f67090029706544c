"""Motions of a spiteful user: one clear error that names the place, or a picture without a NaN."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import DaguerreError
from daguerre.scene.materials import Gltf, TextureSlot
from tests.support.scene.motion_scenes import card_mesh, move, pinhole, sky, turn

NOTHING = np.diag([0.0, 0, 0, 1])
FLAT = np.diag([1.0, 0, 1, 1])


class Over:
    """A value over time that is made by hand, by a hand that may shake."""

    def __init__(self, value: Callable[[float], Any], breaks: Any = ()) -> None:
        self._value, self._breaks = value, breaks

    def at(self, time_s: float) -> Any:
        return self._value(time_s)

    def breaks(self, begin: float, end: float) -> Any:
        return self._breaks


def later(good: Any, bad: Any) -> Over:
    """Good until the time of the scene, bad from then on."""
    return Over(lambda t: good if t <= 1 else bad)


def scene_of(transform: Any = None, **values: Any) -> dg.Scene:
    """A grey card ahead, under a sky, at 1 s."""
    scene = sky()
    place = move(0, 0, -3) if transform is None else transform
    scene.add_instance(card_mesh(scene), dg.Diffuse(), place, **values)
    return scene


def shoot(scene: dg.Scene, camera: dg.Camera | None = None) -> dg.Frame:
    """0.4 s around 1 s."""
    camera = pinhole(shutter_time=0.4) if camera is None else camera
    return dg.render(scene, camera, resolution=(12, 8), spp=8, max_depth=3)


def exposed(**values: Any) -> dg.Camera:
    return pinhole(**({"shutter_time": 0.4} | values))


BAD: dict[str, tuple[Callable[[], Any], str]] = {
    "time beyond": (lambda: dg.keys([(1e13, 1.0)]), r"keys\[0\]: time: .* at most 1e\+12"),
    "spin beyond": (lambda: dg.spin((0, 1, 0), 1e10), "revolutions_per_second: .* at most 1e"),
    "spins about what is too far": (
        lambda: dg.spin((0, 1, 0), 1.0, (1e30, 0, 0)),
        r"spin: center: wanted numbers of at most 1e\+15",
    ),
    "closes before it opens": (
        lambda: shoot(scene_of(), exposed(shutter_time=-0.1)),
        "shutter_time: wanted a number of at least 0",
    ),
    "scene at no time": (lambda: shoot(dg.Scene(time=math.nan)), "scene: time: wanted a number"),
    "time without digits": (
        lambda: shoot(scene_of(dg.keys([(0, move()), (1, move(1))])).at(1e17)),
        r"scene: time: 1e\+17 s is too large for an exposure of 0\.4 s",
    ),
    "shown by a word": (lambda: scene_of(shown="no"), "shown: wanted true or false, got 'no'"),
    "no matrix": (
        lambda: shoot(scene_of(later(move(0, 0, -3), None))),
        r"instance 0: transform: wanted shape \(4, 4\), got None",
    ),
    "NaN later": (
        lambda: shoot(scene_of(later(move(0, 0, -3), np.eye(4) * math.nan))),
        "instance 0: transform: wanted finite numbers",
    ),
    "no breaks": (
        lambda: shoot(scene_of(Over(lambda t: move(t - 1, 0, -3), None))),
        "instance 0: transform: .*NoneType",
    ),
    "focal length below 0 later": (
        lambda: shoot(scene_of(), exposed(focal_length=dg.keys([(0.9, 10.0), (1.1, -10.0)]))),
        "camera: focal_length: wanted a number",
    ),
    "camera flattened": (
        lambda: shoot(scene_of(), exposed(transform=dg.keys([(0.9, np.eye(4)), (1.1, NOTHING)]))),
        "camera: transform: .*singular",
    ),
    "camera beyond": (
        lambda: shoot(scene_of(), exposed(transform=dg.keys([(0.9, move()), (1.1, move(1e30))]))),
        r"camera: transform: wanted a position within 1e\+18 m",
    ),
    "vertices that become more": (
        lambda: shoot(cloth(Over(lambda t: np.eye(4 if t > 1 else 3, 3)))),
        "mesh 0: positions: wanted 3 elements, got 4",
    ),
    "vertices lost": (
        lambda: shoot(cloth(later(np.eye(3), np.eye(3) * math.nan))),
        r"mesh 0: positions\[0\]: wanted finite numbers",
    ),
    "a texture that comes": (
        lambda: shoot(painted(Gltf(base_color_texture=later(None, TextureSlot(0))))),
        "only numbers change over time",
    ),
    "a lamp that darkens more than black": (
        lambda: shoot(lit(dg.PointLight(dg.keys([(0.9, (1, 1, 1)), (1.1, (-1, 0, 0))])))),
        "intensity: wanted three finite numbers of at least 0",
    ),
    "a lamp that becomes another": (
        lambda: shoot(lit(later(dg.PointLight(), dg.SpotLight()))),
        "kind: cannot change while the shutter is open, from .* to ",
    ),
    "paint that reflects more than all": (
        lambda: shoot(painted(dg.Diffuse(dg.keys([(0.9, (1, 1, 1)), (1.1, (2, 2, 2))])))),
        "reflectance: wanted a number from 0 to 1, got 2",
    ),
    "a sky below 0": (lambda: shoot(sky(later(1.0, -1.0))), "environment: .*wanted finite"),
}


def painted(material: Any) -> dg.Scene:
    """The card of a material, and a texture that it may name."""
    scene = sky()
    scene.add_texture(np.ones((2, 2, 3), np.float32))
    scene.add_instance(card_mesh(scene), material, move(0, 0, -3))
    return scene


def lit(light: Any) -> dg.Scene:
    """The card below a lamp."""
    scene = scene_of()
    scene.add_light(light)
    return scene


def cloth(positions: Any) -> dg.Scene:
    """One triangle of such vertices."""
    scene = sky()
    scene.add_instance(scene.add_mesh(positions, [[0, 1, 2]]))
    return scene


@pytest.mark.parametrize("name", BAD)
def test_one_error_that_says_where(name):
    make, message = BAD[name]
    with pytest.raises(DaguerreError, match=message):
        make()


ODD: dict[str, Callable[[], Any]] = {
    "shrinks to nothing": lambda: dg.keys([(0.9, move(0, 0, -3)), (1.1, NOTHING)]),
    "is nothing all of a sudden": lambda: later(move(0, 0, -3), NOTHING),
    "becomes flat": lambda: dg.keys([(0.9, move(0, 0, -3)), (1.1, move(0, 0, -3) @ FLAT)]),
    "almost flat": lambda: dg.keys([(0.9, move(0, 0, -3)), (1.1, np.diag([1e-200, 1, 1, 1]))]),
    "denormal": lambda: dg.keys([(0.9, move(0, 0, -3)), (1.1, np.diag([1e-310] * 3 + [1]))]),
    "shear without inverse": lambda: dg.keys(
        [
            (0.9, move(0, 0, -3)),
            (1.1, np.diag([1.0, 1, 1, 1]) + np.eye(4)[[1, 0, 2, 3]] * (1, 1, 0, 0)),
        ]
    ),
    "huge and tiny": lambda: dg.keys(
        [(0.9, move(0, 0, -3)), (1.1, np.diag([1e150, 1e-150, 1, 1]))]
    ),
    "goes far": lambda: dg.keys([(0, move(1e300, 0, -3)), (2, move(-1e300, 0, 0))]),
    "turns inside out": lambda: dg.keys(
        [(0.8, move(0, 0, -3)), (1.2, move(0, 0, -3) @ np.diag([-1.0, 1, 1, 1]))]
    ),
    "lerped by half a turn": lambda: dg.keys(
        [(0.8, move(0, 0, -3)), (1.2, move(0, 0, -3) @ turn(180))], interpolation="linear"
    ),
    "a far pivot": lambda: dg.keys(
        [(0.9, move(0, 0, -3)), (1.1, move(0, 0, -3) @ turn(30))], pivot=(1e15, 0, 0)
    ),
    "the fastest spin": lambda: dg.spin((0, 0, 1), 1e9, transform=move(0, 0, -3)),
    "a far spin": lambda: dg.spin((0, 0, 1), 1.0, (1e15, 0, 0), move(0, 0, -3)),
    "keys a rounding apart": lambda: dg.keys(
        [(1.0, move(0, 0, -3)), (math.nextafter(1.0, 2), move(1, 0, -3))]
    ),
    "breaks anywhere": lambda: Over(
        lambda t: move(t - 1, 0, -3), [1.1, 0.9, 0.9, -5, 99, math.nan]
    ),
    "a million breaks": lambda: Over(
        lambda t: move(t - 1, 0, -3), np.linspace(0.8, 1.2, 1_000_002)[1:-1]
    ),
    "noise": lambda: Over(lambda t: move(math.sin(1e6 * t), 0, -3)),
}


@pytest.mark.parametrize("name", ODD)
def test_odd_motions_make_a_picture(name):
    """A transform without inverse at a moment is not met then; nothing crashes, nothing is NaN."""
    frame = shoot(scene_of(ODD[name]()))
    assert np.isfinite(frame.rgb).all()
    assert frame.metadata["bad_samples"] == 0


def test_nothing_is_met_where_it_is_nothing():
    """A card that is a point from 1 s on is seen for half of the time."""
    scene = dg.Scene(time=1.0)
    points, faces = card(10.0)
    white = dg.Material(dg.Diffuse((0, 0, 0)), emission=(1, 1, 1))
    scene.add_instance(scene.add_mesh(points, faces), white, later(move(0, 0, -3), NOTHING))
    frame = dg.render(scene, pinhole(shutter_time=0.4), resolution=(12, 8), spp=256)
    assert frame.rgb.mean() == pytest.approx(0.5, rel=0.03)


def _many(value: Callable[[float], Any]) -> Over:
    return Over(value, np.linspace(0.8, 1.2, 100_002)[1:-1])


CROWDED: dict[str, Callable[[], dg.Scene]] = {
    "instance 0 has": lambda: scene_of(_many(lambda t: move(t - 1, 0, -3))),
    "instance 0: shown has": lambda: scene_of(shown=_many(lambda t: t < 1)),
    "material 0 has": lambda: painted(dg.Diffuse(_many(lambda t: (t / 2, 0.1, 0.1)))),
    "light 0 has": lambda: lit(dg.PointLight(_many(lambda t: (t, 1.0, 1.0)))),
    "environment has": lambda: sky(_many(lambda t: t)),
}


@pytest.mark.parametrize("where", CROWDED)
def test_more_keys_than_can_be_shown_are_counted(where):
    session = dg.Session(CROWDED[where](), pinhole(shutter_time=0.4), resolution=(6, 4))
    assert [w.split(" 100000 keys")[0] for w in session.warnings] == [where]


def card(size: float) -> tuple[np.ndarray, np.ndarray]:
    points = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float) * size
    return points, np.array([(0, 1, 2), (0, 2, 3)])
