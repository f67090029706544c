"""Zooms between the positions that their patents give."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from daguerre import lenses
from daguerre.errors import InputError
from daguerre.lenses.errors import LensError

ZOOMS = ["nikon-ai-80-200mm-f4", "nikon-af-s-70-200mm-f2.8", "nikon-ai-25-50mm-f4"]


@pytest.mark.parametrize("name", ZOOMS)
def test_every_focal_length_can_be_had_and_stays_in_focus(name: str) -> None:
    lens = lenses.load(name)
    assert lens.zoom_range_mm is not None
    short, long = lens.zoom_range_mm
    assert lens.zoom_mm == pytest.approx(short)
    starts = [c for c in lens.configurations if c.at_infinity]
    worst = max(
        abs(at.first_order().back_focal_point - at.image_z)
        for at in (lenses.load(name, c.name) for c in starts)
    )
    for mm in np.geomspace(short, long, 12):
        zoomed = lens.at_zoom(mm)
        order = zoomed.first_order()
        assert order.efl == pytest.approx(mm, rel=1e-9)
        assert zoomed.zoom_mm == mm
        assert order.f_number == pytest.approx(zoomed.nominal.f_number, rel=1e-4)
        assert abs(order.back_focal_point - zoomed.image_z) <= worst + 1e-9
        assert all((s.thickness or 0) >= 0 for s in zoomed.surfaces)


@pytest.mark.parametrize("name", ZOOMS)
def test_it_is_exact_where_the_file_says_how_it_stands(name: str) -> None:
    lens = lenses.load(name)
    for c in lens.configurations:
        if not c.at_infinity:
            continue
        own = lenses.load(name, c.name)
        zoomed = lens.at_zoom(own.first_order().efl)
        for a, b in zip(own.surfaces, zoomed.surfaces, strict=True):
            assert a.thickness == pytest.approx(b.thickness, abs=1e-9)
            assert a.semi_diameter == pytest.approx(b.semi_diameter, rel=1e-9)


def test_gaps_move_smoothly_and_each_way_at_a_time() -> None:
    lens = lenses.load("nikon-ai-80-200mm-f4")
    assert lens.zoom_range_mm is not None
    front = [lens.at_zoom(mm).surfaces[4].thickness or 0 for mm in np.geomspace(80, 195, 20)]
    steps = [b - a for a, b in itertools.pairwise(front)]
    assert min(steps) > 0  # the variator never turns back
    assert max(steps) < 2.5 * min(steps)


def test_a_printed_end_is_the_end_and_more_is_refused() -> None:
    lens = lenses.load("nikon-af-s-70-200mm-f2.8")
    assert lens.at_zoom(196.0).first_order().efl == pytest.approx(196, rel=1e-4)
    for mm in (60.0, 300.0):
        with pytest.raises(LensError, match=r"zoom: wanted 71\.5 to 196 mm") as caught:
            lens.at_zoom(mm)
        assert caught.value.code == "lens-zoom"
    prime = lenses.load("tessar-50mm-f2.8")
    assert prime.zoom_range_mm is None
    assert prime.at_zoom(50).first_order().efl == pytest.approx(50, rel=1e-3)
    with pytest.raises(
        InputError, match=r"zoom: wanted 50 mm .this lens is not a zoom., got 60 mm"
    ):
        prime.at_zoom(60)


def test_the_image_of_the_middle_is_as_sharp_as_at_the_ends() -> None:
    lens = lenses.load("nikon-af-s-70-200mm-f2.8")
    for mm in (71.5, 100.0, 160.0, 196.0):
        zoomed = lens.at_zoom(mm)
        order = zoomed.first_order()
        y = np.linspace(-0.4, 0.4, 21) * order.entrance_pupil.diameter
        points = zoomed.trace(
            np.stack([0 * y, y, 0 * y - 20], axis=1), [0, 0, 1], image_z=order.back_focal_point
        )
        assert np.abs(points[:, 1]).max() < 5e-4 * mm
