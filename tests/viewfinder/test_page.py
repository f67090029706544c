"""The page in Chromium: rings turned by mouse, keys and touch give the picture of the command."""

from __future__ import annotations

import itertools
import json
import shlex
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import cli
from daguerre.viewfinder.dials import Dials
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
WORDS = ["--res", "96x64", "--spp", "4", "--quiet", "-o", "out.exr", "-o", "out.png"]


@pytest.fixture(scope="module")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as page:
        yield page


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_scene(tmp_path_factory.mktemp("scene") / "scene.glb")


@pytest.fixture
def server(file: Path) -> Iterator[Live]:
    with stage_of(file) as running:
        yield running


def stage_of(file: Path) -> Any:
    """A server that shows a file with the words of a command line."""
    made = dg.load(file)
    settings = dg.RenderSettings.of(resolution=(96, 64), spp=4)
    stage = Stage(
        made, made.camera(), settings, load=lambda: (dg.load(file), dg.load(file).camera())
    )
    return live(stage, Dials.of({"lens": LENS}), [str(file), *WORDS])


@pytest.fixture
def page(chromium: Browser, server: Live) -> Browser:
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
        "(() => { const d = document.getElementById('frame')?.dataset ?? {};"
        f"return d.rests === 'true' && Number(d.turn) > {after}; }})()"
    )


def settled(page: Browser, server: Live) -> None:
    """Waits until no turn is under way: slow machines show pictures of the first half of a drag."""
    known = -1
    while known != server.hub.number:
        known = server.hub.number
        rests(page, known - 1)
        time.sleep(0.1)


def command_of(page: Browser) -> str:
    """Command that the page shows."""
    return str(page.run("document.getElementById('command').value"))


def check_bits(page: Browser, server: Live, folder: Path) -> None:
    """The picture at rest has the bits of the command that the page shows."""
    settled(page, server)
    words = shlex.split(command_of(page))
    assert words[:2] == ["daguerre", "render"]
    out = folder / "out.exr"
    words[words.index("out.exr")], words[words.index("out.png")] = str(out), str(folder / "a.png")
    assert cli.main(words[1:]) == 0
    alone = dg.load_frame(out).rgb
    seen = server.hub.picture
    assert seen is not None
    assert seen.rests
    assert np.array_equal(np.asarray(seen.frame.rgb, np.float32), alone)


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


def test_a_key_held_down_turns_a_step_each_time(page: Browser, server: Live) -> None:
    before = turn_of(page)
    page.run("document.getElementById('ring-iso').focus()")
    for _ in range(10):
        page.press("ArrowRight")
    rests(page, before)
    settled(page, server)
    assert "--iso=1000" in command_of(page)


def test_a_ring_does_not_jump_back_while_its_picture_is_drawn(page: Browser, server: Live) -> None:
    before = turn_of(page)
    page.run(
        "window.places = []; (function watch() {"
        "places.push(Number(document.getElementById('ring-focus_distance').value));"
        "requestAnimationFrame(watch); })()"
    )
    page.drag("#ring-focus_distance", 120)
    rests(page, before)
    settled(page, server)
    places = json.loads(page.run("JSON.stringify(window.places)"))
    assert places[0] < places[-1]
    # The text of the command line has four digits.
    assert all(b > a - 1e-3 for a, b in itertools.pairwise(places)), places


def test_the_focus_ring_ends_where_the_lens_does(
    page: Browser, server: Live, tmp_path: Path
) -> None:
    before = turn_of(page)
    for _ in range(12):
        page.drag("#ring-focus_distance", 500)
    rests(page, before)
    settled(page, server)
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
    page.until("document.querySelectorAll('#lens-list [role=option]').length < 5")
    assert "Tessar" in page.run("document.getElementById('lens-list').textContent")
    page.click("#lens-list [role=option]")
    page.until("document.getElementById('lens-drawing').naturalWidth > 100")
    before = turn_of(page)
    page.click("#lens-take")
    rests(page, before)
    assert "tessar" in command_of(page)
    check_bits(page, server, tmp_path)


def test_rays_of_a_point(page: Browser) -> None:
    page.click("[data-toggle=section]")
    page.click("#picture", 20, 30)
    page.until("document.getElementById('section-drawing').naturalWidth > 100")
    text = page.run("document.querySelector('#section figcaption').textContent")
    assert "µm wide" in text
    lit = page.run(
        "Math.max(...document.getElementById('spread').getContext('2d')"
        ".getImageData(0, 0, 48, 48).data.filter((_, i) => i % 4 === 0))"
    )
    assert lit == 255
    page.click("[data-toggle=section]")


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


def test_exposure_is_metered_and_locked(page: Browser, server: Live, tmp_path: Path) -> None:
    before = turn_of(page)
    page.run(
        "(() => { const s = document.getElementById('exposure'); s.value = 'auto:matrix';"
        "s.dispatchEvent(new Event('change')); })()"
    )
    rests(page, before)
    assert "--exposure=auto:matrix" in command_of(page)
    check_bits(page, server, tmp_path)
    before = turn_of(page)
    page.click("#lock")
    rests(page, before)
    assert "--exposure" not in command_of(page)
    assert "--iso=" in command_of(page)


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
        text = chromium.until("document.getElementById('error')?.textContent")
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
