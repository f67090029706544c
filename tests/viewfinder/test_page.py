"""The page in Chromium: rings turned by mouse, keys and touch give the picture of the command."""

from __future__ import annotations

import asyncio
import itertools
import json
import re
import shlex
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import daguerre as dg
from daguerre import cli
from daguerre.files.recorded import recorded
from daguerre.viewfinder.clients import Client
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.drawn import Drawn
from daguerre.viewfinder.history import PAUSE_S
from daguerre.viewfinder.opening import opened
from daguerre.viewfinder.stage import Stage
from tests.faults.scene import write_scene
from tests.viewfinder.chromium import Browser, browser, program

from .live import TOKEN, Live, live
from .test_painter import scene

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")
pytestmark = [
    pytest.mark.skipif(program() is None, reason="needs chromium"),
    pytest.mark.xdist_group("chromium"),
]
LENS = "double-gauss-50mm-f2"
#: Lamp that a usual ISO exposes.
LAMP = 3e4
WORDS = ["--res", "96x64", "--spp", "4", "--quiet", "-o", "out.exr", "-o", "out.png"]


@pytest.fixture(scope="module")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as page:
        yield page


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_scene(tmp_path_factory.mktemp("scene") / "scene.glb", LAMP)


@pytest.fixture
def server(file: Path) -> Iterator[Live]:
    with stage_of(file) as running:
        yield running


def stage_of(file: Path, **given: str) -> Any:
    """A server that shows a file as ``daguerre view`` opens it."""
    with recorded() as files:
        made = dg.load(file)
    settings = dg.RenderSettings.of(resolution=(96, 64), spp=4)
    stage = Stage(made, made.camera(), settings, files=files)
    stage.load = lambda: (dg.load(file), dg.load(file).camera())
    dials, said = opened(stage, Dials.of({"lens": LENS, **given}))
    return live(stage, dials, [str(file), *WORDS], said=said)


@pytest.fixture
def page(chromium: Browser, server: Live) -> Browser:
    return shows(chromium, server)


def shows(chromium: Browser, server: Live) -> Browser:
    """The page of a server, with its first picture at rest."""
    chromium.open("about:blank")  # the page before would look for its server
    chromium.run("1")
    chromium.errors.clear()
    chromium.asked.clear()
    chromium.size(1280, 800)
    chromium.open(f"http://{server.host}/#{TOKEN}")
    rests(chromium)
    return chromium


def turn_of(page: Browser) -> int:
    """Number of the turn whose picture the page shows."""
    return int(page.run("document.getElementById('frame').dataset.turn ?? -1"))


def rests(page: Browser, after: int = -1) -> None:
    """Waits until a picture at rest of a later turn is on the screen."""
    page.until(
        "(() => { const frame = document.getElementById('frame');"
        f"return frame?.ariaBusy === 'false' && Number(frame.dataset.turn) > {after}; }})()"
    )


def settled(page: Browser) -> None:
    """Waits until the page shows the picture at rest of all that was turned."""
    page.until("document.getElementById('frame').ariaBusy === 'false'")


def command_of(page: Browser) -> str:
    """Command that the page shows."""
    return str(page.run("document.getElementById('command').value"))


def check_bits(page: Browser, server: Live, folder: Path) -> None:
    """The picture at rest has the bits of the command that the page shows."""
    settled(page)
    words = shlex.split(command_of(page))
    assert words[:2] == ["daguerre", "render"]
    out = folder / "out.exr"
    png = folder / "a.png"
    words[words.index("out.exr")], words[words.index("out.png")] = str(out), str(png)
    assert cli.main(words[1:]) == 0
    alone = dg.load_frame(out).rgb
    seen = server.hub.picture
    assert seen is not None
    assert seen.rests
    assert np.array_equal(np.asarray(seen.frame.rgb, np.float32), alone)
    assert np.array_equal(pixels(server), np.asarray(Image.open(png)))


def pixels(server: Live) -> NDArray[np.uint8]:
    """Pixels of the picture at rest."""
    seen = server.hub.picture
    assert seen is not None
    return seen.shot.photograph.shown(seen.frame, seen.shot.tone)


def choose(page: Browser, name: str, value: str) -> None:
    """Chooses an option of a select, and waits for its picture."""
    before = turn_of(page)
    page.run(
        f"(() => {{ const s = document.getElementById('{name}'); s.value = '{value}';"
        "s.dispatchEvent(new Event('change')); })()"
    )
    rests(page, before)


def set_mode(page: Browser, mode: str) -> None:
    """Turns the mode dial, and waits for its picture."""
    before = turn_of(page)
    page.run(f"document.querySelector('#exposure [value={mode}]').click()")
    rests(page, before)


def mode_of(page: Browser) -> str:
    """Mode that the dial shows."""
    return str(page.run("document.querySelector('#exposure :checked').value"))


RINGS = {
    "focus_distance": "focus",
    "f_stop": "f-stop",
    "shutter_time": "shutter",
    "iso": "iso",
    "exposure_compensation": "ev",
    "white_balance": "wb",
    "blades": "blades",
}


@pytest.mark.parametrize("how", ["drag", "keys", "wheel", "touch"])
@pytest.mark.parametrize("ring", RINGS)
def test_a_ring_turned(page: Browser, server: Live, tmp_path: Path, ring: str, how: str) -> None:
    before, shown = turn_of(page), command_of(page)
    selector = f"#ring-{ring}"
    match how:
        case "drag":
            page.drag(selector, -120)
        case "keys":
            page.run(f"document.querySelector({json.dumps(selector)}).focus()")
            page.press("ArrowRight")
            page.press("ArrowRight")
        case "wheel":
            page.wheel(selector, -120)
            page.wheel(selector, -120)
        case _:
            page.size(390, 844, touch=True)
            page.swipe(selector, -120)
    rests(page, before)
    assert command_of(page) != shown
    assert f"--{RINGS[ring]}=" in command_of(page)
    assert page.errors == []
    check_bits(page, server, tmp_path)


def test_a_click_focuses_there(page: Browser, server: Live, tmp_path: Path) -> None:
    before = turn_of(page)
    page.click("#picture", 40, 30)
    rests(page, before)
    assert "--focus-at=" in command_of(page)
    check_bits(page, server, tmp_path)


def test_a_frame_shows_where_it_focuses(page: Browser, server: Live) -> None:
    page.click("#picture", 40, 30)
    off = page.run(
        "(() => { const [a, b] = ['focus-mark', 'picture'].map((id) =>"
        "document.getElementById(id).getBoundingClientRect());"
        "return [a.left + a.width / 2 - b.left - b.width / 2,"
        "a.top + a.height / 2 - b.top - b.height / 2]; })()"
    )
    assert off == pytest.approx([40, 30], abs=1)
    page.until("document.getElementById('focus-mark').hidden")


def test_a_key_held_down_turns_a_step_each_time(page: Browser, server: Live) -> None:
    began = iso_of(page)
    page.run("document.getElementById('ring-iso').focus()")
    for _ in range(10):
        page.press("ArrowRight")
    settled(page)
    assert iso_of(page) == pytest.approx(began * 2 ** (10 / 3), rel=0.15)


def iso_of(page: Browser) -> float:
    """ISO of the command."""
    return float(re.findall(r"--iso=(\S+)", command_of(page))[0])


@pytest.mark.parametrize("ring", [*RINGS, "time", "zoom", "t_stop"])
def test_a_ring_turned_up_and_down_restores_the_picture(
    chromium: Browser, file: Path, ring: str
) -> None:
    given = {"lens": "canon-ef-24-70mm-f2.8"} if ring == "zoom" else {}
    with stage_of(file, **given) as server:
        page = shows(chromium, server)
        if ring == "t_stop":
            page.run("document.getElementById('iris-scale').value = 'T3'")
            page.run("document.getElementById('iris-scale').dispatchEvent(new Event('change'))")
        shown, before = command_of(page), pixels(server)
        selector = f"#ring-{'f_stop' if ring == 't_stop' else ring}"
        for way, back, count in (("ArrowRight", "ArrowLeft", 3), ("PageUp", "PageDown", 1)):
            turns(page, selector, way, count)
            assert command_of(page) != shown
            assert not np.array_equal(pixels(server), before) or ring == "blades"
            turns(page, selector, back, count)
            assert command_of(page) == shown
            assert np.array_equal(pixels(server), before)
        assert page.errors == []


def test_a_ring_finds_back_while_a_slow_server_refuses_something_else(
    page: Browser, server: Live, monkeypatch: pytest.MonkeyPatch
) -> None:
    hear = server.hub.hear

    async def slow(client: Client, text: str | bytes) -> None:
        if b"turn" in (text if isinstance(text, bytes) else text.encode()):
            await client.tell({"refused": "planted"})
            await asyncio.sleep(0.4)
        await hear(client, text)

    monkeypatch.setattr(server.hub, "hear", slow)
    shown = command_of(page)
    for key in ("ArrowRight", "ArrowLeft"):
        turns(page, "#ring-iso", key)
    assert command_of(page) == shown


def turns(page: Browser, selector: str, key: str, count: int = 3) -> None:
    """Turns a ring by presses of a key, and waits for the picture at rest."""
    page.run(f"document.querySelector({json.dumps(selector)}).focus()")
    for _ in range(count):
        page.press(key)
    settled(page)


def test_the_focus_ring_goes_back_to_the_point_that_was_clicked(
    page: Browser, server: Live
) -> None:
    before = turn_of(page)
    page.click("#picture", 40, 30)
    rests(page, before)
    shown, sharp = command_of(page), pixels(server)
    assert "--focus-at=" in shown
    turns(page, "#ring-focus_distance", "ArrowLeft")
    assert "--focus-distance=" in command_of(page) or "--focus=" in command_of(page)
    turns(page, "#ring-focus_distance", "ArrowRight")
    assert command_of(page) == shown
    assert np.array_equal(pixels(server), sharp)


def test_a_ring_goes_back_to_where_it_was_at_first(page: Browser, server: Live) -> None:
    shown = command_of(page)
    back = "#ring-iso-back"
    page.run(
        "document.querySelector('#ring-iso').closest('.ring').querySelector('.back').id"
        " = 'ring-iso-back'"
    )
    assert page.run(f"document.querySelector('{back}').disabled")
    turns(page, "#ring-iso", "ArrowRight")
    before = turn_of(page)
    page.click(back)
    rests(page, before)
    assert command_of(page) == shown
    assert page.run(f"document.querySelector('{back}').disabled")


def test_a_ring_does_not_jump_back_while_its_picture_is_drawn(page: Browser, server: Live) -> None:
    page.run(
        "window.places = []; (function watch() {"
        "places.push(Number(document.getElementById('ring-focus_distance').value));"
        "requestAnimationFrame(watch); })()"
    )
    page.drag("#ring-focus_distance", 120)
    settled(page)
    places = json.loads(page.run("JSON.stringify(window.places)"))
    assert places[0] < places[-1]
    # The text of the command line has four digits.
    assert all(b > a - 1e-3 for a, b in itertools.pairwise(places)), places


def test_the_focus_ring_ends_where_the_lens_does(
    page: Browser, server: Live, tmp_path: Path
) -> None:
    for _ in range(12):
        page.drag("#ring-focus_distance", 500)
    settled(page)
    ring = "document.querySelector('#ring-focus_distance')"
    assert page.run(f"{ring}.max - {ring}.value") == pytest.approx(0, abs=1e-6)
    shown = page.run(f"{ring}.closest('.ring').querySelector('output').textContent")
    assert shown.endswith("closest"), shown
    assert page.errors == []
    check_bits(page, server, tmp_path)


def test_the_camera_orbits_dollies_and_goes_back(
    page: Browser, server: Live, tmp_path: Path
) -> None:
    shown = command_of(page)
    for move in (
        lambda: page.drag("#picture", 60, 20),
        lambda: page.wheel("#picture", 120),
        lambda: page.press("]"),
    ):
        before = turn_of(page)
        page.run("document.getElementById('picture').focus()")
        move()
        rests(page, before)
        check_bits(page, server, tmp_path)
    assert "--position=" in command_of(page)
    assert "--roll=" in command_of(page)
    before = turn_of(page)
    page.click("#reset")
    rests(page, before)
    assert command_of(page) == shown


@pytest.mark.parametrize(
    ("words", "count", "titles"),
    [
        ("canon wide zoom 1:4", "1 lens", ["Canon EF 11-24 mm f/4 L USM"]),
        ("70-200", "2 lenses",
         ["AF-S Nikkor 70-200 mm f/2.8E FL", "Sony FE 70-200 mm f/2.8 GM OSS II"]),
        ("ziess hologon", "1 lens", ["Zeiss Hologon 15 mm f/8"]),
        ("pinhole", "1 lens", ["pinhole"]),
        ("helios 44", "No lens has all these words. Nearest:", ["Zeiss Biotar 50 mm f/1.4"]),
        ("noctilux", "No lens has all these words.", []),
    ],
)  # fmt: skip
def test_the_search_finds_what_the_package_finds(
    page: Browser, words: str, count: str, titles: list[str]
) -> None:
    page.click("#lens")
    page.run(
        f"(() => {{ const s = document.getElementById('lens-search'); s.value = '{words}';"
        "s.dispatchEvent(new Event('input')); })()"
    )
    page.until(f"document.getElementById('lens-count').textContent === '{count}'")
    shown = page.run("[...document.querySelectorAll('#lens-list span')].map((e) => e.textContent)")
    assert shown == titles
    page.run(
        "(() => { const s = document.getElementById('lens-search'); s.value = ' ';"
        "s.dispatchEvent(new Event('input')); })()"
    )
    assert page.run("document.querySelectorAll('#lens-list span').length") > 120
    assert page.errors == []


def test_a_lens_found_by_its_name(page: Browser, server: Live, tmp_path: Path) -> None:
    page.click("#lens")
    page.run(
        "(() => { const s = document.getElementById('lens-search'); s.value = 'tessar';"
        "s.dispatchEvent(new Event('input')); })()"
    )
    page.until(
        "[1, 2, 3, 4].includes(document.querySelectorAll('#lens-list [role=option]').length)"
    )
    assert "Tessar" in page.run("document.getElementById('lens-list').textContent")
    page.click("#lens-list [role=option]")
    page.until("document.getElementById('lens-drawing').naturalWidth > 100")
    before = turn_of(page)
    page.click("#lens-take")
    rests(page, before)
    assert "tessar" in command_of(page)
    check_bits(page, server, tmp_path)


def test_rays_of_a_point(page: Browser) -> None:
    page.click("[data-panel=rays]")
    page.click("#picture", 20, 30)
    page.until("document.getElementById('rays-drawing').naturalWidth > 100")
    text = page.run("document.querySelector('#rays-text').textContent")
    assert "µm wide" in text
    lit = page.run(
        "Math.max(...document.getElementById('spread').getContext('2d')"
        ".getImageData(0, 0, 48, 48).data.filter((_, i) => i % 4 === 0))"
    )
    assert lit == 255
    page.click("[data-panel=rays]")


def test_three_models_side_by_side(page: Browser) -> None:
    before = turn_of(page)
    page.click("[data-show=models]")
    rests(page, before)
    assert page.run("document.getElementById('names').innerText.split(/\\s+/).join()") == (
        "pinhole,thin,exact"
    )
    before = turn_of(page)
    page.click("[data-show=models]")
    rests(page, before)


def test_two_ways_to_show_asked_for_at_once_both_hold(page: Browser) -> None:
    buttons = "[...document.querySelectorAll('[data-tint=depth], [data-show=models]')]"
    page.run(f"{buttons}.forEach((button) => button.click())")
    page.until(f"{buttons}.every((button) => button.ariaPressed === 'true')")
    page.run(f"{buttons}.forEach((button) => button.click())")
    page.until(f"{buttons}.every((button) => button.ariaPressed === 'false')")


def test_the_loupe_tells_linear_values(page: Browser, server: Live) -> None:
    page.click("[data-toggle=loupe]")
    x, y = page.place("#picture")
    page.mouse("mouseMoved", x - 30, y + 11)
    time.sleep(0.1)
    page.mouse("mouseMoved", x - 31, y + 11)
    text = page.until("document.querySelector('#loupe p').textContent")
    column, row = (int(part) for part in text.split("\n")[0].split(","))
    red = float(text.split("\n")[1].removeprefix("R "))
    frame = server.hub.picture.frame  # type: ignore[union-attr]
    assert red == pytest.approx(float(frame.rgb[row, column, 0]), rel=1e-3)
    page.click("[data-toggle=loupe]")


def test_it_starts_in_manual_as_metered(page: Browser, server: Live, tmp_path: Path) -> None:
    assert "--exposure=manual" in command_of(page)
    assert "--iso=" in command_of(page)
    options = "[...document.querySelectorAll('{}')].map((one) => one.value).join()"
    assert page.run(options.format("#exposure input")) == "P,A,S,manual,auto,light"
    assert page.run(options.format("#meter option")) == "centre,spot,matrix,highlight"
    assert mode_of(page) == "manual"
    check_bits(page, server, tmp_path)


@pytest.mark.parametrize(
    ("mode", "off"),
    [
        ("light", []),
        ("auto", ["iso"]),
        ("A", ["shutter_time"]),
        ("S", ["f_stop"]),
        ("P", ["f_stop", "shutter_time"]),
    ],
)
def test_a_mode_turns_its_rings_itself(
    page: Browser, server: Live, tmp_path: Path, mode: str, off: list[str]
) -> None:
    set_mode(page, mode)
    assert f"--exposure={mode}" in command_of(page)
    check_bits(page, server, tmp_path)
    rings = "[...document.querySelectorAll('.ring:not([hidden]) input:disabled')]"
    assert page.run(f"{rings}.map((one) => one.id.slice(5)).join()") == ",".join(off)
    letter = {"auto": "Auto"}.get(mode, mode)
    titles = page.run(f"{rings}.map((one) => one.title.replace(/ \\(.*/, ''))")
    assert titles == [f"The meter turns it in mode {letter}; M lets you turn it"] * len(off)
    shown = command_of(page)
    for ring in off:
        page.drag(f"#ring-{ring}", -120)
        page.run(f"document.getElementById('ring-{ring}').focus()")
        page.press("ArrowRight")
    assert command_of(page) == shown
    assert page.errors == []


def test_a_mode_that_the_scene_forbids_goes_back(page: Browser, server: Live) -> None:
    server.hub._stage.camera = server.hub._stage.camera.with_(f_stop=4)
    page.run("document.querySelector('#exposure [value=S]').click()")
    error = "document.getElementById('error')"
    text = page.until(f"!{error}.hidden && {error}.textContent")
    assert text == (
        "exposure S chooses the f-stop, but the scene sets it (f_stop): choose another mode"
    )
    assert mode_of(page) == "manual"
    page.click("[data-tint=depth]")  # has the state told anew
    page.until("document.querySelector('[data-tint=depth]').ariaPressed === 'true'")
    assert page.run(f"{error}.textContent") == text
    set_mode(page, "A")
    page.until(f"{error}.hidden")


def test_metered_exposure_is_locked(page: Browser, server: Live, tmp_path: Path) -> None:
    set_mode(page, "P")
    choose(page, "meter", "matrix")
    assert "--exposure=P --meter=matrix" in command_of(page)
    check_bits(page, server, tmp_path)
    metered = pixels(server)
    lock = "document.getElementById('lock').getAttribute('aria-pressed')"
    assert page.run(lock) == "false"
    before = turn_of(page)
    page.click("#lock")
    rests(page, before)
    assert "--exposure=manual" in command_of(page)
    assert "--iso=" in command_of(page)
    assert np.array_equal(pixels(server), metered)
    assert page.run(lock) == "true"
    before = turn_of(page)
    page.click("#lock")
    rests(page, before)
    assert "--exposure=P" in command_of(page)
    assert np.array_equal(pixels(server), metered)


LOCK = "document.getElementById('lock')"


def test_the_lock_is_off_where_no_meter_was_locked(page: Browser, server: Live) -> None:
    assert page.run(f"{LOCK}.ariaPressed") == "false"
    assert page.run(f"{LOCK}.disabled")
    assert page.run(f"{LOCK}.title") == "No meter sets anything in M (K)"
    set_mode(page, "P")
    page.until(f"!{LOCK}.disabled")
    set_mode(page, "manual")
    assert page.run(f"{LOCK}.ariaPressed") == "false"


def test_the_lock_outlives_the_page(page: Browser, server: Live) -> None:
    set_mode(page, "A")
    before = turn_of(page)
    page.click("#lock")
    rests(page, before)
    shows(page, server)
    page.until(f"{LOCK}.ariaPressed === 'true' && !{LOCK}.disabled")
    before = turn_of(page)
    page.click("#lock")
    rests(page, before)
    assert mode_of(page) == "A"
    page.until(f"{LOCK}.ariaPressed === 'false'")


def test_a_play_is_one_step(page: Browser, server: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    def slow(drawn: Drawn) -> None:
        time.sleep(PAUSE_S + 0.2)  # what parts two steps else
        server.hub.publish(drawn)

    began = command_of(page)
    monkeypatch.setattr(server.hub._painter, "_show", slow)
    page.click("#play")
    page.until(f"document.getElementById('ring-time').value > {2.5 / 24}")
    page.click("#play")
    monkeypatch.setattr(server.hub._painter, "_show", server.hub.publish)
    settled(page)
    assert "--time=" in command_of(page)
    before = turn_of(page)
    page.click("#undo")
    rests(page, before)
    assert command_of(page) == began


def test_the_needle_follows_the_rings(page: Browser, server: Live) -> None:
    needle = (
        "[...document.querySelectorAll('#readings div')].find((one) =>"
        "one.firstChild.textContent === 'Against the meter').lastChild.textContent"
    )
    began = float(page.run(needle).removesuffix(" EV"))
    turns(page, "#ring-exposure_compensation", "ArrowRight")
    page.until(f"{needle} === '{began + 1:+.1f} EV'")


def test_a_scene_that_changes_is_offered(page: Browser, file: Path) -> None:
    assert page.run("document.getElementById('changed').hidden")
    time.sleep(0.01)
    file.write_bytes(file.read_bytes())
    page.until("!document.getElementById('changed').hidden")
    before = turn_of(page)
    page.click("#reload")
    rests(page, before)
    page.until("document.getElementById('changed').hidden")


def test_a_setting_that_the_lens_lacks_is_said(page: Browser, server: Live) -> None:
    with_error = "document.getElementById('error')"
    page.run("document.getElementById('spp').value = 0")
    page.run("document.getElementById('spp').dispatchEvent(new Event('change'))")
    text = page.until(f"!{with_error}.hidden && {with_error}.textContent")
    assert "wanted a whole number" in text


def test_a_scene_without_light_is_said(chromium: Browser) -> None:
    dark = scene()
    dark.environment = None
    with live(Stage(dark, dark.camera(), dg.RenderSettings.of(resolution=(60, 40), spp=1))) as one:
        chromium.open(f"http://{one.host}/#{TOKEN}")
        text = chromium.until("document.getElementById('note')?.textContent")
        assert chromium.run("document.getElementById('error').hidden")
    assert text.startswith("the scene has no lights")


def test_no_edge_cuts_a_label(page: Browser) -> None:
    cut = """[...document.querySelectorAll('.barrel text')].filter((text) => {
        const [inner, outer] = [text, text.ownerSVGElement].map((e) => e.getBoundingClientRect());
        return inner.left < outer.left || inner.right > outer.right; })
        .map((text) => text.textContent)"""
    assert page.run("document.querySelectorAll('.barrel text').length") > 20
    for ring in ("white_balance", "iso", "focus_distance"):
        page.run(f"document.getElementById('ring-{ring}').focus()")
        for _ in range(4):
            page.press("PageUp")
            assert page.run(cut) == []


def test_nothing_is_asked_of_another_host(page: Browser, server: Live) -> None:
    own = (f"http://{server.host}/", f"ws://{server.host}/", f"blob:http://{server.host}/")
    assert page.asked
    assert [url for url in page.asked if not url.startswith((*own, "about:"))] == []


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (768, 1024), (390, 844)])
def test_nothing_is_wider_than_the_window(page: Browser, width: int, height: int) -> None:
    page.size(width, height, touch=width < 800)
    assert page.run("document.documentElement.scrollWidth") <= width


def keys(page: Browser, key: str, *, shift: bool = False) -> None:
    """Presses a key with Ctrl."""
    facts = {"key": key, "code": f"Key{key.upper()}", "modifiers": 2 + 8 * shift}
    for kind in ("rawKeyDown", "keyUp"):
        page.call("Input.dispatchKeyEvent", type=kind, windowsVirtualKeyCode=ord(key), **facts)


def steps_of(page: Browser) -> list[bool]:
    """Whether the page offers undo and redo."""
    found = page.run("['undo', 'redo'].map((id) => !document.getElementById(id).disabled)")
    return list(found)


def test_steps_are_undone_and_redone_by_keys_and_buttons(page: Browser, server: Live) -> None:
    assert steps_of(page) == [False, False]
    seen = [(command_of(page), pixels(server))]
    page.drag("#ring-focus_distance", -120)
    settled(page)
    seen.append((command_of(page), pixels(server)))
    set_mode(page, "A")
    seen.append((command_of(page), pixels(server)))
    assert steps_of(page) == [True, False]

    def does(act: Any, index: int) -> None:
        before = turn_of(page)
        act()
        rests(page, before)
        assert command_of(page) == seen[index][0]
        assert np.array_equal(pixels(server), seen[index][1])

    page.run("document.getElementById('meter').focus()")
    does(lambda: keys(page, "Z"), 1)
    does(lambda: page.click("#undo"), 0)
    assert steps_of(page) == [False, True]
    does(lambda: keys(page, "Z", shift=True), 1)
    does(lambda: keys(page, "Y"), 2)
    assert steps_of(page) == [True, False]
    assert page.errors == []


def test_a_drag_with_a_pause_is_one_step(page: Browser, server: Live) -> None:
    began = command_of(page)
    x, y = page.place("#ring-iso")
    page.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
    for dx in (-60, -120):
        page.mouse("mouseMoved", x + dx, y, button="left", buttons=1)
        time.sleep(1.3)
    page.mouse("mouseReleased", x - 120, y, button="left", clickCount=1)
    settled(page)
    before = turn_of(page)
    page.click("#undo")
    rests(page, before)
    assert command_of(page) == began
    assert steps_of(page) == [False, True]


SUM = """(() => { const c = document.getElementById('picture');
    return [...c.getContext('2d').getImageData(0, 0, c.width, c.height).data].join(); })()"""


def test_the_picture_at_rest_before_is_shown_while_held(page: Browser, server: Live) -> None:
    assert page.run("document.getElementById('compare').disabled")
    first = page.run(SUM)
    page.run("document.getElementById('ring-exposure_compensation').focus()")
    for _ in range(4):  # each comes to rest, and is gone before anyone has looked
        before = turn_of(page)
        page.press("ArrowRight")
        rests(page, before)
    second = page.run(SUM)
    assert second != first
    says = "document.getElementById('which').textContent"
    page.call("Input.dispatchKeyEvent", type="keyDown", key="c", code="KeyC")
    assert page.run(SUM) == first
    assert page.run(says).startswith("Before: ")
    assert "ISO" in page.run(says)
    page.call("Input.dispatchKeyEvent", type="keyUp", key="c", code="KeyC")
    assert page.run(SUM) == second
    assert page.run("document.getElementById('which').hidden")
    x, y = page.place("#compare")
    for begins in (True, False):
        point = [{"x": x, "y": y}] if begins else []
        kind = "touchStart" if begins else "touchEnd"
        page.call("Input.dispatchTouchEvent", type=kind, touchPoints=point)
        page.until(f"document.getElementById('which').hidden !== {str(begins).lower()}")
        assert page.run(SUM) == (first if begins else second)
    assert page.errors == []
