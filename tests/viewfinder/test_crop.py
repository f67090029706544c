"""A crop: previews show it, and its points are those of the whole picture."""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.stage import Stage
from tests.viewfinder.chromium import Browser, program

from .live import TOKEN, live, page
from .test_painter import scene

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")
SIZE = (320, 240)
CROP = (160, 60, 280, 220)
RESTS = "document.getElementById('frame')?.ariaBusy === 'false'"


def stage() -> Stage:
    made = scene()
    settings = dg.RenderSettings.of(resolution=SIZE, crop=CROP, spp=2)
    return Stage(made, made.camera(), settings)


def test_a_preview_shows_the_part() -> None:
    shot = stage().shot(Dials())
    assert shot.window == CROP
    assert shot.smaller(2).window == (80, 30, 140, 110)
    assert shot.by_model("pinhole", 2, 1).window == (80, 30, 140, 110)


def test_the_loupe_reads_the_pixel_of_the_whole_picture() -> None:
    with live(stage()) as server, page(server) as one:
        one.until_rest(0)
        one.send(probe=[180, 80])
        one.send(probe=[10, 50])
        while len(one.values) < 2:
            one.step()
        frame = server.hub.picture.frame  # type: ignore[union-attr]
        assert one.open["window"] == list(CROP)
        np.testing.assert_array_equal(one.values[0]["rgb"], frame.rgb[20, 20].tolist())
        assert one.values[1] is None


@pytest.mark.skipif(program() is None, reason="needs chromium")
@pytest.mark.xdist_group("chromium")
def test_a_click_focuses_where_it_points(page: Browser) -> None:
    with live(stage()) as server:
        page.open(f"http://{server.host}/#{TOKEN}")
        page.until(RESTS)
        canvas = "document.getElementById('picture')"
        assert page.run(f"[{canvas}.width, {canvas}.height]") == [120, 160]
        page.click("#picture")
        page.until("document.getElementById('command').value.includes('focus-at')")
        assert "--focus-at=220,140" in page.run("document.getElementById('command').value")
