"""``script/test --room NAME`` runs one room's tests, and says what it leaves out.

Each test has a small checkout of its own: of C++ alone (optics), of Python alone (lenses), and a
room with both (camera). Set-up and the tools of the build are stand-ins that say how they were
called.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
STAND_IN = '#!/usr/bin/env bash\necho "ran ${0##*/} $*"\n'
PASSES = "def test_that_passes(): pass\ndef test_another(): pass\n"


def program(path: Path, text: str = STAND_IN) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """Three rooms, set up and built."""
    found = tmp_path / "clone"
    texts = {
        "core/optics/lens/lens_test.cpp": "",
        "core/camera/camera_test.cpp": "",
        "core/bind/bind.cpp": "",
        "build/dev/CMakeCache.txt": "",
        "tests/camera/test_camera.py": PASSES,
        "tests/lenses/deeper/test_lenses.py": PASSES,
        "tests/support/helpers.py": "",
    }
    for name, text in texts.items():
        (found / name).parent.mkdir(parents=True, exist_ok=True)
        (found / name).write_text(text)
    program(found / "script" / "setup")
    shutil.copy(ROOT / "script" / "test", found / "script" / "test")
    program(found / ".venv" / "bin" / "python", f'#!/bin/sh\nexec {sys.executable} "$@"\n')
    for tool in ("g++", "cmake", "ninja", "ctest"):
        program(tmp_path / "tools" / tool)
    return found


def run(checkout: Path, *words: str) -> tuple[int, str, str]:
    """Exit code, output and errors; without the variables by which xdist knows its workers."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    path = f"{checkout.parent / 'tools'}:{os.environ['PATH']}"
    found = subprocess.run(
        [str(checkout / "script" / "test"), *words],
        capture_output=True,
        text=True,
        check=False,
        env=kept | {"PATH": path, "PYTEST_XDIST_AUTO_NUM_WORKERS": "1"},
    )
    return found.returncode, found.stdout, found.stderr


def closing(said: str) -> list[str]:
    """Lines after the last heading, each without its figures."""
    return said.rpartition("== script/test --room ")[2].splitlines()[1:]


def test_help_says_how_to_call_it_and_runs_nothing(checkout: Path) -> None:
    code, said, errors = run(checkout, "--help")
    assert (code, errors) == (0, "")
    assert said.startswith("script/test [ARGUMENTS...] --")
    assert "script/test --room NAME" in said
    assert said.endswith("ARGUMENTS go to pytest.\n")
    assert "ran " not in said


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--room", "opitcs"], "got 'opitcs'. Did you mean optics? Rooms: camera lenses optics"),
        (["--room=qqqq", "-x"], "got 'qqqq'. Rooms: camera lenses optics"),
        (["--room", "support"], "got 'support'. Rooms:"),
        (["--room", ".*"], "got '.*'. Rooms:"),
        (["-x", "--room"], "got ''. Rooms:"),
        (["--room="], "got ''. Rooms:"),
    ],
)
def test_a_room_without_tests_is_one_error(checkout: Path, words: list[str], says: str) -> None:
    code, said, errors = run(checkout, *words)
    assert (code, said) == (2, "")
    assert errors.count("\n") == 1
    assert errors.startswith("test: --room: wanted a room that has tests, ")
    assert says in errors


def test_a_room_of_cpp_is_built_and_tested_alone(checkout: Path) -> None:
    code, said, _ = run(checkout, "--room", "optics", "-k", "some")
    assert code == 0
    assert "ran setup" not in said
    assert "ran cmake --build build/dev --parallel" in said
    assert "--target optics_test" in said
    assert "-R ^optics$" in said
    assert closing(said)[1] == "none  Python tests: no test_*.py in tests/optics; not used: -k some"


def test_a_room_of_cpp_needs_no_set_up(checkout: Path) -> None:
    (checkout / "build" / "dev" / "CMakeCache.txt").unlink()
    code, said, _ = run(checkout, "--room", "optics")
    assert code == 0
    assert "ran setup" not in said
    assert "ran cmake --build build/core --parallel" in said


def test_a_room_of_python_is_set_up_and_tested_alone(checkout: Path) -> None:
    code, said, _ = run(checkout, "--room=lenses", "-k", "passes")
    assert code == 0
    assert said.startswith("ran setup")
    assert "ran cmake" not in said
    none, ran = closing(said)
    assert none == "none  C++ tests: no *_test.cpp in core/lenses"
    assert ran.startswith("ok  Python tests: 1 passed")


def test_a_failure_of_one_language_does_not_hide_the_other(checkout: Path) -> None:
    program(checkout.parent / "tools" / "ctest", "#!/bin/sh\necho broken\nexit 8\n")
    code, said, _ = run(checkout, "--room", "camera")
    assert code == 1
    cpp, python = closing(said)
    assert cpp == "FAILED(8)  C++ tests: broken"
    assert python.startswith("ok  Python tests: 2 passed")
