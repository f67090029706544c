"""Mutants of stages under strace: nothing outside is opened, and the process goes on."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

pytest.importorskip("pxr")

from . import stage_mutants, traced_stages

pytestmark = pytest.mark.skipif(
    shutil.which("strace") is None, reason="needs strace (apt-get install strace)"
)


@pytest.mark.slow
def test_mutants_stay_in_their_folder(tmp_path: Path) -> None:
    found = traced_stages.traced(tmp_path, seed=2, count=300)
    assert found.faults == []
    assert found.tried == 300
    assert found.ends["read"] > 30
    assert found.ends["refused"] > 30


def test_an_open_outside_is_found(tmp_path: Path) -> None:
    """A trace of calls in the same form, one of them through a link."""
    (tmp_path / "of.1").write_text(
        f'execve("/usr/bin/python", ["-m", "tests.faults.traced_stages"], 0x7ff) = 0\n'
        f'openat(AT_FDCWD</w>, "a/case.usda", O_RDONLY) = 3<{tmp_path}/a/case.usda>\n'
        f'openat(AT_FDCWD</w>, "a/none.usda", O_RDONLY) = -1 ENOENT (No such file or directory)\n'
    )
    own = [f"{tmp_path}/a"]
    assert traced_stages.outside(tmp_path, own) == []
    bad = (
        f'openat(AT_FDCWD</w>, "a/link.usda", O_RDONLY) = 3<{tmp_path}/secret.usda>\n',
        'execve("/bin/true", ["true"], 0x7ff) = 0\n',
        "connect(3<socket:[1]>, {sa_family=AF_INET}, 16) = 0\n",
        f'creat("x", 0600) = 3<{tmp_path}/ab/x>\n',
    )
    (tmp_path / "of.2").write_text("".join(bad))
    assert traced_stages.outside(tmp_path, own) == sorted(line.strip() for line in bad)


def test_mutants_are_the_same_for_a_seed_and_reach_paths(tmp_path: Path) -> None:
    goods = stage_mutants.seeds(stage_mutants.write_folder(tmp_path))
    first, again = (list(stage_mutants.mutants(goods, 5, 200)) for _ in range(2))
    assert first == again
    assert any(name.encode() in data for _, data in first for name in stage_mutants.HOSTILE)
    assert {Path(name).suffix for name, _ in first} == {".usda", ".usdc", ".usdz"}
