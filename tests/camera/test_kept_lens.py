"""Lenses are kept while cameras only move: the same pictures, set up once."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.lenses.library import path_of
from daguerre.rendering.session import Session
from daguerre.setup import lens as setup

Picture = NDArray[np.float32]
NAME = "tessar-50mm-f2.8"
SCENE = dg.Scene()


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Arguments of the exact lenses that were set up; none is kept before."""
    found: list[Any] = []
    exact = setup._exact_lens

    def noted(*given: Any) -> Any:
        found.append(given)
        return exact(*given)

    monkeypatch.setattr(setup, "_exact_lens", noted)
    setup._glass.cache_clear()
    return found


def set_up(camera: dg.Camera) -> Any:
    """The lens of a camera, ready to draw."""
    return Session(SCENE, camera, resolution=(24, 16)).prepared.setup.lens


def at(x: float) -> NDArray[np.float64]:
    """A pose so far to the right, m."""
    pose = np.eye(4)
    pose[0, 3] = x
    return pose


CAMERA = dg.Camera(lens=NAME, f_stop=4, focus_distance=2)


def test_a_camera_that_moves_or_is_exposed_otherwise_keeps_its_lens(made: list[Any]) -> None:
    set_up(CAMERA)
    moved = set_up(CAMERA.with_(transform=at(1), iso=800))
    assert len(made) == 1
    setup._glass.cache_clear()
    alone = set_up(CAMERA.with_(transform=at(1), iso=800))
    assert (moved.notes, moved.f_stop, moved.focus_distance_m) == (
        alone.notes,
        alone.f_stop,
        alone.focus_distance_m,
    )


@pytest.mark.parametrize(
    "change",
    [
        {"f_stop": 5.6},
        {"focus_distance": 3},
        {"shift": (1, 0)},
        {"blades": 5},
        {"sensor_size": (24, 16)},
        {"decenter": [((1, 2), (0.1, 0.0))]},
        {"lens": "double-gauss-50mm-f2"},
    ],
)
def test_another_lens_stop_focus_or_film_is_set_up_anew(
    made: list[Any], change: dict[str, Any]
) -> None:
    set_up(CAMERA)
    set_up(CAMERA.with_(**change))
    assert len(made) == 2


def test_a_lens_file_that_changes_is_read_again(made: list[Any], tmp_path: Path) -> None:
    file = tmp_path / "lens.json"
    for name in (NAME, "double-gauss-50mm-f2"):
        shutil.copyfile(path_of(name), file)
        set_up(CAMERA.with_(lens=file))
    assert len(made) == 2


def test_pictures_have_the_bits_of_a_lens_set_up_for_them(made: list[Any]) -> None:
    scene = dg.Scene()
    scene.set_environment(np.ones((2, 4, 3)))
    camera = CAMERA.with_(transform=at(1))

    def picture(camera: dg.Camera) -> Picture:
        return dg.render(scene, camera, resolution=(24, 16), spp=2).rgb

    picture(CAMERA)
    kept = picture(camera)
    setup._glass.cache_clear()
    np.testing.assert_array_equal(kept, picture(camera))
