"""How lenses focus beside their products: fitted travel, and notes where the whole lens moves."""

from __future__ import annotations

import dataclasses
import json
import math
from typing import Any

import pytest

from daguerre import lenses
from daguerre.camera import Camera
from daguerre.errors import InputError
from daguerre.lenses import Lens
from daguerre.lenses.focus import closest_focus_m, path_of
from daguerre.lenses.focusing import FAR, closest, focusing, whole_lens_note
from daguerre.lenses.json_lens import lens_of
from daguerre.lenses.library import FOLDER
from daguerre.lenses.product import Product
from daguerre.scene import Scene
from daguerre.setup.camera_facts import camera_facts

FITTED = [
    path.stem
    for path in sorted(FOLDER.glob("*.json"))
    if any(one.get("fitted") for one in json.loads(path.read_text())["configurations"])
]
STANDING = "canon-ef-24-70mm-f2.8"  # all near positions are fitted
LED_ON = "sigma-28mm-f1.4"  # one is printed
WHOLE = "canon-ef-100mm-f2.8-macro"


def at_long_end(name: str) -> Lens:
    lens = lenses.load(name)
    ends = lens.zoom_range_mm
    return lens.at_zoom(ends[1]) if ends else lens


def whole(name: str, product: Product | None) -> Lens:
    """A lens without its focusing positions."""
    lens = at_long_end(name)
    at_infinity = tuple(c for c in lens.configurations if c.at_infinity)
    return lens.rebuilt(lens.surfaces, configurations=at_infinity, product=product)


@pytest.mark.parametrize("name", FITTED)
def test_a_fitted_travel_reaches_the_products_closest_focus_at_its_magnification(name: str) -> None:
    lens = at_long_end(name)
    assert lens.product is not None
    assert lens.product.closest_focus_m is not None
    assert lens.product.source
    distance, found = closest(lens, lens.product.closest_focus_m)
    assert distance == lens.product.closest_focus_m
    for by in ("paraxial", "best"):
        lens.focused(1.01 * distance, by=by, measured_from="sensor")  # type: ignore[arg-type]
    if lens.product.magnification is not None:  # the fit does not know it
        assert found == pytest.approx(lens.product.magnification, rel=0.06)


def test_many_lenses_are_fitted() -> None:
    assert len(FITTED) == 14


@pytest.mark.parametrize("by", ["paraxial", "best"])
def test_nothing_moves_at_infinity_where_all_positions_are_fitted(by: Any) -> None:
    for mm in (24.7, 50.0, 67.88):
        fitted = lenses.load(STANDING).focused(math.inf, zoom_mm=mm, by=by)
        plain = whole(STANDING, None).focused(math.inf, zoom_mm=mm, by=by)
        assert fitted.lens.surfaces == plain.lens.surfaces
        assert fitted.film_z_mm == plain.film_z_mm
        near = lenses.load(STANDING).focused(1.0, zoom_mm=mm, by=by)
        assert near.film_z_mm == pytest.approx(fitted.film_z_mm, abs=1e-6)
        assert near.lens.vertices[-1] == pytest.approx(fitted.lens.vertices[-1], abs=1e-9)


def test_fitted_positions_lead_on_beyond_the_printed_ones() -> None:
    lens = lenses.load(LED_ON)
    printed, fitted = (c for c in lens.configurations if not c.at_infinity)
    path = path_of(lens)
    assert path is not None
    assert (path.printed, path.end) == (2, 2.0)
    for way, own in ((1.0, printed), (2.0, fitted)):
        gaps = {i: path.at(way).surfaces[i].thickness for i in own.gaps}
        assert gaps == pytest.approx(own.gaps)
    kept = tuple(c for c in lens.configurations if not c.fitted)
    before = lens.rebuilt(lens.surfaces, configurations=kept)
    for distance in (math.inf, 5.0, 2.0):  # what the printed positions give keeps its bits
        a, b = lens.focused(distance), before.focused(distance)
        assert (a.lens.surfaces, a.film_z_mm) == (b.lens.surfaces, b.film_z_mm)
    assert closest_focus_m(before, from_sensor=True) > 1.2 > 0.28


def test_a_lens_that_differs_from_its_product_says_so_with_both_magnifications() -> None:
    lens = whole("tamron-70-180mm-f2.8", Product(0.85, 0.217))
    note = whole_lens_note(lens, 0.05)
    assert note == (
        "Tamron 70-180 mm f/2.8 Di III VXD focuses as a whole: magnification at 0.85 m from the "
        "sensor is 0.6x, the product's 0.22x"
    )
    moves = dataclasses.replace(lens.product, moves="two groups")  # type: ignore[type-var]
    assert str(whole_lens_note(whole("tamron-70-180mm-f2.8", moves), -0.05)).endswith(
        "0.22x; the product moves two groups"
    )


def test_a_lens_that_comes_less_near_than_its_product_says_so() -> None:
    assert whole_lens_note(lenses.load(WHOLE), 0.3) == (
        "Canon EF 100 mm f/2.8 Macro focuses as a whole, to 0.399 m from the sensor at 0.98x, its "
        "product to 0.31 m from the sensor at 1x"
    )


def test_a_lens_says_nothing_where_it_does_not_matter_or_nothing_is_known() -> None:
    product = Product(0.85, 0.217)
    assert whole_lens_note(whole("tamron-70-180mm-f2.8", product), 0.99 * FAR) is None
    assert whole_lens_note(lenses.load("tamron-70-180mm-f2.8"), 0.2) is None  # its groups move
    alike = Product(0.45, 0.15)  # a lens of 50 mm at 0.45 m
    assert whole_lens_note(whole("nikon-af-s-50mm-f1.4g", alike), 0.15) is None
    assert whole_lens_note(whole("nikon-af-s-50mm-f1.4g", Product(0.45)), 0.15) is None
    assert whole_lens_note(whole("nikon-af-s-50mm-f1.4g", None), 0.15) is None


def test_a_lens_of_a_product_whose_parts_are_known_names_them() -> None:
    note = whole_lens_note(lenses.load("leica-apo-summicron-m-35mm-f2"), 0.1)
    assert note == (
        "Leica APO-Summicron-M 35 mm f/2 ASPH focuses as a whole; the product moves two groups by "
        "different amounts"
    )


@pytest.mark.parametrize("model", ["exact", "thick"])
def test_the_camera_notes_it(model: str) -> None:
    def notes(focus: float, lens: str = WHOLE) -> str:
        camera = Camera(lens_model=model, lens=lens, focus_distance=focus)
        return " ".join(camera_facts(camera, Scene(), resolution=(36, 24)).notes)

    assert "focuses as a whole" in notes(0.5)
    assert "focuses as a whole" not in notes(50.0)
    assert "focuses as a whole" not in notes(0.5, "tessar-50mm-f2.8")


def test_what_moves_in_words() -> None:
    assert str(focusing(lenses.load(WHOLE))) == (
        "the whole lens moves, to 0.399 m from the sensor at 0.98x"
    )
    assert str(focusing(at_long_end(STANDING))) == (
        "groups move (gaps 4, 14), to 0.376 m from the sensor at 0.21x, fitted to the product's "
        "closest focus"
    )
    printed = focusing(lenses.load("canon-rf-85mm-f1.2"))
    assert (printed.gaps, printed.fitted) == ((2, 16), False)


@pytest.mark.parametrize(
    ("product", "message"),
    [
        ({"closest_focus_m": 0}, "product.closest_focus_m: out of range"),
        ({"closest_focus_m": "near"}, "product.closest_focus_m: wrong type: wanted a number"),
        ({"magnification": -1}, "product.magnification: out of range"),
        ({"moves": 3}, "product.moves: wrong type: wanted a string"),
        ([], "product: wrong type: wanted an object"),
    ],
)
def test_a_product_that_cannot_be_read(product: Any, message: str) -> None:
    data = {**lenses.load("tessar-50mm-f2.8").data, "product": product}
    with pytest.raises(InputError, match=message):
        lens_of(data, "own.json")


def test_fitted_is_true_or_false() -> None:
    near = {"name": "near", "gaps": {"0": 1.0}, "object_to_image_m": 0.5, "fitted": "yes"}
    data = {**lenses.load("tessar-50mm-f2.8").data, "configurations": [{"name": "far"}, near]}
    with pytest.raises(InputError, match=r"fitted: wrong type: wanted true or false"):
        lens_of(data, "own.json")


def test_a_slip_in_a_product_is_noted(tmp_path: Any) -> None:
    import json

    data = {**lenses.load("tessar-50mm-f2.8").data, "product": {"magnificaton": 0.2}}
    path = tmp_path / "own.json"
    path.write_text(json.dumps(data))
    assert any("product.magnificaton" in note for note in lenses.read(path).notes)
