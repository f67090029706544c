"""``daguerre demo``: the scene, its picture, and the command that makes it again."""

from __future__ import annotations

import shlex
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.files import extras


@pytest.mark.parametrize("denoised", [True, False])
def test_a_picture_and_its_command(
    denoised: bool,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    if not denoised:
        monkeypatch.setattr(extras, "find_spec", lambda name: None)
    monkeypatch.chdir(tmp_path)
    assert main(["demo", "--res", "30x20", "--spp", "1"]) == 0
    said = capsys.readouterr().out.splitlines()
    assert (extras.hint("mitsuba_oidn") in said[0]) is not denoised
    names = {"night_table.glb", "demo.png", "demo.exr"}
    assert {path.name for path in (tmp_path / "out").iterdir()} == names
    before = dg.load_frame(tmp_path / "out" / "demo.exr").rgb
    assert before.mean() > 0.01
    command = shlex.split(next(line for line in said if line.startswith("daguerre render")))
    assert main([word.replace("demo.", "again.") for word in command[1:]]) == 0
    np.testing.assert_array_equal(dg.load_frame(tmp_path / "out" / "again.exr").rgb, before)


def test_a_denoiser_that_cannot_be_loaded_leaves_the_picture_noisy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def broken(name: str) -> None:
        raise RuntimeError("could not load the thread pool library")

    monkeypatch.setattr("daguerre.rendering.denoise.import_module", broken)
    monkeypatch.setattr(extras, "missing", lambda module: False)
    assert main(["demo", str(tmp_path), "--res", "30x20", "--spp", "1"]) == 0
    assert "libatomic1" in capsys.readouterr().out.splitlines()[0]
    assert (tmp_path / "demo.png").is_file()


def test_it_opens_in_the_viewfinder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("websockets", reason="needs the extra view")
    opened = []
    monkeypatch.setattr("daguerre.viewfinder.run.run", lambda *all_: opened.append(all_) or 0)
    assert main(["demo", str(tmp_path), "--view", "--res", "30x20"]) == 0
    ((stage, dials, *_),) = opened
    assert stage.settings.film.resolution == (30, 20)
    given = {"lens": "double-gauss-50mm-f2", "f_stop": "2", "spp": "32"}
    metered = {"exposure": "manual", "iso": dials.texts["iso"]}
    assert dials.texts == given | metered


def test_a_folder_that_cannot_be_made(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert main(["demo", str(tmp_path / "file" / "out")]) == 5
    assert "cannot write" in capsys.readouterr().err
