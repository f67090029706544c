"""The shipped lenses against their patents' own statements, row by row of the source table."""

from __future__ import annotations

import json
import time
from pathlib import Path

import numpy as np
import pytest

from daguerre import lenses
from daguerre.cli import main
from daguerre.lenses.library import FOLDER, Entry, entries

ENTRIES = entries()


def test_the_table_has_a_row_for_each_file_and_a_source_in_each() -> None:
    assert lenses.names() == sorted(path.stem for path in FOLDER.glob("*.json"))
    assert len(ENTRIES) >= 100
    for entry in ENTRIES:
        assert any(c.isdigit() for c in entry.patent), entry.name
        assert 1840 <= (entry.year or 0) <= 2026, entry.name


@pytest.mark.parametrize(
    ("kind", "count"),
    [
        ("Petzval", 2), ("triplet", 1), ("Tessar", 2), ("Heliar", 4), ("Sonnar", 3), ("Biotar", 1),
        ("double Gauss", 20), ("retrofocus", 8), ("Biogon", 1), ("Hologon", 1), ("telephoto", 15),
        ("macro", 3), ("soft focus", 4), ("aspheric", 25), ("fisheye", 8), ("zoom", 14),
        ("anamorphic", 1), ("Protar", 1),
    ],
)  # fmt: skip
def test_every_family_is_there(kind: str, count: int) -> None:
    assert sum(kind in entry.type for entry in ENTRIES) >= count


def test_they_reach_from_the_1890s_to_today_and_to_f_095() -> None:
    years = [entry.year or 0 for entry in ENTRIES]
    assert min(years) <= 1890
    assert max(years) >= 2024
    assert min(entry.f_number for entry in ENTRIES) <= 0.95


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.name)
def test_a_lens_is_what_its_source_says(entry: Entry) -> None:
    lens = lenses.load(entry.name)
    order = lens.first_order()
    assert (lens.name, lens.patent) == (entry.title, entry.patent)
    assert order.efl == pytest.approx(entry.efl_mm, abs=0.006)
    assert order.bfl == pytest.approx(entry.bfl_mm, abs=0.0006)
    assert order.f_number == pytest.approx(entry.f_number, abs=0.006)
    assert lens.nominal.efl_mm == entry.efl_stated
    if entry.efl_stated is not None:
        assert order.efl == pytest.approx(entry.efl_stated, rel=0.01)
    if entry.f_stated is None:
        assert "f/" in entry.remark or "f-number" in entry.remark
    else:
        assert lens.nominal.f_number == entry.f_stated
        assert order.f_number == pytest.approx(entry.f_stated, rel=0.002)
    film = lens.surfaces[-1].thickness
    assert film is not None
    assert order.bfl == pytest.approx(film, abs=max(0.05, 0.005 * order.bfl))
    if entry.bfl_stated is None:
        assert entry.remark
    else:
        assert film == entry.bfl_stated


@pytest.mark.parametrize(
    "entry", [entry for entry in ENTRIES if entry.efl_long_mm], ids=lambda entry: entry.name
)
def test_each_position_of_a_zoom_is_what_its_source_says(entry: Entry) -> None:
    found = []
    for position in lenses.load(entry.name).configurations:
        if not position.at_infinity:
            continue
        lens = lenses.load(entry.name, position.name)
        order = lens.first_order()
        assert order.efl == pytest.approx(position.efl_mm, rel=0.01)
        assert order.f_number == pytest.approx(position.f_number, rel=0.002)
        assert order.back_focal_point == pytest.approx(
            lens.image_z, abs=max(0.1, 0.005 * order.bfl)
        )
        found.append(order.efl)
    assert found == sorted(found)
    assert found[-1] == pytest.approx(entry.efl_long_mm, abs=0.006)
    assert found[-1] == pytest.approx(entry.efl_long_stated, rel=0.01)


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.name)
def test_the_axial_beam_passes_at_full_aperture_and_meets_in_a_point(entry: Entry) -> None:
    lens = lenses.load(entry.name)
    order = lens.first_order()
    if not lens.prescription.is_axially_symmetric:
        pytest.skip("an anamorphic lens has its foci apart")
    y = 0.87 * np.linspace(0, order.entrance_pupil.diameter / 2, 21)
    origins = np.stack([0 * y, y, 0 * y - 20], axis=1)
    z = order.back_focal_point
    near = lens.trace(origins, [0, 0, 1], clip=True, image_z=z)[:, 1]
    assert np.isfinite(near).all()
    far = lens.trace(origins, [0, 0, 1], clip=True, image_z=z + 1)[:, 1]
    # The best plane, for points weighed by the area of their rings.
    slope = far - near
    shift = -np.sum(y * near * slope) / np.sum(y * slope * slope)
    spot = np.sqrt(np.sum(y * (near + shift * slope) ** 2) / np.sum(y))
    soft = "soft" in entry.type or "fisheye" in entry.type
    assert spot < (0.006 if soft else 0.0012) * order.efl


@pytest.mark.parametrize("entry", [e for e in ENTRIES if "fisheye" in e.type], ids=lambda e: e.name)
def test_a_fisheye_says_its_projection(entry: Entry) -> None:
    assert lenses.load(entry.name).nominal.projection not in (None, "rectilinear")


def test_a_list_of_names_parses_no_lens() -> None:
    start = time.process_time()
    assert len(lenses.names()) == len(ENTRIES)
    assert time.process_time() - start < 0.2


def test_the_list_says_what_a_photographer_asks(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lenses"]) == 0
    rows = capsys.readouterr().out.splitlines()
    assert len(rows) == len(ENTRIES)
    (zoom,) = [row for row in rows if row.startswith("nikon-af-s-70-200mm-f2.8 ")]
    assert zoom.split() == [
        "nikon-af-s-70-200mm-f2.8", "2016", "71.5-196", "mm", "f/2.85", "36x24",
        "WO", "2019/097669", "Ex.", "1",
    ]  # fmt: skip
    assert main(["lenses", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert [item["name"] for item in listed] == lenses.names()
    assert {"title", "year", "patent", "efl_mm", "f_number", "format", "maker"} <= set(listed[0])


def test_files_are_short_and_plain() -> None:
    for path in FOLDER.glob("*.json"):
        data = json.loads(path.read_text(encoding="utf-8"))
        lines = path.read_text(encoding="utf-8").splitlines()
        assert (
            len(lines)
            == 3 + len(data) + 2 + len(data["surfaces"]) + len(data["configurations"]) - 1
        )
        assert "title_in_source" not in data


def test_the_stop_of_the_hologon_lies_in_glass() -> None:
    lens = lenses.load("zeiss-hologon-15mm-f8")
    (stop,) = [s for s in lens.surfaces if s.stop]
    assert stop.glass == "1.713/53.89"
    assert stop.core_glass.index(587.5618) == pytest.approx(1.713)
    # DE 1,241,637: f = 1, back focus 0.3028, glass and air 1.7313.
    order = lens.first_order()
    assert order.efl == pytest.approx(15, rel=1e-4)
    assert order.bfl / order.efl == pytest.approx(0.3028, abs=3e-4)
    assert lens.vertices[-1] / 15 == pytest.approx(1.7313, abs=2e-4)


def test_the_anamorphic_lens_squeezes_by_two() -> None:
    lens = lenses.load("schneider-anamorphic-60mm")
    tall, wide = (lens.prescription.first_order(587.5618, section) for section in "yx")
    assert wide.efl == pytest.approx(lens.nominal.efl_x_mm, rel=0.02)  # US 6,310,731: 31 mm
    assert tall.efl / wide.efl == pytest.approx(1.92, abs=0.01)
    assert tall.back_focal_z == pytest.approx(wide.back_focal_z, abs=0.05)


def test_the_folder_is_part_of_the_package() -> None:
    assert Path(lenses.__file__).parent / "library" == FOLDER
