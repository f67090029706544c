"""Packages that script/setup installs: locked, with hashes, within the ranges of pyproject.toml."""

from __future__ import annotations

import importlib.machinery
import importlib.util
import re
import subprocess
import sys
import tomllib
from itertools import product
from pathlib import Path
from types import ModuleType

import pytest

requirements = pytest.importorskip("packaging.requirements", reason="needs packaging")
utils = pytest.importorskip("packaging.utils")

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
EXTRAS = PROJECT["optional-dependencies"]
TEXT = (ROOT / "packaging" / "locked.txt").read_text()
#: Systems for which script/setup takes the list.
SYSTEMS = [
    {"python_version": version, "python_full_version": f"{version}.1", "platform_machine": machine,
     "sys_platform": "linux", "platform_system": "Linux", "os_name": "posix",
     "implementation_name": "cpython", "platform_python_implementation": "CPython"}
    for version, machine in product(("3.11", "3.12", "3.13", "3.14"), ("x86_64", "aarch64"))
]  # fmt: skip


def program() -> ModuleType:
    """script/locked as a module."""
    loader = importlib.machinery.SourceFileLoader("locked", str(ROOT / "script" / "locked"))
    spec = importlib.util.spec_from_loader("locked", loader)
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    return module


LOCKED = program()


def pins(name: str, system: dict[str, str]) -> list[str]:
    """Versions of a package that a system gets."""
    lines = re.findall(rf"^{re.escape(name)}==.*$", LOCKED.entries().get(name, ""), re.MULTILINE)
    found = [requirements.Requirement(line.removesuffix("\\").strip()) for line in lines]
    return [
        next(iter(one.specifier)).version
        for one in found
        if one.marker is None or one.marker.evaluate(system)
    ]


def wanted(extra: str) -> list[str]:
    """Requirements of an extra, those of the extras within it included."""
    found = []
    for need in EXTRAS[extra]:
        inner = re.match(r"daguerre\[(.*)\]", need)
        found += [one for name in inner[1].split(",") for one in wanted(name)] if inner else [need]
    return found


BUILD = [
    line
    for line in (ROOT / "packaging" / "build-tools.txt").read_text().splitlines()
    if not line.startswith("#")
]


@pytest.mark.parametrize("part", ["daguerre", "build", *EXTRAS])
def test_a_part_is_locked_within_its_ranges(part: str) -> None:
    needs = {"daguerre": PROJECT["dependencies"], "build": BUILD}
    names = LOCKED.names([] if part in needs else [part])
    for text, system in product(needs.get(part) or wanted(part), SYSTEMS):
        need = requirements.Requirement(text)
        if need.marker is None or need.marker.evaluate(system):
            name = utils.canonicalize_name(need.name)
            assert name in names
            versions = pins(name, system)
            assert len(versions) == 1, f"{name} for {system['python_version']}: {versions}"
            assert need.specifier.contains(versions[0], prereleases=True), f"{text}: {versions[0]}"


def test_every_package_has_hashes_and_no_address() -> None:
    listed = LOCKED.entries()
    assert "".join(listed.values()) == TEXT
    for name, entry in listed.items():
        heads = re.findall(rf"^{re.escape(name)}==\S+", entry, re.MULTILINE)
        assert heads
        assert len(re.findall(r"^    --hash=sha256:[0-9a-f]{64}(?: \\)?$", entry, re.MULTILINE))
    assert "://" not in TEXT
    assert " @ " not in TEXT


def test_extras_have_only_what_is_locked() -> None:
    assert LOCKED.names(list(EXTRAS)) == set(LOCKED.entries())


def test_the_lines_of_an_extra_are_written(tmp_path: Path) -> None:
    words = [sys.executable, str(ROOT / "script" / "locked"), "view", str(tmp_path / "out.txt")]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        assert "packaging/locked.txt is not for" in done.stdout
        return
    text = (tmp_path / "out.txt").read_text()
    assert re.search(r"^websockets==", text, re.MULTILINE)
    assert not re.search(r"^dask==", text, re.MULTILINE)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"version_info": (3, 15, 0)}, "CPython 3.15 on"),
        ({"version_info": (3, 10, 9)}, "CPython 3.10 on"),
        ({}, ""),
    ],
)
def test_other_interpreters_are_named(
    change: dict[str, object], said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in change.items():
        monkeypatch.setattr(LOCKED.sys, name, value)
    monkeypatch.setattr(LOCKED.platform, "machine", lambda: "x86_64")
    monkeypatch.setattr(LOCKED.platform, "python_implementation", lambda: "CPython")
    monkeypatch.setattr(LOCKED.sysconfig, "get_config_var", lambda name: 0)
    assert said in LOCKED.unfit()
    assert bool(LOCKED.unfit()) is bool(said)
    monkeypatch.setattr(LOCKED.platform, "machine", lambda: "riscv64")
    assert "on riscv64" in LOCKED.unfit()
