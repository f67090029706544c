"""Lenses by the names that cameras write."""

import pytest

from daguerre.errors import InputError
from daguerre.lenses.library import entries
from daguerre.plates.match.body import library_sensor
from daguerre.plates.match.lens_name import library_lens, parsed


@pytest.mark.parametrize(
    ("model", "make", "name"),
    [
        ("EF24-70mm f/2.8L II USM", None, "canon-ef-24-70mm-f2.8"),
        ("EF11-24mm f/4L USM", "Canon", "canon-ef-11-24mm-f4"),
        ("RF50mm F1.8 STM", "Canon", "canon-rf-50mm-f1.8"),
        ("NIKKOR Z 50mm f/1.8 S", None, "nikon-z-50mm-f1.8"),
        ("AF-S NIKKOR 70-200mm f/2.8E FL ED VR", "NIKON", "nikon-af-s-70-200mm-f2.8"),
        ("FE 70-200mm F2.8 GM OSS II", "Sony", "sony-fe-70-200mm-f2.8"),
        ("FE 135mm F1.8 GM", None, "sony-fe-135mm-f1.8"),
        ("50mm F1.4 DG HSM | Art 014", "SIGMA", "sigma-50mm-f1.4"),
        ("Canon EF 24-70 mm f/2.8 L II USM", None, "canon-ef-24-70mm-f2.8"),
    ],
)
def test_names_of_cameras(model, make, name):
    found, _ = library_lens({"lensModel": model, "lensMake": make, "cameraMake": "x"}, "a.jpg")
    assert found == name


@pytest.mark.parametrize(
    "model", ["EF24-70mm f/2.8L USM", "EF50mm f/1.8 STM", "RF24-105mm F4 L IS USM", "iPhone", ""]
)
def test_lenses_that_the_library_lacks(model):
    """The first Canon EF 24-70 mm is another lens than the second."""
    found, notes = library_lens({"lensModel": model, "cameraMake": "Canon"}, "a.jpg")
    assert found is None
    assert len(notes) == (model != "")
    assert model in "".join(notes)


def test_several_are_asked_about():
    facts = {"lensModel": "50.0 mm f/1.2", "cameraMake": "Canon"}
    wanted = (
        r"a\.jpg: lens: wanted one lens .* got canon-new-fd-50mm-f1.2, canon-rf-50mm-f1.2; .*--lens"
    )
    with pytest.raises(InputError, match=wanted):
        library_lens(facts, "a.jpg")
    found, notes = library_lens(facts | {"lensModel": "85.0 mm f/1.8"}, "a.jpg")
    assert found == "canon-ef-85mm-f1.8"
    assert "is taken as" in notes[0]


def test_every_lens_is_found_by_its_own_name():
    for entry in entries():
        assert library_lens({"lensModel": entry.title}, "a.jpg")[0] == entry.name


def test_parts():
    found = parsed("EF24-70mm f/2.8L II USM")
    assert found.focal == (24, 70)
    assert found.stop == 2.8
    assert found.words == {"ef", "l", "ii", "usm"}
    assert parsed("no numbers") is None
    assert parsed("50mm") is None


@pytest.mark.parametrize(
    ("make", "model", "name"),
    [
        ("SONY", "ILCE-7RM2", "sony-a7r-ii"),
        ("Daguerre", "Sony ILCE-7RM2", "sony-a7r-ii"),
        ("NIKON CORPORATION", "NIKON D5100", "nikon-d5100"),
        ("FUJIFILM", "X-T4", "fujifilm-x-t4"),
        ("Apple", "iPhone 15", None),
        (None, None, None),
    ],
)
def test_bodies(make, model, name):
    found = library_sensor({"cameraMake": make, "cameraModel": model})
    assert (None if found is None else found.name) == name
