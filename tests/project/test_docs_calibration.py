"""The worked examples of docs/coming-from.md, typed as they stand, in an empty folder."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from daguerre import cli

PAGE = Path(__file__).resolve().parents[2] / "docs" / "coming-from.md"
FILES = {"OpenCV": ["camera.yml"], "ROS": ["left.yaml", "right.yaml"], "Kalibr": ["camchain.yaml"]}


def sections() -> dict[str, str]:
    parts = re.split(r"^## ", PAGE.read_text(), flags=re.MULTILINE)[1:]
    return {part.split(":")[0]: part for part in parts}


def blocks(text: str, kind: str) -> list[str]:
    found = re.findall(r"^```(\w*)\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    return [content for of, content in found if of == kind]


def follow(name: str) -> dict[str, Any]:
    """Writes the files, types the commands and runs the Python of a section; what it found."""
    text = sections()[name]
    written = blocks(text, "yaml")
    assert len(written) == len(FILES[name])
    for file, content in zip(FILES[name], written, strict=True):
        assert f"`{file}`" in text
        Path(file).write_text(content)
    for line in "".join(blocks(text, "")).splitlines():
        program, *rest = shlex.split(line)
        assert program == "daguerre"
        done = CliRunner().invoke(cli.app, rest)
        assert done.exit_code == 0, done.output
    found: dict[str, Any] = {}
    imports = blocks(sections()["OpenCV"], "python")[0].split("\n\n")[0]
    exec("import yaml\nfrom pathlib import Path\n" + imports, found)
    for code in blocks(text, "python"):
        exec(code, found)
    return found


def test_each_section_has_files_commands_and_code() -> None:
    assert list(sections()) == list(FILES)
    for text in sections().values():
        assert all(blocks(text, kind) for kind in ("yaml", "", "python"))
        for code in blocks(text, "python"):
            compile(code, str(PAGE), "exec")


@pytest.fixture
def empty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.slow
@pytest.mark.usefixtures("empty")
def test_opencv_measures_the_distance_of_a_board() -> None:
    found = follow("OpenCV")
    assert len(found["ids"]) == 28
    assert found["error"] < 0.1
    assert found["place"][2, 0] == pytest.approx(found["distance"], abs=1e-4)
    assert found["camera"].projection.model == "opencv"


@pytest.mark.slow
@pytest.mark.usefixtures("empty")
def test_ros_rectifies_a_pair_to_level_rows_and_true_depth() -> None:
    found = follow("ROS")
    assert abs(found["off"][:, 1]).max() < 0.2
    assert found["depth"] == pytest.approx(0.6, abs=1e-3)


@pytest.mark.slow
@pytest.mark.usefixtures("empty")
def test_kalibr_measures_squares_of_the_right_size() -> None:
    found = follow("Kalibr")
    assert found["squares"].mean() == pytest.approx(0.030, abs=1e-5)
    assert found["squares"].std() < 2e-4
