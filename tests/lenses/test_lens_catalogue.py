"""The page of the lens library: every lens of the library, with the numbers of its index."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from daguerre import lenses
from daguerre.lenses import library
from daguerre.plots.lens_section import Drawing, Line, Polygon

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "lens-library.md").read_text(encoding="utf-8")


def module(monkeypatch: pytest.MonkeyPatch, name: str) -> ModuleType:
    monkeypatch.syspath_prepend(str(ROOT / "script" / "docs" / "lenses"))
    return __import__(name)


def numbers(text: str) -> list[float]:
    return [float(number) for number in re.findall(r"\d+\.?\d*", text)]


def test_every_lens_has_its_section_and_its_numbers() -> None:
    sections = {part.split("\n", 1)[0]: part for part in PAGE.split("\n### ")[1:]}
    assert set(sections) == set(library.names()), "run script/docs/make-lens-catalogue"
    for entry in library.entries():
        text = sections[entry.name]
        assert f"**{entry.title}** ({entry.year})" in text
        assert entry.patent in text
        assert entry.remark.lower() in text.lower()
        assert entry.also in text
        focal, rest = text.split("Focal length ")[1].split(" mm, back focus ")
        back, rest = rest.split(" mm, f/")
        stop = rest.split(f". {entry.patent}")[0]
        known = [entry.efl_mm, entry.efl_stated, entry.efl_long_mm, entry.efl_long_stated]
        for found, values in (
            (focal, known),
            (back, [entry.bfl_mm, entry.bfl_stated]),
            (stop, [entry.f_number, entry.f_stated]),
        ):
            given = [value for value in values if value is not None]
            assert numbers(found) == pytest.approx(given, rel=1e-5), entry.name


def test_pictures_and_links_of_the_page_exist() -> None:
    shown = set(re.findall(r"!\[\w+\]\(([^)]*)\)", PAGE))
    for entry in library.entries():
        assert f"lenses/drawings/{entry.name}.svg" in shown
        assert f"../python/daguerre/lenses/library/photographs/{entry.name}.webp" in shown
    for name in shown:
        assert (ROOT / "docs" / name).stat().st_size < 40_000


def test_the_page_is_up_to_date(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    make = str(ROOT / "script" / "docs" / "lenses" / "catalogue.py")
    subprocess.run([sys.executable, make, "--page", str(page)], check=True)
    assert page.read_text(encoding="utf-8") == PAGE, "run script/docs/make-lens-catalogue"


def test_the_package_has_a_small_photograph_of_each_lens() -> None:
    sizes = {path.name: path.stat().st_size for path in library.PHOTOGRAPHS.iterdir()}
    assert set(sizes) == {f"{name}.webp" for name in library.names()}
    assert sum(sizes.values()) < 1_100_000


def test_a_small_drawing_keeps_its_curves(monkeypatch: pytest.MonkeyPatch) -> None:
    drawings = module(monkeypatch, "drawings")
    arc = [(0.01 * k * k, float(k)) for k in range(-20, 21)]
    shapes: list[Line | Polygon] = [Line([(0, 0), (1, 0), (5, 0)], "#999999", 1), Polygon(arc)]
    text = drawings.small(Drawing("a < b", 0, 100, 25, shapes))
    paths = [part.split('"', 1)[0] for part in text.split(' d="')[1:]]
    assert paths[0].count("l") == 1
    assert len(paths[0].replace("-", " -").split()) == 3  # straight: two points are enough
    assert 8 < len(paths[1].split()) < 60
    assert paths[1].endswith("z")
    assert "a &lt; b" in text


def test_the_camera_steps_back_with_the_focal_length(monkeypatch: pytest.MonkeyPatch) -> None:
    place = module(monkeypatch, "place")
    entries = {entry.name: entry for entry in library.entries()}

    def at(name: str) -> object:
        return place.place(entries[name], lenses.load(name))

    normal, long = at("double-gauss-50mm-f2"), at("canon-ef-600mm-f4")
    assert normal.distance_m == pytest.approx(0.05 * (1 + 500 / 24), rel=1e-3)
    assert long.distance_m / normal.distance_m == pytest.approx(587.93 / 50, rel=2e-3)
    assert normal.resolution == (300, 200)
    assert at("olympus-zuiko-fisheye-8mm-f2.8").distance_m == 0.3
    squeezed = at("schneider-anamorphic-60mm")
    assert squeezed.resolution[0] == squeezed.size[0] == 300
    assert squeezed.resolution[1] / squeezed.size[1] == pytest.approx(60.5 / 31, rel=0.02)
    zoom = at("nikon-af-s-70-200mm-f2.8")
    assert zoom.lens.zoom_mm == pytest.approx((71.5 * 196) ** 0.5)
