"""The recipes of other package systems say what pyproject.toml says."""

from __future__ import annotations

import re
import tarfile
import tomllib
import zipfile
from pathlib import Path
from typing import Any

import pytest
import yaml

import daguerre as dg

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
RECIPE = yaml.safe_load((ROOT / "packaging" / "conda-recipe.yaml").read_text())
#: Names that differ in conda's channel; nanobind's library is linked there, so None.
CONDA = {
    "OpenImageIO": "py-openimageio",
    "OpenEXR": "openexr-python",
    "nanobind-backend": None,
}


def in_conda(requirements: list[str]) -> set[str]:
    pairs = [re.match(r"([\w-]+)(.*)", one) for one in requirements]
    named = [(CONDA.get(one[1], one[1]), one[2]) for one in pairs if one]
    return {f"{name} {versions}" for name, versions in named if name}


def test_the_conda_recipe_has_the_version_and_the_licence() -> None:
    assert RECIPE["context"]["version"] == dg.__version__
    assert RECIPE["about"]["license"] == PROJECT["project"]["license"]


def test_the_conda_recipe_has_the_dependencies() -> None:
    needs: dict[str, Any] = RECIPE["requirements"]
    assert set(needs["run"]) - {"python"} == in_conda(PROJECT["project"]["dependencies"])
    assert in_conda(PROJECT["build-system"]["requires"]) <= set(needs["host"])
    assert f"cmake {PROJECT['tool']['scikit-build']['cmake']['version']}" in needs["build"]


def test_wheels_of_all_systems_are_of_the_stable_abi() -> None:
    wheels = PROJECT["tool"]["cibuildwheel"]
    abi = wheels["config-settings"]["wheel.py-api"]
    assert f"-C wheel.py-api={abi}" in (ROOT / "script" / "make-wheels").read_text()
    lowest = PROJECT["project"]["requires-python"].removeprefix(">=3.")
    assert abi == f"cp3{lowest}"
    assert wheels["build"][0] == f"cp3{lowest}-*"
    assert (ROOT / wheels["linux"]["before-all"].split()[0]).exists()


def test_the_source_package_has_no_file_of_the_extension(tmp_path: Path, monkeypatch: Any) -> None:
    build = pytest.importorskip("scikit_build_core.build", reason="no scikit-build-core here")
    if not (ROOT / ".git").exists():
        pytest.skip("no checkout here, of which a source package is made")
    monkeypatch.chdir(ROOT)
    with tarfile.open(tmp_path / build.build_sdist(str(tmp_path))) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert {"LICENSE", "core/version.h", "scenes/extensions/glass.py"} <= names
    assert not [name for name in names if name.startswith("extensions/")]


def test_the_made_wheel_has_the_licence_and_the_package_alone() -> None:
    wheels = sorted((ROOT / "dist").glob("daguerre-*.whl"))
    if not wheels:
        pytest.skip("no dist/daguerre-*.whl; script/make-wheels makes it")
    for wheel in wheels:
        with zipfile.ZipFile(wheel) as archive:
            texts = {name: archive.read(name) for name in archive.namelist()}
        assert {name.split("/")[0].partition("-")[0] for name in texts} <= {
            "daguerre", "daguerre.libs",
        }  # fmt: skip
        assert any(name.endswith(".dist-info/licenses/LICENSE") for name in texts)
        assert not [name for name, text in texts.items() if b"GPL-3.0-or-later" in text]
