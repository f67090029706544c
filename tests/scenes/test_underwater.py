"""The pool behind a flat port and a dome, against refraction on paper."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg

WATER, GLASS = 1.333, 1.517
WALL_M, TILE_M = 5.0, 0.25
SHAPE = (32, 144)  # of the part of the picture above the amphora, pixels
TOP_MM, SIZE_MM = 8.0, (36.0, 8.0)


@pytest.fixture(scope="module")
def scenes(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dg.Scene]:
    folder = tmp_path_factory.mktemp("underwater")
    sys.path.insert(0, str(Path(__file__).parents[2] / "scenes"))
    try:
        from solids import bare, dome, flat
    finally:
        sys.path.pop(0)
    made = {}
    for name, module in (("bare", bare), ("flat", flat), ("dome", dome)):
        module.make().write(path := folder / f"{name}.glb")
        made[name] = dg.load(path)
    return made


def on_the_wall(port: str) -> NDArray[np.float64]:
    """Points of the wall behind 5 x 5 points of each pixel, relative to the axis, m."""
    rows, columns = ((np.arange(5 * n) + 0.5) / (5 * n) for n in SHAPE)
    x = (columns[None, :] - 0.5) * SIZE_MM[0] / 35 + 0 * rows[:, None]
    y = (TOP_MM - rows[:, None] * SIZE_MM[1]) / 35 + 0 * columns[None, :]
    tangent = np.hypot(x, y)
    sine = tangent / np.hypot(1, tangent)

    def behind(index: float) -> NDArray[np.float64]:
        return np.tan(np.arcsin(sine / index))

    across = WALL_M * tangent
    if port == "flat":
        across = 0.04 * tangent + 0.01 * behind(GLASS) + (WALL_M - 0.05) * behind(WATER)
    return np.stack((x, y)) / tangent * across


def joints(port: str) -> NDArray[np.float64]:
    """The share of each pixel that joints between tiles fill."""
    x, y = on_the_wall(port)
    along = np.stack((x + 2.5, y + 1.2)) / TILE_M % 1
    dark = (np.minimum(along, 1 - along) < 0.03).any(0)
    return dark.reshape(SHAPE[0], 5, SHAPE[1], 5).mean((1, 3))


def picture(scene: dg.Scene, **camera: Any) -> NDArray[np.float64]:
    """Luminance of the part above the amphora, with even light."""
    height = 24.0
    whole = round(SHAPE[0] * height / SIZE_MM[1])
    top = round((height / 2 - TOP_MM) / height * whole)
    seen = scene.camera("Camera").with_(**camera)
    given: dict[str, Any] = {"spp": 96, "max_depth": 8, "light_paths": "off"}
    crop = (0, top, SHAPE[1], top + SHAPE[0])
    light = dg.render(scene, seen, resolution=(SHAPE[1], whole), crop=crop, **given).rgb[..., 1]
    around = np.lib.stride_tricks.sliding_window_view(np.pad(light, 7, mode="edge"), (15, 15))
    return np.asarray(np.minimum(light / np.median(around, (2, 3)), 1.2))


def likeness(scene: dg.Scene, port: str) -> float:
    """Correlation of darkness with the joints."""
    return -float(np.corrcoef(picture(scene, lens="pinhole").ravel(), joints(port).ravel())[0, 1])


def test_a_flat_port_has_the_pincushion_of_refraction(scenes: dict[str, dg.Scene]) -> None:
    assert likeness(scenes["flat"], "flat") > 0.6
    assert likeness(scenes["flat"], "none") < 0.2


@pytest.mark.parametrize("name", ["bare", "dome"])
def test_a_dome_about_the_pupil_keeps_the_framing(scenes: dict[str, dg.Scene], name: str) -> None:
    assert likeness(scenes[name], "none") > 0.6
    assert likeness(scenes[name], "flat") < 0.2


def contrast(scene: dg.Scene, focus_m: float) -> float:
    """Contrast of some tiles in the upper left through a real lens at f/2."""
    camera = scene.camera("Camera").with_(
        lens="double-gauss-50mm-f2", f_stop=2, focus_distance=focus_m
    )
    given: dict[str, Any] = {"spp": 64, "max_depth": 8, "light_paths": "off"}
    crop = (500, 300, 580, 380)
    light = dg.render(scene, camera, resolution=(1440, 960), crop=crop, **given).rgb[..., 1]
    return float(np.std(light.clip(max=2 * np.median(light))) / light.mean())


@pytest.mark.parametrize("port", ["bare", "flat", "dome"])
def test_the_wall_is_sharp_at_its_apparent_distance(scenes: dict[str, dg.Scene], port: str) -> None:
    """Through a flat port at 3/4 of the distance, through a dome at some 4 radii."""
    radius = 0.1
    apparent = {
        "bare": WALL_M,
        "flat": 0.04 + 0.01 / GLASS + (WALL_M - 0.05) / WATER,
        "dome": radius + 1 / ((WATER - 1) / radius + WATER / (WALL_M - radius)),
    }[port]
    near, sharp, far = (contrast(scenes[port], apparent * k) for k in (1 / 1.33, 1, 1.33))
    assert sharp > 1.015 * near
    assert sharp > 1.015 * far
