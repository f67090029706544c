"""Connections that break, fall silent or come back; and a thousand turns."""

from __future__ import annotations

import contextlib
import gc
import random
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import daguerre as dg
from daguerre.viewfinder.stage import Stage

from .chromium import Browser, program
from .live import TOKEN, Live, live
from .test_painter import scene

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")
pytestmark = [
    pytest.mark.skipif(program() is None, reason="needs chromium"),
    pytest.mark.xdist_group("chromium"),
]


class Wire:
    """A line between page and server that can be cut, or fall silent as that of a closed laptop."""

    def __init__(self, port: int, own: int) -> None:
        self._target, self._open, self._pairs = port, threading.Event(), []
        self._open.set()
        self.accepts = True
        self._door = socket.create_server(("127.0.0.1", own))
        threading.Thread(target=self._serve, daemon=True).start()

    def silence(self, silent: bool) -> None:
        """Holds all bytes back, or lets them go."""
        (self._open.clear if silent else self._open.set)()

    def cut(self) -> None:
        """Breaks all connections and refuses new ones."""
        self.accepts = False
        for one in self._pairs:
            with contextlib.suppress(OSError):
                one.shutdown(socket.SHUT_RDWR)
            one.close()
        self._pairs = []

    def mend(self) -> None:
        """Accepts connections again."""
        self.accepts = True

    def close(self) -> None:
        """Ends it."""
        self.cut()
        self._door.close()

    def _serve(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                near, _ = self._door.accept()
                if not self.accepts:
                    near.close()
                    continue
                far = socket.create_connection(("127.0.0.1", self._target))
                self._pairs += [near, far]
                for a, b in ((near, far), (far, near)):
                    threading.Thread(target=self._pump, args=(a, b), daemon=True).start()

    def _pump(self, a: socket.socket, b: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while part := a.recv(1 << 16):
                self._open.wait()
                b.sendall(part)
            b.shutdown(socket.SHUT_WR)


@pytest.fixture
def own_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as free:
        return int(free.getsockname()[1])


@pytest.fixture
def server(own_port: int) -> Iterator[Live]:
    made = scene()
    settings = dg.RenderSettings.of(resolution=(96, 64), spp=2)
    also = [f"http://127.0.0.1:{own_port}"]
    with live(Stage(made, made.camera(), settings), also=also) as running:
        yield running


@pytest.fixture
def wire(server: Live, own_port: int, page: Browser) -> Iterator[Wire]:
    """A wire by which the page is open."""
    made = Wire(server.port, own_port)
    page.open(f"http://127.0.0.1:{own_port}/#{TOKEN}")
    rests(page)
    yield made
    made.close()


def rests(page: Browser, after: int = -1, timeout: float = 60) -> int:
    """Waits until a picture at rest of a later turn is shown, and returns the turn."""
    return int(
        page.until(
            "(() => { const frame = document.getElementById('frame'), d = frame?.dataset ?? {};"
            f"return frame?.ariaBusy === 'false' && Number(d.turn) > {after} && d.turn; }})()",
            timeout,
        )
    )


def test_a_line_that_is_cut_comes_back(wire: Wire, page: Browser) -> None:
    wire.cut()
    page.until("document.getElementById('status').textContent.includes('lost')", 5)
    wire.mend()
    began = time.monotonic()
    page.until("!document.getElementById('status').textContent.includes('lost')", 10)
    assert time.monotonic() - began < 3
    page.run("document.getElementById('ring-iso').focus()")
    page.press("ArrowRight")
    rests(page, 0)


@pytest.mark.slow
def test_a_silent_minute(wire: Wire, page: Browser) -> None:
    wire.silence(True)
    time.sleep(60)
    wire.silence(False)
    page.until("!document.getElementById('status').textContent.includes('lost')", 10)
    page.run("document.getElementById('ring-iso').focus()")
    page.press("ArrowRight")
    rests(page, 0)


TURNS: dict[str, Any] = {
    "f_stop": lambda r: f"{r.choice([2, 2.8, 4, 5.6, 8])}",
    "focus_distance": lambda r: f"{r.uniform(0.6, 9):.4g}",
    "iso": lambda r: f"{r.choice([50, 100, 400, 1600])}",
    "shutter_time": lambda r: f"1/{r.choice([30, 60, 125])}",
    "blades": lambda r: f"{r.choice([0, 5, 6, 9])}",
    "focus_at": lambda r: f"{r.randrange(96)},{r.randrange(64)}",
    "place.position": lambda r: f"{r.uniform(-1, 1):.3f},{r.uniform(0.5, 2):.3f},2",
    "lens": lambda r: r.choice(["double-gauss-50mm-f2", "thin"]),
    "white_balance": lambda r: f"{r.choice([3200, 5600, 6500])}",
}


def resident_kb(pid: str = "self") -> int:
    """Resident memory of a process, kB."""
    text = Path(f"/proc/{pid}/status").read_text()
    return int(text.split("VmRSS:")[1].split()[0])


@pytest.mark.slow
def test_a_thousand_turns(server: Live, page: Browser) -> None:
    page.open(f"http://{server.host}/#{TOKEN}")
    rests(page)
    dice = random.Random(4)
    memory, heap = [], []
    for k in range(1000):
        name = dice.choice(list(TURNS))
        server.turn({name: TURNS[name](dice)})
        time.sleep(dice.choice([0, 0, 0.01, 0.05, 0.2]))
        if k % 100 == 99:
            rests(page, server.hub.number - 1)
            gc.collect()
            memory.append(resident_kb())
            heap.append(int(page.run("performance.memory.usedJSHeapSize")))
    assert page.errors == []
    assert memory[-1] - memory[0] < 30_000, memory
    assert heap[-1] - heap[0] < 8 << 20, heap
