"""A system on which the core cannot run gets one sentence, and no crash."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from daguerre import compiled

FLAGS = "fpu sse sse2 ssse3 sse4_1 sse4_2 popcnt"


def cpu_info(folder: Path, flags: str) -> Path:
    path = folder / "cpuinfo"
    path.write_text(f"processor\t: 0\nmodel name\t: Old\nflags\t\t: {flags}\nbugs\t: \n\n" * 3)
    return path


def test_a_processor_of_the_baseline_lacks_nothing(tmp_path: Path) -> None:
    assert compiled.missing_instructions(cpu_info(tmp_path, FLAGS)) == []
    assert compiled.missing_instructions() == []


def test_an_old_processor_is_named_before_the_core_is_loaded(tmp_path: Path) -> None:
    path = cpu_info(tmp_path, FLAGS.replace("sse4_2", "").replace("popcnt", ""))
    assert compiled.missing_instructions(path) == ["popcnt", "sse4_2"]
    code = (
        "import builtins, pathlib, sys; real = pathlib.Path.open;"
        "pathlib.Path.open = lambda path, *rest: real(path if 'cpuinfo' not in str(path) "
        f"else pathlib.Path({str(path)!r}), *rest);"
        "sys.argv = ['/usr/bin/daguerre'];"
        "import daguerre"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 70
    assert done.stderr == (
        "daguerre: error: this processor lacks popcnt, sse4_2; use an x86-64 processor of 2009 or "
        "later, or build Daguerre from source with -C cmake.define.DG_ARCH=\n"
    )


@pytest.mark.parametrize("flags", ["", None])
def test_a_system_that_does_not_tell_is_tried(tmp_path: Path, flags: str | None) -> None:
    path = tmp_path / "cpuinfo"
    if flags is not None:
        path.write_text("processor\t: 0\nFeatures\t: fp asimd\n")  # of ARM
    assert compiled.missing_instructions(path) == []


@pytest.mark.parametrize(
    ("said", "wanted"),
    [
        ("/lib/libm.so.6: version `GLIBC_2.34' not found (required by x)", "wanted glibc 2.34"),
        ("No module named 'nanobind_backend'", "pip install nanobind-backend"),
        ("undefined symbol: abc", "install daguerre again"),
    ],
)
def test_the_loader_s_words_become_what_to_do(said: str, wanted: str) -> None:
    error = compiled.unloadable(ImportError(said))
    assert wanted in str(error)
    assert "\n" not in str(error)
