"""The page for all: axe-core finds nothing, and every control has a name."""

from __future__ import annotations

import json
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest

import daguerre as dg
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.stage import Stage

from .chromium import Browser, program
from .live import TOKEN, Live, live
from .test_painter import scene

pytest.importorskip("websockets", reason="needs the extra view")
AXE = find_spec("axe_core_python")
pytestmark = [
    pytest.mark.skipif(program() is None, reason="needs chromium"),
    pytest.mark.skipif(AXE is None, reason="needs axe-core-python"),
    pytest.mark.xdist_group("chromium"),
]


@pytest.fixture(scope="module")
def server() -> Iterator[Live]:
    made = scene()
    settings = dg.RenderSettings.of(resolution=(96, 64), spp=2)
    with live(
        Stage(made, made.camera(), settings), Dials.of({"lens": "double-gauss-50mm-f2"})
    ) as s:
        yield s


@pytest.fixture
def page(server: Live, page: Browser) -> Browser:
    page.open(f"http://{server.host}/#{TOKEN}")
    page.until("document.getElementById('frame')?.ariaBusy === 'false'")
    return page


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (390, 844)])
@pytest.mark.parametrize("state", ["as it opens", "rays", "lenses", "beside"])
def test_axe_finds_nothing(page: Browser, state: str, width: int, height: int) -> None:
    page.size(width, height, touch=width < 800)
    if state == "rays":
        page.click("[data-panel=rays]")
        page.click("#picture", 10, 12)
        page.until("document.getElementById('rays-drawing').naturalWidth > 100")
    elif state == "lenses":
        page.click("#lens")
        page.until("document.querySelectorAll('#lens-list [role=option]').length > 100")
        page.click("#lens-list [role=option]:nth-child(9)")
        page.until("document.getElementById('lens-drawing').naturalWidth > 100")
    elif state == "beside":
        page.run(
            "(() => { const e = document.getElementById('beside'); e.selectedIndex = 2;"
            "e.dispatchEvent(new Event('change')); })()"
        )
        page.until("!document.getElementById('divider').hidden")
    assert AXE is not None
    assert AXE.origin is not None
    page.run(Path(AXE.origin).with_name("axe.min.js").read_text("utf-8") + ";0")
    found = page.run("axe.run().then((r) => JSON.stringify(r.violations))")
    told = [
        (one["id"], one["impact"], [node["html"][:120] for node in one["nodes"]][:3])
        for one in json.loads(found)
    ]
    assert told == []
