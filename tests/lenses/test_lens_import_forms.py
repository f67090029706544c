"""Forms, glasses and solves of other lens files, where a plain round trip does not reach."""

from __future__ import annotations

import copy
import math
from pathlib import Path

import numpy as np
import pytest

from daguerre.lenses.formats.draft import moved
from daguerre.lenses.formats.glass import coded
from daguerre.lenses.groups import rotation
from tests.bad_files.lens_imports import ZOOM
from tests.lenses.test_lens_import import (
    ANAMORPHIC,
    ASPHERE,
    GLASS,
    ODD,
    PLACED,
    check_same,
    imported,
    made,
    original,
    row,
)
from tests.support.lenses import lens_writers as write


@pytest.mark.parametrize("kind", ["XASPHERE", "XOSPHERE"])
def test_extended_aspheres_are_scaled_by_their_radius(kind: str, tmp_path: Path) -> None:
    """Terms of (r / r0)^p: XDAT 1 is their number, XDAT 2 is r0, then alpha_p = A_p r0^p."""
    data = ASPHERE if kind == "XASPHERE" else ODD
    text, r0, step = write.zmx(data), 2.5, 2 if kind == "XASPHERE" else 1
    old = "EVENASPH" if kind == "XASPHERE" else "ODDASPHE"
    for s in data["surfaces"]:
        terms = {int(name[1:]): a for name, a in s.get("asphere", {}).items()}
        if not terms:
            continue
        count = max(terms) // step
        rows = [f"XDAT 1 {count}", f"XDAT 2 {r0}"]
        rows += [f"XDAT {p // step + 2} {a * r0**p!r} 0 0 1" for p, a in terms.items()]
        text = text.replace(f"TYPE {old}", f"TYPE {kind}\n  " + "\n  ".join(rows), 1)
    check_same(imported(text, tmp_path, ".zmx"), original(data, tmp_path))


@pytest.mark.parametrize(
    ("constant", "powers"),
    [("", (4, 6, 8)), ("AsphericalA2", (2, 4, 6)), ("AsphericalOddCount\t2", (3, 4, 5, 6, 8))],
)
def test_optical_bench_counts_its_powers(
    constant: str, powers: tuple[int, ...], tmp_path: Path
) -> None:
    """Sources: files of the site; with n odd powers they stand between the first even ones."""
    data = copy.deepcopy(ASPHERE)
    values = [3e-5 * 10.0 ** -(p - 2) for p in powers]
    terms = {f"a{p}": a for p, a in zip(powers, values, strict=True)}
    data["surfaces"][0]["asphere"], data["surfaces"][1]["asphere"] = terms, {}
    text = write.optical_bench(data).replace("[constants]", f"[constants]\n{constant}")
    head, _, tail = text.partition("[aspherical data]\n")
    rows = "\t".join(repr(v) for v in (31.7, -0.62, *values))
    tail = "\n".join([f"1\t{rows}", *tail.split("\n")[1:]])
    lens = imported(f"{head}[aspherical data]\n{tail}", tmp_path, ".txt")
    check_same(lens, original(data, tmp_path))


def test_an_x_toroid_is_a_y_toroid_on_its_side(tmp_path: Path) -> None:
    turned = copy.deepcopy(ANAMORPHIC)
    turned["surfaces"] = [
        row("toroid", 60.0, 5.0, 12.0, glass=GLASS, radius_x=85.0, conic=-0.4, tilt=[0, 0, 90]),
        row("spherical", -300.0, 3.0, 12.0),
        row("stop", None, 70.0, 9.0),
    ]
    plain = copy.deepcopy(turned)
    plain["surfaces"][0]["tilt"] = [0, 0, 0]
    text = write.seq(plain).replace("S 60.0", "S 85.0").replace("YTO; RDX 85.0", "XTO; RDX 60.0")
    check_same(imported(text, tmp_path, ".seq"), original(turned, tmp_path))


@pytest.mark.parametrize("across", [False, True])
def test_cylinders(across: bool, tmp_path: Path) -> None:
    kind = "cyl-y" if across else "cyl-x"  # the axis along y: power in x
    data = made([row(kind, 45.0, 4.0, 10.0, glass=GLASS), *ASPHERE["surfaces"][1:]])
    plain = made([row("spherical", 45.0, 4.0, 10.0, glass=GLASS), *ASPHERE["surfaces"][1:]])
    form = "CYL; RDX 45.0; RDY 0" if across else "CYL"
    text = write.seq(plain).replace("  CIR 10.0", f"  {form}\n  CIR 10.0")
    wanted = original(data, tmp_path)
    check_same(imported(text, tmp_path, ".seq"), wanted)
    rows = "TYPE TOROIDAL\n  PARM 1 45.0\n  CURV 0" if across else "TYPE TOROIDAL"
    old = f"TYPE STANDARD\n  CURV {1 / 45.0!r}"
    text = write.zmx(plain).replace(old, rows if across else f"{rows}\n  CURV {1 / 45.0!r}")
    check_same(imported(text, tmp_path, ".zmx"), wanted)


def test_codes_of_glasses() -> None:
    assert coded("517642") == pytest.approx((1.517, 64.2))
    assert coded("517000.642000") == pytest.approx((1.517, 64.2))
    assert coded("500.700") == pytest.approx((1.5, 70.0))
    assert coded("1620410.603200") == pytest.approx((1.162041, 60.32))
    assert coded("BK7") is None
    assert coded("1.5") is None


def test_private_glasses_of_code_v_are_tables(tmp_path: Path) -> None:
    nodes = [(656.3, 1.60), (587.6, 1.605), (486.1, 1.61)]
    data = copy.deepcopy(ASPHERE)
    data["surfaces"][0]["glass"] = {"table": [list(node) for node in nodes]}
    indices = " ".join(str(n) for _, n in nodes)
    private = f"PRV\nPWL 656.3 587.6&\n 486.1\n'MY GLASS' {indices}\nEND"
    text = (
        write.seq(ASPHERE)
        .replace("DIM M", f"DIM M\n{private}")
        .replace(f"{GLASS['nd']}:{GLASS['vd']}", "'MY GLASS'")
    )
    check_same(imported(text, tmp_path, ".seq"), original(data, tmp_path))


@pytest.mark.parametrize(
    ("solve", "gap"),
    [
        ("TCOM 2 8.5", lambda travel: 8.5 - travel),
        ("TOLE 2 11.0", lambda travel: 11.0 - travel - 2.0),
    ],
)
def test_thickness_solves_hold_in_every_position(solve: str, gap: object, tmp_path: Path) -> None:
    """On surface 4: with surface 2 it makes up a sum; or all from 2 to 4 do (3 is 2 mm thick)."""
    text = write.zmx(ZOOM).replace("  CURV 0.0492", f"  {solve}\n  CURV 0.0492")
    for position, travel in (("a", 6.0), ("b", 7.0)):
        lens = imported(text, tmp_path, ".zmx", position)
        assert lens.surfaces[1].thickness == pytest.approx(travel)
        assert callable(gap)
        assert lens.surfaces[3].thickness == pytest.approx(gap(travel))


def test_frames_turn_about_x_then_the_new_y_then_the_new_z() -> None:
    """Right-handed; what is done in one order is undone by the other with the signs changed."""
    shift, tilt = [1.0, -2.0, 0.5], [10.0, 20.0, 30.0]
    x, y, z = (rotation(tuple(t if i == k else 0.0 for i, t in enumerate(tilt))) for k in range(3))
    frame = moved(shift, tilt)
    np.testing.assert_allclose(frame[:3, :3], x @ y @ z, atol=1e-15)
    np.testing.assert_allclose(frame[:3, 3], shift)
    np.testing.assert_allclose(x @ [0, 0, 1], [0, -math.sin(math.radians(10)), x[2, 2]])
    np.testing.assert_allclose(y @ [0, 0, 1], [math.sin(math.radians(20)), 0, y[2, 2]])
    back = moved([-v for v in shift], [-v for v in tilt], tilt_first=True)
    np.testing.assert_allclose(frame @ back, np.eye(4), atol=1e-15)


def test_compound_tilts_place_surfaces_where_the_frames_are(tmp_path: Path) -> None:
    tilt = (1.5, -2.0, 20.0)
    zemax = (
        write.zmx(PLACED)
        .replace(
            "PARM 3 1.5\n  PARM 4 0.0\n  PARM 5 0.0", "PARM 3 1.5\n  PARM 4 -2.0\n  PARM 5 20.0"
        )
        .replace(
            "PARM 3 -1.5\n  PARM 4 -0.0\n  PARM 5 -0.0", "PARM 3 -1.5\n  PARM 4 2.0\n  PARM 5 -20.0"
        )
    )
    code_v = write.seq(PLACED).replace("ADE -1.5; BDE -0.0; CDE 0.0", "ADE -1.5; BDE 2.0; CDE 20.0")
    wanted = moved([0, 0, 0], list(tilt))[:3, :3]
    for text, suffix in ((zemax, ".zmx"), (code_v, ".seq")):
        lens = imported(text, tmp_path, suffix)
        surface = lens.surfaces[3]
        np.testing.assert_allclose(rotation(surface.tilt), wanted, atol=1e-14)
        np.testing.assert_allclose(surface.decenter, [0.4, -0.3, 0.0], atol=1e-12)
        assert not any(lens.surfaces[4].tilt)


def test_the_image_of_code_v_may_stand_off_the_last_gap(tmp_path: Path) -> None:
    text = write.seq(ASPHERE).replace("SI 0.0 0.0", "SI 0.0 -0.25")
    assert imported(text, tmp_path, ".seq").surfaces[-1].thickness == 41.79 - 0.25


def test_a_clear_diameter_beyond_the_sphere_is_the_spheres(tmp_path: Path) -> None:
    data = made([row("spherical", 31.0, 9.0, 60.0, glass=GLASS), *ASPHERE["surfaces"][1:]])
    data["surfaces"][1] = row("spherical", -310.0, 1.5, 13.0)
    lens = imported(write.zmx(data), tmp_path, ".zmx")
    assert any(
        n.startswith("a clear diameter is reduced to the diameter of the sphere (surface 1")
        for n in lens.notes
    )
    semi = lens.surfaces[0].semi_diameter
    assert semi is not None
    assert semi <= 31.0


def test_dummies_are_joined_and_numbers_kept(tmp_path: Path) -> None:
    """A plane of air in front, and one in the middle: nothing happens there."""
    text = write.seq(ASPHERE)
    text = text.replace("\nS 31.7", "\nS 0 2.5\nS 31.7").replace("\nS 0.0", "\nS 0 0.5\nS 0.0")
    text = text.replace("S -310.0 1.5", "S -310.0 1.0")
    lens = imported(text, tmp_path, ".seq")
    check_same(lens, original(ASPHERE, tmp_path))
    assert [s["from"] for s in lens.data["surfaces"]] == [2, 3, 5]
