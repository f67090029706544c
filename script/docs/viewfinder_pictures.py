"""The pictures of docs/viewfinder.md: the page in Chromium at five sizes, and rings that turn.

    python script/docs/viewfinder_pictures.py

Needs Chromium and the extras ``view`` and ``denoise``.
"""

from __future__ import annotations

import contextlib
import io
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from PIL import Image

import daguerre as dg
from daguerre.cli.demo import write_scene
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.opening import opened
from daguerre.viewfinder.stage import Stage

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.viewfinder.chromium import Browser, browser
from tests.viewfinder.live import TOKEN, live

DOCS = Path("docs")
DIALS = {"lens": "double-gauss-50mm-f2", "f_stop": "2"}
#: Size and samples of the picture on the five screens, and in the animation.
STILL, MOVING = ((900, 600), 64), ((480, 320), 6)
RESTS = "document.getElementById('frame')?.dataset.rests === 'true'"
QUALITY = 85

#: Rings that the animation turns, with steps to the right; each goes back the same way.
TURNS = {"focus_distance": 9, "f_stop": 9, "iso": 6}
#: Window of the animation, its size in the docs, and how long each frame stays, ms.
WINDOW, SHOWN, FRAME_MS = (1200, 750), (720, 450), 180
ANIMATION_QUALITY = 40


def window(page: Browser, folder: Path) -> Image.Image:
    """Returns what the window shows."""
    page.screenshot(folder / "window.png")
    return Image.open(io.BytesIO((folder / "window.png").read_bytes())).convert("RGB")


def keep(page: Browser, name: str, folder: Path) -> None:
    """Writes what the window shows as JPEG."""
    page.run("scrollTo(0, 0)")
    time.sleep(1)
    path = DOCS / f"{name}.jpg"
    window(page, folder).save(path, quality=QUALITY, optimize=True)
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")


def frames_of_turns(page: Browser, folder: Path) -> Iterator[Image.Image]:
    """Turns rings by the keyboard, and yields the window at each picture at rest."""
    for name, steps in TURNS.items():
        page.run(f"document.getElementById('ring-{name}').focus()")
        for key in ["ArrowRight"] * steps + ["ArrowLeft"] * steps:
            page.press(key)
            time.sleep(0.1)
            page.until(RESTS, 600)
            yield window(page, folder).resize(SHOWN, Image.Resampling.LANCZOS)


def animate(page: Browser, folder: Path) -> None:
    """Writes an animated picture of turning rings."""
    first, *others = frames_of_turns(page, folder)
    path = DOCS / "viewfinder.webp"
    first.save(
        path, save_all=True, append_images=others, duration=FRAME_MS, loop=0,
        quality=ANIMATION_QUALITY, method=6, minimize_size=True,
    )  # fmt: skip
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")


def screens(page: Browser, folder: Path) -> None:
    """Writes the page at five sizes."""
    for name, size in (("viewfinder", (1440, 900)), ("viewfinder-wide", (1920, 1080))):
        page.size(*size)
        keep(page, name, folder)
    page.size(820, 1180, touch=True)
    page.click("[data-panel=rays]")
    page.click("#picture", 40, 20)
    page.until("document.getElementById('rays-drawing').src", 60)
    keep(page, "viewfinder-tablet", folder)
    page.click("[data-panel=rays]")
    for name, size in (("phone", (390, 844)), ("phone-landscape", (844, 390))):
        page.size(*size, touch=True)
        keep(page, f"viewfinder-{name}", folder)


@contextlib.contextmanager
def shown(page: Browser, file: Path, size: tuple[int, int], spp: int) -> Iterator[None]:
    """Opens the page of a scene in a window for a desk, denoised, with its picture at rest."""
    scene = dg.load(file)
    stage = Stage(scene, scene.camera(), dg.RenderSettings.of(resolution=size, spp=spp))
    dials, _ = opened(stage, Dials.of(DIALS))
    words = [file.name, "--res", f"{size[0]}x{size[1]}", "-o", f"{file.stem}.png"]
    with live(stage, dials, words) as server:
        page.size(*WINDOW)
        page.open(f"http://{server.host}/#{TOKEN}")
        page.until(RESTS, 600)
        page.click("[data-show=denoised]")
        page.until("!!document.querySelector('[data-show=denoised][aria-pressed=true]')", 60)
        time.sleep(2)
        yield


def main() -> None:
    """Opens the page and writes its pictures."""
    with tempfile.TemporaryDirectory() as name, browser(Path(name) / "profile") as page:
        folder = Path(name)
        file = folder / "night_table.glb"
        write_scene(file)
        with shown(page, file, *STILL):
            screens(page, folder)
        with shown(page, file, *MOVING):
            animate(page, folder)


if __name__ == "__main__":
    main()
