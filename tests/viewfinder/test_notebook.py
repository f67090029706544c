"""The panel in a notebook: the same page, with messages by the kernel's comm."""

from __future__ import annotations

import base64
import json
import queue
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import daguerre as dg

from .chromium import Browser, program
from .test_painter import scene

pytest.importorskip("anywidget", reason="needs the extra notebook")
pytest.importorskip("simplejpeg", reason="needs the extra notebook")

#: A model as front ends give it to a widget, whose messages the test carries.
MODEL = """
(async () => {
  const texts = TEXTS;
  const code = new Blob([texts.esm], {type: 'text/javascript'});
  const widget = (await import(URL.createObjectURL(code))).default;
  const handlers = [];
  window.sent = [];
  window.give = (content, bytes) => {
    const raw = bytes === null ? [] : [Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0))];
    handlers.forEach((act) => act(content, raw.map((r) => new DataView(r.buffer))));
  };
  const el = document.createElement('div');
  document.body.append(el);
  widget.render({el, model: {
    get: (name) => texts[name],
    on: (_, act) => handlers.push(act),
    send: (one) => window.sent.push(one),
  }});
  window.root = el.shadowRoot;
})()
"""


@pytest.fixture
def view() -> Iterator[Any]:
    made = dg.view(scene(), resolution=(96, 64), spp=2)
    yield made
    made.close()


class Kernel:
    """Carries messages between a widget and a page, as a kernel does."""

    def __init__(self, view: Any, page: Browser) -> None:
        self._view, self._page = view, page
        self._out: queue.Queue[tuple[Any, Any]] = queue.Queue()
        view.widget.send = lambda content, buffers=None: self._out.put((content, buffers))
        texts = {name: getattr(view.widget, name) for name in ("panel", "style")}
        texts["esm"] = str(view.widget._esm)
        page.run(MODEL.replace("TEXTS", json.dumps(texts)))

    def step(self) -> None:
        """Carries all that waits."""
        for message in self._page.run("window.sent.splice(0)"):
            self._view.widget._handle_custom_msg(message, [])
        while not self._out.empty():
            content, buffers = self._out.get()
            data = json.dumps(base64.b64encode(buffers[0]).decode()) if buffers else "null"
            self._page.run(f"window.give({json.dumps(content)}, {data})")

    def until(self, script: str) -> Any:
        """Carries messages until an expression is true."""
        end = time.monotonic() + 60
        while not (value := self._page.run(script)):
            assert time.monotonic() < end, f"never true: {script}"
            self.step()
            time.sleep(0.02)
        return value


@pytest.mark.skipif(program() is None, reason="needs chromium")
@pytest.mark.xdist_group("chromium")
def test_the_panel_turns_the_camera(view: Any, page: Browser) -> None:
    kernel = Kernel(view, page)
    frame = "root.getElementById('frame')"
    kernel.until(f"{frame}.ariaBusy === 'false'")
    turn = page.run(f"{frame}.dataset.turn")
    page.run("root.getElementById('ring-f_stop').focus()")
    page.press("ArrowRight")
    page.press("ArrowRight")
    kernel.until(f"{frame}.ariaBusy === 'false' && {frame}.dataset.turn !== '{turn}'")
    assert page.run("root.getElementById('command').closest('div').hidden")
    assert view.camera.f_stop != 4
    assert page.errors == []
    alone = dg.render(scene(), view.camera, resolution=(96, 64), spp=2)
    assert np.array_equal(view._hub.picture.frame.rgb, alone.rgb)


@pytest.mark.skipif(program() is None, reason="needs chromium")
@pytest.mark.xdist_group("chromium")
def test_photographs_of_lenses_come_by_message(view: Any, page: Browser) -> None:
    kernel = Kernel(view, page)
    kernel.until("root.getElementById('frame').ariaBusy === 'false'")
    page.run("root.getElementById('lens').click()")
    kernel.until("root.querySelectorAll('#lens-list [role=option]').length > 100")
    kernel.until("root.querySelector('#lens-list img')?.naturalWidth > 100")
    assert page.run("root.querySelectorAll('#lens-list img[src]').length") < 70
    page.run("root.querySelectorAll('#lens-list [role=option]')[5].click()")
    kernel.until("root.querySelector('#lens-photograph img')?.naturalWidth > 100")
    kernel.until("root.getElementById('lens-drawing').naturalWidth > 100")
    turn = view._hub.number
    page.run("root.getElementById('lens-take').click()")
    kernel.until(f"Number(root.getElementById('frame').dataset.turn) > {turn}")
    assert view.camera.lens != scene().camera().lens
    assert not [url for url in page.asked if "/photographs/" in url]
    assert page.errors == []


def test_the_camera_comes_back_exposed_as_metered(view: Any) -> None:
    assert view.camera.exposure == "manual"
    assert view.camera.with_(exposure="light", iso=100) == scene().camera()


def test_a_wrong_setting_is_one_error() -> None:
    with pytest.raises(dg.UsageError, match="spp"):
        dg.view(scene(), spp=0)
