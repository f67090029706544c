"""One version everywhere: core/version.h, CITATION.cff, the CHANGELOG, CMake and the built core."""

from __future__ import annotations

import re
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest
import yaml

import daguerre as dg

ROOT = Path(__file__).resolve().parents[2]
HEADER = (ROOT / "core" / "version.h").read_text()


def version() -> str:
    """The version as pyproject.toml finds it for the metadata of the package."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    row = project["tool"]["scikit-build"]["metadata"]["version"]
    assert row["input"] == "core/version.h"
    found = re.search(row["regex"], HEADER)
    assert found is not None
    return found["value"]


def test_it_is_a_version() -> None:
    assert re.fullmatch(r"\d+\.\d+\.\d+(rc\d+)?", version())
    assert HEADER.count("DG_VERSION") == 1


def test_citation_has_it() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert citation["version"] == version()
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert citation["license"] == project["license"]
    assert [a["name"] for a in citation["authors"]] == [a["name"] for a in project["authors"]]


def test_changelog_begins_with_it() -> None:
    headings = re.findall(r"^## (.*)$", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert re.fullmatch(
        re.escape(version()) + r" \((not yet released|\d{4}-\d\d-\d\d)\)", headings[0]
    )


def test_the_built_core_has_it() -> None:
    """Fails where the core is older than core/version.h: build it again."""
    assert dg.__version__ == version()


@pytest.mark.skipif(shutil.which("cmake") is None, reason="cmake is not installed")
@pytest.mark.parametrize(
    ("text", "number"), [("1.0.0rc1", "1.0.0"), ("12.10.3", "12.10.3"), ("2.0.1rc10", "2.0.1")]
)
def test_cmake_takes_its_numbers(tmp_path: Path, text: str, number: str) -> None:
    (tmp_path / "core").mkdir()
    (tmp_path / "core" / "version.h").write_text(HEADER.replace(version(), text))
    rules = (ROOT / "CMakeLists.txt").read_text().split("project(daguerre")[0]
    said = (
        f'if(NOT version STREQUAL "{number}")\nmessage(FATAL_ERROR "it is ${{version}}")\nendif()\n'
    )
    (tmp_path / "check.cmake").write_text(rules + said)
    subprocess.run(["cmake", "-P", "check.cmake"], cwd=tmp_path, check=True)


def test_changelog_is_for_readers() -> None:
    """A section has at most 60 lines; stages that were never released have none."""
    sections = re.split(r"^## ", (ROOT / "CHANGELOG.md").read_text(), flags=re.MULTILINE)[1:]
    assert [s.splitlines()[0] for s in sections[1:] if "not yet released" in s] == []
    assert max(len(s.rstrip().splitlines()) for s in sections) <= 60
