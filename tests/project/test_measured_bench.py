"""The bench of measured products: its conventions, its data, and a glass of another colour."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.polynomial.polynomial import polyfit

from daguerre import lenses
from daguerre.lenses.glasses.catalogue import LINE_C, LINE_D, LINE_F
from daguerre.lenses.medium import Medium
from tests.support.lenses.line_glass import on_the_line

ROOT = Path(__file__).resolve().parents[2]
BENCH, DATA = ROOT / "bench", ROOT.parent / "shared" / "data" / "reality"
G_LINE, NM = 435.8343, np.arange(380.0, 781.0, 5.0)
NAMES = ("canon-ef-85mm-f1.8", "tessar-50mm-f2.8")


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(str(BENCH))
    import measured

    return measured


def run(*flags: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(BENCH / "measured.py"), *flags]
    return subprocess.run(command, capture_output=True, text=True)


def test_agrees_with_an_independent_evaluation(bench: Any) -> None:
    """The data has errors of two lenses, computed with another program and glass on the line."""
    if not DATA.is_dir():
        pytest.skip("no measured lenses at ../shared/data/reality")
    found = json.loads(run("--json", "--lens", *NAMES).stdout)
    stated = json.loads((DATA / "lens_measured.json").read_text())["lenses"]
    for one in (one for one in stated if one["lens"] in NAMES):
        mine = {
            name: [r for r in found[name] if r["product"] == one["product"]]
            for name in ("distortion", "vignetting")
        }
        shapes = [c["rms_px"] for c in one["curves"]["distortion_percent"]]
        assert [r["px"] for r in mine["distortion"]] == pytest.approx(shapes, abs=0.03)
        before = one["baseline"]
        on_line = colour_on_the_line(bench, one["product"])
        for channel in ("red", "blue"):
            known = before[f"lateral_{channel}_rms_px"]
            assert [r[f"{channel}_px"] for r in on_line] == pytest.approx(known, abs=0.06)
        errors_ev = {r["f_stop"]: r["ev"] for r in mine["vignetting"]}
        for _, f_stop, distance, ev, *_ in before["vignetting_rms_ev"]:
            assert distance < 1000 or errors_ev[f_stop] == pytest.approx(ev, abs=0.03)
    assert found["summary"]["errors"] == 0
    assert {r["lens"] for r in found["magnification"]} == {NAMES[0]}


def colour_on_the_line(bench: Any, product: str) -> list[dict[str, Any]]:
    """Lateral colour of a product, predicted with glass on the normal line."""
    (one,) = [c for c in bench.calibrations(DATA)[0] if c.product == product]
    on_line = replace(one, lens=on_the_line(one.lens))
    return [bench.colour(on_line, terms) for terms in one.lateral_colour]


def test_without_data() -> None:
    done = run("--data", str(BENCH))
    assert done.returncode == 3
    assert "--data: wanted a folder with lens_measured.json" in done.stderr


def test_lens_without_measurements(
    bench: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(bench, "calibrations", lambda folder: ([], "made up"))
    monkeypatch.setattr(sys, "argv", ["measured.py", "--lens", "petzval"])
    with pytest.raises(SystemExit, match="2"):
        bench.main()
    assert "--lens: wanted a lens with measurements, got petzval" in capsys.readouterr().err


def test_without_data_and_package(
    bench: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    import measured_products

    monkeypatch.setattr(measured_products, "SHARED", tmp_path)
    monkeypatch.setitem(sys.modules, "lensfunpy", None)
    with pytest.raises(bench.DaguerreError, match="or the package lensfunpy"):
        measured_products.calibrations(None)


def test_package_has_the_numbers_of_the_file(bench: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    import measured_products

    pytest.importorskip("lensfunpy", reason="lensfunpy is not installed")
    if not DATA.is_dir():
        pytest.skip("no measured lenses at ../shared/data/reality")
    of_file = {(c.product, c.unit_mm): c for c in measured_products.calibrations(DATA)[0]}
    monkeypatch.setattr(measured_products, "SHARED", BENCH)
    of_package, source = measured_products.calibrations(None)
    assert source.startswith("lensfunpy")
    assert len(of_package) > 10
    for one in of_package:
        heights, _ = one.heights(5)
        (other,) = [c for (name, unit), c in of_file.items() if same(one, name, unit)]
        for evaluated, *both in (
            (one.undistorted, one.distortion, other.distortion),
            (partial(one.colour, channel="b"), one.lateral_colour, other.lateral_colour),
            (one.illumination, one.vignetting, other.vignetting),
        ):
            for mine, theirs in zip(*both, strict=True):
                expected = evaluated(theirs, heights_mm=heights)
                assert evaluated(mine, heights_mm=heights) == pytest.approx(expected, abs=1e-5)


def same(one: Any, product: str, unit_mm: float) -> bool:
    return bool(one.product == product and math.isclose(one.unit_mm, unit_mm, rel_tol=0.01))


def made_up(bench: Any, lens: str, **terms: Any) -> Any:
    """A calibration of a frame of 36 x 24 mm."""
    names = ("distortion", "lateral_colour", "vignetting")
    given = {name: tuple(terms.get(name, ())) for name in names}
    return bench.Calibration(lens, "made up", "A", (3.0, 2.0), 0.5 * math.hypot(36, 24), **given)


def test_frame(bench: Any) -> None:
    one = made_up(bench, "double-gauss-50mm-f2")
    assert one.unit_mm == pytest.approx(12)
    assert one.pixel_mm == pytest.approx(6e-3)
    heights, area = one.heights(bench.POINTS)
    mean = float((area * heights**4).sum() / area.sum())
    assert mean == pytest.approx(18**4 / 5 + 2 * (18 * 12) ** 2 / 9 + 12**4 / 5, rel=0.02)


@pytest.mark.parametrize(
    "terms",
    [
        {"model": "ptlens", "a": 0.01, "b": -0.03, "c": 0.02},
        {"model": "poly3", "k1": -0.02},
        {"model": "poly5", "k1": -0.02, "k2": 0.003},
    ],
)
def test_distortion_is_undone(bench: Any, terms: dict[str, Any]) -> None:
    one = made_up(bench, "double-gauss-50mm-f2")
    heights = np.linspace(0, 21, 8)
    r = one.undistorted(terms, heights) / 12
    factors = {
        "ptlens": lambda: 0.01 * r**3 - 0.03 * r**2 + 0.02 * r + 1,
        "poly3": lambda: 1.02 - 0.02 * r**2,
        "poly5": lambda: 1 - 0.02 * r**2 + 0.003 * r**4,
    }
    assert 12 * r * factors[terms["model"]]() == pytest.approx(heights, abs=1e-9)


@pytest.mark.parametrize("name", ["double-gauss-50mm-f2", *NAMES])
def test_glass_of_another_colour_is_seen(bench: Any, name: str) -> None:
    """One glass after the other is swapped for one of the same nd and Vd, 0.01 away in P_gF."""
    lens = lenses.load(name)
    one, terms = as_predicted(bench, name)
    before = bench.colour(one, terms)
    assert before["blue_px"] < 0.02
    assert before["red_px"] < 0.02
    glasses = [i for i, s in enumerate(lens.surfaces) if s.medium.formula != "constant"]
    assert len(glasses) >= 4
    for i in glasses:
        surfaces = list(lens.surfaces)
        surfaces[i] = replace(surfaces[i], medium=bluer(surfaces[i].medium, 0.01))
        after = bench.colour(replace(one, lens=lens.rebuilt(surfaces)), terms)
        axial = abs(after["axial_g_um"] - before["axial_g_um"])
        assert after["blue_px"] > before["blue_px"] + 0.05 or axial > 5, (i, after["blue_px"])


def as_predicted(bench: Any, name: str) -> tuple[Any, dict[str, Any]]:
    """A calibration that says what the bench predicts for a lens."""
    one = made_up(bench, name)
    heights, _ = one.heights(bench.POINTS)
    shifts = bench.predicted_colour(bench.placed(lenses.load(name), 8.0), heights)
    terms: dict[str, Any] = {"model": "poly3", "focal": 50.0}
    for channel, mm in shifts.items():
        v, c, b = polyfit(heights / 12, mm / heights, 2)
        terms |= {f"v{channel}": 1 + v, f"c{channel}": c, f"b{channel}": b}
    return one, terms


def bluer(glass: Medium, more: float) -> Medium:
    """A glass whose partial dispersion P_gF is larger, and nd and Vd are the same."""

    def bend(nm: Any) -> Any:
        return (nm - LINE_F) * (nm - LINE_D) * (nm - LINE_C)

    spread = glass.index(LINE_F) - glass.index(LINE_C)
    n = [glass.index(nm) + more * spread * bend(nm) / bend(G_LINE) for nm in NM]
    return Medium("table", (tuple(NM), tuple(n)))
