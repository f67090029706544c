"""Recipes are data: they name files of their own folder alone, and write none."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.lenses.index import FOLDER
from daguerre.pictures.exr.reader import ExrReader
from daguerre.post.run import HISTORY

FILM = {"focal_length": 50, "sensor": "36x24"}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder ``looks`` beside pictures, in the current folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "looks").mkdir()
    light = np.ones((6, 8, 3), np.float32)
    for name in ("in.exr", "kernel.exr", "looks/kernel.exr"):
        dg.Frame(light[:3, :3] if "kernel" in name else light).save(name)
    return tmp_path


def post(entry: dict[str, object], *words: str) -> int:
    """Applies a recipe of one effect."""
    Path("looks/r.json").write_text(json.dumps([entry]))
    return int(main(["post", "in.exr", "-o", "out.exr", "--recipe", "looks/r.json", *words]))


def history() -> str:
    """List of the effects that made the picture."""
    with ExrReader("out.exr") as reader:
        return str(reader.facts[HISTORY])


def test_a_recipe_writes_nothing(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = Path("kernel.exr").read_bytes()
    for target in (folder / "kernel.exr", "kernel.exr", "new.exr"):
        effect = {"effect": "distortion", "k1": -0.1, **FILM, "stmap": str(target)}
        assert post(effect) == 3
        assert "r.json: [0]: stmap: a recipe writes no file" in capsys.readouterr().err
    assert Path("kernel.exr").read_bytes() == before
    assert {path.name for path in folder.rglob("*.exr")} == {"in.exr", "kernel.exr"}


@pytest.mark.parametrize(
    ("effect", "key"),
    [
        ({"effect": "psf"}, "file"),
        ({"effect": "stmap"}, "file"),
        ({"effect": "diffraction", "f_number": 8, "sensor": "36x24"}, "dust"),
        ({"effect": "fake-flare"}, "aperture_image"),
        ({"effect": "distortion", "model": "lens", "sensor": "36x24"}, "lens"),
    ],
)
def test_files_elsewhere_are_refused(
    folder: Path, effect: dict[str, object], key: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("looks/link.exr").symlink_to(folder / "kernel.exr")
    for name in ("../kernel.exr", str(folder / "kernel.exr"), "link.exr"):
        assert post({**effect, key: name}) == 3
        error = capsys.readouterr().err
        assert f"r.json: [0]: {key}: leaves the recipe's folder" in error
        assert "--effect may name others" in error
    assert not Path("out.exr").exists()


def test_files_of_the_recipes_folder(folder: Path) -> None:
    """Names count from the recipe; the history has them as they were given, and no output."""
    assert post({"effect": "psf", "file": "kernel.exr"}) == 0
    assert '"file": "kernel.exr"' in history()
    (folder / "looks" / "a.json").write_bytes((FOLDER / "double-gauss-50mm-f2.json").read_bytes())
    for lens in ("double-gauss-50mm-f2", "a.json"):
        assert post({"effect": "vignetting", "model": "lens", "sensor": "36x24", "lens": lens}) == 0
    words = "distortion:k1=-0.1,focal_length=50,sensor=36x24,stmap=st.exr"
    assert main(["post", "in.exr", "-o", "out.exr", "--effect", words]) == 0
    assert Path("st.exr").is_file()
    assert "stmap" not in history()
