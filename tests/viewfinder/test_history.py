"""Undo and redo: every turn is a step, and a step back is the picture before, to the bit."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.viewfinder import rungs
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.history import MOST, PAUSE_S, History, Steps
from daguerre.viewfinder.stage import Stage

from .live import Live, Page, live, page
from .test_painter import scene

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")

GAUSS, TESSAR = "double-gauss-50mm-f2", "tessar-50mm-f2.8"


def iso(number: int) -> Dials:
    """Dials that differ by their ISO."""
    return Dials({"iso": str(number)})


def turned(count: int) -> History:
    """A history after a number of steps."""
    found = History(iso(0))
    for number in range(1, count + 1):
        found = found.turned(iso(number), number)
    return found


def undone(history: History) -> History:
    """The history after an undo, which must be possible."""
    found = history.undone
    assert found is not None
    return found


def redone(history: History) -> History:
    """The history after a redo, which must be possible."""
    found = history.redone
    assert found is not None
    return found


def test_64_steps_are_undone_and_redone() -> None:
    history = turned(MOST + 6)
    for number in range(MOST + 5, 5, -1):
        history = undone(history)
        assert history.now == iso(number)
    assert history.undone is None
    for number in range(7, MOST + 7):
        history = redone(history)
        assert history.now == iso(number)
    assert history.redone is None
    assert undone(history).now == iso(MOST + 5)


def test_a_turn_after_an_undo_drops_the_redos() -> None:
    history = undone(turned(3)).turned(iso(9), 9)
    assert history.redone is None
    assert undone(history).now == iso(2)


def test_turns_of_one_step_are_undone_at_once() -> None:
    history = turned(2)
    for number in (10, 11, 12):
        history = history.turned(iso(number), 3)
    assert undone(history).now == iso(2)
    assert redone(undone(history)).now == iso(12)


def test_a_turn_after_an_undo_is_a_step_of_its_own() -> None:
    history = undone(turned(3)).turned(iso(9), 3)
    assert undone(history).now == iso(2)


def test_a_turn_that_changes_nothing_is_no_step() -> None:
    history = turned(2)
    assert history.turned(iso(2), 3) is history
    there_and_back = history.turned(iso(5), 3).turned(iso(2), 3)
    assert undone(there_and_back).now == iso(1)


def test_turns_without_a_pause_are_one_step() -> None:
    steps = Steps()
    first = steps.of_turn({"iso"}, 10.0)
    assert steps.of_turn({"iso"}, 10.0 + PAUSE_S) == first
    assert steps.of_turn({"iso"}, 10.1 + 2 * PAUSE_S) != first


def test_turns_of_other_dials_are_other_steps() -> None:
    steps = Steps()
    first = steps.of_turn({"iso"}, 10.0)
    second = steps.of_turn({"f_stop", "t_stop"}, 10.1)
    assert len({first, second, steps.of_turn({"iso"}, 10.2)}) == 3


def test_a_gesture_is_one_step_with_its_pauses() -> None:
    steps = Steps()
    before = steps.of_turn({"iso"}, 10.0)
    steps.hold(20.0)
    first = steps.of_turn({"iso"}, 20.1)
    assert first != before
    assert steps.of_turn({"iso"}, 60.0) == first
    steps.let_go(100.0)
    assert steps.of_turn({"iso"}, 100.01) == first  # was on its way
    assert steps.of_turn({"iso"}, 110.0) != first


def test_a_gesture_that_turned_nothing_joins_no_steps() -> None:
    steps = Steps()
    first = steps.of_turn({"iso"}, 10.0)
    steps.hold(20.0)
    steps.let_go(21.0)
    assert steps.of_turn({"iso"}, 21.1) != first


@pytest.fixture
def server() -> Iterator[Live]:
    made = scene()
    settings = dg.RenderSettings.of(resolution=(60, 40), spp=1)
    camera = made.camera().with_(f_stop=None)  # so that a mode may choose it
    with live(Stage(made, camera, settings)) as running:
        yield running


def rests(one: Page, server: Live) -> NDArray[np.float32]:
    """Values of the picture at rest after all turns."""
    one.until_rest(server.hub.number)
    drawn = server.hub.picture
    assert drawn is not None
    assert drawn.request.number == server.hub.number
    return np.array(drawn.frame.rgb)


def until(one: Page, holds: Callable[[], Any]) -> None:
    """Takes messages until a condition holds."""
    end = time.monotonic() + 60
    while not holds():
        assert time.monotonic() < end
        one.step()


def does(one: Page, server: Live, **message: Any) -> NDArray[np.float32]:
    """Sends a message that moves the dials, and waits for its picture."""
    before = server.hub.number
    one.send(**message)
    while one.state["turn"] == before:
        assert not one.refused, one.refused
        one.step()
    return rests(one, server)


def turns(again: int) -> list[dict[str, str | None]]:
    """Turns of lenses, rings, modes and the camera's place; each changes something.

    No two of the same dials follow each other, which would be one step.
    """
    return [
        {"lens": GAUSS},
        {"focus_distance": f"{3 + again}", "focus_at": None},
        {"exposure": "A"},
        {"f_stop": "4", "t_stop": None},
        {"lens": TESSAR},
        {"place.position": "0.5,1.5,2", "place.look_at": "0,0,-2", "place.roll": None},
        {"exposure": "P"},
        {"meter": ("highlight", "matrix")[again % 2]},
        {"exposure": "manual"},
        {"iso": f"{400 + again}"},
        {"lens": "thin"},
        {"spp": "1"},
        {"exposure": "light"},
        {"place.position": "0,2,2", "place.look_at": "0,0,-3", "place.roll": "4"},
        {"shutter_time": "1/30", "shutter_angle": None},
        {"spp": "2"},
    ]


def test_64_turns_are_undone_and_redone_to_the_bit(server: Live) -> None:
    with page(server) as one:
        one.until_rest(0)
        seen = [(dict(one.state["dials"]), rests(one, server))]
        for changes in itertools.chain(*map(turns, range(MOST // 16))):
            picture = does(one, server, turn=changes)
            seen.append((dict(one.state["dials"]), picture))
        assert len(seen) == MOST + 1
        for dials, picture in seen[-2::-1]:
            assert np.array_equal(does(one, server, undo=True), picture)
            assert one.state["dials"] == dials
        assert (one.state["undoes"], one.state["redoes"]) == (False, True)
        for dials, picture in seen[1:]:
            assert np.array_equal(does(one, server, redo=True), picture)
            assert one.state["dials"] == dials
        assert (one.state["undoes"], one.state["redoes"]) == (True, False)


def test_there_may_be_nothing_to_undo(server: Live) -> None:
    with page(server) as one:
        one.until_rest(0)
        for name in ("undo", "redo"):
            one.send(**{name: True})
            until(one, lambda: one.refused)
            assert one.refused.pop().startswith(f"{name}: nothing was")
        assert one.state["turn"] == 0


def test_a_turn_that_fails_is_no_step(server: Live) -> None:
    with page(server) as one:
        one.until_rest(0)
        does(one, server, turn={"lens": GAUSS})
        does(one, server, turn={"iso": "400"})
        does(one, server, undo=True)
        one.send(turn={"f_stop": "0.7"})
        until(one, lambda: one.state["error"])
        rests(one, server)
        assert (one.state["undoes"], one.state["redoes"]) == (True, True)
        does(one, server, redo=True)
        assert one.state["dials"] == {"lens": GAUSS, "iso": "400"}
        does(one, server, undo=True)
        does(one, server, undo=True)
        assert one.state["dials"] == {}
        assert not one.state["undoes"]


@pytest.mark.parametrize("stop", [{"f_stop": "2"}, {"t_stop": "2.1"}])
def test_a_lens_that_opens_less_goes_to_its_widest_stop(server: Live, stop: Any) -> None:
    with page(server) as one:
        one.until_rest(0)
        does(one, server, turn={"lens": GAUSS, **stop})
        one.send(turn={"lens": TESSAR})
        until(one, lambda: one.state["note"])
        rests(one, server)
        assert one.state["note"] == (
            "This lens opens no wider than f/2.8, so the aperture is there now."
        )
        assert one.state["error"] == ""
        assert one.state["dials"] == {"lens": TESSAR, "f_stop": "2.8"}
        assert "--f-stop=2.8" in one.state["command"]
        does(one, server, undo=True)
        assert one.state["dials"] == {"lens": GAUSS, **stop}
        assert one.state["note"] == ""


def test_a_stop_of_the_scene_gives_way_to_a_lens_that_opens_less() -> None:
    made = scene()
    settings = dg.RenderSettings.of(resolution=(60, 40), spp=1)
    with (
        live(Stage(made, made.camera().with_(f_stop=1.2), settings)) as server,
        page(server) as one,
    ):
        one.until_rest(0)
        one.send(turn={"lens": TESSAR})
        until(one, lambda: one.state["note"])
        rests(one, server)
        assert one.state["dials"] == {"lens": TESSAR, "f_stop": "2.8"}


def test_models_that_cannot_be_drawn_go_back(server: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rungs, "MODELS", ("pinhole", "none", "exact"))
    with page(server) as one:
        one.until_rest(0)
        does(one, server, turn={"lens": GAUSS})
        one.send(show={"models": True})
        until(one, lambda: one.state["error"])
        rests(one, server)
        assert not one.state["show"]["models"]
        assert one.state["dials"] == {"lens": GAUSS}


def test_a_step_that_was_never_drawn_and_cannot_be_is_passed_by(server: Live) -> None:
    with page(server) as one:
        one.until_rest(0)
        does(one, server, turn={"iso": "400"})
        one.send(turn={"lens": "telephoto-200mm-f1.8", "focus_distance": "0.6"})
        one.send(turn={"lens": "thin"})
        until(one, lambda: one.state["dials"].get("lens") == "thin")
        rests(one, server)
        one.send(undo=True)
        until(one, lambda: one.state["error"] or one.state["dials"] == {"iso": "400"})
        if one.state["error"]:  # the step was undone to what cannot be drawn
            rests(one, server)
            does(one, server, undo=True)
        assert one.state["dials"] == {"iso": "400"}


def test_a_page_that_watches_undoes_nothing(server: Live) -> None:
    with page(server) as first:
        first.until_rest(0)
        does(first, server, turn={"iso": "400"})
        with page(server) as other:
            other.until_rest(1)
            assert other.state["undoes"]
            for message in ({"undo": True}, {"redo": True}, {"hold": True}):
                other.send(**message)
                until(other, lambda: other.refused)
                assert "read-only" in other.refused.pop()
            assert server.hub.dials.texts == {"iso": "400"}


def test_steps_outlive_the_page(server: Live) -> None:
    with page(server) as first:
        first.until_rest(0)
        does(first, server, turn={"iso": "400"})
    with page(server) as again:
        again.until_rest(1)
        does(again, server, undo=True)
        assert again.state["dials"] == {}
