"""Lenses that go out in another program's format and come back the same."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daguerre import lenses
from daguerre.lenses.errors import LensError
from daguerre.lenses.library import FOLDER
from tests.support.lenses import lens_writers as write

Data = dict[str, Any]
GLASS = {"nd": 1.62041, "vd": 60.32}


def shipped(name: str) -> Data:
    """A lens of the library; glasses by nd and vd, without what else tells which they are."""
    data: Data = json.loads((FOLDER / f"{name}.json").read_text())
    data = {key: value for key, value in data.items() if key not in ("maker", "year")}
    for s in data["surfaces"]:
        if s["glass"]:
            s["glass"] = {key: s["glass"][key] for key in ("nd", "vd") if key in s["glass"]}
    return data


def made(surfaces: list[Data], **more: Any) -> Data:
    """A lens of the test's own."""
    return {"schema": "daguerre-lens/0.1", "name": "made", "surfaces": surfaces, **more}


def row(kind: str, radius: float | None, thickness: float, semi: float, **more: Any) -> Data:
    surface: Data = {"kind": kind, "radius": radius, "thickness": thickness}
    return {**surface, "semi_diameter": semi, "glass": None, **more}


ASPHERE = made(
    [
        row(
            "aspheric",
            31.7,
            6.0,
            14.0,
            glass=GLASS,
            conic=-0.62,
            asphere={"a4": 2.5e-6, "a6": -3.25e-9, "a8": 1.5e-12},
        ),
        row("aspheric", -310.0, 1.5, 13.0, conic=1.25, asphere={"a4": 4.0e-6}),
        row("stop", None, 41.79, 11.0),
    ]
)
ODD = made(
    [
        row(
            "aspheric", 33.0, 5.0, 13.0, glass=GLASS, asphere={"a3": 3e-5, "a4": -1e-6, "a5": 2e-8}
        ),
        row("spherical", -250.0, 2.0, 12.5),
        row("stop", None, 45.0, 11.0),
    ]
)
PLACED = made(
    [
        row("spherical", 40.0, 5.0, 14.0, glass=GLASS),
        row("spherical", -220.0, 2.0, 14.0),
        row("stop", None, 3.0, 10.0),
        row(
            "spherical",
            -45.0,
            2.5,
            12.0,
            glass={"nd": 1.6727, "vd": 32.25},
            decenter=[0.4, -0.3, 0.0],
            tilt=[1.5, 0.0, 0.0],
        ),
        row("spherical", -120.0, 60.0, 13.0),
    ]
)
ANAMORPHIC = made(
    [
        row("toroid", 60.0, 5.0, 12.0, glass=GLASS, radius_x=85.0, conic=-0.4),
        row("biconic", -300.0, 3.0, 12.0, radius_x=-150.0, conic=0.3, conic_x=-0.8),
        row("stop", None, 70.0, 9.0),
    ]
)
CENTRED = {
    "tessar": shipped("tessar-50mm-f2.8"),
    "double gauss": shipped("double-gauss-50mm-f2"),
}
ZOOM = shipped("nikon-af-s-70-200mm-f2.8")
ZOOM["configurations"] = ZOOM["configurations"][:3]


def original(data: Data, folder: Path, configuration: str | None = None) -> lenses.Lens:
    path = folder / "original.json"
    path.write_text(json.dumps(data))
    return lenses.read(path, configuration)


def imported(
    text: str | bytes, folder: Path, suffix: str, configuration: str | None = None
) -> lenses.Lens:
    path = folder / f"lens{suffix}"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return lenses.read(path, configuration)


def but_film(notes: tuple[str, ...]) -> tuple[str, ...]:
    """Notes without the one on the film, which each file with an image distance has."""
    return tuple(note for note in notes if "has its image" not in note)


def check_same(lens: lenses.Lens, other: lenses.Lens) -> None:
    """First order to 1e-9, rays to 1e-9 mm, the same ones stopped."""
    a, b = lens.first_order(), other.first_order()
    for key in ("efl", "bfl", "ffl", "f_number", "back_principal_point"):
        assert getattr(a, key) == pytest.approx(getattr(b, key), rel=1e-9), key
    assert a.entrance_pupil.z == pytest.approx(b.entrance_pupil.z, rel=1e-9)
    random = np.random.default_rng(7)
    count = 60
    pupil = 0.7 * b.entrance_pupil.diameter * (random.random((count, 2)) - 0.5)
    slopes = 0.3 * (random.random((count, 2)) - 0.5)
    directions = np.column_stack([slopes, np.ones(count)])
    origins = np.column_stack([pupil, np.full(count, b.entrance_pupil.z)]) - 200 * directions
    origins[:, 2] = b.entrance_pupil.z - 200
    for nm in (450.0, 587.5618, 650.0):
        for clip in (False, True):
            z = b.back_focal_point
            got = lens.trace(origins, directions, nm, clip=clip, image_z=z)
            wanted = other.trace(origins, directions, nm, clip=clip, image_z=z)
            np.testing.assert_allclose(got, wanted, rtol=0, atol=1e-9)
            assert np.isfinite(wanted).any()


WRITERS: dict[str, tuple[Callable[[Data], str], str]] = {
    "zmx": (write.zmx, ".zmx"),
    "zmx in inches": (lambda data: write.zmx(data, "IN"), ".zmx"),
    "seq": (write.seq, ".seq"),
    "seq of curvatures": (lambda data: write.seq(data, False), ".seq"),
    "optical bench": (write.optical_bench, ".txt"),
}


@pytest.mark.parametrize("form", list(WRITERS))
@pytest.mark.parametrize("name", ["tessar", "double gauss", "asphere"])
def test_a_lens_comes_back_the_same(name: str, form: str, tmp_path: Path) -> None:
    data = {**CENTRED, "asphere": ASPHERE}[name]
    writer, suffix = WRITERS[form]
    lens = imported(writer(data), tmp_path, suffix)
    check_same(lens, original(data, tmp_path))
    assert lens.name == data["name"]


@pytest.mark.parametrize("thickness_first", [False, True])
@pytest.mark.parametrize("name", ["tessar", "double gauss"])
def test_pbrt_comes_back_the_same(name: str, thickness_first: bool, tmp_path: Path) -> None:
    data = copy.deepcopy(CENTRED[name])
    for s in data["surfaces"]:
        if s["glass"]:
            del s["glass"]["vd"]  # pbrt knows one index
    lens = imported(write.pbrt(data, thickness_first), tmp_path, ".dat")
    check_same(lens, original(data, tmp_path))
    assert any("dispersion" in note for note in lens.notes)
    assert any("before their surfaces" in note for note in lens.notes) == thickness_first


@pytest.mark.parametrize("form", ["zmx", "zmx in inches"])
def test_odd_powers_come_back(form: str, tmp_path: Path) -> None:
    writer, suffix = WRITERS[form]
    check_same(imported(writer(ODD), tmp_path, suffix), original(ODD, tmp_path))


@pytest.mark.parametrize("form", ["zmx", "zmx in inches", "seq"])
@pytest.mark.parametrize("data", [PLACED, ANAMORPHIC], ids=["placed", "anamorphic"])
def test_what_is_not_round_comes_back(data: Data, form: str, tmp_path: Path) -> None:
    writer, suffix = WRITERS[form]
    lens = imported(writer(data), tmp_path, suffix)
    other = original(data, tmp_path)
    check_same(lens, other)
    assert not lens.prescription.is_axially_symmetric


@pytest.mark.parametrize("form", ["zmx", "seq", "optical bench"])
def test_zoom_positions_come_back(form: str, tmp_path: Path) -> None:
    writer, suffix = WRITERS[form]
    first = imported(writer(ZOOM), tmp_path, suffix)
    assert len(first.configurations) == 3
    for position, configuration in enumerate(ZOOM["configurations"]):
        other = original(ZOOM, tmp_path, configuration["name"])
        name = first.configurations[position].name
        lens = imported(writer(ZOOM), tmp_path, suffix, name)
        if form == "optical bench":
            check_same(lens, other)
        else:  # the files say nothing of the iris of each position
            assert lens.first_order().efl == pytest.approx(other.first_order().efl, rel=1e-9)


def test_utf16_and_latin_text_are_read(tmp_path: Path) -> None:
    text = write.zmx({**ASPHERE, "name": "Zei\u00df"})
    for data in (
        text.encode("utf-16"),
        b"\xfe\xff" + text.encode("utf-16-be"),
        text.encode("utf-16-le"),
        text.encode("latin-1"),
        b"\xef\xbb\xbf" + text.encode(),
        text.replace("\n", "\r\n").encode(),
    ):
        assert imported(data, tmp_path, ".zmx").name == "Zei\u00df"


def test_the_text_decides_where_the_suffix_does_not(tmp_path: Path) -> None:
    for text in (write.zmx(ASPHERE), write.seq(ASPHERE), write.optical_bench(ASPHERE)):
        check_same(imported(text, tmp_path, ".txt"), original(ASPHERE, tmp_path))
    dat = imported(write.pbrt(CENTRED["tessar"]), tmp_path, ".txt")
    assert dat.first_order().efl == pytest.approx(50, rel=0.02)


# The beam that a file states ---------------------------------------------------------------------


@pytest.mark.parametrize(
    ("aperture", "f_number"),
    [("ENPD 12.5", None), ("FNUM 4 0", 4.0), ("FNUM 5.6 1", 5.6)],
)
def test_zemax_sizes_the_stop(aperture: str, f_number: float | None, tmp_path: Path) -> None:
    lens = imported(write.zmx(ASPHERE).replace("FLOA", aperture), tmp_path, ".zmx")
    order = lens.first_order()
    if f_number is None:
        assert order.entrance_pupil.diameter == pytest.approx(12.5, rel=1e-9)
    else:
        assert order.f_number == pytest.approx(f_number, rel=1e-9)


def test_code_v_sizes_the_stop(tmp_path: Path) -> None:
    text = write.seq(ASPHERE)
    lens = imported(text.replace("DIM M", "DIM M; EPD 11.25"), tmp_path, ".seq")
    assert lens.first_order().entrance_pupil.diameter == pytest.approx(11.25, rel=1e-9)
    lens = imported(text.replace("DIM M", "DIM M; FNO 4.5"), tmp_path, ".seq")
    assert lens.first_order().f_number == pytest.approx(4.5, rel=1e-9)


def test_a_finite_object_widens_the_working_aperture(tmp_path: Path) -> None:
    """At distance x before the front focus, m = f/x; the pupil lies behind the lens."""
    text = write.zmx(ASPHERE).replace("FLOA", "FNUM 8 1").replace("DISZ INFINITY", "DISZ 300")
    order = imported(text, tmp_path, ".zmx").first_order()
    m = order.efl / (300 + order.front_focal_point)
    slope = 0.5 * order.entrance_pupil.diameter / (300 + order.entrance_pupil.z) / m
    assert 1 / (2 * slope) == pytest.approx(8, rel=1e-9)
    text = text.replace("FNUM 8 1", "OBNA 0.02")
    order = imported(text, tmp_path, ".zmx").first_order()
    half = 0.5 * order.entrance_pupil.diameter / (300 + order.entrance_pupil.z)
    assert math.sin(math.atan(half)) == pytest.approx(0.02, rel=1e-9)


# Notes on what is not honoured --------------------------------------------------------------------


def test_dpgf_of_a_model_glass_is_its_deviation_from_the_normal_line(tmp_path: Path) -> None:
    text = write.zmx(ASPHERE).replace("60.32 0\n", "60.32 0.01\n", 1)
    lens = imported(text, tmp_path, ".zmx")
    assert but_film(lens.notes) == ()
    rules = [s.dispersion.rule for s in lens.surfaces if s.dispersion]
    assert rules[0] == "theta_gF"
    g, f, c = (lens.surfaces[0].medium.index(nm) for nm in (435.8343, 486.1327, 656.2725))
    assert (g - f) / (f - c) == pytest.approx(0.6438 - 0.001682 * 60.32 + 0.01, abs=1e-9)


@pytest.mark.parametrize(
    ("catalogues", "maker", "note"),
    [
        ("CORNING", "Hoya", "glass LAF2: took that of Hoya, others differ (Hikari)"),
        ("HIKARI", "Hikari", ""),
        ("HIKARI HOYA", "Hikari", "glass LAF2: took that of Hikari, others differ (Hoya)"),
    ],
)
def test_a_name_in_several_catalogues_is_noted_where_they_differ(
    catalogues: str, maker: str, note: str, tmp_path: Path
) -> None:
    text = write.zmx(ASPHERE).replace("___BLANK 1 0 1.62041 60.32 0", "LAF2 0 0 1.5 40 0", 1)
    lens = imported(text.replace("GCAT SCHOTT", f"GCAT {catalogues}", 1), tmp_path, ".zmx")
    assert next(s.dispersion.maker for s in lens.surfaces if s.dispersion) == maker
    notes = [n for n in lens.notes if n.startswith("glass")]
    assert [n[: len(note)] for n in notes] == ([note] if note else [])


@pytest.mark.parametrize(
    ("old", "new", "note"),
    [
        ("FLOA", "FLOA\nVCYN 0 0.2", "vignetting factors"),
        ("ENVD 20 1 0", "ENVD 35 1 0", "temperature 35"),
        ("  STOP", "  STOP\n  SQAP 3 2 0", "aperture SQAP"),
        ("  STOP", "  STOP\n  COAT AR", "coatings are ignored; the lens's coating applies"),
        ("  STOP", "  STOP\n  SCBD 1 2", "record SCBD"),
        (
            "___BLANK 1 0 1.62041 60.32 0",
            "QX9 0 0 1.62041 60.32 0",
            "glass: QX9 is in no catalogue, ",
        ),
        ("___BLANK 1 0 1.62041 60.32 0", "BK7 0 0 1.5 40 0", "glass BK7: took N-BK7"),
    ],
)
def test_zemax_notes(old: str, new: str, note: str, tmp_path: Path) -> None:
    text = write.zmx(ASPHERE)
    assert old in text
    assert but_film(imported(text, tmp_path, ".zmx").notes) == ()
    notes = imported(text.replace(old, new, 1), tmp_path, ".zmx").notes
    assert [n for n in notes if n.startswith(note)], notes


def test_code_v_notes(tmp_path: Path) -> None:
    text = write.seq(ASPHERE)
    assert but_film(imported(text, tmp_path, ".seq").notes) == (
        "no EPD, FNO, NA or NAO: the f-number follows from the stop's clear diameter",
    )
    more = "EPD 11; VUY .1 .2\nTEM 40\nREX 3; PIK THI S1 S2; XYZ 1"
    notes = imported(text.replace("STO", f"STO\n{more}"), tmp_path, ".seq").notes
    wanted = ("vignetting factors", "TEM 40", "aperture REX", "pickups", "command XYZ is ignored")
    for start in wanted:
        assert [n for n in notes if n.startswith(start)], (start, notes)
    assert len(but_film(notes)) == len(wanted)


def test_a_tilted_film_is_told(tmp_path: Path) -> None:
    """A break that is never taken back leaves the film off the axis; the surfaces are exact."""
    text = write.zmx(ASPHERE)
    last = "TYPE STANDARD\n  CURV 0\n  DISZ 0"
    number = text.count("SURF") - 1
    broken = text.replace(last, f"TYPE COORDBRK\n  PARM 3 5\n  DISZ 0\nSURF {number + 1}\n  {last}")
    lens = imported(broken, tmp_path, ".zmx")
    assert any(
        n.startswith("the film is decentred by 0, 0 mm and tilted by 5, 0, 0 degrees")
        for n in lens.notes
    )
    check_same(lens, original(ASPHERE, tmp_path))


def test_zemax_tilts_up_and_code_v_left_handed(tmp_path: Path) -> None:
    """The same element in both: a positive tilt about x takes the axis toward -y."""
    data = copy.deepcopy(PLACED)
    data["surfaces"][3]["decenter"] = [0.0, 0.0, 0.0]
    ray = {"origins": [0, 0, -10], "directions": [0, 0, 1]}
    y = [
        imported(text, tmp_path, suffix).trace(**ray)[0, 1]
        for text, suffix in ((write.zmx(data), ".zmx"), (write.seq(data), ".seq"))
    ]
    assert y[0] == pytest.approx(y[1], abs=1e-9)
    assert abs(y[0]) > 0.1


# Edges and light ----------------------------------------------------------------------------------


def test_a_crossing_near_the_rim_shortens_the_glass(tmp_path: Path) -> None:
    data = copy.deepcopy(CENTRED["tessar"])
    data["surfaces"][0]["semi_diameter"] = data["surfaces"][1]["semi_diameter"] = 13.5
    lens = original(data, tmp_path)
    (note,) = [n for n in lens.notes if "cross" in n]
    assert note.startswith("surfaces 0 and 1 cross")
    a, b = (s.semi_diameter for s in lens.surfaces[:2])
    assert a == b
    assert a is not None
    assert a < 13.5
    c = [1 / s["radius"] if s["radius"] else 0.0 for s in data["surfaces"][:2]]
    sags = [k * a * a / (1 + math.sqrt(1 - (k * a) ** 2)) for k in c]
    assert data["surfaces"][0]["thickness"] + sags[1] - sags[0] == pytest.approx(0, abs=5e-3)


def test_a_crossing_within_the_beam_is_an_error(tmp_path: Path) -> None:
    data = copy.deepcopy(CENTRED["tessar"])
    data["surfaces"][0]["thickness"] = 0.2
    with pytest.raises(LensError) as caught:
        original(data, tmp_path)
    assert (caught.value.code, caught.value.surface) == ("lens-edge", 0)


def test_a_lens_that_is_all_obstruction_is_dark(tmp_path: Path) -> None:
    data = copy.deepcopy(CENTRED["tessar"])
    front = data["surfaces"][0]
    front["inner_semi_diameter"] = 0.999 * front["semi_diameter"]
    with pytest.raises(LensError) as caught:
        original(data, tmp_path)
    assert (caught.value.code, caught.value.surface) == ("lens-no-light", 0)
