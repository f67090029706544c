"""Differences from measured products, which the package has."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from daguerre import lenses
from daguerre.cli import main
from daguerre.lenses.agreement import Agreement, agreement
from daguerre.lenses.library import FOLDER

LENS = "canon-ef-85mm-f1.8"


def test_line_of_a_product() -> None:
    found = Agreement("A", 1.0, 0.25, 0.5, 0.125, 0.06, 0.124, 0.13)
    assert str(found) == (
        "Differences from the measured product: distortion 1.00 px, red 0.25 px, blue 0.50 px, "
        "light 0.12 EV open, 0.06 EV stopped down, magnification 0.12 (maker 0.13)"
    )


def test_line_of_a_relative_without_light() -> None:
    found = str(Agreement("B", distortion_px=1.0))
    assert found == "Differences from a measured relative: distortion 1.00 px"


def test_line_says_what_was_fitted() -> None:
    fitted = ("magnification", "vignetting")
    found = str(Agreement("A", open_ev=0.1, magnification=0.2, stated=0.21, fitted=fitted))
    light, near = "light 0.10 EV open (mount fitted)", "(maker 0.21, travel fitted)"
    assert found.endswith(f": {light}, magnification 0.20 {near}")


def test_command_prints_it(capsys: pytest.CaptureFixture[str]) -> None:
    found = agreement(lenses.load(LENS))
    assert found is not None
    assert found.blue_px is not None
    assert main(["lens", LENS]) == 0
    assert f"{found}\n" in capsys.readouterr().out


def test_lens_that_was_not_measured_has_none(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = shutil.copy(FOLDER / f"{LENS}.json", tmp_path / f"{LENS}.json")
    for lens in ("double-gauss-50mm-f2", str(own)):
        assert agreement(lenses.load(lens)) is None
        assert main(["lens", lens]) == 0
        assert "Differences from" not in capsys.readouterr().out
