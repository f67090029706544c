"""The pictures of docs/viewfinder.md: the page in Chromium at a desk, on a tablet and on a phone.

    python script/docs/viewfinder_pictures.py

Needs Chromium and the extras ``view`` and ``denoise``.
"""

from __future__ import annotations

import sys
import tempfile
import time
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
WORDS = ["night_table.glb", "--res", "900x600", "-o", "night_table.png"]
RESTS = "document.getElementById('frame')?.dataset.rests === 'true'"
QUALITY = 85


def keep(page: Browser, name: str, folder: Path) -> None:
    """Writes what the window shows as JPEG."""
    page.run("scrollTo(0, 0)")
    time.sleep(1)
    page.screenshot(folder / "window.png")
    Image.open(folder / "window.png").convert("RGB").save(
        DOCS / f"{name}.jpg", quality=QUALITY, optimize=True
    )


def main() -> None:
    """Opens the page at three sizes."""
    with tempfile.TemporaryDirectory() as name, browser(Path(name) / "profile") as page:
        folder = Path(name)
        write_scene(folder / "night_table.glb")
        scene = dg.load(folder / "night_table.glb")
        settings = dg.RenderSettings.of(resolution=(900, 600), spp=64)
        stage = Stage(scene, scene.camera(), settings)
        dials, _ = opened(stage, Dials.of(DIALS))
        with live(stage, dials, WORDS) as server:
            page.size(1440, 900)
            page.open(f"http://{server.host}/#{TOKEN}")
            page.until(RESTS, 600)
            page.click("[data-show=denoised]")
            page.until("!!document.querySelector('[data-show=denoised][aria-pressed=true]')", 60)
            keep(page, "viewfinder", folder)
            page.size(820, 1180, touch=True)
            page.click("[data-panel=rays]")
            page.click("#picture", 40, 20)
            page.until("document.getElementById('rays-drawing').src", 60)
            keep(page, "viewfinder-tablet", folder)
            page.click("[data-panel=rays]")
            page.size(390, 844, touch=True)
            keep(page, "viewfinder-phone", folder)


if __name__ == "__main__":
    main()
