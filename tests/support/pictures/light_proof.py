"""Camera rays and light paths held against each other: cases, and the test of one.

``camera`` draws all that camera rays can find, ``light`` leaves to light paths all that these can
find, ``both`` shares it by the balance heuristic; each is held against the others by Welch's test,
pixel by pixel and block by block. What a light path cannot find (behind smooth glass, say) stays
with the camera in each of them. Lamps should be large, so that camera rays alone converge.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre as dg
from tests.support.pictures.statistical import Rare, batch_means, differences, seldom_met
from tests.support.scene import scenes

SIZE = (48, 32)
GAUSS = "double-gauss-50mm-f2"
CLOSE = 1.2  # m, where lenses are focused
SMALL = (9.0, 6.0)  # mm: pixels small enough for a lamp out of focus to be a disc of many
PLAN = (3000.0, 0.0)  # light paths per sample index


@dataclass(frozen=True)
class Case:
    """A scene and a camera, and how much is drawn of it with camera rays, with light, with both."""

    scene: Callable[[], dg.Scene]
    camera: dg.Camera
    plan: tuple[float, float] = PLAN
    spp: tuple[int, int, int] = (128, 32, 32)
    brightest: float = 1500.0  # what a camera ray can meet
    options: dict[str, Any] = field(default_factory=dict)


def ball(
    scene: dg.Scene, kind: Any, at: tuple[float, float, float], radius: float, segments: int = 12
) -> None:
    """A ball of a material."""
    points, faces, normals = scenes.sphere(segments, radius)
    scene.add_instance(scene.add_mesh(points, faces, normals), dg.Material(kind), scenes.at(*at))


def lamp(
    scene: dg.Scene, at: tuple[float, float, float], radius: float, color: Any, name: str = ""
) -> None:
    """A ball of light of so many cd/m2 at a radius of 1 cm; as bright in all at any other."""
    color = tuple(c * (0.01 / radius) ** 2 for c in color)
    scene.add_light(dg.SphereLight(color, radius, name=name), scenes.at(*at))


def wall(scene: dg.Scene, z: float = -3.5) -> None:
    """A white wall that the lamps light, and a dim sky."""
    points, faces = scenes.quad(4, z)
    scene.add_instance(scene.add_mesh(points, faces), dg.Material(dg.Diffuse((0.6, 0.5, 0.4))))
    scene.set_environment(color=(0.002, 0.003, 0.005))


def thin(**changes: Any) -> dg.Camera:
    return dg.Camera(lens="thin", focal_length=50, f_stop=2.0, focus_distance=CLOSE).with_(
        sensor_size=SMALL, **changes
    )


def glass(name: str = GAUSS, f_stop: float = 2.0, **changes: Any) -> dg.Camera:
    facts = {"sensor_size": SMALL, "focus_distance": CLOSE} | changes
    return dg.Camera(lens=name, f_stop=f_stop, **facts)


def pictures(
    case: Case, technique: str, plan: tuple[float, float] | None = None, seed: int = 0
) -> NDArray[np.float64]:
    """Eight independent pictures by one technique, (8, H, W, 3)."""
    spp = case.spp[("camera", "light", "both").index(technique)]
    plan = case.plan if plan is None else plan
    seed += 1000 * (1 + ("camera", "light", "both").index(technique))
    options: dict[str, Any] = {"resolution": SIZE, "max_depth": 4} | case.options
    return batch_means(
        case.scene(),
        case.camera,
        8,
        spp,
        seed=seed,
        technique=technique,
        light_paths="off" if technique == "camera" else plan,
        **options,
    )


def by_chance(
    case: Case, camera: NDArray[np.float64], light: NDArray[np.float64] | None = None
) -> Rare:
    """Camera pictures that know what light paths bring: next to none of them, with the same seeds,
    leave all else."""
    light = pictures(case, "light") if light is None else light
    m1, m2 = case.plan
    rest = pictures(case, "light", (1e-6 * (m1 > 0), 1e-6 * (m2 > 0)))
    found = light.mean(axis=0) - rest.mean(axis=0)
    return seldom_met(camera, found, case.brightest, case.spp[0] * len(camera))


def check(case: Case) -> None:
    """Camera, light and both have one mean, and light has had a share in it."""
    camera, light, both = (pictures(case, name) for name in ("camera", "light", "both"))
    expected = by_chance(case, camera, light)
    assert both.mean() > 0
    assert differences(light, both) == []
    assert differences(both, expected) == []
    assert differences(light, expected) == []
    # Light paths that bring 5 % too much must not go unnoticed.
    assert differences(light * 1.05, expected) != []
