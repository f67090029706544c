"""A scene whose files change: the page offers to load it again, and shows the new content."""

from __future__ import annotations

import contextlib
import io
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from daguerre import cli
from daguerre.lenses.library import FOLDER
from daguerre.viewfinder import run, watch

from .chromium import Browser, browser, program
from .live import TOKEN, Live, Page, live, page

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")
pytest.importorskip("pxr")

LENS = "double-gauss-50mm-f2.json"
ROOT = """#usda 1.0
(
    metersPerUnit = 1
    subLayers = [@./layer.usda@]
)
def Camera "c"
{
    float focalLength = 0.5
    float horizontalAperture = 0.36
    float verticalAperture = 0.24
    double3 xformOp:translate = (0, 0, 3)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}
"""
LAYER = """#usda 1.0
def Mesh "m" (
    prepend apiSchemas = ["MaterialBindingAPI"]
)
{
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    point3f[] points = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (interpolation = "vertex")
    rel material:binding = </M>
}
def Material "M"
{
    token outputs:surface.connect = </M/S.outputs:surface>
    def Shader "S"
    {
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor.connect = </M/T.outputs:rgb>
        token outputs:surface
    }
    def Shader "T"
    {
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @./wood.png@
        float4 inputs:fallback = (0, 0, 0, 1)
        float3 outputs:rgb
    }
}
"""


def _png(value: int) -> bytes:
    image = pytest.importorskip("PIL.Image")
    with io.BytesIO() as stream:
        image.new("RGB", (4, 4), (value, value, value)).save(stream, "PNG")
        return stream.getvalue()


def _hdr(value: int) -> bytes:
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + bytes((value, 90, 90, 129)) * 32


@dataclass
class _Shown:
    folder: Path
    server: Live


@pytest.fixture
def shown(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[_Shown]:
    """The server of ``daguerre view`` for a stage; its picture is missing at first."""
    (tmp_path / "root.usda").write_text(ROOT)
    (tmp_path / "layer.usda").write_text(LAYER)
    (tmp_path / "sky.hdr").write_bytes(_hdr(90))
    (tmp_path / LENS).write_bytes((FOLDER / LENS).read_bytes())
    opened: list[Any] = []
    monkeypatch.setattr(run, "run", lambda *given: opened.append(given) or 0)
    monkeypatch.setattr(watch, "_LOOK_S", 0.05)
    monkeypatch.setattr(watch, "_LOOKS", 10_000)
    words = ("--env", "sky.hdr", "--lens", LENS, "--res", "60x40", "--spp", "4", "--f-stop", "4")
    monkeypatch.chdir(tmp_path)
    assert cli.main(["view", "root.usda", *words, "--exposure", "light"]) == 0
    stage, dials, rest, *_ = opened[0]
    with live(stage, dials, rest) as server:
        yield _Shown(tmp_path, server)


def _until_changed(one: Page, names: list[str]) -> None:
    while one.changed != names:
        one.step()


def _hear(one: Page) -> None:
    """Takes messages until none comes for many looks at the files."""
    with contextlib.suppress(TimeoutError):
        while True:
            one.step(0.5)


def _edits() -> list[tuple[str, bytes]]:
    lens = json.loads((FOLDER / LENS).read_bytes())
    lens["surfaces"][0]["radius"] *= 1.3
    return [
        ("wood.png", _png(100)),
        ("wood.png", _png(200)),
        ("root.usda", ROOT.replace("(0, 0, 3)", "(0, 0, 9)").encode()),
        ("layer.usda", LAYER.replace("(1, 1, 0)", "(0.2, 0.2, 0)").encode()),
        ("sky.hdr", _hdr(190)),
        (LENS, json.dumps(lens).encode()),
    ]


@pytest.mark.parametrize("mode", ["light", "P"])
def test_every_file_that_the_scene_reads_is_watched_and_loaded_again(
    shown: _Shown, mode: str
) -> None:
    with page(shown.server) as one:
        one.until_rest(0)
        one.send(turn={"iso": "200", "exposure": mode})
        one.until_rest(1)
        before, began = one.bytes, one.state["dials"]
        for turn, (name, data) in enumerate(_edits(), 2):
            (shown.folder / name).write_bytes(data)
            _until_changed(one, [name])
            one.send(reload=True)
            one.until_rest(turn)
            _until_changed(one, [])
            assert one.bytes != before, name
            assert one.state["dials"] == began
            before = one.bytes
        assert one.refused == []


def test_a_scene_that_no_longer_loads_leaves_the_picture(shown: _Shown) -> None:
    with page(shown.server) as one:
        one.until_rest(0)
        (shown.folder / "layer.usda").write_text("#usda 1.0\ndef (((")
        _until_changed(one, ["layer.usda"])
        one.send(reload=True)
        while not one.refused:
            one.step()
        assert "root.usda" in one.refused[0]
        one.send(turn={"iso": "200"})
        one.until_rest(1)
        assert one.changed == ["layer.usda"]
        (shown.folder / "layer.usda").write_text(LAYER)
        one.send(reload=True)
        one.until_rest(2)
        _until_changed(one, [])
        assert len(one.refused) == 1


def test_a_lens_that_no_longer_loads_leaves_the_picture(shown: _Shown) -> None:
    stage = shown.server.hub._stage
    with page(shown.server) as one:
        one.until_rest(0)
        (shown.folder / LENS).write_text("{}")
        _until_changed(one, [LENS])
        one.send(reload=True)
        while not one.refused:
            one.step()
        assert LENS in one.refused[0]
        assert shown.server.hub._stage is stage


def test_a_page_that_comes_later_is_offered_it_too(shown: _Shown) -> None:
    with page(shown.server) as one:
        (shown.folder / "sky.hdr").write_bytes(_hdr(190))
        (shown.folder / "layer.usda").write_text(LAYER + "\n")
        _until_changed(one, ["layer.usda", "sky.hdr"])
        with page(shown.server) as other:
            _until_changed(other, ["layer.usda", "sky.hdr"])


def test_a_file_that_changes_again_is_offered_again(
    shown: _Shown, monkeypatch: pytest.MonkeyPatch
) -> None:
    with page(shown.server) as one:
        one.until_rest(0)
        (shown.folder / "sky.hdr").write_bytes(_hdr(190))
        _until_changed(one, ["sky.hdr"])
        monkeypatch.setattr(watch, "_LOOK_S", 1.0)
        _hear(one)
        one.send(reload=True)
        one.until_rest(1)
        (shown.folder / "sky.hdr").write_bytes(_hdr(90))
        _until_changed(one, [])
        _until_changed(one, ["sky.hdr"])


def test_a_file_that_is_away_for_a_moment_has_not_changed(shown: _Shown) -> None:
    with page(shown.server) as one:
        one.until_rest(0)
        file = shown.folder / "layer.usda"
        file.rename(shown.folder / "away.usda")
        _hear(one)
        assert one.changed == []
        (shown.folder / "away.usda").rename(file)
        _hear(one)
        assert one.changed == []


@pytest.fixture
def chromium(tmp_path: Path) -> Iterator[Browser]:
    with browser(tmp_path / "profile") as found:
        yield found


@pytest.mark.skipif(program() is None, reason="needs chromium")
@pytest.mark.xdist_group("chromium")
def test_the_page_names_what_changed(chromium: Browser, shown: _Shown) -> None:
    chromium.open(f"http://{shown.server.host}/#{TOKEN}")
    hidden = "document.getElementById('changed')?.hidden"
    text = "document.getElementById('changed')?.firstElementChild.textContent"
    rests = "document.getElementById('frame')?.dataset.rests === 'true'"
    chromium.until(rests)
    assert chromium.run(hidden)
    wanted = ["layer.usda has changed.", "layer.usda and sky.hdr have changed.",
              "layer.usda and 2 other files have changed."]  # fmt: skip
    files = [("layer.usda", LAYER.encode() + b"\n"), ("sky.hdr", _hdr(91)), ("wood.png", _png(9))]
    for (name, data), words in zip(files, wanted, strict=True):
        (shown.folder / name).write_bytes(data)
        chromium.until(f"{text} === {words!r}")
    assert not chromium.run(hidden)
    chromium.open("about:blank")
    chromium.open(f"http://{shown.server.host}/#{TOKEN}")
    chromium.until(f"{hidden} === false && {text} === {wanted[2]!r}")
    chromium.click("#reload")
    chromium.until(hidden)
