"""The picker of lenses: photographs on demand, filters, keys, and the sheet of a phone."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import daguerre as dg
from daguerre import lenses
from daguerre.lenses.index import entries
from daguerre.viewfinder import lens_list
from daguerre.viewfinder import server as served
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.stage import Stage

from .chromium import Browser, browser, program
from .live import TOKEN, Live, live
from .live import page as socket_page
from .test_painter import scene
from .test_server import get

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")

LENS = "double-gauss-50mm-f2"
COUNT = len(lens_list.offered())
chromium_only = [
    pytest.mark.skipif(program() is None, reason="needs chromium"),
    pytest.mark.xdist_group("chromium"),
]


@pytest.fixture(scope="module")
def server() -> Iterator[Live]:
    made = scene()
    settings = dg.RenderSettings.of(resolution=(96, 64), spp=2)
    dials = Dials.of({"lens": LENS, "f_stop": "16"})  # which all lenses have
    with live(Stage(made, made.camera(), settings), dials) as running:
        yield running


# The server


@pytest.mark.parametrize("name", ["canon-50mm-f0.95", "zeiss-hologon-15mm-f8"])
def test_a_photograph_is_served(server: Live, name: str) -> None:
    answer = get(server, f"/photographs/{name}.webp")
    assert answer.status == 200
    assert answer.headers["Content-Type"] == "image/webp"
    assert answer.headers["X-Content-Type-Options"] == "nosniff"
    assert answer.headers["Cross-Origin-Resource-Policy"] == "same-origin"
    assert answer.body == lens_list.photograph_path(name).read_bytes()


@pytest.mark.parametrize(
    "path",
    [
        "/photographs/",
        "/photographs/no-such-lens.webp",
        f"/photographs/{LENS}.json",
        f"/photographs/{LENS}",
        f"/photographs/../{LENS}.json",
        f"/photographs/..%2f{LENS}.json",
        "/photographs/../../index.py",
        f"/photographs/./{LENS}.webp",
        f"//photographs/{LENS}.webp",
        f"/photographs/{LENS}.webp/",
    ],
)
def test_nothing_else_is_served_beside_the_photographs(server: Live, path: str) -> None:
    assert get(server, path).status == 404


def test_a_photograph_has_the_rules_of_the_door(server: Live) -> None:
    assert get(server, f"/photographs/{LENS}.webp", host="evil.example").status == 421
    assert get(server, f"/photographs/{LENS}.webp", "POST").status in (400, 405)


def test_a_photograph_that_is_missing_is_not_found(
    server: Live, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setitem(served.PHOTOGRAPHS, f"/photographs/{LENS}.webp", tmp_path / "gone.webp")
    assert get(server, f"/photographs/{LENS}.webp").status == 404


# Facts for the filters


def facts_of(name: str) -> dict[str, Any]:
    return next(one for one in lens_list.facts() if one["name"] == name)


def test_facts_are_those_of_the_search() -> None:
    for entry in entries():
        facts = facts_of(entry.name)
        found = {one.name for kind in facts["kinds"] for one in dg.lenses.find(kind)}
        assert not facts["kinds"] or entry.name in found
        for maker in facts["makers"]:
            assert entry in dg.lenses.find(maker)
    assert facts_of("canon-ef-24-70mm-f2.8")["focal_mm"] == (24, 70)
    assert "zoom" in facts_of("canon-ef-24-70mm-f2.8")["kinds"]
    assert facts_of("zeiss-jena-biogon-35mm-f2.8")["makers"] == ["Zeiss"]
    assert facts_of("nikon-nikkor-50mm-f1.2")["makers"] == ["Nikon", "Nippon Kogaku"]


def test_the_name_of_a_prime_spans_no_range() -> None:
    name = "vivitar-series-1-135mm-f2.3"
    assert facts_of(name)["focal_mm"] == (135, 135)
    assert name not in [one.name for one in dg.lenses.find("50mm")]


def test_opening_the_page_computes_no_facts(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: object) -> None:
        raise AssertionError("facts were computed")

    monkeypatch.setattr(lens_list, "library", fails)
    monkeypatch.setattr(lens_list, "kinds_of", fails)
    monkeypatch.setattr(lenses, "load", fails)
    assert len(lens_list.offered()) == COUNT


def test_a_photograph_comes_by_message(server: Live) -> None:
    with socket_page(server) as one:
        one.until_rest(0)
        one.send(photograph=LENS)
        while "photograph" not in (message := json.loads(one.socket.recv(30))):
            pass
        found = message["photograph"]
        assert base64.b64decode(found["webp"]) == lens_list.photograph_path(LENS).read_bytes()
        one.send(photograph="../index")
        while "refused" not in (message := json.loads(one.socket.recv(30))):
            pass
        assert "wanted a lens of the library" in message["refused"]


# The page


@pytest.fixture(scope="module")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("chromium") / "profile") as found:
        yield found


@pytest.fixture
def page(chromium: Browser, server: Live) -> Browser:
    return opened(chromium, server, 1440, 900)


def opened(page: Browser, server: Live, width: int, height: int) -> Browser:
    """The page with its first picture, and the picker closed."""
    page.open("about:blank")
    page.run("1")
    page.errors.clear()
    page.asked.clear()
    page.size(width, height, touch=width < 800)
    page.open(f"http://{server.host}/#{TOKEN}")
    page.until("document.getElementById('frame')?.ariaBusy === 'false'")
    return page


def open_picker(page: Browser) -> None:
    page.click("#lens")
    page.until("document.querySelectorAll('#lens-list [role=option]').length > 100")


def set_value(page: Browser, name: str, value: str) -> None:
    page.run(
        f"(() => {{ const s = document.getElementById('{name}'); s.value = {json.dumps(value)};"
        f"if (s.value !== {json.dumps(value)}) throw Error('no such value');"
        "s.dispatchEvent(new Event(s.matches('select') ? 'change' : 'input')); })()"
    )


def count_of(page: Browser) -> str:
    return str(page.run("document.getElementById('lens-count').textContent"))


def names_of(page: Browser) -> list[str]:
    found: list[str] = page.run(
        "[...document.querySelectorAll('#lens-list [role=option]')].map((e) => e.id.slice(5))"
    )
    return found


def chosen_of(page: Browser) -> str:
    found: list[str] = page.run(
        "[...document.querySelectorAll('#lens-list [aria-selected=true]')]"
        ".map((e) => e.id.slice(5))"
    )
    assert len(found) == 1
    assert (
        page.run("document.getElementById('lens-list').getAttribute('aria-activedescendant')")
        == f"lens-{found[0]}"
    )
    return found[0]


def photographs_asked(page: Browser) -> set[str]:
    page.run("1")  # takes in the events so far
    return {url for url in page.asked if "/photographs/" in url}


IN_VIEW = (
    "(() => { const list = document.getElementById('lens-list').getBoundingClientRect();"
    "return [...document.querySelectorAll('#lens-list img')].filter((e) => {"
    "const b = e.getBoundingClientRect(); return b.bottom > list.top && b.top < list.bottom; })"
    ".every((e) => e.naturalWidth > 100); })()"
)


@pytest.mark.usefixtures("chromium")
class TestPage:
    pytestmark = chromium_only

    def test_photographs_come_as_they_are_seen(self, page: Browser) -> None:
        assert photographs_asked(page) == set()
        open_picker(page)
        page.until(IN_VIEW)
        first = photographs_asked(page)
        assert 10 < len(first) < 70
        page.run("document.getElementById('lens-list').scrollTo(0, 1e6)")
        page.until(IN_VIEW)
        assert len(photographs_asked(page)) > len(first)
        assert page.errors == []

    def test_photographs_say_what_they_are(self, page: Browser) -> None:
        open_picker(page)
        alt = page.run("document.querySelector('#lens-canon-50mm-f0\\\\.95 img').alt")
        assert alt == "Head, chart and lanterns, rendered through Canon 50 mm f/0.95"
        assert "rendered by Daguerre" in page.run(
            "document.getElementById('lens-caption').textContent"
        )

    def test_a_card_without_a_photograph_says_so(self, page: Browser) -> None:
        open_picker(page)
        for name, text in (("scene", "the scene’s own"), ("thin", "without glass")):
            card = f"document.getElementById('lens-{name}')"
            assert page.run(f"{card}.querySelector('.lens-photograph').textContent") == text
            assert not page.run(f"!!{card}.querySelector('img')")
        page.run("document.querySelector('#lens-list img').dispatchEvent(new Event('error'))")
        assert (
            page.run("document.querySelectorAll('#lens-list .lens-photograph')[3].textContent")
            == "no picture"
        )

    @pytest.mark.parametrize(
        ("name", "value", "fits"),
        [
            ("lens-kind", "zoom", lambda e: e.efl_long_mm is not None),
            ("lens-length", "0", lambda e: e.efl_mm < 20.9),
            ("lens-speed", "1.4", lambda e: e.f_number < 1.47),
            ("lens-era", "1970", lambda e: 1970 <= e.year < 1980),
            ("lens-era", "0", lambda e: e.year < 1950),
            ("lens-maker", "Zeiss", lambda e: "Zeiss" in f"{e.maker} {e.title} {e.also}"),
        ],
    )
    def test_a_filter(self, page: Browser, name: str, value: str, fits: Any) -> None:
        open_picker(page)
        assert count_of(page) == f"{COUNT} lenses"
        set_value(page, name, value)
        wanted = {entry.name for entry in entries() if fits(entry)}
        assert set(names_of(page)) == wanted
        assert count_of(page) == f"{len(wanted)} lenses"
        page.click("#lens-reset")
        assert count_of(page) == f"{COUNT} lenses"

    def test_filters_and_words_hold_together(self, page: Browser) -> None:
        open_picker(page)
        set_value(page, "lens-search", "canon")
        page.until("document.querySelectorAll('#lens-list [role=option]').length < 30")
        set_value(page, "lens-kind", "zoom")
        set_value(page, "lens-length", "2")
        assert names_of(page) == ["canon-ef-24-70mm-f2.8"]
        assert count_of(page) == "1 lens"
        set_value(page, "lens-era", "0")
        assert names_of(page) == []
        assert count_of(page) == "No lens fits all of this."

    def test_arrows_walk_the_grid_and_enter_uses_the_lens(self, page: Browser) -> None:
        open_picker(page)
        columns = page.run(
            "getComputedStyle(document.getElementById('lens-list'))"
            ".gridTemplateColumns.split(' ').length"
        )
        assert columns > 3
        names = names_of(page)
        page.run("document.getElementById('lens-list').focus()")
        at = names.index(chosen_of(page))
        assert names[at] == LENS
        for key, step in (
            ("ArrowDown", columns), ("ArrowRight", 1), ("ArrowUp", -columns), ("ArrowLeft", -1),
        ):  # fmt: skip
            page.press(key)
            at += step
            assert chosen_of(page) == names[at]
        page.press("Home")
        page.press("ArrowUp")
        assert chosen_of(page) == "scene"
        page.press("End")
        assert chosen_of(page) == names[-1]
        page.until("document.getElementById('lens-drawing').naturalWidth > 100")
        facts = page.run("document.getElementById('lens-facts').innerText")
        assert str(next(e.year for e in entries() if e.name == names[-1])) in facts
        page.press("Enter")
        assert not page.run("document.getElementById('lenses').open")
        page.until(f"document.getElementById('command').value.includes('--lens={names[-1]}')")
        assert page.errors == []

    def test_words_then_an_arrow_reach_the_grid(self, page: Browser) -> None:
        open_picker(page)
        set_value(page, "lens-search", "ziess hologon")
        page.until("document.querySelectorAll('#lens-list [role=option]').length === 1")
        page.run("document.getElementById('lens-search').focus()")
        page.press("ArrowDown")
        assert page.run("document.activeElement.id") == "lens-list"
        assert chosen_of(page) == "zeiss-hologon-15mm-f8"

    def test_escape_closes_at_the_first_press(self, page: Browser) -> None:
        open_picker(page)
        set_value(page, "lens-search", "canon")
        page.run("document.getElementById('lens-search').focus()")
        page.press("Escape")
        assert not page.run("document.getElementById('lenses').open")

    def test_a_phone_has_two_columns_and_a_sheet(self, chromium: Browser, server: Live) -> None:
        page = opened(chromium, server, 390, 844)
        shown = "document.getElementById('{}').checkVisibility()"
        open_picker(page)
        assert not page.run(shown.format("lens-chosen"))
        assert not page.run(shown.format("lens-kind"))
        page.click("#lens-more")
        assert page.run(shown.format("lens-kind"))
        page.click("#lens-more")
        left = page.run(
            "[...new Set([...document.querySelectorAll('#lens-list [role=option]')]"
            ".map((e) => e.getBoundingClientRect().left))].length"
        )
        assert left == 2
        page.click("#lens-canon-50mm-f0\\.95")
        assert page.run(shown.format("lens-chosen"))
        page.until("document.querySelector('#lens-photograph img').naturalWidth > 100")
        page.click("#lens-back")
        assert not page.run(shown.format("lens-chosen"))
        page.click("#lens-canon-50mm-f0\\.95")
        page.click("#lens-take")
        page.until("document.getElementById('command').value.includes('canon-50mm-f0.95')")
        assert page.errors == []
