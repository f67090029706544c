"""Layers of a frame by name: those of the page, their shapes, and what is said without them."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import UsageError
from daguerre.frame.aovs import TABLE, Source
from tests.support.scene import scenes

PAGE = Path(__file__).resolve().parents[2] / "docs" / "ground-truth.md"
SIZE = (12, 8)


def rows() -> dict[str, tuple[str, str]]:
    """Shape and condition of each name in the page's table."""
    part = PAGE.read_text().partition("\n## Layers by name")[2].partition("![")[0]
    found = {}
    for line in re.findall(r"^\| (`.*) \|$", part, re.MULTILINE):
        names, shape, _, condition = line.split(" | ")
        found |= dict.fromkeys(re.findall(r"`(\w+)`", names), (shape, condition))
    return found


@pytest.fixture(scope="module")
def frame() -> dg.Frame:
    return dg.render(
        scenes.lamp_room(), dg.Camera(), resolution=SIZE, spp=2, aovs=True, gt_time="mid",
        motion=True, gt_lens="mean", gt_rays=4,
    )  # fmt: skip


def test_the_page_has_every_layer() -> None:
    known = {
        n for row in TABLE if Source.ALWAYS not in row.sources for n in (row.name, *row.aliases)
    }
    assert rows().keys() == known


def test_shapes_are_those_of_the_page(frame: dg.Frame) -> None:
    width, height = SIZE
    seen = 0
    for name, (shape, condition) in rows().items():
        if "--" in condition:  # made by the command line, or by exposure
            continue
        parts = re.findall(r"\d+", shape)
        assert frame.layer(name).shape == (height, width, *map(int, parts)), name
        seen += 1
    assert seen > 10


def test_code_of_the_page_runs() -> None:
    code = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(), re.DOTALL | re.MULTILINE)[0]
    render = dg.render

    class Small:
        @staticmethod
        def render(*given: object, **more: object) -> dg.Frame:
            return render(*given, **more, resolution=SIZE, spp=1)  # type: ignore[arg-type]

    names = {"dg": Small, "scene": scenes.lamp_room(), "camera": dg.Camera()}
    exec(compile(code, "docs/ground-truth.md", "exec"), names)
    assert names["depth"].shape == SIZE[::-1]  # type: ignore[union-attr]
    assert names["normal"].shape == (*SIZE[::-1], 3)  # type: ignore[union-attr]
    assert names["flow"].shape == (*SIZE[::-1], 2)  # type: ignore[union-attr]
    assert names["picture"].dtype == np.float32  # type: ignore[union-attr]


def test_parts_are_in_their_order(frame: dg.Frame, tmp_path: Path) -> None:
    frame.save(tmp_path / "a.exr")
    for one in (frame, dg.load_frame(tmp_path / "a.exr")):  # files sort channels: B, G, R
        for name, parts in (("P", "XYZ"), ("albedo", "RGB"), ("motion", "UV")):
            stacked = np.stack([one.aovs[f"{name}.{part}"] for part in parts], axis=2)
            assert np.array_equal(one.layer(name), stacked, equal_nan=True)
    assert frame.layer("depth") is frame.aovs["depth.Z"]
    assert frame.layer("depth.Z") is frame.aovs["depth.Z"]
    assert np.array_equal(frame.layer("normal"), frame.layer("N"))


def test_an_unknown_layer_names_those_that_are_there(frame: dg.Frame) -> None:
    with pytest.raises(UsageError, match=r"P, albedo.*got 'dept' \(did you mean 'depth'"):
        frame.layer("dept")
    with pytest.raises(UsageError, match="render with aovs=True"):
        dg.Frame(frame.rgb).layer("depth")
