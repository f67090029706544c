"""Where an allocation fails, however late, one error says so and the samples are kept."""

from __future__ import annotations

import json
import platform
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.faults.process import run
from tests.faults.scene import write_scene

pytestmark = pytest.mark.skipif(
    platform.libc_ver()[0] != "glibc" or shutil.which("cc") is None,
    reason="needs a C compiler and the GNU C library",
)
RENDER = "--res 96x64 --spp 2 --threads 1 --quiet -o a.exr"
#: numpy and Python say this where they forget to report that memory ended.
FORGOTTEN = re.compile("SystemError: .*(without (setting an )?exception|with an exception set)")
#: The C library ends the process where a new thread has no memory for its own data.
ABORTED = "cannot allocate memory for thread-local data: ABORT"


def _ends(folder: Path, least: int, most: int, words: str) -> list[dict[str, Any]]:
    """How ``render`` ended, first where nothing fails."""
    library = folder / "failing_malloc.so"
    source = Path(__file__).with_name("failing_malloc.c")
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", library, source], check=True)
    scene = str(write_scene(folder / "scene.glb"))
    command = (sys.executable, "-m", "tests.faults.no_memory", str(least), str(most), "render")
    done = run([*command, scene, *words.split()], check=True, LD_PRELOAD=str(library))
    ends: list[dict[str, Any]] = json.loads(done.stdout)
    return ends


def _check(ends: list[dict[str, Any]]) -> None:
    whole = ends[0]
    assert whole["code"] == 0
    assert whole["counted"] > 10
    assert len(ends) > 10
    late = 0
    for end in ends[1:]:
        if end["said"][-1:] == [ABORTED]:
            assert end["files"].keys() <= {"a.checkpoint.exr"}, end
            continue
        errors = [line for line in end["said"] if line.startswith("daguerre: error: ")]
        if end["code"] == 0:
            assert end["files"] == whole["files"], end
            continue
        assert len(errors) == 1, end
        assert end["code"] in (3, 5) or FORGOTTEN.search(errors[0]), end
        assert end["files"].keys() <= {"a.exr", "a.checkpoint.exr"}, end
        assert end["files"].get("a.exr", whole["files"]["a.exr"]) == whole["files"]["a.exr"], end
        if end["resumed"] is not None:
            late += 1
            assert end["resumed"] == whole["files"], end
        if "cannot write" in errors[0]:
            assert end["resumed"] is not None, end
    assert late > 2


def test_large_allocations(tmp_path: Path) -> None:
    _check(_ends(tmp_path, 1 << 16, 40, f"{RENDER} --checkpoint 0.01 --aov all"))


@pytest.mark.slow
@pytest.mark.parametrize("words", ["", "--light-paths 4 --aov all", "--noise 0.1"])
def test_small_allocations(tmp_path: Path, words: str) -> None:
    _check(_ends(tmp_path, 512, 300, f"{RENDER} {words}"))
