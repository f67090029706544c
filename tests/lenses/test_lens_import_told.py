"""Lens files of other programs: a missing RDM is decided by the film; film and fields are noted."""

from __future__ import annotations

import copy
from pathlib import Path

import pytest

from daguerre import lenses
from daguerre.lenses.errors import LensError
from tests.lenses.test_lens_import import ASPHERE, CENTRED, check_same, imported, original
from tests.support.lenses import lens_writers as write

#: Files that are kept beside the project.
CASES = Path(__file__).parents[3] / "shared" / "cases" / "files"
LENSES = {**CENTRED, "asphere": ASPHERE}


@pytest.mark.parametrize("radii", [True, False], ids=["radii", "curvatures"])
@pytest.mark.parametrize("name", LENSES)
def test_without_rdm_the_film_decides(name: str, radii: bool, tmp_path: Path) -> None:
    text = write.seq(LENSES[name], radii)
    bare = text.replace("RDM N; ", "").replace("RDM; ", "")
    assert "RDM" not in bare
    lens = imported(bare, tmp_path, ".seq")
    check_same(lens, original(LENSES[name], tmp_path))
    word = "radii" if radii else "curvatures"
    (note,) = [n for n in lens.notes if "RDM" in n]
    assert f"no RDM: the numbers of surfaces are read as {word}" in note
    assert not any("RDM" in n for n in imported(text, tmp_path, ".seq").notes)


def test_a_near_object_counts_for_its_film(tmp_path: Path) -> None:
    """The image of an object at 150 mm lies where the film of the file is."""
    data = copy.deepcopy(CENTRED["tessar"])
    lens = original(data, tmp_path)
    order = lens.first_order()
    film = order.back_focal_point + order.efl**2 / (150 + order.front_focal_point)
    data["surfaces"][-1]["thickness"] = film - float(lens.vertices[-1])
    for radii in (True, False):
        text = write.seq(data, radii).replace("RDM N; ", "").replace("RDM; ", "")
        found = imported(text.replace("SO 0.0 0.1e14", "SO 0.0 150"), tmp_path, ".seq")
        assert found.first_order().efl == pytest.approx(order.efl, rel=1e-9)
        assert any("object 150 mm before the lens" in note for note in found.notes)


def test_without_a_film_they_are_radii(tmp_path: Path) -> None:
    text = "LEN; EPD 0.1; SO 0 1e13; S 0.3 0.2 1.5:60; S -0.35 {film}; STO; SI 0 0; GO"
    lens = imported(text.format(film=0), tmp_path, ".seq")
    assert lens.surfaces[0].radius == pytest.approx(0.3)
    assert imported(text.format(film=2.8), tmp_path, ".seq").surfaces[0].radius == pytest.approx(
        1 / 0.3
    )
    assert any("as the file has no image distance to choose by" in note for note in lens.notes)


def test_a_reading_that_makes_no_lens_is_not_taken(tmp_path: Path) -> None:
    """Curvatures of 1e-4 per mm would be radii of a hair's thickness."""
    text = write.seq(ASPHERE, False).replace("RDM N; ", "")
    weak = text.replace("S -0.0032258064516129032 ", "S -1e-4 ")
    assert weak != text
    lens = imported(weak, tmp_path, ".seq")
    assert lens.surfaces[1].radius == pytest.approx(-1e4)
    assert any("the other reading makes no lens" in note for note in lens.notes)


def test_if_neither_makes_a_lens_the_error_is_that_of_radii(tmp_path: Path) -> None:
    text = write.seq(ASPHERE).replace("RDM; ", "").replace("STO", "")
    with pytest.raises(LensError, match="exactly one stop, got 0"):
        imported(text, tmp_path, ".seq")


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ("FTYP 0 0 3 3 0 0 0\nXFLN 0 0 0\nYFLN 0 10 14.5", "fields up to 14.5 degrees"),
        ("FTYP 1 0 2 3 0 0 0\nYFLN 0 30", "fields up to 30 mm at the object"),
        ("FTYP 3 0 2 3 0 0 0\nYFLN 0 21.6", "fields up to 21.6 mm on the film"),
    ],
)
def test_fields_of_zemax_are_noted(fields: str, words: str, tmp_path: Path) -> None:
    lens = imported(write.zmx(ASPHERE).replace("FLOA", f"FLOA\n{fields}"), tmp_path, ".zmx")
    assert any(n.startswith(f"{words} do not set the frame") for n in lens.notes), lens.notes


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ("YAN 0 10 14.5", "fields up to 14.5 degrees"),
        ("YOB 0 30", "fields up to 30 mm at the object"),
        ("XIM 0 12; YIM 0 21.6", "fields up to 21.6 mm on the film"),
    ],
)
def test_fields_of_code_v_are_noted(fields: str, words: str, tmp_path: Path) -> None:
    lens = imported(write.seq(ASPHERE).replace("DIM M", f"DIM M\n{fields}"), tmp_path, ".seq")
    assert any(n.startswith(f"{words} do not set the frame") for n in lens.notes), lens.notes


@pytest.mark.parametrize(("writer", "suffix"), [(write.zmx, ".zmx"), (write.seq, ".seq")])
def test_a_film_away_from_the_focus_is_noted(writer, suffix: str, tmp_path: Path) -> None:
    data = copy.deepcopy(ASPHERE)
    data["surfaces"][-1]["thickness"] = 40.32
    lens = imported(writer(data), tmp_path, suffix)
    (note,) = [n for n in lens.notes if "image" in n]
    focus = lens.first_order().bfl
    assert "40.32 mm behind the last surface" in note
    assert f"{focus:.4g} mm" in note
    film = lens.focused(float("inf")).film_z_mm - lens.vertices[-1]
    assert film == pytest.approx(focus)
    (near,) = [n for n in imported(writer(ASPHERE), tmp_path, suffix).notes if "image" in n]
    assert near == (
        "the file has its image 41.79 mm behind the last surface: the focus distance of the "
        "camera places the film"
    )


def test_a_file_that_focuses_has_its_own_film(tmp_path: Path) -> None:
    """A zoom whose groups focus keeps the film of the file."""
    data = copy.deepcopy(ASPHERE)
    data["surfaces"][-1]["thickness"] = 40.32
    near = {"name": "near", "gaps": {"1": 3.0}, "object_distance_mm": 400.0}
    data["configurations"] = [{"name": "far", "gaps": {}}, near]
    text = write.zmx(data) + "THIC 0 1 INFINITY 0 0 0\nTHIC 0 2 400 0 0 0\n"
    lens = imported(text, tmp_path, ".zmx")
    assert not lens.configurations[1].at_infinity
    assert not any("image" in n for n in lens.notes), lens.notes


@pytest.mark.skipif(not CASES.is_dir(), reason="../shared/cases/files is not here")
def test_the_file_without_rdm_is_in_curvatures() -> None:
    ours, stated = (lenses.read(CASES / f"seq_curv{end}.seq") for end in ("", "_n"))
    assert ours.first_order().efl == pytest.approx(3.01, abs=0.005)
    assert ours.first_order() == stated.first_order()
