"""Aids in Chromium: marks that all eyes see, guides, tints with their legends, parade, loupe."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from daguerre.viewfinder import tint
from daguerre.viewfinder.bundle import bundled
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.false_colour import false_colour, zone_colours

from .chromium import Browser, browser, program
from .colour_blind import SEEN_BY, contrast, seen
from .live import Live, live
from .test_aids import stage
from .test_page import pixels, shows, turns

pytest.importorskip("websockets", reason="needs the extra view")
pytestmark = [
    pytest.mark.skipif(program() is None, reason="needs chromium"),
    pytest.mark.xdist_group("chromium"),
]
#: Contrast of what must be told apart, WCAG 2.2, 1.4.11.
ENOUGH = 3


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as found:
        yield found


@pytest.fixture
def boards() -> Iterator[Live]:
    with live(stage(), Dials()) as running:
        yield running


@pytest.fixture
def finder(window: Browser, boards: Live) -> Browser:
    return shows(window, boards)


def module(name: str) -> str:
    """Expression of a module of the page, which serves all as one script."""
    return f"(() => {{ {bundled(name)} return module_{name}; }})()"


def marked(page: Browser, shown: NDArray[np.uint8], **which: bool) -> NDArray[np.uint8]:
    """Pixels that marks.js lays over a picture, (H, W, 4)."""
    height, width = shown.shape[:2]
    opaque = np.dstack([shown, np.full((height, width), 255, np.uint8)])
    shows = {"zebra": False, "peaking": False, **which}
    found = page.run(
        f"[...{module('marks')}.marks({opaque.ravel().tolist()}, {width}, {height},"
        f"{json.dumps(shows)})]"
    )
    return np.array(found, np.uint8).reshape(height, width, 4)


@pytest.mark.parametrize("eyes", SEEN_BY)
@pytest.mark.parametrize("colour", [(255, 255, 255), (255, 60, 20), (40, 90, 255), (20, 255, 40)])
def test_zebra_is_seen_by_all_eyes(finder: Browser, eyes: str, colour: Any) -> None:
    shown = np.full((24, 32, 3), 120, np.uint8)
    shown[4:20, 8:24] = colour
    over = marked(finder, shown, zebra=True)
    part = np.zeros((24, 32), bool)
    part[4:20, 8:24] = True
    assert np.array_equal(over[..., 3] == 255, part)
    stripes = seen(over[4:20, 8:24, :3], eyes)
    light, dark = stripes[0, :].max(axis=0), stripes[0, :].min(axis=0)
    assert contrast(light, dark) > ENOUGH
    beneath = seen(np.array(colour), eyes)
    assert max(contrast(light, beneath), contrast(dark, beneath)) > ENOUGH
    # Diagonal: a row down, the stripes are one pixel to the left.
    assert np.array_equal(stripes[0, 1:], stripes[1, :-1])


@pytest.mark.parametrize("eyes", SEEN_BY)
@pytest.mark.parametrize("beneath", [0, 90, 160, 255])
def test_peaking_is_seen_by_all_eyes(finder: Browser, eyes: str, beneath: int) -> None:
    shown = np.full((24, 32, 3), beneath, np.uint8)
    shown[:, 16:] = beneath - 90 if beneath > 127 else beneath + 90
    over = marked(finder, shown, peaking=True)
    line = (over[..., 3] == 255) & (over[..., 0] == 255)
    border = (over[..., 3] == 255) & ~line
    assert sorted(set(np.nonzero(line)[1])) == [15, 16]
    assert sorted(set(np.nonzero(border)[1]) - {15, 16}) == [14, 17]
    bright, dark = seen(over[12, 15, :3], eyes), seen(over[12, 14, :3], eyes)
    assert contrast(bright, dark) > ENOUGH
    for colour in (shown[0, 0], shown[0, -1]):
        below = seen(colour, eyes)
        assert max(contrast(bright, below), contrast(dark, below)) > ENOUGH


@pytest.mark.parametrize("name", ["2.39:1", "1.85:1", "1:1", "4:5"])
def test_guides_stand_at_the_right_pixels(finder: Browser, name: str) -> None:
    finder.run(
        "(() => { const s = document.getElementById('guides');"
        f"s.value = '{name}'; s.dispatchEvent(new Event('change')); }})()"
    )
    box = "(() => {{ const b = document.querySelector('{}').getBoundingClientRect();"
    box += "return [b.left, b.top, b.right, b.bottom]; }})()"
    left, top, right, bottom = finder.run(box.format("#picture"))
    x0, y0, x1, y1 = finder.run(box.format("#guide"))
    across, down = (float(part) for part in name.split(":"))
    assert (x1 - x0) / (y1 - y0) == pytest.approx(across / down, rel=0.005)
    assert [x0 - left, y0 - top] == pytest.approx([right - x1, bottom - y1], abs=0.5)
    assert min(x0 - left, y0 - top) == pytest.approx(0, abs=0.5)
    assert finder.run("document.getElementById('guide').innerText") == name
    assert finder.run("getComputedStyle(document.getElementById('guide')).boxShadow") != "none"


TINT = """(() => { const c = document.getElementById('tint');
    return [...c.getContext('2d').getImageData(0, 0, c.width, c.height).data]; })()"""


def tinted(page: Browser, kind: str) -> NDArray[np.uint8]:
    """Turns a tint on; returns its pixels."""
    page.click(f"[data-tint={kind}]")
    page.until("!document.getElementById('tint').hidden")
    page.until(f"document.querySelector('[data-tint={kind}]').ariaPressed === 'true'")
    found = page.run(TINT)
    return np.array(found, np.uint8).reshape(60, 90, 4)[..., :3]


def legend(page: Browser) -> tuple[list[str], list[list[int]]]:
    """Texts and colours of the legend."""
    rows = page.run(
        "[...document.querySelectorAll('#legend span')].map((e) => [e.textContent,"
        "getComputedStyle(e).backgroundColor.match(/\\d+/g).map(Number)])"
    )
    return [text for text, _ in rows], [colour for _, colour in rows]


def test_false_colour_has_a_legend_in_stops(finder: Browser, boards: Live) -> None:
    own = pixels(boards)
    assert boards.hub.picture is not None
    wanted = false_colour(boards.hub.picture.frame)
    assert np.array_equal(tinted(finder, tint.FALSE_COLOUR), wanted)
    texts, colours = legend(finder)
    assert texts == ["≤−6", "−5", "−4", "−3", "−2", "−1", "0", "+1", "+2", "+3", "+4", "+5", "≥+6"]
    assert colours == zone_colours().tolist()
    assert "18 % grey" in finder.run("document.getElementById('legend').innerText")
    # The picture itself is untouched: what lies under the tint, and what is saved.
    beneath = finder.run(
        "(() => { const c = document.getElementById('picture');"
        "return [...c.getContext('2d').getImageData(0, 0, c.width, c.height).data]; })()"
    )
    assert np.array_equal(np.array(beneath).reshape(60, 90, 4)[..., :3], own)
    assert np.array_equal(pixels(boards), own)
    finder.click("[data-tint=false-colour]")
    finder.until("document.getElementById('legend').hidden")
    assert finder.run("document.getElementById('tint').hidden")


def test_the_depth_of_field_has_a_legend_in_metres(finder: Browser) -> None:
    tinted(finder, tint.DEPTH)
    texts, colours = legend(finder)
    assert [text.split(" ")[0] for text in texts] == ["nearer", "sharp", "farther"]
    assert all(" m (" in text and " ft)" in text for text in texts[:2])
    assert colours == [list(one) for one in (tint.NEAR, tint.SHARP, tint.FAR)]
    assert finder.errors == []


def test_the_picture_before_is_shown_with_its_own_tint(finder: Browser, boards: Live) -> None:
    def over() -> bytes | None:
        """Pixels of the tint; None: there is none."""
        if finder.run("document.getElementById('tint').hidden"):
            return None
        return bytes(finder.run(TINT))

    def turned() -> bytes | None:
        turns(finder, "#ring-exposure_compensation", "ArrowRight")
        return over()

    plain = [over(), turned()]
    tinted(finder, tint.FALSE_COLOUR)
    first = over()
    time.sleep(1.1)  # a picture that stays for less was on the way to another
    second = turned()
    assert plain == [None, None]
    assert None not in (first, second)
    assert first != second
    for key, wanted, legend in [("keyDown", first, True), ("keyUp", second, False)]:
        finder.call("Input.dispatchKeyEvent", type=key, key="c", code="KeyC")
        assert over() == wanted
        hidden = "!document.getElementById('legend').checkVisibility()"
        assert finder.run(hidden) == legend


def test_the_loupe_tells_how_far_the_point_is(finder: Browser) -> None:
    finder.click("[data-toggle=loupe]")
    x, y = finder.place("#picture")
    finder.mouse("mouseMoved", x, y + 20)
    text = "document.querySelector('#loupe p').textContent"
    finder.until(f"{text}.endsWith('2 m (6.6 ft)')")
    sky = finder.run("document.getElementById('picture').getBoundingClientRect().top") + 4
    for dx in (1, 2, 3):
        finder.mouse("mouseMoved", x + dx, sky)
        finder.run("new Promise((done) => setTimeout(done, 60))")
    finder.until(f"{text}.endsWith('∞')")


def test_the_parade_shows_columns_of_each_channel(finder: Browser) -> None:
    half = np.zeros((8, 84, 4), np.uint8)
    half[:, :42, 0] = 255
    counts = finder.run(
        f"{module('parade')}.parade({half.ravel().tolist()}, 84, 8).map((one) => [...one])"
    )
    red, green = (np.array(counts[c]).reshape(80, 84) for c in (0, 1))
    assert (red[0, :42] > 0).all()
    assert (red[0, 42:] == 0).all()
    assert (red[-1, 42:] > 0).all()
    assert (green[-1] > 0).all()
    assert finder.run("document.getElementById('parade').hidden")
    finder.click("[data-toggle=parade]")
    lit = finder.run(
        "Math.max(...document.getElementById('parade').getContext('2d')"
        ".getImageData(0, 0, 256, 80).data.filter((_, i) => i % 4 < 3))"
    )
    assert lit > 100
