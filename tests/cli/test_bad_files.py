"""Every file of the catalogue ends in one line and its exit code, or in a picture without NaN."""

from __future__ import annotations

import re
import tempfile
import time
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

from daguerre.cli import main
from daguerre.files.reading import shown
from tests.bad_files import CASES, Case

#: CPU time of one file in this process; the files measured as processes have 10 s on the clock.
CPU_S = 5.0


def contents(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*")}


def check_lines(case: Case, bad: Path, code: int, text: str) -> None:
    """The exit code, and what was said on stderr."""
    lines = text.splitlines()
    if not case.error:
        assert code == 0, text
        warnings = [line for line in lines if "warning: " in line]
        assert not case.warning or any(re.search(case.warning, line) for line in warnings), text
        return
    assert code == case.code, text
    last, start = lines[-1], f"daguerre: error: {shown(bad)}: "
    assert last.startswith(start), text
    assert re.search(case.error, last[len(start) :]), text
    assert all(line.startswith("daguerre: ") for line in lines), text
    assert len(last) < 800 + 2 * len(str(bad)), last


def check_picture(case: Case, path: Path) -> None:
    """Finite pixels, and none that had to be dropped, unless a warning counts them."""
    image = oiio.ImageInput.open(str(path))
    assert image is not None
    pixels = image.read_image("float")
    dropped = image.spec().get_int_attribute("daguerre:bad_samples", 0)
    image.close()
    assert np.isfinite(pixels).all()
    assert dropped == 0 or "NaN or infinite" in case.warning


@pytest.mark.parametrize("case", CASES, ids=[case.name for case in CASES])
def test_bad_file(tmp_path: Path, case: Case, capfd, monkeypatch) -> None:
    folder, outputs, temporary = (tmp_path / name for name in ("in", "out", "tmp"))
    for path in (folder, outputs, temporary):
        path.mkdir()
    bad = case.make(folder)
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    before = contents(folder)
    capfd.readouterr()
    started = time.process_time()
    code = main(case.words(bad, outputs / "o"))
    assert time.process_time() - started < CPU_S
    check_lines(case, bad, code, capfd.readouterr().err)
    assert contents(temporary) == set()
    if case.error:
        assert contents(outputs) == set()
        assert contents(folder) == before
    elif (outputs / "o.exr").exists():
        check_picture(case, outputs / "o.exr")
