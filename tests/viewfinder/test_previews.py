"""Denoised previews: a plain picture first, the exact one at rest, and no waiting for either."""

from __future__ import annotations

import itertools
import math
import os
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.frame.frame import Frame
from daguerre.viewfinder import hub, previews, work
from daguerre.viewfinder.drawn import Drawn
from daguerre.viewfinder.image import image_of
from daguerre.viewfinder.sheet import Sheet
from daguerre.viewfinder.show import Show
from daguerre.viewfinder.stage import Stage

from .chromium import browser, program
from .live import TOKEN, Live, Page, live, page
from .test_painter import scene

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")

SIZE = (120, 80)
SPP = 64
STATUS = "document.getElementById('status')?.textContent"
PICTURE = "document.getElementById('frame').dataset.picture"
BUTTON = "document.querySelector('[data-show=denoised]')"
STEPS = [1, 2, 4, 8, 16, 32, 64]


def grey(frame: Frame) -> Frame:
    """A picture that no other step makes."""
    return replace(frame, rgb=np.full_like(frame.rgb, 0.5), channels=None, bands=None)


@pytest.fixture
def clean(monkeypatch: pytest.MonkeyPatch) -> None:
    """Previews by a denoiser that is fast everywhere, of pictures that come slowly."""
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    monkeypatch.setattr(previews.extras, "missing", lambda _: False)
    monkeypatch.setattr(previews, "check_available", lambda: None)
    monkeypatch.setattr(previews, "preview", grey)
    monkeypatch.setattr(previews, "MOST_S", math.inf)
    monkeypatch.setattr(work, "LONGEST_S", 1e6)  # samples double at each step
    drawn = work._refined

    def slowly(session: Any) -> Iterator[tuple[int, bool]]:
        for step in drawn(session):
            yield step
            time.sleep(0.1)

    monkeypatch.setattr(work, "_refined", slowly)


@pytest.fixture
def server(clean: None) -> Iterator[Live]:
    made = scene()
    with live(Stage(made, made.camera(), dg.RenderSettings.of(resolution=SIZE, spp=SPP))) as found:
        yield found


@pytest.fixture
def sheets(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, int, bool]]:
    """Turn, samples and denoising of each whole picture that is ready for pages, as it is."""
    found: list[tuple[int, int, bool]] = []
    make = hub.Hub._sheet_of

    def noted(self: hub.Hub, drawn: Drawn, *rest: Any, denoised: bool) -> Sheet:
        if drawn.whole:
            found.append((drawn.request.number, drawn.samples, denoised))
        return make(self, drawn, *rest, denoised=denoised)

    monkeypatch.setattr(hub.Hub, "_sheet_of", noted)
    return found


def turned(one: Page, turn: int, **changes: str) -> list[dict[str, Any]]:
    """Heads of all pictures of a turn."""
    one.send(turn=changes)
    one.until_rest(turn)
    return [head for head in one.heads if head["turn"] == turn]


def shown(one: Page, denoised: bool | None) -> None:
    """Presses Denoise, and waits until the server says so."""
    one.send(show={"denoised": denoised})
    while one.state["show"]["denoised"] is not denoised:
        one.step()


def bits(f_stop: float) -> bytes:
    """Pixels of the command."""
    made = scene()
    frame = dg.render(made, made.camera().with_(f_stop=f_stop), resolution=SIZE, spp=SPP)
    return Stage(made, made.camera()).photograph.shown(frame, "srgb").tobytes()


def test_pictures_on_the_way_are_denoised_after_the_plain_ones(
    server: Live, sheets: list[tuple[int, int, bool]]
) -> None:
    with page(server) as one:
        one.until_rest(0)
        assert one.state["show"]["denoised"] is None
        turned(one, 1, f_stop="8")
        while not any(head["denoised"] for head in one.heads):
            one.step()
    order = [(samples, denoised) for turn, samples, denoised in sheets if turn == 1]
    plain = [samples for samples, denoised in order if not denoised]
    clean = [samples for samples, denoised in order if denoised]
    assert plain == STEPS
    assert len(clean) >= 3
    assert clean == sorted(set(clean))
    assert all(order.index((n, False)) < order.index((n, True)) for n in clean)
    assert all(b >= 2 * a for a, b in itertools.pairwise(clean))


def test_the_picture_at_rest_has_the_bits_of_the_command(server: Live) -> None:
    with page(server) as one:
        one.until_rest(0)
        heads = turned(one, 1, f_stop="8")
        assert any(head["denoised"] for head in heads)
        assert not heads[-1]["denoised"]
        assert one.bytes == bits(8)
        one.send(probe=[1, 1])
        time.sleep(0.5)
        while not one.values:
            one.step()
        assert one.heads[-1] is heads[-1]  # nothing follows it


def test_previews_change_neither_histogram_nor_values(
    server: Live, monkeypatch: pytest.MonkeyPatch
) -> None:
    histograms: dict[bool, dict[int, Any]] = {False: {}, True: {}}
    make = hub.Hub._sheet_of

    def noted(self: hub.Hub, drawn: Drawn, image: Any, show: Show, *, denoised: bool) -> Sheet:
        if drawn.whole and drawn.request.number == 1:
            histograms[denoised][drawn.samples] = image.histogram
        return make(self, drawn, image, show, denoised=denoised)

    monkeypatch.setattr(hub.Hub, "_sheet_of", noted)
    with page(server) as one:
        one.until_rest(0)
        assert any(head["denoised"] for head in turned(one, 1, f_stop="8"))
        plain, clean = histograms[False], histograms[True]
        assert clean
        assert clean == {samples: plain[samples] for samples in clean}
        one.send(turn={"f_stop": "4"})
        while not one.heads[-1]["denoised"]:
            one.step()
        assert set(one.bytes) == {188}
        picture = server.hub.picture
        assert picture is not None
        assert np.ptp(picture.frame.rgb) > 0.1


def test_a_slow_denoiser_delays_nothing_and_is_left_alone(
    server: Live, sheets: list[tuple[int, int, bool]], monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[int] = []
    held = threading.Event()

    def slow(frame: Frame) -> Frame:
        calls.append(1)
        assert held.wait(15)
        return grey(frame)

    monkeypatch.setattr(previews, "MOST_S", 0.01)
    with page(server) as one:
        one.until_rest(0)
        monkeypatch.setattr(previews, "preview", slow)
        server.hub._previews._pause_end = -math.inf
        turned(one, 1, f_stop="8")
        assert [sheet for sheet in sheets if sheet[0] == 1] == [(1, n, False) for n in STEPS]
        assert calls == [1]
        held.set()
        end = time.monotonic() + 10
        while server.hub._previews._pause_end < time.monotonic() < end:
            time.sleep(0.01)
        turned(one, 2, f_stop="5.6")
        assert not any(denoised for turn, _, denoised in sheets if turn > 0)  # it came too late
        assert calls == [1]


def test_one_picture_of_each_doubling_is_denoised(server: Live) -> None:
    with page(server) as one:
        one.until_rest(0)
    last, made = server.hub.picture, previews.Previews()
    assert last is not None
    shown: list[Drawn] = []
    for samples in (4, 5, 7, 8, 15, 16):
        for rests in (True, False):
            drawn = replace(last, samples=samples, rests=rests)
            made.offer(drawn, lambda _, one=drawn: shown.append(one))
            made._thread.submit(int).result(15)  # after that picture
    made.close()
    assert [(one.samples, one.rests) for one in shown] == [(4, False), (8, False), (16, False)]


@pytest.mark.parametrize("cause", ["core", "extra", "fault"])
def test_what_cannot_be_denoised_is_shown_plain(
    clean: None, monkeypatch: pytest.MonkeyPatch, cause: str
) -> None:
    def fails(_: Frame) -> Frame:
        raise dg.errors.InputError("planted")

    match cause:
        case "core":
            monkeypatch.setattr(os, "cpu_count", lambda: 1)
        case "extra":
            monkeypatch.setattr(previews.extras, "missing", lambda _: True)
        case "fault":
            monkeypatch.setattr(previews, "preview", fails)
    made = scene()
    stage = Stage(made, made.camera(), dg.RenderSettings.of(resolution=SIZE, spp=SPP))
    with live(stage) as server, page(server) as one:
        one.until_rest(0)
        assert not any(head["denoised"] for head in turned(one, 1, f_stop="8"))
        assert one.bytes == bits(8)


def test_the_choice_of_the_user_counts(server: Live) -> None:
    pytest.importorskip("mitsuba_oidn", reason="needs the extra denoise")
    with page(server) as one:
        one.until_rest(0)
        shown(one, True)
        heads = turned(one, 1, f_stop="8")
        assert all(head["denoised"] for head in heads if head["whole"])
        assert not any(head["denoised"] for head in heads if not head["whole"])
        assert one.bytes != bits(8)
        shown(one, False)
        heads = turned(one, 2, f_stop="5.6")
        assert not any(head["denoised"] for head in heads)
        assert one.bytes == bits(5.6)
        with page(server) as other:  # pages share it
            other.until_rest(2)
            assert other.state["show"]["denoised"] is False


@pytest.mark.skipif(program() is None, reason="needs chromium")
@pytest.mark.xdist_group("chromium")
def test_noise_does_not_come_and_go_on_the_page(server: Live, tmp_path: Path) -> None:
    own, show = server.hub, Show(denoised=None, models=False)
    with browser(tmp_path / "profile") as window:
        window.open(f"http://{server.host}/#{TOKEN}")
        window.until(f"{STATUS} === '{SPP} samples'", 60)
        assert window.run(f"{BUTTON}.getAttribute('aria-pressed')") == "false"
        assert "on the way" in window.run(f"{BUTTON}.title")
        last = own.picture
        assert last is not None
        image = image_of(last)

        def status(samples: int, *, denoised: bool = False, rests: bool = False) -> str:
            """Text of the page when a picture has come."""
            drawn = replace(last, samples=samples, rests=rests)
            before = int(window.run(PICTURE))

            def hand() -> None:
                own._show = show
                if denoised:
                    own._hand_out_preview(drawn, image, show)
                else:
                    own._hand_out(drawn, image, show, own._readings)

            server.loop.call_soon_threadsafe(hand)
            window.until(f"Number({PICTURE}) > {before}")
            return str(window.run(STATUS))

        assert status(4) == "120 × 80, 4 of 64 samples"
        assert status(4, denoised=True) == "120 × 80, 4 of 64 samples, denoised"
        assert status(8) == "120 × 80, 8 of 64 samples, denoised"
        assert status(9) == "120 × 80, 9 of 64 samples"
        assert status(9, denoised=True).endswith("denoised")
        show = Show(denoised=False, models=False)
        assert status(9) == "120 × 80, 9 of 64 samples"
        show = Show(denoised=None, models=False)
        assert status(9, denoised=True).endswith("denoised")
        assert status(16, rests=True) == "16 samples"
        assert status(4) == "120 × 80, 4 of 64 samples"
        own._show = Show(denoised=None, models=False, tint="depth")
        own._hand_out_preview(replace(last, rests=False), image, show)  # of another show
        assert own._sheets == int(window.run(PICTURE))


def test_a_preview_has_less_noise() -> None:
    pytest.importorskip("mitsuba_oidn", reason="needs the extra denoise")
    made = scene()
    noisy = dg.render(made, resolution=SIZE, spp=1)
    truth = dg.render(made, resolution=SIZE, spp=256).rgb
    error = [np.mean((f.rgb - truth) ** 2) for f in (noisy, previews.preview(noisy))]
    assert error[1] < 0.5 * error[0]
