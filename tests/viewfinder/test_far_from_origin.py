"""The origin of the scene in the viewfinder: kept while the camera is near it."""

from __future__ import annotations

import numpy as np

import daguerre as dg
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.stage import Stage
from daguerre.viewfinder.work import _session
from tests.support.scene.scenes import at, lamp_room


def placed(x: float) -> dg.Camera:
    return dg.Camera(transform=at(x, 0, 1), focus_distance=5.0)


def test_a_camera_that_crosses_an_edge_again_builds_the_scene_once() -> None:
    stage = Stage(lamp_room(), placed(0), dg.RenderSettings.of(resolution=(48, 32)))
    origins = []
    for x in (400.0, 600.0, 400.0, 1000.0, 600.0, 1100.0, 1000.0, 200.0, 100.0, -500.0):
        stage.camera = placed(x)
        shot = stage.shot(Dials.of({}))
        origins.append(_session(stage, shot.smaller(1)).built.origin[0])
    assert origins == [0, 0, 0, 0, 0, 1024, 1024, 1024, 1024, 0]


def test_the_picture_at_rest_has_the_bits_of_the_command() -> None:
    stage = Stage(lamp_room(), placed(0), dg.RenderSettings.of(resolution=(48, 32), spp=1))
    _session(stage, stage.shot(Dials.of({})))
    stage.camera = placed(700.0)
    shot = stage.shot(Dials.of({}))
    assert _session(stage, shot).built.origin == (0, 0, 0)
    session = _session(stage, shot, last=True)
    assert session.built.origin == (1024, 0, 0)
    session.draw(0, 1)
    alone = dg.render(lamp_room(), placed(700.0), resolution=(48, 32), spp=1)
    assert np.array_equal(session.frame().rgb, alone.rgb)
