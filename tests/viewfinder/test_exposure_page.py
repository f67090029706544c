"""Exposure in Chromium: the mode dial, the needle, and rings that act as on a camera."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.exposure.lux_seconds import display_gain
from daguerre.rendering.over_meter import exposure_in_words
from daguerre.viewfinder.painter import Drawn
from daguerre.viewfinder.stage import Stage
from tests.faults.scene import write_scene

from .chromium import Browser, browser, program
from .live import TOKEN, Live, live
from .test_page import (
    LAMP,
    command_of,
    iso_of,
    mode_of,
    rests,
    set_mode,
    settled,
    shows,
    stage_of,
    turn_of,
    turns,
)
from .test_painter import scene

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")
pytestmark = [
    pytest.mark.skipif(program() is None, reason="needs chromium"),
    pytest.mark.xdist_group("chromium"),
]
MODES = ("P", "A", "S", "manual", "auto", "light")
NEEDLE = "document.getElementById('needle')"


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as found:
        yield found


@pytest.fixture(scope="module")
def lit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_scene(tmp_path_factory.mktemp("scene") / "scene.glb", LAMP)


@pytest.fixture
def stopped_down(lit: Path) -> Iterator[Live]:
    with stage_of(lit, f_stop="5.6") as running:
        yield running


@pytest.fixture
def camera(window: Browser, stopped_down: Live) -> Browser:
    return shows(window, stopped_down)


def seen(server: Live) -> Drawn:
    found = server.hub.picture
    assert found is not None
    return found


# The dial


def test_the_dial_is_that_of_a_camera(camera: Browser) -> None:
    letters = camera.run(
        "[...document.querySelectorAll('#exposure label')].map((e) => e.innerText)"
    )
    assert letters == ["P", "A", "S", "M", "Auto", "Light"]
    inputs = "[...document.querySelectorAll('#exposure input')].map((e) => e.{})"
    told = camera.run(inputs.format("title"))
    assert all(len(text) > 20 for text in told)
    assert camera.run(inputs.format("ariaLabel")) == told


def test_the_dial_turns_by_keys(camera: Browser, stopped_down: Live) -> None:
    camera.press("e")
    assert camera.run("document.activeElement.value") == "manual"
    for key, mode in (("ArrowLeft", "S"), ("ArrowLeft", "A"), ("ArrowRight", "S")):
        before = turn_of(camera)
        camera.press(key)
        rests(camera, before)
        assert mode_of(camera) == mode
        assert f"--exposure={mode}" in command_of(camera)


def test_the_dial_turns_by_touch(camera: Browser, stopped_down: Live) -> None:
    camera.size(390, 844, touch=True)
    boxes = camera.run(
        "[...document.querySelectorAll('#exposure input')].map((e) =>"
        "[e.getBoundingClientRect().width, e.getBoundingClientRect().height])"
    )
    assert np.min(boxes) >= 44
    before = turn_of(camera)
    x, y = camera.place("#exposure label:nth-child(2)")
    camera.call("Input.dispatchTouchEvent", type="touchStart", touchPoints=[{"x": x, "y": y}])
    camera.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
    rests(camera, before)
    assert "--exposure=A" in command_of(camera)


@pytest.mark.parametrize("mode", MODES)
def test_rings_that_the_meter_turns_are_marked(
    camera: Browser, stopped_down: Live, mode: str
) -> None:
    if mode != "manual":
        set_mode(camera, mode)
    settled(camera)
    marked = camera.run(
        "[...document.querySelectorAll('.ring.metered')].map((e) => [e.querySelector('input').id,"
        "getComputedStyle(e.querySelector('label'), '::after').content])"
    )
    wanted = {"P": ["f_stop", "shutter_time"], "A": ["shutter_time"], "S": ["f_stop"]}
    wanted["auto"] = ["iso"]
    letter = json.dumps({"auto": "Auto"}.get(mode, mode))
    assert marked == [[f"ring-{name}", letter] for name in wanted.get(mode, [])]


def test_a_page_that_watches_cannot_turn_the_dial(camera: Browser, stopped_down: Live) -> None:
    stopped_down.hub._clients[0].turns = False
    camera.run("document.querySelector('#exposure [value=A]').click()")
    error = "document.getElementById('error')"
    assert camera.until(f"!{error}.hidden && {error}.textContent").startswith("view: read-only")
    assert mode_of(camera) == "manual"


# The needle

#: Turns of rings, each of which moves the needle in some mode.
STEPS = [
    ("exposure_compensation", "ArrowRight", 2), ("exposure_compensation", "ArrowLeft", 5),
    ("iso", "ArrowRight", 2), ("shutter_time", "ArrowRight", 2), ("f_stop", "ArrowRight", 2),
]  # fmt: skip


@pytest.mark.parametrize("mode", MODES)
def test_the_needle_is_the_closing_line_of_render(
    camera: Browser, stopped_down: Live, mode: str
) -> None:
    if mode != "manual":
        set_mode(camera, mode)
    for ring, key, count in STEPS:
        if camera.run(f"document.getElementById('ring-{ring}').disabled"):
            continue
        turns(camera, f"#ring-{ring}", key, count)
        words = exposure_in_words(seen(stopped_down).session, seen(stopped_down).frame)
        size, side = words.removeprefix(f"{mode}, ").removesuffix(" the meter").split(" EV ")
        wanted = float(size) * (1 if side == "over" else -1)
        shown = float(camera.run(f"{NEEDLE}.ariaValueNow"))
        assert shown == pytest.approx(float(np.clip(wanted, -3, 3)), abs=0.1)
        text = camera.run(f"{NEEDLE}.ariaValueText")
        if float(size):
            assert text.removeprefix("+").removeprefix("−").startswith(size)
            assert side in text
        assert camera.errors == []


def test_the_needle_follows_the_first_picture_of_a_turn(
    camera: Browser, stopped_down: Live
) -> None:
    began, iso = float(camera.run(f"{NEEDLE}.ariaValueNow")), iso_of(camera)
    camera.run(
        f"window.shown = []; new MutationObserver(() => window.shown.push({NEEDLE}.ariaValueNow))"
        f".observe({NEEDLE}, {{attributeFilter: ['aria-valuenow']}})"
    )
    turns(camera, "#ring-iso", "ArrowRight", 3)
    values = [float(value) for value in camera.run("window.shown") if float(value) != began]
    assert values
    assert round(values[0] - began, 2) >= 0.2  # decimals, as shown
    assert values[-1] - began == pytest.approx(np.log2(iso_of(camera) / iso), abs=0.1)
    assert np.diff([began, *values]).min() > -0.1


@pytest.mark.parametrize(("key", "end"), [("ArrowRight", 3), ("ArrowLeft", -3)])
def test_beyond_the_scale_the_needle_is_an_arrow(
    camera: Browser, stopped_down: Live, key: str, end: int
) -> None:
    beyond = "document.querySelector('#needle .pointer').classList.contains('beyond')"
    assert not camera.run(beyond)
    turns(camera, "#ring-exposure_compensation", key, 12)
    assert camera.run(beyond)
    assert float(camera.run(f"{NEEDLE}.ariaValueNow")) == end
    assert camera.run(f"{NEEDLE}.ariaValueText")[1:].startswith(("4.0 stops", "3.9", "4.1"))


def test_the_scale_is_in_thirds_and_the_needle_points_into_it(
    camera: Browser, stopped_down: Live
) -> None:
    turns(camera, "#ring-exposure_compensation", "ArrowRight", 4)
    over = float(camera.run(f"{NEEDLE}.ariaValueNow"))
    ticks = camera.run(
        "[...document.querySelectorAll('#needle .tick')].map((e) => e.x1.baseVal.value)"
    )
    assert len(ticks) == 19
    assert np.diff(ticks) == pytest.approx(np.diff(ticks)[0], abs=0.01)
    box = camera.run(
        "(() => { const b = document.querySelector('#needle .pointer').getBBox();"
        "return b.x + b.width / 2; })()"
    )
    assert box == pytest.approx(np.interp(over, np.linspace(-3, 3, 19), ticks), abs=0.5)


def test_without_light_the_needle_says_so(window: Browser) -> None:
    dark = scene()
    dark.environment = None
    with live(Stage(dark, dark.camera(), dg.RenderSettings.of(resolution=(60, 40), spp=1))) as one:
        window.open("about:blank")
        window.open(f"http://{one.host}/#{TOKEN}")
        window.until("document.getElementById('frame')?.ariaBusy === 'false'")
        window.until(f"{NEEDLE}.ariaValueText === 'no light to meter'")
        assert window.run("document.querySelector('#needle .pointer').getBBox().width") == 0


# Rings as on a camera

#: Change of brightness, in stops, by three clicks to the right of each ring.
AS_ON_CAMERAS: dict[str, dict[str, int]] = {
    "light": {"f_stop": 0, "shutter_time": 0, "iso": 0, "exposure_compensation": 1},
    "manual": {"f_stop": -1, "shutter_time": 1, "iso": 1, "exposure_compensation": 1},
    "auto": {"f_stop": 0, "shutter_time": 0, "exposure_compensation": 1},
    "A": {"f_stop": 0, "iso": 0, "exposure_compensation": 1},
    "S": {"shutter_time": 0, "iso": 0, "exposure_compensation": 1},
    "P": {"iso": 0, "exposure_compensation": 1},
}


def brightness(found: Drawn) -> float:
    """Brightness of the middle of a picture, stops."""
    height, width = found.frame.rgb.shape[:2]
    part = found.frame.rgb[height // 4 : -height // 4, width // 4 : -width // 4]
    return float(np.log2(display_gain(found.frame.metadata) * part.mean()))


@pytest.mark.parametrize("mode", MODES)
def test_rings_change_the_picture_as_on_a_camera(
    camera: Browser, stopped_down: Live, mode: str
) -> None:
    if mode != "manual":
        set_mode(camera, mode)
    for ring, stops in AS_ON_CAMERAS[mode].items():
        settled(camera)
        before = seen(stopped_down)
        turns(camera, f"#ring-{ring}", "ArrowRight", 3)
        after = seen(stopped_down)
        assert brightness(after) - brightness(before) == pytest.approx(stops, abs=0.2), ring
        if ring == "f_stop":  # the blur changes in every mode
            assert not np.array_equal(after.frame.rgb, before.frame.rgb)
        if (mode, ring) == ("light", "iso"):  # a perfect sensor has no noise
            assert np.array_equal(after.frame.rgb, before.frame.rgb)
        turns(camera, f"#ring-{ring}", "ArrowLeft", 3)
    assert camera.errors == []
