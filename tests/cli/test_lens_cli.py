"""``daguerre lens``: numbers, pictures, and what it refuses."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from daguerre.cli import main

LENS = "tessar-50mm-f2.8"
LIBRARY = Path(__file__).resolve().parents[2] / "python/daguerre/lenses/library"


def test_json_has_every_figure(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lens", LENS, "--json", "--f-stop", "8", "--focus", "2"]) == 0
    facts = json.loads(capsys.readouterr().out)
    bench = facts["bench"]
    assert bench["f_stop"] == 8
    assert bench["focus_m"] == 2
    assert bench["working_f_number"] > 8
    assert bench["magnification"] == pytest.approx(-0.0235, rel=0.01)
    assert len(bench["seidel"]["surfaces"]) == len(facts["surfaces"])
    heights = bench["mtf"]["height"]
    assert len(bench["mtf"]["diffraction_tangential"]) == len(heights)
    assert bench["field"]["relative_illumination"][0] == 1
    assert bench["points"][0]["rms"] > 0


@pytest.mark.parametrize("field", ["10", "10mm", "0", "12deg"])
def test_the_psf_of_a_point(field: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lens", LENS, "--psf", f"{field},inf", "--f-stop", "8", "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["distance_m"] is None
    (film,) = facts["films"]
    assert film["film_mm"] == 0
    assert 0 < film["radius_50_mm"] < film["radius_80_mm"]
    assert facts["focus_m"] is None
    if field == "12deg":
        assert facts["angle_deg"] == pytest.approx(12, abs=1e-6)


@pytest.mark.parametrize(("focus", "says"), [([], "infinity"), (["--focus", "3"], "3 m")])
def test_the_psf_says_what_is_in_focus(
    focus: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["lens", LENS, "--psf", "0,3", "--f-stop", "8", *focus]) == 0
    assert f"focused at {says}: a point at 3 m" in capsys.readouterr().out


def test_through_focus_is_sharpest_in_the_middle(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    pytest.importorskip("matplotlib", reason="pictures are drawn by matplotlib")
    picture = tmp_path / "psf.png"
    command = ["lens", LENS, "--psf", "0,inf", "--through-focus", "--f-stop", "16"]
    assert main([*command, "-o", str(picture), "--json"]) == 0
    films = json.loads(capsys.readouterr().out)["films"]
    rms = [film["rms_mm"] for film in films]
    assert len(rms) == 9
    assert rms.index(min(rms)) == 4
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert main(command) == 0
    assert len(capsys.readouterr().out.splitlines()) == 11


@pytest.mark.parametrize(
    ("flags", "code", "says"),
    [
        (["--psf", "10"], 2, "FIELD,DISTANCE"),
        (["--psf", "10,-1"], 2, "above 0"),
        (["--psf", "10kg,1"], 2, "--psf"),
        (["--psf", "89deg,inf"], 3, "light reaches the film"),
        (["--through-focus"], 2, "--psf"),
        (["--plot", "x.gif"], 2, "--plot"),
        (["--drawing", "x.jpg"], 2, "--drawing"),
        (["--focus-by", "eye", "--json"], 2, "best or paraxial"),
        (["--f-stop", "1", "--json"], 3, "f/2.8"),
        (["--focus", "0.01", "--json"], 3, "nearest"),
        (["--zoom", "70", "--json"], 3, "lens-zoom"),
    ],
)
def test_what_cannot_be_is_said(
    flags: list[str], code: int, says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["lens", LENS, *flags]) == code
    error = capsys.readouterr().err
    assert says in error
    assert "Traceback" not in error


def test_a_lens_is_exported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "lens.json"
    given = [
        "--export",
        str(file),
        "--degree",
        "3",
        "--focus",
        "2",
        "--sensor",
        "apsc",
        "--blades",
        "5",
    ]
    assert main(["lens", LENS, "--export", str(file), *given]) == 0
    data = json.loads(file.read_text())
    assert data["degree"] == 3
    assert data["setting"]["focus_m"] == 2
    assert len(data["setting"]["iris"]["edges"]) == 5
    assert data["film"]["half"][0] < 16
    said = capsys.readouterr()
    assert "degree 3" in said.err
    assert "rad RMS" in said.err
    assert said.out == ""


def test_an_export_says_where_it_does_not_follow_the_lens(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "fisheye.json"
    assert main(["lens", "fisheye-16mm-f2.8", "--export", str(file), "--degree", "3"]) == 0
    said = capsys.readouterr().err
    assert re.search(r"off by more than 20 um RMS from [\d.]+ to 2[12].* mm off the middle", said)
    assert "a higher --degree" in said


@pytest.mark.parametrize(
    ("flags", "says"),
    [
        (["--export", "lens.txt"], "--export: wanted a name ending in .c, .glsl, .osl"),
        (["--export", "lens.osl", "--degree", "4"], "degree: wanted an odd number"),
        (["--export", "lens.osl", "--sensor", "huge"], "--sensor: wanted a size in mm"),
        (["--degree", "5"], "--degree needs --export FILE"),
        (["--blade-rotation", "5"], "--blade-rotation needs --export FILE"),
        (["--export", "lens.osl", "--blades", "2"], "blades: wanted 3 to 64"),
    ],
)
def test_a_wrong_export_is_refused(
    flags: list[str],
    says: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["lens", LENS, *flags]) == 2
    assert says in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("flags", "name"),
    [
        (["--plot"], "sheet.png"),
        (["--drawing"], "section.svg"),
        (["--psf", "0,inf", "--plot"], "psf.png"),
        (["--flare", "15", "--plot"], "ghosts.png"),
        (["--flare", "15", "--polynomial", "3", "--plot"], "both.png"),
        (["--flare", "15", "--drawing"], "ghost.svg"),
        (["--degree", "3", "--export"], "lens.json"),
    ],
)
def test_each_file_is_told(
    flags: list[str], name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if name.endswith(".png"):
        pytest.importorskip("matplotlib", reason="pictures are drawn by matplotlib")
    file = tmp_path / name
    assert main(["lens", LENS, *flags, str(file)]) == 0
    told = [line for line in capsys.readouterr().err.splitlines() if "wrote" in line]
    assert [line.partition(" (")[0] for line in told] == [f"daguerre: wrote {file}"]
    assert file.stat().st_size > 0


POLYNOMIAL = ["lens", LENS, "--flare", "10", "--polynomial"]


def test_polynomial_ghosts_have_their_errors_in_the_list(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Each row and the last lines have the numbers of --json."""
    assert main([*POLYNOMIAL, "7", "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert main([*POLYNOMIAL, "7"]) == 0
    out = capsys.readouterr().out
    lit = [ghost for ghost in facts["ghosts"] if ghost["light"] > 0]
    assert "error mm  of radius  centre off mm" in out
    for ghost in lit[:20]:
        error = ghost["polynomial"]
        row = next(r for r in out.splitlines() if r.startswith("{}-{} ".format(*ghost["surfaces"])))
        numbers = [f"{error[name]:.2g}" for name in ("error_mm", "error", "shift_mm")]
        assert row.removesuffix("  diverges").split()[-3:] == numbers
        assert row.endswith("  diverges") == error["diverges"]
    assert any(ghost["polynomial"]["diverges"] for ghost in lit)
    assert all(ghost["polynomial"] is None for ghost in facts["ghosts"][len(lit) :])
    whole = facts["polynomial"]
    assert (whole["degree"], whole["ghosts"]) == (7, len(lit))
    assert f"median error {whole['median_error_mm']:.2g} mm" in out
    assert f"{whole['diverging']} of {len(lit)} expansions diverge (degree 5 is better" in out
    assert re.search(
        rf"{whole['rays']} rays: polynomials [\d.]+ CPU s after [\d.]+ s of set-up, ", out
    )


def test_the_highest_degree_is_that_of_expansions() -> None:
    from daguerre.cli.lens.flare import MAX_DEGREE
    from daguerre.polynomial import elements

    assert MAX_DEGREE == elements.MAX_DEGREE


def test_a_surface_without_expansion_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lens = json.loads((LIBRARY / f"{LENS}.json").read_text())
    lens["surfaces"][3] |= {"kind": "aspheric", "asphere": {"a5": 1e-8}}
    odd = tmp_path / "odd.json"
    odd.write_text(json.dumps(lens))
    assert main(["lens", str(odd), "--flare", "0", "--polynomial", "3"]) != 0
    (line,) = capsys.readouterr().err.splitlines()
    assert "surface 3: Taylor expansion" in line
