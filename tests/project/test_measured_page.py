"""The page of measured products, README's sentence and the package's figures are up to date."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from daguerre import lenses
from daguerre.lenses.agreement import FILE

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT.parent / "shared" / "data" / "reality"
DOCS = ROOT / "docs"
NUMBER = re.compile(r"[-+]?\d+\.\d+")


@pytest.fixture
def tools(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """The modules that make the page, which import each other by name."""
    monkeypatch.syspath_prepend(str(ROOT / "script" / "docs" / "measurements"))
    monkeypatch.syspath_prepend(str(ROOT / "bench"))
    pytest.importorskip("matplotlib", reason="plots are drawn by matplotlib")
    import kept
    import make
    import measured
    import tables

    yield {"kept": kept, "make": make, "measured": measured, "tables": tables}
    for name in ("kept", "make", "measured", "measured_products", "plots", "tables"):
        sys.modules.pop(name, None)


def kept_lenses() -> dict[str, Any]:
    return dict(json.loads(FILE.read_text())["lenses"])


def test_page_has_each_lens_that_the_package_has() -> None:
    found = set(re.findall(r"^\| `([\w.-]+)`", block("distortion"), re.MULTILINE))
    assert found == set(kept_lenses())
    assert found < set(lenses.names())


def test_plots_are_small() -> None:
    found = [DOCS / "measured.svg", *DOCS.glob("measured/*.svg")]
    assert len(found) == 7
    for path in found:
        assert path.stat().st_size < 400e3, path.name


def test_rows_become_figures_and_tables(tools: Any) -> None:
    rows = made_up()
    (name,) = found = tools["kept"].agreements(rows)
    expected = {"distortion_px": 2.0, "red_px": 0.2, "blue_px": 0.4, "open_ev": 0.3}
    expected |= {"stopped_ev": 0.1, "magnification": 0.12, "stated": 0.15}
    assert found[name] == {"product": "A", **expected, "fitted": []}
    texts = tools["tables"].texts(rows)
    assert texts["distortion"].splitlines()[2:] == [
        "| `tessar-50mm-f2.8` | 50 | Zeiss Tessar \\| II | -1.00 | -2.00 | 2.00 |",
        "| `tessar-50mm-f2.8` (B) | 50 | Zeiss Tessar I | -1.00 | -2.00 | 5.00 |",
    ]
    assert "| 2.8 | -1.00 | -2.00 | 0.30 | 11 | -1.00 | -2.00 | -0.10 |" in texts["light"]
    assert "| 0.15 | 0.12 | -20 % | at 0.60 m, its nearest |" in texts["magnification"]
    assert "for 2 real lenses," in tools["tables"].sentence(rows)


def test_fitted_quantities_are_marked(tools: Any) -> None:
    """The travel of a focusing group of this zoom is fitted."""
    rows = made_up()
    rows["magnification"][0]["lens"] = name = "canon-ef-11-24mm-f4"
    assert tools["kept"].fitted(name) == ["magnification"]
    assert tools["tables"].texts(rows)["magnification"].endswith("| travel fitted |")


def made_up() -> dict[str, Any]:
    """Rows of the bench: a product, and a relative that is farther off."""
    curve = {"height_mm": [10.0, 20.0], "measured": [0.0, -1.0], "predicted": [0.0, -2.0]}
    own = {"lens": "tessar-50mm-f2.8", "product": "Zeiss Zeiss Tessar | II", "match": "A"}
    own |= {"focal_mm": 50.0, "curve": curve, "red_curve": curve, "blue_curve": curve}
    relative = {**own, "product": "Zeiss Zeiss Tessar I", "match": "B"}
    near = {"lens": own["lens"], "closest_focus_m": 0.5, "at_m": 0.6}
    return {
        "distortion": [{**relative, "px": 5.0}, {**own, "px": 2.0}],
        "colour": [{**own, "red_px": 0.2, "blue_px": 0.4}],
        "vignetting": [
            {**own, "f_stop": 2.8, "kind": "open", "ev": 0.3, "corner_ev": -1.0},
            {**own, "f_stop": 11.0, "kind": "stopped", "ev": 0.1, "corner_ev": -0.1},
        ],
        "mtf": [],
        "magnification": [{**near, "magnification": 0.15, "predicted": 0.12}],
    }


@pytest.mark.slow
@pytest.mark.timeout(3000)
def test_figures_are_up_to_date(tools: Any) -> None:
    """Traces again what ``script/docs/make-measured`` traced."""
    if not DATA.is_dir():
        pytest.skip("no measured lenses at ../shared/data/reality")
    rows = tools["make"].computed(None)
    found, known = tools["kept"].agreements(rows), kept_lenses()
    assert found.keys() == known.keys()
    for name, one in found.items():
        for words in ("product", "fitted"):
            assert one.pop(words) == known[name].pop(words), name
        assert one == pytest.approx(known[name], abs=0.02, rel=0.02), name
    for name, text in tools["tables"].texts(rows).items():
        shown = block(name, DOCS / "measured.md") if name == "summary" else block(name)
        assert NUMBER.sub("", text) == NUMBER.sub("", shown.strip())
        assert numbers(text) == pytest.approx(numbers(shown), abs=0.03), name
    sentence = block("sentence", ROOT / "README.md")
    assert numbers(tools["tables"].sentence(rows)) == pytest.approx(numbers(sentence), abs=0.11)


def block(name: str, page: Path = ROOT / "bench" / "records" / "measured.md") -> str:
    """Text between the marks of a block."""
    mark = f"<!-- measured {name}: by script/docs/make-measured -->"
    return page.read_text().split(mark)[1].split("<!-- end of measured -->")[0]


def numbers(text: str) -> list[float]:
    return [float(number) for number in NUMBER.findall(text)]
