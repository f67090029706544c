"""The page on five screens: the picture stays in view, nothing overlaps, nothing is cut."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import daguerre as dg
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.opening import opened
from daguerre.viewfinder.stage import Stage
from tests.faults.scene import write_scene

from .chromium import Browser, browser, program
from .live import TOKEN, Live, live
from .live import page as page_of

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")
pytestmark = [
    pytest.mark.skipif(program() is None, reason="needs chromium"),
    pytest.mark.xdist_group("chromium"),
]
PHONE, ASIDE, TABLET, DESK, WIDE = (390, 844), (844, 390), (820, 1180), (1440, 900), (1920, 1080)
TOUCHED = (PHONE, ASIDE, TABLET)
LAMP = 3e4
#: Waits for a frame: rings that change their width are drawn anew before it.
PAINTED = "new Promise((done) => requestAnimationFrame(() => setTimeout(() => done(0))))"
RESTS = "document.getElementById('frame')?.ariaBusy === 'false'"
#: Controls that can be seen, after scrolling where the page scrolls.
CONTROLS = """[...document.querySelectorAll('button, input, select, #picture, [tabindex="0"]')]
    .filter((e) => e.checkVisibility({checkVisibilityCSS: true}))"""
NAME = "(e.id || e.dataset.toggle || e.dataset.show || e.dataset.panel || e.outerHTML)"


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Live]:
    file = write_scene(tmp_path_factory.mktemp("scene") / "scene.glb", LAMP)
    made = dg.load(file)
    stage = Stage(made, made.camera(), dg.RenderSettings.of(resolution=(96, 64), spp=2))
    dials, said = opened(stage, Dials.of({"lens": "canon-ef-24-70mm-f2.8"}))
    with live(stage, dials, [str(file), "-o", "out.png"], said=said) as running:
        yield running


@pytest.fixture(scope="module")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as page:
        yield page


@pytest.fixture(params=[PHONE, ASIDE, TABLET, DESK, WIDE], ids=lambda size: f"{size[0]}x{size[1]}")
def size(request: pytest.FixtureRequest) -> tuple[int, int]:
    found: tuple[int, int] = request.param
    return found


@pytest.fixture
def page(chromium: Browser, server: Live, size: tuple[int, int]) -> Browser:
    return shows(chromium, server, size)


def shows(page: Browser, server: Live, size: tuple[int, int]) -> Browser:
    """The page as it opens on a screen."""
    page.size(*size, touch=size in TOUCHED)
    page.open("about:blank")
    page.open(f"http://{server.host}/#{TOKEN}")
    page.until(RESTS)
    page.run("document.fonts.ready.then(() => 0)")
    return page


def controls(page: Browser, fault: str) -> Any:
    """Controls with a fault, which is an expression of `e`, each scrolled into view before."""
    return page.run(
        f"{CONTROLS}.filter((e) => {{ e.scrollIntoView({{block: 'center', inline: 'center'}});"
        f"return {fault}; }}).map((e) => {NAME})"
    )


COVERED = """(() => {
    const b = e.getBoundingClientRect();
    const [x, y] = [b.left + b.width / 2, b.top + b.height / 2];
    return !e.contains(document.elementFromPoint(x, y)); })()"""
#: A finger that is 21 px off the middle still hits the control; its label is as large.
SMALL = """(() => {
    const own = e.matches('[type=radio], [type=checkbox]') ? [e, ...e.labels] : [e];
    const b = e.getBoundingClientRect(), [x, y] = [b.left + b.width / 2, b.top + b.height / 2];
    const hits = (dx, dy) => own.some((o) => o.contains(document.elementFromPoint(x + dx, y + dy)));
    const boxes = own.map((one) => (one.closest('.barrel') ?? one).getBoundingClientRect());
    return boxes.some((box) => box.width < 44 || box.height < 44)
        || [[-21, 0], [21, 0], [0, -21], [0, 21]].some(([dx, dy]) => !hits(dx, dy)); })()"""
CUT = """[...document.querySelectorAll('.viewfinder *')].filter((e) => e.checkVisibility()
    && [...e.childNodes].some((one) => one.nodeType === 3 && one.data.trim())
    && !e.closest('svg, option, [role=listbox]') && getComputedStyle(e).display !== 'inline'
    && (e.scrollWidth > e.clientWidth + 1 || e.getBoundingClientRect().right > innerWidth + 1)
    && !e.closest('.tools')).map((e) => e.outerHTML)"""
TOUCHING = """[...document.querySelectorAll('.barrel svg')].filter((s) => s.checkVisibility())
    .flatMap((svg) => {
        const edge = svg.getBoundingClientRect();
        const all = [...svg.querySelectorAll('text')]
            .map((t) => [t.textContent, t.getBoundingClientRect()])
            .sort((a, b) => a[1].left - b[1].left);
        return all.filter(([, box], i) => box.left < edge.left || box.right > edge.right
            || i + 1 < all.length && box.right + 1 > all[i + 1][1].left)
            .map(([text]) => text); })"""


def test_no_control_lies_under_another(page: Browser) -> None:
    assert controls(page, COVERED) == []


def test_no_control_lies_under_a_panel_s_own(page: Browser) -> None:
    page.run("document.querySelector('[data-panel=rays]').click()")
    try:
        inside = f"e.closest('.panel, .finder, .head') && {COVERED}"
        assert controls(page, inside) == []
    finally:
        page.run("document.querySelector('#rays .close').click()")


def test_the_picture_is_in_view_at_each_ring(page: Browser) -> None:
    hidden = """(() => {
        const b = document.getElementById('picture').getBoundingClientRect();
        const at = document.elementFromPoint(b.left + b.width / 2, b.top + b.height / 2);
        return b.top < 0 || b.left < 0 || b.bottom > innerHeight || b.right > innerWidth
            || b.width < 300 || at?.id !== 'picture'; })()"""
    rings = page.run("document.querySelectorAll('.ring:not([hidden])').length")
    assert rings >= 8
    assert controls(page, f"e.type === 'range' && {hidden}") == []


def test_no_text_is_cut(page: Browser) -> None:
    assert page.run(CUT) == []


def test_no_label_of_a_ring_touches_another(page: Browser) -> None:
    assert page.run("document.querySelectorAll('.barrel text').length") > 20
    for ring in page.run(
        "[...document.querySelectorAll('.ring:not([hidden]) input')].map((e) => e.id)"
    ):
        page.run(f"(window.ring = document.getElementById('{ring}')).focus()")
        for share in range(11):
            page.run(
                f"ring.value = Number(ring.min) + {share / 10} * (ring.max - ring.min);"
                "ring.dispatchEvent(new Event('input'))"
            )
            page.run(PAINTED)
            assert page.run(TOUCHING) == [], (ring, share)
    page.until(RESTS)  # a ring can go back once the server has answered its turns
    page.run("document.querySelectorAll('.back:enabled').forEach((one) => one.click())")
    page.until(RESTS)
    page.until("!document.querySelector('.back:enabled')")


def test_targets_of_touch_are_large(page: Browser, size: tuple[int, int]) -> None:
    if size in TOUCHED:
        assert controls(page, f"e.id !== 'picture' && {SMALL}") == []


@pytest.mark.parametrize("small", ["#exposure label", "#exposure label:first-child", "#lens"])
def test_a_small_target_would_be_found(chromium: Browser, server: Live, small: str) -> None:
    page = shows(chromium, server, PHONE)
    page.run(
        "document.styleSheets[0].insertRule("
        f"'{small} {{ min-height: 30px; height: 30px; align-self: start }}',"
        "document.styleSheets[0].cssRules.length)"
    )
    assert controls(page, f"e.id !== 'picture' && {SMALL}")


@pytest.mark.parametrize("size", [DESK, WIDE], indirect=True)
def test_the_tools_are_in_one_row_on_a_desk(page: Browser) -> None:
    tops = page.run(
        "[...document.querySelectorAll('.tools :is(button, select)')]"
        ".filter((e) => e.checkVisibility()).map((e) => e.getBoundingClientRect().top)"
    )
    assert len(tops) > 10
    assert max(tops) - min(tops) < 4


def test_every_control_has_a_tooltip(page: Browser) -> None:
    assert controls(page, "!e.title") == []


@pytest.mark.parametrize("button", ["[data-panel=rays]", "#lens", "#help"])
def test_what_a_click_opens_is_in_view(page: Browser, button: str) -> None:
    page.run(f"document.querySelector('{button}').click()")
    inside = """[...document.querySelectorAll('.panel, dialog[open]')]
        .filter((e) => e.checkVisibility()).map((e) => e.getBoundingClientRect()).map((b) =>
 b.top >= 0 && b.left >= 0 && b.bottom <= innerHeight && b.right <= innerWidth)"""
    assert page.run(inside) == [True]
    page.run("document.querySelector('[data-panel=rays]').focus()")
    page.press("Escape")
    assert page.run(inside) == []


@pytest.mark.parametrize("size", [DESK], indirect=True)
def test_save_is_in_view_on_a_desk(page: Browser) -> None:
    bottom = page.run("document.querySelector('[data-save=png]').getBoundingClientRect().bottom")
    assert 0 < bottom <= DESK[1]


@pytest.mark.parametrize("size", [DESK, WIDE], indirect=True)
def test_the_picture_fills_what_it_can(page: Browser) -> None:
    width, height, frame_width, frame_height = page.run(
        "['picture', 'frame'].flatMap((id) => { const b ="
        "document.getElementById(id).getBoundingClientRect(); return [b.width, b.height]; })"
    )
    assert width / height == pytest.approx(1.5, rel=0.01)
    assert max(width / frame_width, height / frame_height) == pytest.approx(1, abs=0.01)
    assert frame_height > 0.7 * page.run("innerHeight")


@pytest.mark.parametrize("size", [PHONE, ASIDE, TABLET], indirect=True)
def test_save_is_a_tap_away_on_a_touch_screen(page: Browser) -> None:
    page.click("#to-save")
    in_view = """(() => {
        const b = document.querySelector('[data-save=png]').getBoundingClientRect();
        return b.top > 0 && b.bottom <= innerHeight; })()"""
    assert page.run(in_view)
    assert page.run("document.activeElement.dataset.save") == "png"


def test_what_was_saved_moves_nothing(chromium: Browser, server: Live) -> None:
    page = shows(chromium, server, DESK)
    box = "JSON.stringify(document.getElementById('picture').getBoundingClientRect())"
    before = page.run(box)
    text = "Saved open_chess_set_512-1.png where Daguerre was started"
    page.run(f"document.getElementById('saved').textContent = '{text}'")
    assert page.run(box) == before


@pytest.mark.parametrize(("size", "word"), [(PHONE, "Tap"), (DESK, "Click")], indirect=["size"])
def test_a_hint_stays_until_the_picture_is_touched(page: Browser, word: str) -> None:
    page.run("sessionStorage.clear()")
    page.reload()
    hint = "document.getElementById('hint')"
    page.until(f"{hint}?.checkVisibility() && {RESTS}")
    assert page.run(f"{hint}.textContent").startswith(f"{word} to focus")
    page.click("#picture")
    page.until(f"{hint}.hidden")
    page.reload()
    page.until(RESTS)
    assert page.run(f"{hint}.hidden")
    page.run("sessionStorage.clear()")


def test_models_keep_the_size_of_the_picture(chromium: Browser, server: Live) -> None:
    page = shows(chromium, server, DESK)
    box = "JSON.stringify(document.getElementById('picture').getBoundingClientRect())"
    before = page.run(box)
    page.run("document.querySelector('[data-show=models]').click()")
    page.until("document.querySelectorAll('#names span').length === 3")
    assert page.run(box) == before
    page.run("document.querySelector('[data-show=models]').click()")
    page.until("document.querySelectorAll('#names span').length === 0")


def test_the_page_remembers_itself(chromium: Browser, server: Live) -> None:
    page = shows(chromium, server, DESK)
    page.run(
        "for (const one of ['toggle=grid', 'panel=rays'])"
        "document.querySelector(`[data-${one}]`).click()"
    )
    page.run(
        "(() => { const s = document.getElementById('iris-scale'); s.value = 'f2';"
        "s.dispatchEvent(new Event('change')); })()"
    )
    shown = """JSON.stringify([document.getElementById('iris-scale').value,
        document.querySelector('[data-toggle=grid]').ariaPressed,
        document.querySelector('[data-panel=rays]').ariaExpanded,
        document.getElementById('rays').hidden])"""
    known = page.run(shown)
    assert known == '["f2","true","true",false]'
    page = shows(chromium, server, DESK)
    assert page.run(shown) == known
    page.run("sessionStorage.clear()")


def test_keys_press_controls(chromium: Browser, server: Live) -> None:
    page = shows(chromium, server, DESK)
    grid = "document.querySelector('[data-toggle=grid]')"
    assert page.run(f"{grid}.title").endswith("(G)")
    page.press("g")
    assert page.run(f"{grid}.ariaPressed") == "true"
    page.run("document.getElementById('spp').focus()")
    page.press("g")
    assert page.run(f"{grid}.ariaPressed") == "true"
    page.run("document.activeElement.blur()")
    page.press("4")
    assert page.run("document.activeElement.id") == "ring-iso"
    page.press("g")
    assert page.run(f"{grid}.ariaPressed") == "false"
    page.press("?")
    listed = page.run("document.getElementById('keys-list').innerText")
    for text in ("ISO", "Grid", "Full screen", "Lens", "Save PNG"):
        assert text in listed
    page.press("Escape")
    assert not page.run("document.getElementById('keys').open")


def test_the_first_escape_closes_the_search(chromium: Browser, server: Live) -> None:
    page = shows(chromium, server, DESK)
    page.press("o")
    page.call("Input.insertText", text="canon")
    assert page.run("document.getElementById('lens-search').value") == "canon"
    page.press("Escape")
    assert not page.run("document.getElementById('lenses').open")


def test_a_barred_storage_bars_nothing(tmp_path: Path, server: Live) -> None:
    with browser(tmp_path / "profile") as page:
        page.call(
            "Page.addScriptToEvaluateOnNewDocument",
            source="Object.defineProperty(window, 'sessionStorage',"
            "{get() { throw new Error('barred'); }})",
        )
        page.size(*DESK)
        page.open(f"http://{server.host}/#{TOKEN}")
        page.until(RESTS)
        page.press("g")
        assert page.run("document.querySelector('[data-toggle=grid]').ariaPressed") == "true"
        assert page.errors == []


def test_a_page_that_watches_says_so(chromium: Browser, server: Live) -> None:
    chromium.open("about:blank")
    with page_of(server) as first:
        first.step()
        page = shows(chromium, server, PHONE)
        text = page.until("!document.getElementById('watches').hidden && document.body.innerText")
        assert "Read-only: another page controls the camera." in text
    page.until("document.getElementById('watches').hidden")


def test_a_distance_too_near_for_the_lens_is_one_sentence(chromium: Browser, server: Live) -> None:
    page = shows(chromium, server, PHONE)
    server.turn({"focus_distance": "0.001"})
    error = "document.getElementById('error')"
    text = page.until(f"!{error}.hidden && {error}.textContent")
    assert text.startswith("The lens does not focus that near")
    server.turn({"focus_distance": None})
    page.until(f"{error}.hidden")
