"""The section of a lens as pixels."""

from __future__ import annotations

import math

import numpy as np
import pytest

from daguerre import lenses
from daguerre.plots.lens_section import Drawing, Line, Polygon, section
from daguerre.plots.raster import GLASS, painted

BLACK, RED = "#000000", "#ff0000"


def _of(*shapes: Line | Polygon) -> Drawing:
    return Drawing("", -10.0, 30.0, 10.0, list(shapes))


@pytest.mark.parametrize("turn", np.linspace(0, 2 * math.pi, 9))
def test_a_line_covers_its_length_times_its_width(turn: float) -> None:
    a, b = (10 + 6 * math.cos(turn), 6 * math.sin(turn)), (10.0, 0.3)
    length = math.dist(a, b) * 400 / 40
    picture = painted(_of(Line([a, b], BLACK, 3.0)), 400)
    assert picture.shape == (200, 400, 3)
    assert (1 - picture[..., 0]).sum() == pytest.approx(3 * length, rel=0.06)  # and round ends


def test_glass_is_filled_to_its_outline_with_the_object_side_left_and_the_top_above() -> None:
    shape = Polygon([(20.0, 4.0), (28.0, 4.0), (28.0, 8.0), (20.0, 8.0)], RED, RED)
    picture = painted(_of(shape), 400)
    green = picture[..., 1]
    assert picture[40, 340] == pytest.approx([1, 1 - GLASS, 1 - GLASS])
    inside = np.zeros((200, 400), bool)
    inside[20:60, 300:380] = True
    assert (green[~inside] == 1).mean() > 0.99
    full = GLASS * 40 * 80 + (1 - GLASS) * 2 * (40 + 80) / 2 + 2 * (40 + 80) / 2
    assert (1 - green).sum() == pytest.approx(full, rel=0.02)


def test_a_ring_of_two_turns_is_filled_by_parity() -> None:
    inner = [(10 + 2 * x, 2 * y) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1))]
    outer = [(10 + 6 * x, 6 * y) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1))]
    picture = painted(_of(Polygon([*outer, *inner], RED, RED)), 400)
    assert picture[100, 200].tolist() == [1, 1, 1]
    assert picture[100, 240] == pytest.approx([1, 1 - GLASS, 1 - GLASS])


def test_what_lies_outside_of_the_window_or_has_no_place_is_left_out() -> None:
    far = Line([(-1e9, -1e9), (-1e8, -1e9)], BLACK, 2.0)
    nowhere = Line([(math.nan, 0.0), (5.0, 0.0)], BLACK, 2.0)
    assert (painted(_of(far, nowhere), 100) == 1).all()


def test_a_lens_has_glass_in_the_middle_and_its_film_at_the_right() -> None:
    lens = lenses.load("double-gauss-50mm-f2")
    drawing = section(lens)
    picture = painted(drawing)
    assert max(picture.shape) == 512
    span = drawing.right - drawing.left
    at = [int((z - drawing.left) / span * 512) for z in (lens.vertices[0] + 1, lens.image_z)]
    row = int(0.45 * len(picture))
    assert picture[row, at[0], 2] > picture[row, at[0], 0]  # bluish
    assert picture[:, at[1]].mean() < 0.5  # the dark film
