"""Turns that change the brightness alone: no sample is drawn anew, and the bits are a render's."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import MismatchError
from daguerre.files.value import same
from daguerre.rendering.session import Session
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.stage import Stage

from .test_painter import Seen, scene

pytest.importorskip("simplejpeg", reason="needs the extra view")
SIZE = (60, 40)
STARTS: list[tuple[dict[str, str], str]] = [
    ({"lens": "pinhole"}, "exposure_f_stop iso"),
    ({"lens": "double-gauss-50mm-f2", "exposure": "auto"}, "exposure_compensation exposure"),
    ({"exposure": "P"}, "white_balance look"),  # its meter may change the time for others
    ({"sensor": "ideal", "exposure": "manual"}, "iso exposure_compensation"),
]
TURNS: list[dict[str, str]] = [
    {"iso": "400"},
    {"exposure_compensation": "1"},
    {"white_balance": "3200"},
    {"look": "standard"},
    {"exposure": "light"},
    {"exposure": "auto"},
    {"meter": "highlight"},
    {"exposure_f_stop": "4"},
]


@pytest.fixture
def stage() -> Stage:
    made = scene()
    made.set_environment(color=(200.0, 200.0, 200.0))
    return Stage(
        made, made.camera().with_(f_stop=None), dg.RenderSettings.of(resolution=SIZE, spp=3)
    )


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, int]]:
    """Ranges of samples that sessions draw."""
    found: list[tuple[int, int]] = []
    draw = Session.draw

    def counted(self: Session, begin: int, end: int, progress: Any = None) -> bool:
        found.append((begin, end))
        return draw(self, begin, end, progress)

    monkeypatch.setattr(Session, "draw", counted)
    return found


@pytest.fixture
def seen(stage: Stage) -> Iterator[Seen]:
    made = Seen(stage)
    yield made
    made.painter.close()


def check(seen: Seen, number: int, dials: Dials) -> None:
    """The picture at rest is a render's, linear and developed, and has its metadata."""
    last = seen.until_rest(number)[-1]
    stage = seen.stage
    shot = stage.shot(dials)
    session = Session(stage.scene, shot.camera, settings=shot.settings)
    session.draw(0, 3)
    alone = session.frame()
    assert np.array_equal(last.frame.rgb, alone.rgb)
    assert same(last.frame.metadata, alone.metadata)
    pixels = last.shot.photograph.shown(last.frame, "srgb")
    assert np.array_equal(pixels, shot.photograph.shown(alone, "srgb"))


@pytest.mark.parametrize(
    ("start", "turn"),
    [({"exposure": "manual"}, turn) for turn in TURNS]
    + [
        (start, turn)
        for start, names in STARTS
        for turn in TURNS
        if turn.keys() <= {*names.split()}
    ],
    ids=lambda one: "-".join(one),
)
def test_a_turn_of_brightness_develops_the_picture_that_is_there(
    seen: Seen, drawn: list[Any], start: dict[str, str], turn: dict[str, str]
) -> None:
    dials = Dials().turned(start)
    seen.request(1, dials)
    seen.until_rest(1)
    drawn.clear()
    turned = dials.turned(turn)
    seen.request(2, turned)
    first = seen.pictures.get(timeout=60)
    assert (first.request.number, first.rests, drawn) == (2, True, [])
    seen.pictures.put(first)
    check(seen, 2, turned)


@pytest.mark.parametrize(
    "turn",
    [{"f_stop": "8"}, {"shutter_time": "1/500"}, {"seed": "7"}, {"natural_vignetting": "true"}],
    ids=lambda one: next(iter(one)),
)
def test_other_turns_draw(seen: Seen, drawn: list[Any], turn: dict[str, str]) -> None:
    seen.request(1)
    seen.until_rest(1)
    drawn.clear()
    dials = Dials().turned(turn)
    seen.request(2, dials)
    check(seen, 2, dials)
    assert drawn


def test_a_turn_of_brightness_while_samples_are_drawn_ends_none(
    stage: Stage, drawn: list[tuple[int, int]]
) -> None:
    stage.settings = stage.settings.with_(spp=1 << 9, resolution=(120, 80))
    seen = Seen(stage)
    try:
        dials = Dials().turned({"exposure": "manual"})
        seen.request(1, dials)
        while seen.pictures.get(timeout=60).samples < 4:
            pass
        for number in range(2, 8):
            dials = dials.turned({"iso": str(100 * number)})
            seen.request(number, dials)
            while (picture := seen.pictures.get(timeout=60)).request.number < number:
                pass
            assert picture.samples >= 4
            assert picture.frame.metadata["isoSpeed"] == 100 * number
        last = picture if picture.rests else seen.until_rest(7)[-1]
        assert last.frame.metadata["isoSpeed"] == 700
        assert last.frame.metadata["samples"] == 1 << 9
        whole = [one for one in drawn if one != (0, 1)]
        assert whole == sorted(set(whole))
    finally:
        seen.painter.close()


def test_panels_are_developed_anew(seen: Seen, drawn: list[Any]) -> None:
    dials = Dials().turned({"lens": "double-gauss-50mm-f2"})
    seen.request(1, dials, models=True)
    before = seen.until_rest(1)[-1]
    drawn.clear()
    seen.request(2, dials.turned({"iso": "400"}), models=True)
    after = seen.until_rest(2)[-1]
    assert drawn == []
    for old, new in zip(before.panels, after.panels, strict=True):
        assert np.array_equal(old.frame.rgb, new.frame.rgb)
        assert new.frame.metadata["isoSpeed"] == 400


def test_a_session_takes_no_brightness_of_other_light(stage: Stage) -> None:
    session = Session(stage.scene, stage.camera, settings=stage.settings)
    session.expose(replace(stage.camera, iso=200.0))
    with pytest.raises(MismatchError, match="same light"):
        session.expose(stage.camera.with_(f_stop=11))
