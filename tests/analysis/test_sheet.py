"""The data sheet as a file, and the drawing on it."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np
import pytest

from daguerre import analysis, lenses
from daguerre.analysis.figures import Figures, data_sheet
from daguerre.analysis.illumination import within_light
from daguerre.lenses.agreement import agreement
from daguerre.plots.lens_outline import element_outlines, sag

SVG = "{http://www.w3.org/2000/svg}"
HEADS = {"svg": b"<?xml", "png": b"\x89PNG", "pdf": b"%PDF"}


@pytest.fixture(scope="module")
def made() -> Figures:
    return data_sheet(analysis.set_up(lenses.load("tessar-50mm-f2.8"), f_stop=8), psf_pixels=32)


@pytest.mark.parametrize("kind", ["svg", "png", "pdf"])
def test_the_page_is_a_file_of_its_kind(kind: str, made: Figures) -> None:
    pytest.importorskip("matplotlib", reason="data sheets are drawn by matplotlib")
    from daguerre.plots.sheet import page

    data = page(made, kind)
    assert data.startswith(HEADS[kind])
    if kind == "svg":
        root = ElementTree.fromstring(data)
        width, height = (float(root.get(k, "0").removesuffix("pt")) for k in ("width", "height"))
        assert height / width == pytest.approx(297 / 210, rel=1e-2)


def test_the_page_shows_the_agreement_with_the_product(made: Figures) -> None:
    pytest.importorskip("matplotlib", reason="data sheets are drawn by matplotlib")
    from matplotlib.figure import Figure

    from daguerre.plots.sheet import draw_sheet

    found = str(agreement(made.bench.lens))
    assert "px" in found
    assert found in [text.get_text() for text in draw_sheet(made, Figure).texts]


def test_the_field_of_the_figures_ends_where_the_light_does() -> None:
    bench = analysis.set_up(lenses.load("tessar-50mm-f2.8"), field_mm=60.0)
    lit = within_light(bench)
    assert 20 < lit.field_mm < 45
    light = analysis.relative_illumination(bench, [0, 0.98 * lit.field_mm, 1.02 * lit.field_mm])
    assert light.relative[1] > 0.02 > light.relative[2]
    assert within_light(lit) is lit


def test_elements_are_drawn_from_their_own_diameters_with_flat_edges() -> None:
    lens = lenses.load("double-gauss-50mm-f2")
    outlines = element_outlines(lens)
    assert len(outlines) == 6
    for (points, _), surface in zip(outlines, (0, 2, 3, 6, 7, 9), strict=True):
        z, y = np.array(points).T
        both = [lens.surfaces[k].semi_diameter or 0 for k in (surface, surface + 1)]
        assert y.max() == pytest.approx(max(both))
        assert y.min() == pytest.approx(-max(both))
        # The vertices lie on it, at their places along the axis.
        for k in (surface, surface + 1):
            on_axis = np.isclose(y, 0, atol=1e-9)
            assert np.isclose(z[on_axis], lens.vertices[k]).any()


def test_a_stop_inside_glass_divides_nothing() -> None:
    lens = lenses.load("zeiss-hologon-15mm-f8")
    assert lens.surfaces[[s.stop for s in lens.surfaces].index(True)].glass
    assert len(element_outlines(lens)) == 3


def test_sags_of_conics_and_aspheres() -> None:
    plane = lenses.load("double-gauss-50mm-f2").surfaces[0]
    parabola = plane.replaced(radius=20.0, conic=-1.0, asphere={})
    assert sag(parabola, 4.0) == pytest.approx(16 / 40)
    sphere = plane.replaced(radius=-20.0, conic=0.0, asphere={4: 1e-5, 3: 1e-4})
    assert sag(sphere, 4.0) == pytest.approx(-(20 - np.sqrt(400 - 16)) + 256e-5 + 64e-4)
    assert np.isnan(sag(sphere, 21.0))
    cylinder = plane.replaced(kind="cyl-y", radius=20.0)
    assert sag(cylinder, 4.0, "y") == 0
    assert sag(cylinder, 4.0, "x") == pytest.approx(20 - np.sqrt(400 - 16))


def test_the_drawing_needs_no_package_and_has_three_fields() -> None:
    from daguerre.plots.lens_section import COLORS, draw

    root = ElementTree.fromstring(draw(lenses.load("heliar-100mm-f4")))
    strokes = [line.get("stroke") for line in root.iter(f"{SVG}polyline")]
    assert all(strokes.count(colour) >= 3 for colour in COLORS)
    assert len(list(root.iter(f"{SVG}polygon"))) == 5
