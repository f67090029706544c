"""A random walk through the page: no error, the bits of the command shown, memory stays flat."""

from __future__ import annotations

import json
import logging
import random
from collections import deque
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from daguerre.viewfinder import hub, rungs

from .chromium import Browser, browser, program
from .live import TOKEN, Live
from .test_beside import canvas
from .test_page import check_bits, file, keys, pixels, rests, settled, stage_of
from .test_walk import SLACK_MB, memory_mb

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")
pytestmark = [
    pytest.mark.skipif(program() is None, reason="needs chromium"),
    pytest.mark.xdist_group("chromium"),
]
__all__ = ["file"]
SCREENS = ((390, 844), (844, 390), (820, 1180), (1440, 900), (1920, 1080))
#: Turns between two looks at the bits, and between two reloads.
LOOK, RELOAD = 50, 110
#: Growth of the page's heap between two reloads, after the first turns, MB.
HEAP_SLACK_MB = 8
WARM = 40
SEEN = "(e) => !e.disabled && e.checkVisibility({checkVisibilityCSS: true})"
ARROWS = ("ArrowRight", "ArrowLeft", "ArrowUp", "ArrowDown", "PageUp", "PageDown")


class Walk:
    """Random turns of a page.

    Attributes:
        page: The page.
        server: Its server.
        trail: The last turns, for messages.
    """

    def __init__(self, page: Browser, server: Live, seed: int) -> None:
        self.page, self.server = page, server
        self.chance = random.Random(seed)
        self.trail: deque[str] = deque(maxlen=30)
        self.turns: dict[Callable[[], None], int] = {
            self.ring_by_key: 6, self.ring_by_drag: 4, self.ring_by_wheel: 4, self.back: 2,
            self.mode: 4, self.choose: 5, self.lens: 5, self.toggle: 6, self.step: 4,
            self.picture: 5, self.compare: 2, self.button: 3, self.divide: 2, self.resize: 1,
            self.play: 1, self.save: 1, self.samples: 1, self.keys: 1,
        }  # fmt: skip

    def turn(self) -> None:
        """Does something at random, and looks at the picture at times."""
        (act,) = self.chance.choices([*self.turns], [*self.turns.values()])
        act()
        if self.chance.random() < 0.3:
            self.page.run("new Promise((done) => setTimeout(done, 150))")

    # Turns

    def ring_by_key(self) -> None:
        if self.focus(self.one_of(".ring input")):
            for _ in range(self.chance.randint(1, 4)):
                self.page.press(self.chance.choice(ARROWS))

    def ring_by_drag(self) -> None:
        if ring := self.one_of(".ring input"):
            self.page.drag(ring, self.chance.randint(-300, 300))

    def ring_by_wheel(self) -> None:
        if ring := self.one_of(".ring input"):
            self.page.wheel(ring, self.chance.choice((-120, 120)))

    def back(self) -> None:
        self.click(self.one_of(".ring .back"))

    def mode(self) -> None:
        if self.chance.random() < 0.3:
            self.page.press("e")
            self.page.press(self.chance.choice(ARROWS[:2]))
        else:
            self.click(self.one_of("#exposure label:has(:enabled)"))

    def choose(self) -> None:
        if select := self.one_of("main select"):
            self.page.run(
                f"(() => {{ const e = document.querySelector({json.dumps(select)});"
                f"e.selectedIndex = Math.floor({self.chance.random()} * e.options.length);"
                "e.dispatchEvent(new Event('change')); })()"
            )
        if self.page.run("document.getElementById('lenses').open"):  # Beside picks another lens
            self.lens()

    def lens(self) -> None:
        """A lens of the picker: any, or one that the search finds."""
        page, listed = self.page, "document.querySelectorAll('#lens-list [role=option]')"
        if not page.run("document.getElementById('lenses').open"):
            self.click("#lens")
        page.until(f"{listed}.length > 0 || document.getElementById('lens-search').value")
        if self.chance.random() < 0.3:
            words = self.chance.choice(["zoom", "canon 50", "1970s", "tessar", "noctilux", ""])
            page.run(
                "(() => { const e = document.getElementById('lens-search');"
                f"e.value = '{words}'; e.dispatchEvent(new Event('input')); }})()"
            )
        chosen = page.run(
            f"(() => {{ const e = {listed}[Math.floor({self.chance.random()} * {listed}.length)];"
            "e?.click(); return e?.id; })()"
        )
        self.trail.append(f"lens {chosen}")
        use = self.one_of("#lens-take, #lens-compare")
        if chosen and use and self.chance.random() < 0.9:
            self.click(use)
        else:
            page.press("Escape")
        assert not page.run("document.getElementById('lenses').open")

    def toggle(self) -> None:
        self.click(self.one_of("[data-toggle], [data-tint], [data-show], [data-panel]"))

    def step(self) -> None:
        if self.chance.random() < 0.5:
            self.click(self.one_of("#undo, #redo"))
        else:
            keys(self.page, self.chance.choice("ZZY"))

    def picture(self) -> None:
        """A click, a drag, a look, the wheel or a key on the picture."""
        page, chance = self.page, self.chance
        width, height = page.run(
            "(({clientWidth: w, clientHeight: h}) => [w, h])(document.getElementById('picture'))"
        )
        dx, dy = (chance.uniform(-0.48, 0.48) * size for size in (width, height))
        match chance.randrange(5):
            case 0:
                page.click("#picture", dx, dy)
            case 1:
                page.drag("#picture", 0.2 * dx, 0.2 * dy)
            case 2:
                x, y = page.place("#picture")
                page.mouse("mouseMoved", x + dx, y + dy)
            case 3:
                page.wheel("#picture", chance.choice((-120, 120)))
            case _:
                self.focus("#picture")
                page.press(chance.choice((*ARROWS[:4], "+", "-", "[", "]")))

    def compare(self) -> None:
        for kind in ("keyDown", "keyUp"):
            self.page.call("Input.dispatchKeyEvent", type=kind, key="c", code="KeyC")

    def button(self) -> None:
        self.click(self.one_of("#lock, #hyperfocal, #level, #reset, #copy, #help"))
        self.page.press("Escape")

    def divide(self) -> None:
        if self.focus(self.one_of("#divider")):
            self.page.press(self.chance.choice((*ARROWS, "Home", "End")))

    def resize(self) -> None:
        width, height = self.chance.choice(SCREENS)
        self.page.size(width, height, touch=min(width, height) < 850)

    def play(self) -> None:
        for _ in range(2):
            self.click("#play")
            self.page.run("new Promise((done) => setTimeout(done, 200))")

    def save(self) -> None:
        self.click(self.one_of("[data-save]"))

    def samples(self) -> None:
        self.page.run(
            f"(() => {{ const e = document.getElementById('spp'); e.value = "
            f"{self.chance.randint(1, 4)}; e.dispatchEvent(new Event('change')); }})()"
        )

    def keys(self) -> None:
        self.page.run("document.activeElement.blur()")
        self.page.press(self.chance.choice("gzplrtdbmnxayv0k1234567"))

    # Means

    def one_of(self, selector: str) -> str:
        """Selector of one of the elements that can be used now; empty: none can."""
        name = self.page.run(
            f"(() => {{ const all = [...document.querySelectorAll({json.dumps(selector)})]"
            f".filter({SEEN}); const e = all[Math.floor({self.chance.random()} * all.length)];"
            "if (!e) return ''; e.id ||= `walk-${++window.walk || (window.walk = 1)}`;"
            "return `#${CSS.escape(e.id)}`; })()"
        )
        return str(name)

    def click(self, selector: str) -> None:
        self.trail.append(f"click {selector}")
        if selector:
            self.page.click(selector)

    def focus(self, selector: str) -> bool:
        self.trail.append(f"focus {selector}")
        if selector:
            self.page.run(f"document.querySelector({json.dumps(selector)}).focus()")
        return bool(selector)

    # Looks

    def check(self, folder: Path) -> None:
        """The screen shows the bits of the command shown."""
        self.trail.append(f"look {self.server.hub.number} {self.server.hub.error}")
        self.plain()
        check_bits(self.page, self.server, folder)
        shown, wanted = canvas(self.page), pixels(self.server)
        divided = self.page.run("!document.getElementById('divider').hidden")
        share = float(self.page.run("document.getElementById('divider').ariaValueNow")) / 100
        # Beside another one, the picture of the command is left of the divider.
        width = max(0, round(wanted.shape[1] * share) - 1) if divided else wanted.shape[1]
        assert shown.shape == wanted.shape
        assert np.array_equal(shown[:, :width], wanted[:, :width])

    def plain(self) -> None:
        """Shows one picture, not denoised, as models and denoised pictures have other bits."""
        self.page.run(  # a panel over it may have taken the click that ends it
            "(() => { const e = document.getElementById('play');"
            "if (e.ariaPressed === 'true') e.click(); })()"
        )
        settled(self.page)
        for name in ("models", "denoised"):
            button = f"document.querySelector('[data-show={name}]')"
            if self.page.run(f"{button}.ariaPressed === 'true'"):
                self.page.run(f"{button}.click()")
                self.page.until(f"{button}.ariaPressed === 'false'")
                settled(self.page)

    def heap_mb(self) -> float:
        """Heap of the page that is in use."""
        self.page.call("HeapProfiler.collectGarbage")
        return float(self.page.call("Runtime.getHeapUsage")["usedSize"]) / 2**20


@pytest.fixture
def faults(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Errors of the server that no user can mend."""
    found: list[str] = []

    def noted(error: Exception) -> str:
        text = reason_of(error)
        if text.startswith("internal error"):
            found.append(text)
        return text

    reason_of = hub.reason_of
    for module in (hub, rungs):
        monkeypatch.setattr(module, "reason_of", noted)
    return found


@pytest.fixture
def walk(file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Walk]:
    monkeypatch.chdir(tmp_path)  # saved pictures go there
    with browser(tmp_path / "profile") as page, stage_of(file) as server:
        yield Walk(page, server, 57)


@pytest.mark.parametrize("count", [60, pytest.param(1000, marks=pytest.mark.slow)])
def test_random_turns_of_the_page(
    walk: Walk, faults: list[str], count: int, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    page = walk.page
    server_mb: list[float] = []
    heap_mb: list[float] = []
    for number in range(count):
        if number % RELOAD == 0:
            page.open(f"http://{walk.server.host}/#{TOKEN}")
            rests(page)
        walk.turn()
        assert not page.errors, (page.errors, walk.trail)
        assert not faults, (faults, walk.trail)
        if number % LOOK == LOOK - 1 or number == count - 1:
            try:
                walk.check(tmp_path)
            except AssertionError as error:
                raise AssertionError(f"after {number} turns: {[*walk.trail]}") from error
            server_mb.append(memory_mb())
        if number % RELOAD in (WARM, RELOAD - 1):
            heap_mb.append(walk.heap_mb())
    assert [one.getMessage() for one in caplog.records if one.levelno >= logging.ERROR] == []
    grown = np.diff(heap_mb)[::2]
    print(f"server {server_mb} MB, page {heap_mb} MB")
    # The first half fills what is kept, such as lenses.
    assert server_mb[-1] - server_mb[len(server_mb) // 2] < SLACK_MB, server_mb
    assert all(grown < HEAP_SLACK_MB), heap_mb
