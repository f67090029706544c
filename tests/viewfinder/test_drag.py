"""A hand that keeps moving sees pictures, and the last turn counts."""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.viewfinder import hub, work
from daguerre.viewfinder.drawn import Drawn
from daguerre.viewfinder.stage import Stage

from .chromium import Browser, browser, program
from .live import TOKEN, Live, live
from .test_painter import scene

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")
pytestmark = [
    pytest.mark.skipif(program() is None, reason="needs chromium"),
    pytest.mark.xdist_group("chromium"),
]
#: Time that each set-up takes, s: several moves of a mouse.
SLOW_S = 0.1
SHOWN = "Number(document.getElementById('frame').dataset.turn)"
RESTS = "document.getElementById('frame')?.ariaBusy === 'false'"


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch) -> Iterator[Live]:
    make = work._session

    def slowly(*shot: Any) -> Any:
        time.sleep(SLOW_S)
        return make(*shot)

    monkeypatch.setattr(work, "_session", slowly)
    made = scene()
    with live(
        Stage(made, made.camera(), dg.RenderSettings.of(resolution=(240, 160), spp=1))
    ) as one:
        yield one


@pytest.fixture
def page(server: Live, tmp_path: Path) -> Iterator[Browser]:
    with browser(tmp_path / "profile") as one:
        one.open(f"http://{server.host}/#{TOKEN}")
        one.until(RESTS)
        yield one


def drags(page: Browser, seconds: float, turns: int) -> int:
    """Drags the picture at 60 moves a second, at most so long, until turns are seen."""
    seen: set[int] = set()
    x, y = page.place("#picture")
    page.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
    end = time.monotonic() + seconds
    for k in itertools.count(1):
        page.mouse("mouseMoved", x + 60 * math.sin(0.05 * k), y, button="left", buttons=1)
        seen.add(int(page.run(SHOWN)))
        if len(seen) > turns or time.monotonic() > end:
            break
        time.sleep(1 / 60)
    page.mouse("mouseMoved", x, y, button="left", buttons=1)
    page.mouse("mouseReleased", x, y, button="left", clickCount=1)
    return len(seen)


def test_pictures_follow_a_hand_that_does_not_rest(page: Browser) -> None:
    assert drags(page, 15, 5) > 5


def test_the_next_turn_comes_while_a_picture_is_developed(
    page: Browser, server: Live, monkeypatch: pytest.MonkeyPatch
) -> None:
    develop = hub.image_of
    newer: list[bool] = []

    def developed_late(drawn: Drawn, **more: Any) -> Any:
        number, end = drawn.request.number, time.monotonic() + 0.6  # the page sends after 1 s
        while server.hub.number == number and time.monotonic() < end:
            time.sleep(0.01)
        newer.append(server.hub.number > number)
        return develop(drawn, **more)

    monkeypatch.setattr(hub, "image_of", developed_late)
    drags(page, 15, 3)
    assert any(newer)


def test_the_last_move_of_a_drag_is_drawn(page: Browser, server: Live) -> None:
    drags(page, 0.5, 99)  # ends where it began
    time.sleep(3 * SLOW_S)
    page.until(RESTS)
    place = server.hub.dials.texts["place.position"]
    np.testing.assert_allclose([float(v) for v in place.split(",")], (0, 1, 2), atol=1e-3)


def test_what_was_turned_goes_before_other_messages(page: Browser, server: Live) -> None:
    """Undo takes back the turns that still wait for the picture of one before."""
    texts: list[str | None] = [server.hub.dials.texts.get("f_stop")]
    page.run("document.getElementById('ring-f_stop').focus()")
    page.press("ArrowRight")
    page.until(f"{SHOWN} > 0 && !document.getElementById('undo').disabled")
    texts.append(server.hub.dials.texts["f_stop"])
    page.run(
        """(() => {
          const ring = document.getElementById('ring-f_stop');
          const press = () => ring.dispatchEvent(
            new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true, cancelable: true}));
          for (let k = 0; k < 3; k++) press();
          document.getElementById('undo').click();
        })()"""
    )
    time.sleep(6 * SLOW_S)
    page.until(RESTS)
    assert server.hub.number >= 4  # both went out
    assert server.hub.dials.texts.get("f_stop") in texts
