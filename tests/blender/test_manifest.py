"""The manifest of the extension for Blender, and the zip that users install."""

import io
import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tomllib
import zipfile
from pathlib import Path

import pytest

import daguerre as dg
from tests.support.blender.blender_extension import FOLDER, ROOT, wheel_of_this

sys.path.insert(0, str(ROOT / "packaging"))
import blender_manifest

TEXT = (FOLDER / "blender_manifest.toml").read_text()
WHEEL = "some-1.0-py3-none-any.whl"
SCRIPT = ROOT / "script" / "make-blender-extension"


def made(version="1.0.0rc1", wheels=(WHEEL,)):
    return tomllib.loads(blender_manifest.filled(TEXT, version, list(wheels)))


def test_the_manifest_is_good_with_its_wheels():
    manifest = made()
    assert blender_manifest.faults(manifest, {f"wheels/{WHEEL}"}) == []
    assert manifest["version"] == "1.0.0-rc1"
    assert manifest["wheels"] == [f"./wheels/{WHEEL}"]


def test_the_package_s_version_becomes_a_semantic_one():
    assert blender_manifest.semantic("2.3.4") == "2.3.4"
    assert blender_manifest.faults(made(dg.__version__), {f"wheels/{WHEEL}"}) == []


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("schema_version", "2.0.0"),
        ("id", "daguerre_for_blender"),
        ("id", "dag-uerre"),
        ("version", "1.0.0rc1"),
        ("version", "1.0"),
        ("name", ""),
        ("tagline", "Renders."),
        ("tagline", "x" * 65),
        ("maintainer", None),
        ("type", "addon"),
        ("blender_version_min", "4.1.0"),
        ("blender_version_min", "5.0"),
        ("license", ["GPL-3.0-or-later"]),
        ("license", []),
        ("platforms", ["linux"]),
        ("tags", "Render"),
        ("permissions", ["files"]),
        ("permissions", {"disk": "Writes files"}),
        ("permissions", {"files": "Writes files."}),
        ("wheels", ["./wheels/some.whl"]),
        ("wheels", ["./wheels/other-1.0-py3-none-any.whl"]),
        ("wheels", "none"),
    ],
)
def test_a_planted_fault_is_found(name, value):
    manifest = made() | {name: value}
    found = blender_manifest.faults(manifest, {f"wheels/{WHEEL}"})
    assert found
    assert all(fault.startswith(name) for fault in found)


def test_a_wheel_outside_of_the_list_is_found():
    files = {f"wheels/{WHEEL}", "wheels/other-1.0-py3-none-any.whl"}
    assert len(blender_manifest.faults(made(), files)) == 1


def test_every_file_names_its_licence():
    assert "GNU GENERAL PUBLIC LICENSE\n" in (FOLDER / "LICENSE").read_text()
    for path in (*FOLDER.glob("*.py"), FOLDER / "blender_manifest.toml"):
        first = path.read_text().split("\n")[0]
        assert first == "# SPDX-License-Identifier: GPL-3.0-or-later", path


def test_nothing_of_the_package_is_under_the_extension_s_licence():
    for path in (ROOT / "python").rglob("*.py"):
        assert "GPL" not in path.read_text(), path


@pytest.fixture
def wheels(tmp_path):
    """A wheel of ours and a folder with another one."""
    other = tmp_path / "wheels"
    other.mkdir()
    own = tmp_path / f"daguerre-{dg.__version__}-cp311-abi3-manylinux_2_34_x86_64.whl"
    own.write_bytes(b"ours" * 100)
    (other / WHEEL).write_bytes(b"other")
    return own, other


def make(own, other, out):
    words = [sys.executable, SCRIPT, "--wheel", own, "--wheels", other, "--out", out]
    return subprocess.run(words, capture_output=True, text=True, check=False)


def test_the_zip_has_the_source_and_the_wheels_and_the_same_bytes_again(wheels, tmp_path):
    own, other = wheels
    first, again = make(own, other, tmp_path / "a"), make(own, other, tmp_path / "b")
    assert first.returncode == again.returncode == 0, first.stderr
    (path,), (path_again,) = (tmp_path / "a").iterdir(), (tmp_path / "b").iterdir()
    assert path.name == f"daguerre-{dg.__version__}-linux-x64.zip"
    assert path.read_bytes() == path_again.read_bytes()
    with zipfile.ZipFile(path) as archive:
        names = set(archive.namelist())
        manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
        assert archive.read(f"wheels/{WHEEL}") == b"other"
    assert {p.name for p in FOLDER.glob("*.*")} | {"LICENSE"} <= names
    assert not any("__pycache__" in name or name.endswith(".pyc") for name in names)
    assert sorted(manifest["wheels"]) == sorted(
        f"./{name}" for name in names if name.startswith("wheels/")
    )


def test_a_zip_that_is_too_large_is_refused_and_removed(wheels, tmp_path):
    own, other = wheels
    with own.open("wb") as file:
        file.truncate(41_000_000)
    found = make(own, other, tmp_path / "a")
    assert found.returncode == 1
    assert "wanted at most 40 MB" in found.stderr
    assert list((tmp_path / "a").iterdir()) == []


def test_a_wheel_that_is_not_there_is_one_line(tmp_path):
    found = make(tmp_path / "none.whl", tmp_path, tmp_path / "a")
    assert found.returncode == 1
    assert found.stderr.startswith("make-blender-extension: wanted a wheel")
    assert "Traceback" not in found.stderr


def test_blender_s_own_check_accepts_the_zip(wheels, tmp_path):
    bpy = pytest.importorskip("bpy", reason="no bpy here, which brings Blender's check")
    check = Path(bpy.utils.system_resource("SCRIPTS")) / "addons_core/bl_pkg/cli/blender_ext.py"
    if not check.exists():
        pytest.skip(f"no {check}")
    own, other = wheels
    assert make(own, other, tmp_path / "a").returncode == 0
    (path,) = (tmp_path / "a").iterdir()
    words = [sys.executable, check, "validate", path]
    found = subprocess.run(words, capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stdout + found.stderr


def test_the_made_zip_is_small_enough():
    zips = sorted((ROOT / "dist").glob("daguerre-*-linux-x64.zip"))
    if not zips:
        pytest.skip(
            "no dist/daguerre-VERSION-linux-x64.zip; script/make-blender-extension makes it"
        )
    for path in zips:
        assert path.stat().st_size <= 40e6
        with zipfile.ZipFile(path) as archive:
            needed = {"daguerre", "nanobind_backend", "mmh3", "deflate", "openexr", "tifffile"}
            wheels = {name.split("/")[1].split("-")[0].lower() for name in archive.namelist()
                      if name.startswith("wheels/")}  # fmt: skip
            assert needed <= wheels
            assert "numpy" not in wheels


def test_the_script_is_executable():
    assert shutil.which(str(SCRIPT))


def test_the_zip_installs_in_blender(tmp_path):
    """Blender unpacks the wheels of its Python and turns the extension on."""
    pytest.importorskip("bpy", reason="no bpy here, in which the zip is installed")
    others = tmp_path / "wheels"
    others.mkdir()
    own = wheel_of_this(tmp_path)
    (others / WHEEL).write_bytes(small_wheel())
    found = make(own, others, tmp_path)
    assert found.returncode == 0, found.stderr
    (path,) = tmp_path.glob("*.zip")
    facts, home = installed(tmp_path, path, lambda name: name != "daguerre")
    assert facts["lens"] == "blender"
    for place in (facts["package"], facts["core"]):
        assert Path(place).is_relative_to(home), place


def test_the_made_zip_draws_in_a_blender_that_has_nothing_else(tmp_path):
    """F12 in a Python with Blender and its NumPy alone: all else comes out of the zip."""
    pytest.importorskip("bpy", reason="no bpy here, in which the zip is installed")
    zips = sorted((ROOT / "dist").glob("daguerre-*-linux-x64.zip"), key=os.path.getmtime)
    if not zips:
        pytest.skip(
            "no dist/daguerre-VERSION-linux-x64.zip; script/make-blender-extension makes it"
        )
    facts, home = installed(tmp_path, zips[-1], OF_BLENDER.__contains__, tmp_path / "a.exr")
    for name in ("daguerre", "nanobind_backend", "mmh3"):
        assert Path(facts["modules"][name]).is_relative_to(home), facts["modules"][name]
    others = [place for place in facts["modules"].values() if "site-packages" in place]
    assert not [place for place in others if place.startswith(str(ROOT))], others
    corner, middle = facts["colours"]
    assert min(corner) > 0
    assert min(middle) > 1.5 * max(corner)  # the lit cube before the grey world


#: Packages of Blender's own Python, with those that its network access needs.
OF_BLENDER = {"bpy", "numpy", "requests", "urllib3", "idna", "charset_normalizer", "certifi"}


def installed(folder, path, is_kept, *picture):
    """Facts of a Blender with a fresh home in which a zip is installed, and that home.

    Its Python has the packages alone whose names are kept.
    """
    home, bare = folder / "home", folder / "bare"
    home.mkdir()
    bare.mkdir()
    for one in Path(sysconfig.get_path("platlib")).iterdir():
        if is_kept(one.name.split("-")[0].removesuffix(".libs")):
            (bare / one.name).symlink_to(one)
    # OpenImageIO and more, which lie in the folder of Python where Blender is a program
    paths = [bare, *bare.glob("bpy/*/python/lib/python*/site-packages")]
    settings = {
        "BLENDER_USER_RESOURCES": str(home),
        "PYTHONPATH": os.pathsep.join(map(str, paths)),
    }
    script = ROOT / "tests" / "support" / "blender" / "blender_install.py"
    found = subprocess.run(
        [sys.executable, "-S", script, path, *picture],
        capture_output=True, text=True, check=False, timeout=300, cwd=folder,
        env={**os.environ, **settings},
    )  # fmt: skip
    lines = [line for line in found.stdout.splitlines() if line.startswith("FACTS ")]
    assert lines, found.stdout + found.stderr
    facts = json.loads(lines[0].removeprefix("FACTS "))
    assert facts["done"] == ["FINISHED"]
    assert facts["engine"] == "DAGUERRE"
    return facts, home


def small_wheel():
    """Bytes of a wheel with one empty module."""
    info = "some-1.0.dist-info"
    files = {
        "some.py": "",
        f"{info}/METADATA": "Metadata-Version: 2.1\nName: some\nVersion: 1.0\n",
        f"{info}/WHEEL": "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    }
    files[f"{info}/RECORD"] = "".join(f"{name},,\n" for name in files)
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for name, text in files.items():
            archive.writestr(name, text)
    return data.getvalue()
