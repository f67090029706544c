"""Speed of the viewfinder through Chromium: from the turn of a ring to the picture on the canvas.

    python bench/viewfinder.py [SCENE.glb] [--turns 60] [--lens double-gauss-50mm-f2] [--json]

Without a scene: the night table of ``script/demo``. At 240 x 135 (small) and 960 x 540 (large):

* metered: the exposure at which a viewfinder starts, before the server listens;
* open: from navigation to the first picture on the canvas, of the first page, and the median of
  later ones;
* turn: from a key to the first new picture, turning focus, iris and shutter, each turn after the
  last picture of the one before began to show;
* expose: the same at rest, turning ISO, compensation, white balance and look; ``draws`` counts the
  times that samples were drawn for it, which must be none;
* rest_cpu: CPU time at rest, of the server and of the whole browser;
* stream: the rate at which finished pictures arrive.

At 480 x 270 with ghosts, while a mouse drags the picture until 100 turns have shown:

* ghosts: time from one picture of a turn to that of the next; CPU time for each, of the server and
  of the browser; how many pictures had a layer of live ghosts.

Then the time in which a new request ends a render or a set-up, and the bytes of the page without
photographs.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import json
import math
import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

import daguerre as dg
from daguerre.cli.demo import write_scene
from daguerre.rendering import Cancelled, CancelToken
from daguerre.rendering.session import Session
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.ghosts import Layer
from daguerre.viewfinder.opening import opened
from daguerre.viewfinder.server import FILES
from daguerre.viewfinder.stage import Stage

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from tests.viewfinder.chromium import Browser, browser
from tests.viewfinder.live import TOKEN, live

TURNED = ("#ring-focus_distance", "#ring-f_stop", "#ring-shutter_time")
EXPOSED = ("#ring-iso", "#ring-exposure_compensation", "#ring-white_balance", "#look")
#: Pages that are opened after the first one.
AGAIN = 5
#: Time of the measurement at rest, s: long enough to hold what the browser does now and then.
REST_S = 20
#: Notes in each page when its first picture is on the canvas.
OPENING = """
new MutationObserver(() => (window.opened ??= performance.now()))
  .observe(document, {subtree: true, attributes: true, attributeFilter: ['data-picture']})
"""
#: Notes in the page when the first picture of each turn is on the canvas.
FOLLOW = """
(() => {
  const frame = document.getElementById('frame');
  let turn = Number(frame.dataset.turn);
  window.followed = [];
  new MutationObserver(() => {
    if (Number(frame.dataset.turn) > turn) window.followed.push(performance.now());
    turn = Number(frame.dataset.turn);
  }).observe(frame, {attributes: true});
})()
"""
#: Notes in the page when a key is pressed, and when a picture of a later turn is on the canvas.
WATCH = """
(() => {
  const frame = document.getElementById('frame');
  window.turns = [];
  document.addEventListener('keydown', () => {
    window.pressed = {at: performance.now(), turn: Number(frame.dataset.turn)};
  }, true);
  new MutationObserver(() => {
    const p = window.pressed;
    if (p && Number(frame.dataset.turn) > p.turn) {
      window.turns.push(performance.now() - p.at);
      window.pressed = null;
    }
  }).observe(frame, {attributes: true});
})()
"""


def loaded(path: str | None) -> tuple[dg.Scene, dg.Camera]:
    """The scene and its camera."""
    with tempfile.TemporaryDirectory() as folder:
        if path is None:
            path = str(Path(folder) / "night_table.glb")
            write_scene(Path(path))
        scene = dg.load(path)
    return scene, scene.camera()


def open_page(page: Browser, host: str) -> float:
    """Opens the page; returns the time from navigation to its first picture, ms."""
    page.open(f"http://{host}/#{TOKEN}")
    return float(page.until("window.opened", 120))


def rests(page: Browser) -> None:
    """Waits until the picture rests."""
    page.until("document.getElementById('frame').dataset.rests === 'true'", 600)


def turned(page: Browser, controls: Sequence[str], count: int) -> list[float]:
    """Times from a key to the first new picture, ms."""
    page.run(WATCH)
    for k in range(count):
        page.run(f"document.querySelector({json.dumps(controls[k % len(controls)])}).focus()")
        page.press("ArrowRight" if (k // len(controls)) % 4 < 2 else "ArrowLeft")
        try:
            page.until(f"window.turns.length > {k}", 20)
        except AssertionError:  # the ring is at its end
            page.run("window.turns.push(null)")
        time.sleep(0.2)
    return [float(t) for t in page.run("window.turns") if t is not None]


def followed(stage: Stage, dials: Dials, page: Browser, turns: int) -> dict[str, float]:
    """Measures pictures that follow a hand with ghosts."""
    dials, _ = opened(stage, dials.turned({"flare": "auto"}))
    with live(stage, dials) as server:
        open_page(page, server.host)
        rests(page)
        page.run(FOLLOW)
        with mock.patch.object(Layer, "added", autospec=True, side_effect=Layer.added) as layers:
            cpus = drag(page, turns)
        times = page.run("window.followed")
        rests(page)
    found = summed("ghosts", np.diff(times))
    each = {f"ghosts_{name}_cpu_ms": 1e3 * cpu / len(times) for name, cpu in cpus.items()}
    return {**found, **each, "ghosts_share": layers.call_count / len(times)}


def drag(page: Browser, turns: int) -> dict[str, float]:
    """Drags the picture at 60 moves a second until turns have shown; returns CPU time, s."""
    pids = processes()
    x, y = page.place("#picture")
    before = {name: cpu_of(some) for name, some in pids.items()}
    page.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
    for k in itertools.count(1):
        at = x + 60 * math.sin(0.03 * k), y + 20 * math.sin(0.02 * k)
        page.mouse("mouseMoved", *at, button="left", buttons=1)
        if k % 10 == 0 and page.run("window.followed.length") > turns:
            break
        time.sleep(1 / 60)
    page.mouse("mouseReleased", *at, button="left", buttons=0, clickCount=1)
    return {name: cpu_of(some) - before[name] for name, some in pids.items()}


def processes() -> dict[str, list[int]]:
    """Processes of the server, which is this one, and of the browser."""
    own = os.getpid()
    return {"server": [own], "browser": [pid for pid in children_of(own) if pid != own]}


def summed(name: str, times: Sequence[float]) -> dict[str, float]:
    """Median and 95th percentile of times, ms."""
    return {
        f"{name}_median_ms": float(np.median(times)),
        f"{name}_p95_ms": float(np.percentile(times, 95)),
    }


def rest_cpu() -> dict[str, float]:
    """CPU time at rest of this process, which serves, and of the browser, % of a core."""
    pids = processes()
    before, began = {name: cpu_of(some) for name, some in pids.items()}, time.monotonic()
    time.sleep(REST_S)
    scale = 100 / (time.monotonic() - began)
    return {f"rest_cpu_{n}_percent": scale * (cpu_of(pids[n]) - before[n]) for n in pids}


def measured(stage: Stage, dials: Dials, page: Browser, turns: int) -> dict[str, float]:
    """Measures a viewfinder in the browser."""
    rows: dict[str, float] = {}
    began = time.monotonic()
    dials, _ = opened(stage, dials)
    rows["metered_ms"] = 1e3 * (time.monotonic() - began)
    with live(stage, dials) as server:
        rows["open_first_ms"] = open_page(page, server.host)
        rests(page)
        rows["open_ms"] = float(np.median([open_page(page, server.host) for _ in range(AGAIN)]))
        rows |= summed("turn", turned(page, TURNED, turns))
        rests(page)
        time.sleep(1)
        with mock.patch.object(Session, "draw", autospec=True, side_effect=Session.draw) as draw:
            rows |= summed("expose", turned(page, EXPOSED, turns))
        rows["expose_draws"] = draw.call_count
        time.sleep(1)
        rows |= rest_cpu()
        rows["stream_per_s"] = streamed(server, page)
    return rows


def cpu_of(pids: list[int]) -> float:
    """CPU seconds of processes."""
    ticks = 0
    for pid in pids:
        try:
            parts = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        ticks += int(parts[11]) + int(parts[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def children_of(pid: int) -> list[int]:
    """A process and all below it."""
    found = [pid]
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        for child in task.read_text().split():
            found += children_of(int(child))
    return found


def streamed(server: Any, page: Browser, seconds: float = 4.0) -> float:
    """Pictures that arrive per second, when they need no drawing."""
    hub = server.hub
    end = time.monotonic() + seconds
    began = int(page.run("document.getElementById('frame').dataset.picture"))
    while time.monotonic() < end:
        hub.publish(hub.picture)
    return (int(page.run("document.getElementById('frame').dataset.picture")) - began) / seconds


def cancelled(scene: dg.Scene, camera: dg.Camera) -> list[float]:
    """Times from a request to the end of the work before it, in a render and in set-ups, ms."""
    found = []

    def run(token: CancelToken, work: Callable[[], object]) -> None:
        with contextlib.suppress(Cancelled), token:
            while True:
                work()
                token.throw_if_cancelled()
        found[-1] = 1e3 * (time.perf_counter() - found[-1])

    settings = dg.RenderSettings.of(resolution=(960, 540), spp=1 << 16)
    built = Session(scene, camera, settings=settings).built
    sessions = [Session(scene, camera, settings=settings, built=built) for _ in range(20)]
    distances = itertools.count(1, 0.001)

    def set_up() -> Session:
        """Makes a session whose lens is focused where none was before: nothing is kept of it."""
        focused = camera.with_(focus_distance=next(distances))
        return Session(scene, focused, settings=settings, built=built)

    works = (lambda: sessions.pop().draw(0, 1 << 16), set_up)
    for k in range(40):
        token = CancelToken()
        thread = threading.Thread(target=run, args=(token, works[k % 2]))
        thread.start()
        time.sleep(0.05 + 0.007 * k)
        found.append(time.perf_counter())
        token.cancel()
        thread.join()
    return found


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene", nargs="?")
    parser.add_argument("--turns", type=int, default=60)
    parser.add_argument("--lens", default="double-gauss-50mm-f2")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    scene, camera = loaded(options.scene)
    dials = Dials.of({"lens": options.lens})
    rows: dict[str, Any] = {"threads": os.cpu_count()}
    # Chromium's last processes may still write while the folder is removed.
    folders = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
    with folders as folder, browser(Path(folder)) as page:
        page.call("Page.addScriptToEvaluateOnNewDocument", source=OPENING)
        for key, size in (("small", (240, 135)), ("large", (960, 540))):
            stage = Stage(scene, camera, dg.RenderSettings.of(resolution=size, spp=16))
            found = measured(stage, dials, page, options.turns)
            rows |= {f"{key}_{name}": value for name, value in found.items()}
        stage = Stage(scene, camera, dg.RenderSettings.of(resolution=(480, 270), spp=16))
        rows |= followed(stage, dials, page, 100)
    ends = cancelled(scene, camera.with_(lens=options.lens))
    rows["cancel_median_ms"], rows["cancel_most_ms"] = float(np.median(ends)), max(ends)
    rows["page_bytes"] = sum(map(len, FILES.values()))
    if options.json:
        print(json.dumps(rows))
        return
    for name, value in rows.items():
        print(f"{name:32} {value:.4g}" if isinstance(value, float) else f"{name:32} {value}")


if __name__ == "__main__":
    main()
