"""The diffs of examples/ that add a camera, a BSDF, a channel and a layer: short, and right."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Any

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
MOST = {"camera_kind": 4, "bsdf": 9, "aov": 2, "film_layer": 3}  # files

pytestmark = pytest.mark.skipif(shutil.which("git") is None, reason="git applies the diffs")


def git_apply(folder: Path, name: str, *options: str) -> str:
    """Applies a diff to a folder, a repository or not; returns the words of git."""
    return subprocess.run(
        ["git", "apply", *options, str(ROOT / "examples" / f"{name}.diff")],
        cwd=folder,
        env={**os.environ, "GIT_CEILING_DIRECTORIES": str(folder.parent)},
        capture_output=True,
        text=True,
        check=True,
    ).stdout


def size_of(name: str) -> tuple[int, int]:
    """Files and new lines of a diff."""
    rows = [line.split("\t") for line in git_apply(ROOT, name, "--numstat").splitlines()]
    return len(rows), sum(int(row[0]) for row in rows)


@pytest.mark.parametrize("name", MOST)
def test_a_diff_applies_and_touches_few_files(name: str) -> None:
    git_apply(ROOT, name, "--check")
    files, _ = size_of(name)
    assert 0 < files <= MOST[name]


@pytest.mark.parametrize("name", MOST)
def test_contributing_tells_its_size(name: str) -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text()
    told = re.search(rf"examples/{name}\.diff\): (\d+) files, (\d+) lines", text)
    assert told is not None
    assert (int(told[1]), int(told[2])) == size_of(name)


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Figures of a build with all diffs."""
    pytest.importorskip("nanobind", reason="the core is built here")
    if shutil.which("cmake") is None or shutil.which("ninja") is None:
        pytest.skip("the core is built here: wanted cmake and ninja")
    folder = tmp_path_factory.mktemp("patched")
    for part in ("core", "cmake", "python"):
        shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("_core*.so"))
    shutil.copy(ROOT / "CMakeLists.txt", folder)
    for name in MOST:
        git_apply(folder, name)
    options = ("-DDG_TESTS=OFF", "-DDG_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}")
    run(["cmake", "-S", ".", "-B", "build", "-G", "Ninja", *options], folder)
    run(["cmake", "--build", "build", "--target", "_core"], folder)
    (built,) = (folder / "build").rglob("_core*.so")
    shutil.copy(built, folder / "python" / "daguerre")
    program = Path(__file__).with_name("applied_diffs.py")
    # -S: an editable install would come before the patched package.
    return json.loads(run([sys.executable, "-S", str(program)], folder))


def run(command: list[str], folder: Path) -> str:
    """Output of a command that sees the patched package."""
    places = [
        str(folder / "python"),
        *{sysconfig.get_path(name) for name in ("purelib", "platlib")},
    ]
    found = subprocess.run(
        command,
        cwd=folder,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(places)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert found.returncode == 0, found.stdout + found.stderr
    return found.stdout


@pytest.mark.slow
@pytest.mark.xdist_group("patched core")
def test_a_singlet_is_sharp_on_a_bowl(measured: Any) -> None:
    found = measured["bundles"]
    assert found["depths"] == pytest.approx(found["wanted"], rel=1e-4)
    assert found["weights"] == pytest.approx([1, 1, 1], rel=1e-6)
    assert found["back"] < 1e-9


@pytest.mark.slow
@pytest.mark.xdist_group("patched core")
@pytest.mark.parametrize("state", ["still", "focusing"])
def test_light_finds_its_way_back_through_a_singlet(measured: Any, state: str) -> None:
    (seen, *seen_at), (sent, *sent_at) = measured[state]
    assert seen > 1
    assert sent == pytest.approx(seen, rel=0.003)
    # Without the factor by which the field's curvature spreads rays, the middle moves by 0.017 px.
    assert sent_at == pytest.approx(seen_at, abs=0.006)


@pytest.mark.slow
@pytest.mark.xdist_group("patched core")
def test_a_roof_has_its_slope(measured: Any) -> None:
    assert measured["slope"] == pytest.approx([30, 30], abs=1e-3)


@pytest.mark.slow
@pytest.mark.xdist_group("patched core")
def test_what_a_kind_does_not_take_is_refused(measured: Any) -> None:
    assert measured["refusal"] == "camera: tilt: wanted none of a singlet, got (3, 0)"


def rough_albedo(degrees: float, reflectance: float, roughness: float) -> float:
    """Oren and Nayar's albedo: the integral of f |cos| over the hemisphere, by Fujii's formula."""
    n = 400
    u, phi = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n * 2 * np.pi)
    cos_i = np.sqrt(u)  # evenly in cos^2, as |cos| weights them
    wi = np.stack([np.sqrt(1 - u) * np.cos(phi), np.sqrt(1 - u) * np.sin(phi), cos_i])
    cos_o, sin_o = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    s = wi[0] * sin_o + cos_i * cos_o - cos_i * cos_o
    t = np.where(s > 0, np.maximum(cos_i, cos_o), 1)
    scale = 1 / (1 + (0.5 - 2 / (3 * np.pi)) * roughness)
    return float((reflectance * scale * (1 + roughness * s / t)).mean())


@pytest.mark.slow
@pytest.mark.xdist_group("patched core")
def test_a_rough_matte_plane_has_the_albedo_of_its_formula(measured: Any) -> None:
    wanted = [rough_albedo(degrees, 0.5, 0.8) for degrees in (0, 60)]
    assert measured["albedos"] == pytest.approx(wanted, rel=0.005)
    assert wanted[1] > 1.02 * wanted[0]  # a limb that does not darken


@pytest.mark.slow
@pytest.mark.xdist_group("patched core")
def test_a_surface_that_passes_light_has_no_roughness(measured: Any) -> None:
    assert "roughness: wanted a number from 0 to 0, got 1" in measured["rough_diffuse_refusal"]


@pytest.mark.slow
@pytest.mark.xdist_group("patched core")
def test_a_layer_of_bright_samples_holds_them(measured: Any) -> None:
    dim, bright, merged, saved = measured["bright"]
    assert dim == 0
    assert bright == pytest.approx(2, rel=0.02)
    assert merged == saved == bright
