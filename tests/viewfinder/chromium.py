"""A headless Chromium, driven over its DevTools protocol."""

from __future__ import annotations

import base64
import contextlib
import json
import os
import shutil
import subprocess
import tempfile
import time
import urllib.request
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
FLAGS = (
    *("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"),
    *("--no-first-run", "--disable-extensions", "--disable-background-networking"),
    *("--remote-debugging-port=0", "--remote-allow-origins=*", "--hide-scrollbars"),
)
KEYS = {
    "Escape": 27,
    "ArrowRight": 39,
    "ArrowLeft": 37,
    "ArrowUp": 38,
    "ArrowDown": 40,
    "PageUp": 33,
    "Tab": 9,
}


def program() -> str | None:
    """Path of Chromium; None: it is not installed."""
    return next(filter(None, map(shutil.which, NAMES)), None)


@dataclass
class Browser:
    """A page in Chromium.

    Attributes:
        socket: Connection to the page's DevTools.
        errors: Errors and warnings that its console has shown.
        asked: Addresses that it has requested.
    """

    socket: Any
    errors: list[str] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)
    _number: int = 0

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Calls a method of the protocol and returns its result."""
        self._number += 1
        self.socket.send(json.dumps({"id": self._number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self.socket.recv(60))
            if message.get("id") == self._number:
                assert "error" not in message, (method, message["error"])
                found: dict[str, Any] = message["result"]
                return found
            self._note(message)

    def _note(self, message: dict[str, Any]) -> None:
        """Keeps what an event of the page says."""
        facts = message.get("params", {})
        match message.get("method"):
            case "Runtime.exceptionThrown":
                self.errors.append(json.dumps(facts["exceptionDetails"])[:500])
            case "Runtime.consoleAPICalled" if facts["type"] in ("error", "warning"):
                self.errors.append(json.dumps(facts["args"])[:500])
            case "Log.entryAdded" if facts["entry"]["level"] in ("error", "warning"):
                self.errors.append(facts["entry"]["text"])
            case "Network.requestWillBeSent":
                self.asked.append(facts["request"]["url"])

    def open(self, url: str) -> None:
        """Opens an address, also if only its fragment is another one."""
        self.call("Page.navigate", url="about:blank")
        self.call("Page.navigate", url=url)

    def reload(self) -> None:
        """Reloads the page, and waits until the one before is gone."""
        self.run("window.isBefore = true")
        self.call("Page.reload")
        self.until("!window.isBefore && document.readyState === 'complete'")

    def run(self, script: str) -> Any:
        """Value of a JavaScript expression, promises awaited."""
        found = self.call(
            "Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True
        )
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def until(self, script: str, timeout: float = 60) -> Any:
        """Waits until a JavaScript expression is true, and returns its value."""
        end = time.monotonic() + timeout
        while not (value := self.run(script)):
            assert time.monotonic() < end, f"never true: {script}"
            time.sleep(0.02)
        return value

    def place(self, selector: str) -> tuple[float, float]:
        """Middle of an element that is scrolled into view, CSS px."""
        box = self.run(
            f"(() => {{ const e = document.querySelector({json.dumps(selector)});"
            "e.scrollIntoView({block: 'center'}); const b = e.getBoundingClientRect();"
            "return [b.left + b.width / 2, b.top + b.height / 2]; })()"
        )
        return float(box[0]), float(box[1])

    def mouse(self, kind: str, x: float, y: float, **more: Any) -> None:
        """Sends an event of the mouse."""
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def drag(self, selector: str, dx: float, dy: float = 0.0) -> None:
        """Drags an element by its middle."""
        x, y = self.place(selector)
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        for t in (0.3, 0.6, 1.0):
            self.mouse("mouseMoved", x + t * dx, y + t * dy, button="left", buttons=1)
        self.mouse("mouseReleased", x + dx, y + dy, button="left", clickCount=1)

    def click(self, selector: str, dx: float = 0.0, dy: float = 0.0) -> None:
        """Clicks on an element, off its middle by (dx, dy) CSS px."""
        x, y = self.place(selector)
        self.mouse("mousePressed", x + dx, y + dy, button="left", buttons=1, clickCount=1)
        self.mouse("mouseReleased", x + dx, y + dy, button="left", clickCount=1)

    def wheel(self, selector: str, dy: float) -> None:
        """Turns the mouse's wheel over an element."""
        x, y = self.place(selector)
        self.mouse("mouseWheel", x, y, deltaX=0, deltaY=dy)

    def swipe(self, selector: str, dx: float) -> None:
        """Moves a finger across an element."""
        x, y = self.place(selector)
        self.call("Input.dispatchTouchEvent", type="touchStart", touchPoints=[{"x": x, "y": y}])
        for t in (0.2, 0.4, 0.6, 0.8, 1.0):
            point = {"x": x + t * dx, "y": y}
            self.call("Input.dispatchTouchEvent", type="touchMove", touchPoints=[point])
        self.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def press(self, key: str) -> None:
        """Presses a key and lets it go."""
        code = KEYS.get(key, ord(key[0].upper()))
        facts = {"key": key, "code": key, "windowsVirtualKeyCode": code}
        self.call("Input.dispatchKeyEvent", type="keyDown", **facts)
        self.call("Input.dispatchKeyEvent", type="keyUp", **facts)

    def size(self, width: int, height: int, *, touch: bool = False) -> None:
        """Sets the window's size, CSS px, and whether it is a touch screen."""
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width, height=height, deviceScaleFactor=1, mobile=touch,
        )  # fmt: skip
        self.call("Emulation.setTouchEmulationEnabled", enabled=touch)

    def screenshot(self, path: Path) -> None:
        """Writes a picture of the window."""
        found = self.call("Page.captureScreenshot", format="png")
        path.write_bytes(base64.b64decode(found["data"]))

    def offline(self, offline: bool) -> None:
        """Cuts the page's network, or mends it."""
        self.call(
            "Network.emulateNetworkConditions",
            offline=offline, latency=0, downloadThroughput=-1, uploadThroughput=-1,
        )  # fmt: skip


@contextlib.contextmanager
def browser(folder: Path) -> Iterator[Browser]:
    """Runs Chromium with one page; its profile is in a folder."""
    from websockets.sync.client import connect

    found = program()
    assert found is not None
    # Its sockets lie in a folder of their own, whose path must be short.
    with tempfile.TemporaryDirectory(prefix="dg-", ignore_cleanup_errors=True) as sockets:
        process = subprocess.Popen(
            [found, *FLAGS, f"--user-data-dir={folder}", "about:blank"],
            env=os.environ | {"TMPDIR": sockets},
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        try:
            with connect(_page_address(folder), max_size=None) as socket:
                page = Browser(socket)
                for domain in ("Page", "Runtime", "Log", "Network"):
                    page.call(f"{domain}.enable")
                page.size(1280, 800)
                yield page
        finally:
            process.terminate()
            process.wait(20)


def _page_address(folder: Path) -> str:
    """Address of the DevTools of the first page, once Chromium has written its port."""
    port_file = folder / "DevToolsActivePort"
    end = time.monotonic() + 60
    while time.monotonic() < end:
        with contextlib.suppress(OSError, ValueError, StopIteration, IndexError):
            port = int(port_file.read_text().split()[0])
            with urllib.request.urlopen(f"http://127.0.0.1:{port}/json/list", timeout=5) as answer:
                pages = json.load(answer)
            return str(next(p["webSocketDebuggerUrl"] for p in pages if p["type"] == "page"))
        time.sleep(0.1)
    raise AssertionError("Chromium did not start")
