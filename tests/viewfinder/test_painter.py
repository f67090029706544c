"""The painter: small pictures first, the newest request wins, the last picture is the render."""

from __future__ import annotations

import queue
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.viewfinder import painter, work
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.drawn import Drawn, PictureRequest
from daguerre.viewfinder.image import image_of
from daguerre.viewfinder.painter import Painter
from daguerre.viewfinder.rungs import MODELS
from daguerre.viewfinder.stage import Stage

simplejpeg = pytest.importorskip("simplejpeg", reason="needs the extra view")


def scene() -> dg.Scene:
    """A lit floor before a camera."""
    found = dg.Scene()
    corners = np.array([[-2, 0, -6], [2, 0, -6], [2, 0, 0], [-2, 0, 0]], np.float32)
    material = found.add_material(dg.Material(kind=dg.Diffuse((0.5, 0.4, 0.3))))
    mesh = found.add_mesh(corners, np.array([[0, 2, 1], [0, 3, 2]], np.uint32))
    found.add_instance(mesh, material=material)
    found.set_environment(color=(1.0, 1.0, 1.0))
    found.add_camera("main", dg.Camera(transform=dg.look_at((0, 1, 2), (0, 0, -3)), f_stop=4))
    return found


@pytest.fixture
def stage() -> Stage:
    made = scene()
    settings = dg.RenderSettings.of(resolution=(120, 80), spp=8)
    return Stage(made, made.camera(), settings)


class Seen:
    """Pictures and failures of a painter."""

    def __init__(self, stage: Stage) -> None:
        self.pictures: queue.Queue[Drawn] = queue.Queue()
        self.failures: queue.Queue[tuple[PictureRequest, Exception]] = queue.Queue()
        self.stage = stage
        self.painter = Painter(self.pictures.put, lambda *one: self.failures.put(one))

    def request(self, number: int, dials: Dials | None = None, *, models: bool = False) -> None:
        """Asks for a picture."""
        dials = dials or Dials()
        self.painter.request(
            PictureRequest(number, self.stage, dials, self.stage.shot(dials), models)
        )

    def until_rest(self, number: int) -> list[Drawn]:
        """Pictures until that at rest of a request."""
        found = []
        while True:
            found.append(self.pictures.get(timeout=60))
            if found[-1].rests and found[-1].request.number == number:
                return found


@pytest.fixture
def seen(stage: Stage) -> Iterator[Seen]:
    made = Seen(stage)
    yield made
    made.painter.close()


def test_pictures_grow_until_they_rest(seen: Seen) -> None:
    seen.request(1)
    pictures = seen.until_rest(1)
    widths = [drawn.frame.width for drawn in pictures]
    samples = [drawn.samples for drawn in pictures]
    assert widths == sorted(widths)
    assert widths[0] < 120
    assert widths[-1] == 120
    assert samples[-4:] == [1, 2, 4, 8]
    assert [drawn.rests for drawn in pictures] == [False] * (len(pictures) - 1) + [True]


@pytest.mark.parametrize(
    "turns",
    [
        {},
        {"f_stop": "2", "focus_distance": "3"},
        {"lens": "double-gauss-50mm-f2"},
        {"spp": "3"},
        {"place.position": "0.5,1.5,2", "place.look_at": "0,0,-2"},
        {"seed": "9"},
    ],
)
def test_the_picture_at_rest_is_the_render(seen: Seen, stage: Stage, turns: Any) -> None:
    dials = Dials().turned(turns)
    seen.request(1, dials)
    last = seen.until_rest(1)[-1]
    alone = dg.render(scene(), dials.camera(stage.camera), settings=dials.settings(stage.settings))
    assert np.array_equal(last.frame.rgb, alone.rgb)


def test_the_newest_wish_wins(seen: Seen) -> None:
    for number in range(1, 40):
        seen.request(number, Dials().turned({"iso": str(100 + number)}))
        time.sleep(0.005)
    numbers = [drawn.request.number for drawn in seen.until_rest(39)]
    assert numbers == sorted(numbers)
    assert seen.pictures.empty()


def test_while_a_hand_moves_the_next_wish_comes_before_a_better_picture(
    seen: Seen, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The hand turns on when it sees a picture; work on better ones would delay the next."""
    monkeypatch.setattr(painter, "WAIT_S", 60.0)
    for number in (1, 2):
        seen.request(number, Dials().turned({"f_stop": str(4 + number)}))
        while seen.pictures.get(timeout=60).request.number != number:
            pass
    time.sleep(0.5)
    assert seen.pictures.empty()
    monkeypatch.setattr(painter, "WAIT_S", 0.0)
    seen.request(3)
    seen.until_rest(3)


def test_a_wish_that_cannot_be_is_a_failure_and_the_next_one_is_drawn(seen: Seen) -> None:
    wrong = Dials().turned({"lens": "double-gauss-50mm-f2", "f_stop": "0.5"})
    seen.request(1, wrong)
    request, error = seen.failures.get(timeout=60)
    assert request.number == 1
    assert "f_stop: wanted 2 or more" in str(error)
    seen.request(2)
    seen.until_rest(2)


@pytest.mark.parametrize("fault", [MemoryError, RuntimeError], ids=lambda one: one.__name__)
def test_after_a_fault_of_any_kind_the_next_wish_is_drawn(
    seen: Seen, monkeypatch: pytest.MonkeyPatch, fault: type[Exception]
) -> None:
    def fails(*_: object, **__: object) -> None:
        raise fault("planted")

    with monkeypatch.context() as patch:
        patch.setattr(work, "Session", fails)
        seen.request(1)
        assert isinstance(seen.failures.get(timeout=60)[1], fault)
    seen.request(2)
    seen.until_rest(2)


@pytest.mark.parametrize(("size", "kind"), [((240, 160), "rgb"), ((300, 160), "jpeg")])
def test_small_pictures_go_as_they_are(seen: Seen, stage: Stage, size: Any, kind: str) -> None:
    stage.settings = stage.settings.with_(resolution=size, spp=4)
    seen.request(1)
    last = seen.until_rest(1)[-1]
    image = image_of(last)
    shown = last.frame.display(stage.tone)
    assert (image.kind, image.size) == (kind, size)
    if kind == "rgb":
        pixels = np.frombuffer(image.bytes, np.uint8).reshape(shown.shape)
        assert np.array_equal(pixels, shown)
    else:
        pixels = simplejpeg.decode_jpeg(image.bytes)
        assert np.abs(pixels.astype(int) - shown).mean() < 4


def test_three_models_of_a_lens_side_by_side(seen: Seen, stage: Stage) -> None:
    dials = Dials().turned({"lens": "double-gauss-50mm-f2"})
    seen.request(1, dials, models=True)
    last = seen.until_rest(1)[-1]
    assert [panel.name for panel in last.panels] == list(MODELS)
    assert last.samples == 8
    camera = dials.camera(stage.camera)
    for panel in last.panels:
        settings = stage.settings.with_(resolution=(40, 26))
        alone = dg.render(scene(), camera.with_(lens_model=panel.name), settings=settings)
        assert np.array_equal(panel.frame.rgb, alone.rgb)


def test_a_painter_at_rest_draws_nothing_until_the_next_request(seen: Seen, stage: Stage) -> None:
    settings, stage.settings = stage.settings, stage.settings.with_(spp=1 << 20)
    seen.request(1)
    seen.pictures.get(timeout=60)
    seen.painter.rest()
    time.sleep(0.5)
    while not seen.pictures.empty():
        seen.pictures.get()
    time.sleep(work.LONGEST_S + 0.5)
    assert seen.pictures.empty()
    stage.settings = settings
    seen.request(2)
    seen.until_rest(2)


def test_a_closed_painter_stops_at_once(stage: Stage) -> None:
    stage.settings = stage.settings.with_(spp=1 << 20)
    seen = Seen(stage)
    seen.request(1)
    seen.pictures.get(timeout=60)
    began = time.monotonic()
    seen.painter.close()
    assert time.monotonic() - began < 2
