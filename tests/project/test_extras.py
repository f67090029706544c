"""A missing package of an extra: one error says how to install it, before work begins."""

from __future__ import annotations

import json
import re
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import daguerre as dg
from daguerre.calibration import source
from daguerre.cli import main
from daguerre.development import camera_raw, ocio
from daguerre.files import extras
from tests.faults.scene import write_scene

ROOT = Path(__file__).parents[2]
RENDER = ["--lens", "double-gauss-50mm-f2", "--res", "8x6", "--spp", "1"]


@pytest.fixture
def without(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Hides a package."""

    def hide(module: str) -> None:
        real = extras.find_spec
        monkeypatch.setattr(
            extras, "find_spec", lambda name: None if name == module else real(name)
        )

    return hide


def test_every_extra_is_in_the_project_file() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    offered = project["optional-dependencies"]
    for name, extra in extras.EXTRAS.values():
        assert any(line.startswith(f"{name}>=") for line in offered[extra]), (name, extra)
        assert not any(line.startswith(name) for line in project["dependencies"]), name
    brought = {extra for _, extra in extras.EXTRAS.values()} - {"compare"}  # that is for tests
    assert offered["all"] == [f"daguerre[{','.join(sorted(brought))}]"]


def installed(monkeypatch: pytest.MonkeyPatch, record: dict[str, object] | None) -> None:
    """Makes pip's record of the installation."""
    text = None if record is None else json.dumps(record)
    found = SimpleNamespace(read_text=lambda name: text if name == "direct_url.json" else None)
    monkeypatch.setattr("importlib.metadata.distribution", lambda name: found)


def test_hint_of_an_editable_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    clone = tmp_path / "my clone"
    clone.mkdir()
    installed(monkeypatch, {"dir_info": {"editable": True}, "url": clone.as_uri()})
    monkeypatch.setattr(sys, "prefix", str(clone / ".venv"))
    assert extras.hint("matplotlib") == f"cd '{clone}' && .venv/bin/pip install -e '.[plot]'"
    monkeypatch.chdir(clone)
    assert extras.hint("matplotlib") == ".venv/bin/pip install -e '.[plot]'"
    monkeypatch.setattr(sys, "prefix", "/opt/env")
    assert extras.hint("pxr") == "/opt/env/bin/pip install -e '.[usd]'"


@pytest.mark.parametrize(
    "record",
    [None, {"archive_info": {}, "url": "file:///a.whl"}, {"dir_info": {}, "url": "file:///a"}],
)
def test_hint_of_a_wheel(record: dict[str, object] | None, monkeypatch: pytest.MonkeyPatch) -> None:
    installed(monkeypatch, record)
    assert extras.hint("matplotlib") == 'pip install "daguerre[plot]"'


@pytest.mark.parametrize(
    ("package", "words"),
    [
        ("tifffile", ["-o", "a.tif"]),
        ("tifffile", ["--sensor", "sony-a7r-ii", "-o", "a.dng"]),
        ("rawpy", ["--sensor", "sony-a7r-ii", "--iso", "100", "-o", "a.jpg"]),
        ("mitsuba_oidn", ["--denoise", "-o", "a.png"]),
    ],
)
def test_a_render_that_could_not_be_written_is_refused_first(
    package: str,
    words: list[str],
    tmp_path: Path,
    without: Callable[[str], None],
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    scene = write_scene(tmp_path / "scene.glb")
    without(package)
    assert main(["render", str(scene), *RENDER, "--quiet", *words]) == 2
    said = capsys.readouterr().err
    assert extras.hint(package) in said, said
    assert said.count("\n") == 1, said
    assert [path.name for path in tmp_path.iterdir()] == ["scene.glb"]


@pytest.mark.parametrize(
    ("package", "use"),
    [
        ("yaml", lambda folder: source.load(folder / "a.yaml")),
        ("rawpy", lambda folder: camera_raw.read_shot(folder / "a.dng")),
        ("PyOpenColorIO", lambda folder: ocio.view_of(_grey().rgb, "ACES 2.0")),
        ("tifffile", lambda folder: _grey().save(folder / "a.tif")),
    ],
)
def test_functions(
    package: str, use: Callable[[Path], object], tmp_path: Path, without: Callable[[str], None]
) -> None:
    (tmp_path / "a.yaml").write_text("a: 1\n")
    (tmp_path / "a.dng").write_bytes(b"II*\0")
    without(package)
    with pytest.raises(dg.UsageError, match=re.escape(extras.hint(package))):
        use(tmp_path)


def _grey() -> dg.Frame:
    return dg.Frame(np.full((4, 4, 3), 0.2, np.float32))
