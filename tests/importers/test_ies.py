"""Photometric files: what each form of LM-63 says, and files that are wrong."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import DaguerreError, InputError
from daguerre.importers import ies
from daguerre.scene.light_profile import ProfileTable
from tests.fuzz import changes

VERTICAL = "0 45 90"


def text(
    horizontal: str = "0",
    candelas: str = "100 60 20",
    head: str = "IESNA:LM-63-1995",
    facts: str = "1 1000 1 {v} {h} 1 2 0.1 0.1 0",
    factors: str = "1 1 50",
    tilt: str = "TILT=NONE",
    vertical: str = VERTICAL,
) -> str:
    """A file of some lines."""
    counts = facts.format(v=len(vertical.split()), h=len(horizontal.split()))
    lines = [head, "[TEST] none", tilt, counts, factors, vertical, horizontal, candelas]
    return "\n".join(line for line in lines if line) + "\n"


def load(folder: Path, content: str | bytes, name: str = "lamp.ies") -> dg.LightProfile:
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode("latin-1"))
    return dg.LightProfile.from_ies(path)


def intensity(profile: dg.LightProfile, theta_deg: float, phi_deg: float) -> float:
    theta, phi = np.radians(theta_deg), np.radians(phi_deg)
    way = np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), -np.cos(theta)
    return float(profile.factors([way])[0, 1])


def test_candelas_stand_at_their_angles(tmp_path: Path) -> None:
    profile = load(tmp_path, text("0 90 180 270 360", "100 60 20 100 61 21 100 62 22 100 63 23 "
                                  "100 60 20"))  # fmt: skip
    assert profile.peak == 100
    for phi, expected in ((0, 60), (90, 61), (180, 62), (270, 63), (45, 60.5), (315, 61.5)):
        assert intensity(profile, 45, phi) == pytest.approx(expected, rel=1e-5)
    assert intensity(profile, 22.5, 90) == pytest.approx(80.5, rel=1e-5)
    assert intensity(profile, 90.1, 90) == 0
    assert profile.relative().peak == pytest.approx(1)


SYMMETRIES = {
    "the same all around": ("0", "9 5 1", {0: 5, 77: 5, 300: 5}),
    "quadrants": ("0 90", "9 5 1 9 7 1", {0: 5, 90: 7, 180: 5, 270: 7, 225: 6, 315: 6}),
    "two sides": ("0 90 180", "9 5 1 9 7 1 9 3 1", {90: 7, 180: 3, 270: 7, 315: 6, 225: 5}),
    "the other two sides": (
        "90 180 270", "9 5 1 9 7 1 9 3 1", {90: 5, 180: 7, 270: 3, 0: 7, 45: 6, 315: 5}
    ),
    "the circle": ("0 180 360", "9 5 1 9 7 1 9 5 1", {0: 5, 180: 7, 270: 6}),
    "a circle without its end": ("0 120 240", "9 5 1 9 7 1 9 3 1", {0: 5, 240: 3, 300: 4}),
}  # fmt: skip


@pytest.mark.parametrize("name", SYMMETRIES)
def test_symmetric_files_are_completed(name: str, tmp_path: Path) -> None:
    horizontal, candelas, expected = SYMMETRIES[name]
    profile = load(tmp_path, text(horizontal, candelas))
    for phi, value in expected.items():
        assert intensity(profile, 45, phi) == pytest.approx(value, rel=1e-5)


FACTORS = {
    "candela multiplier": ({"facts": "1 1000 2.5 {v} {h} 1 2 0 0 0"}, 2.5),
    "ballast factor": ({"factors": "0.9 1 50"}, 0.9),
    "ballast-lamp factor of 1995": ({"factors": "0.9 0.5 50"}, 0.45),
    "and of 1986, which has no first line": ({"head": "", "factors": "0.9 0.5 50"}, 0.45),
    "and of 1991": ({"head": "IESNA91", "factors": "1 0.5 50"}, 0.5),
    "none in 2002": ({"head": "IESNA:LM-63-2002", "factors": "0.9 0.5 50"}, 0.9),
    "the kind of test in 2019": ({"head": "IES:LM-63-2019", "factors": "1 1.1 50"}, 1),
    "a tilt of no effect": ({"tilt": "TILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8"}, 1),
    "a tilt": ({"tilt": "tilt=include\n1 2 -10 10 0.8 0.6"}, 0.7),
    "lamps and lumens": ({"facts": "4 -1 1 {v} {h} 1 1 0 0 0"}, 1),
}


@pytest.mark.parametrize("name", FACTORS)
def test_factors(name: str, tmp_path: Path) -> None:
    changed, factor = FACTORS[name]
    profile = load(tmp_path, text(**changed))
    assert intensity(profile, 0, 0) == pytest.approx(100 * factor, rel=1e-5)
    assert intensity(profile, 90, 30) == pytest.approx(20 * factor, rel=1e-5)


def test_lines_may_end_anywhere_and_names_have_any_encoding(tmp_path: Path) -> None:
    plain = load(tmp_path, text())
    words = text().split("\n")
    numbers = " ".join(words[3:]).split()
    for end in ("\n", "\r\n", "\r"):
        spread = end.join([*words[:2], "[MANUFAC] L\xe4mp \x85 \x0c", words[2], *numbers, "\x1a"])
        assert load(tmp_path, spread) == plain
    assert load(tmp_path, text().replace(" ", " , ", 0).replace("100 60", "100,60")) == plain


def test_upward_light(tmp_path: Path) -> None:
    profile = load(tmp_path, text(vertical="90 135 180"))
    assert intensity(profile, 180, 0) == pytest.approx(20)
    assert intensity(profile, 89, 0) == 0


FACTS = "1 1 1 {v} {h} 1 2 0 0 0"
BROKEN: dict[str, tuple[Any, str]] = {
    "no tilt": ("IESNA:LM-63-1995\n1 2 3\n", "no line TILT=NONE, which IES LM-63 requires"),
    "a tilt of a file": (text(tilt="TILT=../a.tlt"), "line 3: TILT: wanted NONE or INCLUDE, got"),
    "type B": (text(facts=FACTS.replace("1 2 0", "2 2 0")), "line 4: photometric type: wanted 1 "
               "(type C), got 2 (type B)"),
    "type A": (text(facts=FACTS.replace("1 2 0", "3 2 0")), "got 3 (type A)"),
    "no type": (text(facts=FACTS.replace("1 2 0", "7.5 2 0")), "wanted 1 (type C), got 7.5"),
    "a word": (text(candelas="100 abc 20"), "line 8: candelas: wanted a finite number, got 'abc'"),
    "nan": (text(candelas="100 nan 20"), "line 8: candelas: wanted a finite number, got 'nan'"),
    "an underscore": (text(candelas="100 6_0 20"), "line 8: candelas: wanted a finite number"),
    "negative": (text(candelas="100 -60 20"), "line 8: candelas: wanted at least 0, got -60"),
    "too few": (text(candelas="100 60"), "line 8: candelas: wanted a number, got the end of"),
    "too many": (text(candelas="100 60 20 5"), "line 8: end: wanted the end of the file, got '5'"),
    "half an angle": (text(facts=FACTS.replace("{v}", "2.5")), "line 4: number of vertical angles: "
                      "wanted a whole number, got 2.5"),
    "no angles": (text(facts=FACTS.replace("{v}", "0")), "line 4: number of vertical angles: "
                  "wanted 1 .. "),
    "a billion": (text(facts=FACTS.replace("{v} {h}", "1e6 1e6")), "line 4: numbers of angles: "
                  "wanted a product of at most"),
    "falling": (text(vertical="0 90 45"), "line 6: vertical angle: wanted more than 90, got 45"),
    "beyond": (text(vertical="0 90 190"), "line 6: vertical angle: wanted 0 .. 180, got 190"),
    "no range": (text("0 45", "1 2 3 4 5 6"), "line 7: horizontal angles: wanted a range of 0, "),
    "huge": (text(candelas="1e30 1 1", facts=FACTS.replace("1 1 1 ", "1 1 1e30 ")),
             "line 8: candelas: wanted finite numbers"),
    "nothing": ("", "no line TILT=NONE"),
    "bytes": (bytes(range(256)) * 20, "no line TILT=NONE"),
}  # fmt: skip


@pytest.mark.parametrize("name", BROKEN)
def test_broken_files_are_one_error_with_its_place(name: str, tmp_path: Path) -> None:
    content, said = BROKEN[name]
    with pytest.raises(InputError) as error:
        load(tmp_path, content)
    message = str(error.value)
    assert said in message
    assert message.startswith(str(tmp_path / "lamp.ies"))
    assert "\n" not in message


def test_what_is_no_file_of_this_kind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InputError, match="no such file"):
        dg.LightProfile.from_ies(tmp_path / "none.ies")
    (tmp_path / "folder.ies").mkdir()
    with pytest.raises(InputError, match="wanted a file, got a folder"):
        dg.LightProfile.from_ies(tmp_path / "folder.ies")
    with pytest.raises(InputError, match=r"wanted \.ies, got \.txt"):
        load(tmp_path, text(), "lamp.txt")
    monkeypatch.setattr(ies, "MAX_BYTES", 50)
    with pytest.raises(InputError, match="at most 50 bytes"):
        load(tmp_path, text())


def test_400_changed_files_are_read_or_refused_by_one_error(tmp_path: Path) -> None:
    seeds = [text("0 90 180", "9 5 1 9 7 1 9 3 1"), text(tilt="TILT=INCLUDE\n1\n2\n0 90\n1 0.5")]
    rng = random.Random(5)
    read = 0
    for i in range(400):
        seed = seeds[i % 2]
        data = (
            changes.in_text(rng, seed).encode("utf-8", "surrogatepass")
            if rng.random() < 0.7
            else changes.in_bytes(rng, seed.encode())
        )
        try:
            profile = load(tmp_path, data)
        except DaguerreError as error:
            assert "\n" not in str(error)  # noqa: PT017
            continue
        assert np.isfinite(profile.factors([(0, 0, -1), (1, 2, 3)])).all()
        read += 1
    assert 10 < read < 390


def test_a_table_of_many_angles_is_what_the_file_says(tmp_path: Path) -> None:
    theta, phi = np.arange(0, 181, 2.5), np.arange(0, 361, 5.0)
    values = np.random.default_rng(2).uniform(1, 1000, (len(theta), len(phi))).round(2)
    values[:, -1] = values[:, 0]
    profile = load(
        tmp_path,
        text(
            " ".join(map(str, phi)),
            "\n".join(" ".join(map(str, column)) for column in values.T),
            vertical=" ".join(map(str, theta)),
        ),
    )
    (table,) = profile.parts
    assert isinstance(table, ProfileTable)
    assert np.array_equal(table.values, values.astype(np.float32))
    assert profile == dg.LightProfile.table(theta, values, phi)
