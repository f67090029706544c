"""Speed of the viewfinder through Chromium: from the turn of a ring to the picture on the canvas.

    python bench/viewfinder.py [SCENE.glb] [--turns 60] [--lens double-gauss-50mm-f2]

Turns the rings of focus, iris and shutter with the keyboard, each turn after the last picture of
the one before began to show, and prints median and 95th percentile of the time to the first new
picture, in ms; the rate at which finished pictures of 960 x 540 arrive; the CPU time of server and
page at rest; the time in which a new wish ends a render or a set-up; and the bytes of the page.
Without a scene: the night table of ``script/demo``.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import json
import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import daguerre as dg
from daguerre.cli.demo import write_scene
from daguerre.rendering import Cancelled, CancelToken
from daguerre.rendering.session import Session
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.opening import opened
from daguerre.viewfinder.server import FILES
from daguerre.viewfinder.stage import Stage

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from tests.viewfinder.chromium import Browser, browser
from tests.viewfinder.live import TOKEN, live

RINGS = ("focus_distance", "f_stop", "shutter_time")
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


def turned(page: Browser, count: int) -> list[float]:
    """Times from a key to the first new picture, ms."""
    page.run(WATCH)
    for k in range(count):
        ring = f"#ring-{RINGS[k % len(RINGS)]}"
        page.run(f"document.querySelector({json.dumps(ring)}).focus()")
        page.press("ArrowRight" if (k // len(RINGS)) % 4 < 2 else "ArrowLeft")
        try:
            page.until(f"window.turns.length > {k}", 20)
        except AssertionError:  # the ring is at its end
            page.run("window.turns.push(NaN)")
        time.sleep(0.2)
    return [float(t) for t in page.run("window.turns") if t is not None]


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
    """Pictures of 960 x 540 that arrive per second, when they need no drawing."""
    hub = server.hub
    end = time.monotonic() + seconds
    began = int(page.run("document.getElementById('frame').dataset.picture"))
    while time.monotonic() < end:
        hub.publish(hub.picture)
    return (int(page.run("document.getElementById('frame').dataset.picture")) - began) / seconds


def cancelled(scene: dg.Scene, camera: dg.Camera) -> list[float]:
    """Times from a wish to the end of the work before it, in a render and in set-ups, ms."""
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
    options = parser.parse_args()
    scene, camera = loaded(options.scene)
    dials = Dials.of({"lens": options.lens})
    rows: dict[str, Any] = {"threads": os.cpu_count()}
    with tempfile.TemporaryDirectory() as folder, browser(Path(folder)) as page:
        for size, key in (((240, 135), "small"), ((960, 540), "large")):
            stage = Stage(scene, camera, dg.RenderSettings.of(resolution=size, spp=16))
            began = time.monotonic()
            first, _ = opened(stage, dials)
            rows[f"{key}_metered_ms"] = 1e3 * (time.monotonic() - began)
            with live(stage, first) as server:
                began = time.monotonic()
                page.open(f"http://{server.host}/#{TOKEN}")
                page.until("document.getElementById('frame')?.dataset.picture > 0", 120)
                rows[f"{key}_open_ms"] = 1e3 * (time.monotonic() - began)
                times = turned(page, options.turns)
                rows[f"{key}_turn_median_ms"] = float(np.nanmedian(times))
                rows[f"{key}_turn_p95_ms"] = float(np.nanpercentile(times, 95))
                page.until("document.getElementById('frame').dataset.rests === 'true'", 600)
                time.sleep(1)
                pids = children_of(os.getpid())
                before, start = cpu_of(pids), time.monotonic()
                time.sleep(20)  # long enough to hold what the browser does now and then
                rows[f"{key}_rest_cpu_percent"] = (
                    100 * (cpu_of(pids) - before) / (time.monotonic() - start)
                )
                if key == "large":
                    rows["stream_per_s"] = streamed(server, page)
    ends = cancelled(scene, camera.with_(lens=options.lens))
    rows["cancel_median_ms"], rows["cancel_most_ms"] = float(np.median(ends)), max(ends)
    rows["page_bytes"] = sum(map(len, FILES.values()))
    for name, value in rows.items():
        print(f"{name:24} {value:.4g}" if isinstance(value, float) else f"{name:24} {value}")


if __name__ == "__main__":
    main()
