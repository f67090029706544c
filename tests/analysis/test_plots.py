"""``result.plot()``: what it draws, where, and what it says without matplotlib."""

from __future__ import annotations

import inspect
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import analysis, lenses
from daguerre.analysis.ghosts import Ghosts
from daguerre.analysis.plotted import Plotted, Sectioned
from daguerre.errors import UsageError
from daguerre.files import extras
from daguerre.plots.results import DRAWERS

pyplot = pytest.importorskip("matplotlib.pyplot", reason="plots are drawn by matplotlib")
pyplot.switch_backend("agg")
from daguerre.plots.figure import Plot  # noqa: E402  # it needs matplotlib

PAGE = Path(__file__).resolve().parents[2] / "docs" / "lens-bench.md"
HEIGHTS = np.linspace(0, 10, 5)


@pytest.fixture(scope="module")
def results() -> dict[type, Any]:
    bench = analysis.set_up(lenses.load("tessar-50mm-f2.8"), f_stop=8)
    light = analysis.pencil(bench, 10.0)
    assert light is not None
    found = [
        bench, light, analysis.spot(light, grid=12),
        analysis.point_spread(light, pixels=16), analysis.wavefront(light, grid=24),
        analysis.seidel_sums(bench), analysis.relative_illumination(bench, HEIGHTS, grid=12),
        analysis.field_curvature(bench, HEIGHTS), analysis.distortion(bench, HEIGHTS),
        analysis.modulation_transfer(light, [0, 10, 20]), Ghosts(bench, 15.0, rays=64),
        dg.calibrate("tessar-50mm-f2.8", resolution=(60, 40)),
    ]  # fmt: skip
    return {type(one): one for one in found}


def title(axes: Any) -> str:
    found: str = axes.get_title(loc="left") or axes.get_title()
    return found


def test_every_result_has_a_drawing(results: dict[type, Any]) -> None:
    assert results.keys() == DRAWERS.keys()
    public = [getattr(analysis, name) for name in analysis.__all__]
    plotted = {one for one in public if inspect.isclass(one) and issubclass(one, Plotted)}
    assert plotted - {analysis.Figures} <= DRAWERS.keys()
    assert len(plotted) >= 8


@pytest.mark.parametrize("kind", DRAWERS, ids=lambda kind: kind.__name__)
def test_a_result_fills_a_new_figure_or_given_axes(kind: type, results: dict[type, Any]) -> None:
    result = results[kind]
    figure = result.plot()
    assert figure.axes[0].has_data()
    assert title(figure.axes[0])
    assert figure._repr_png_().startswith(b"\x89PNG")
    assert pyplot.get_fignums() == []  # figures of pyplot are the user's
    mine, (left, right) = pyplot.subplots(1, 2)
    try:
        assert result.plot(right) is mine
        assert right.has_data()
        assert not left.has_data()
    finally:
        pyplot.close(mine)


def test_curves_are_the_numbers(results: dict[type, Any]) -> None:
    mtf = results[analysis.Mtf]
    lines = mtf.plot().axes[0].lines
    assert np.array_equal(lines[0].get_ydata(), mtf.waves[:, 0])
    assert np.array_equal(lines[2].get_ydata(), mtf.waves[:, 1])
    light = results[analysis.Pencil]
    assert np.array_equal(mtf.waves, analysis.diffraction_mtf(light, [0, 10, 20]))
    spot = results[analysis.Spot]
    axes = spot.plot().axes[0]
    points = np.concatenate([line.get_xydata() for line in axes.lines])
    assert len(points) == len(spot.points)
    wanted = 1e3 * np.sqrt(((spot.points - spot.centroid) ** 2).sum(axis=1).max())
    assert np.hypot(*points.T).max() == pytest.approx(wanted)
    assert f"{1e3 * spot.rms:.3g} µm" in title(axes)
    psf = results[analysis.Psf]
    (image,) = psf.plot().axes[0].images
    assert np.argmax(image.get_array()) == np.argmax(np.asarray(psf))


def test_names_of_lenses_are_plain_text(results: dict[type, Any]) -> None:
    bench = results[analysis.Bench]
    odd = replace(bench, lens=replace(bench.lens, name=r"50 mm $\frac$"))
    assert odd.plot()._repr_png_()
    assert Ghosts(odd, 15.0, rays=64).plot()._repr_png_()


def test_a_notebook_shows_sections_without_matplotlib(
    results: dict[type, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(extras, "missing", lambda module: True)
    for kind, result in results.items():
        if issubclass(kind, Sectioned):
            assert result._repr_svg_().startswith("<svg")
        else:
            assert result._repr_png_() is None
        with pytest.raises(UsageError, match=r"plot: needs the package matplotlib.*plot"):
            result.plot()


def test_a_notebook_shows_plots(results: dict[type, Any]) -> None:
    assert results[analysis.Spot]._repr_png_().startswith(b"\x89PNG")


def test_axes_are_axes(results: dict[type, Any]) -> None:
    for result in results.values():
        with pytest.raises(UsageError, match=r"plot: axes: wanted .*got 3"):
            result.plot(3)


def test_a_data_sheet_is_a_page(results: dict[type, Any]) -> None:
    made = analysis.data_sheet(results[analysis.Bench], psf_pixels=16)
    page = made.plot()
    assert len(page.axes) > 20
    with pytest.raises(UsageError, match="fills a page"):
        made.plot(page.axes[0])


def test_code_of_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    opened: list[Any] = []
    monkeypatch.setattr(Plot, "show", lambda self: opened.append(self))
    monkeypatch.setattr(analysis, "data_sheet", lambda bench: bench)  # it takes seconds
    code = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(), re.DOTALL | re.MULTILINE)
    names: dict[str, Any] = {}
    try:
        for block in code:
            exec(compile(block, PAGE.name, "exec"), names)
        assert names["left"].get_title(loc="left") or names["left"].get_title()
    finally:
        pyplot.close("all")
    assert Path("spot.pdf").read_bytes().startswith(b"%PDF")
    assert [type(one) for one in opened] == [Plot]
