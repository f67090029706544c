"""A command loads what it needs, so that it starts quickly."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
from pathlib import Path

import pytest

from daguerre import cli
from daguerre.cli.short_process import CONTAINERS
from tests.faults.scene import write_scene

LOADED = (
    "import sys; from daguerre.cli import main; main(sys.argv[1:]); "
    "print(*{name.split('.')[1] for name in sys.modules if name.startswith('daguerre.')})"
)


@pytest.mark.parametrize(
    ("command", "rooms"),
    [
        (["--version"], {"rendering", "setup", "lenses", "sensors", "development"}),
        (
            ["--help"],
            {"rendering", "setup", "lenses", "sensors", "development", "plates", "post"}
            | {"camera", "scene"},
        ),
        (["lenses"], {"rendering", "setup", "development", "analysis"}),
        (["render", "nowhere.glb", "-o", "x.exr"], {"analysis", "plots", "development", "post"}),
    ],
)
def test_a_command_loads_no_room_that_it_does_not_enter(
    command: list[str], rooms: set[str]
) -> None:
    done = subprocess.run(
        [sys.executable, "-c", LOADED, *command], capture_output=True, text=True, check=True
    )
    assert not rooms & set(done.stdout.splitlines()[-1].split())


#: Modules that a small .png without textures, sensor and lens of glass does not need. Typer would
#: load pydantic, with email and sockets.
NEEDLESS = {
    *("OpenEXR", "asyncio", "concurrent.futures", "email", "html", "http", "logging", "numpy.ma"),
    *("multiprocessing", "pydantic", "rich", "secrets", "socket", "ssl", "tempfile", "unittest"),
    *("daguerre.distortion.model", "daguerre.pictures.exr.write", "daguerre.lenses.lens"),
    *("daguerre.maps.ray_map", "daguerre.rendering.passes", "daguerre.scene.curve_bases"),
    *("daguerre.scene.light_profile", "daguerre.scene.point_cache", "daguerre.scene.polygon_mesh"),
    *("daguerre.scene.subdivision.rules", "daguerre.sensors.sensor", "daguerre.setup.lens"),
}


def test_a_small_picture_loads_few_modules(tmp_path: Path) -> None:
    scene = write_scene(tmp_path / "scene.glb")
    picture = tmp_path / "a.png"
    words = f"render {scene} --camera left --res 48x32 --spp 1 -q -o {picture}".split()
    code = "import sys; from daguerre.cli import main; main(sys.argv[1:]); print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code, *words], capture_output=True, text=True, check=True
    )
    assert picture.is_file(), done.stderr
    modules = set(done.stdout.split())
    assert not modules & NEEDLESS
    assert len([name for name in modules if name.startswith("daguerre.")]) <= 252


def test_the_help_shows_each_command_with_its_whole_line(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert cli.main(["--help"]) == 0
    shown = capsys.readouterr().out
    for name, command in cli.COMMANDS.items():
        assert command.line.endswith(".")
        assert any(
            line.split(maxsplit=1) == [name, command.line] for line in shown.splitlines() if line
        ), name


def test_flags_before_a_command_do_not_hide_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["--", "version"]) == 0
    assert "numpy" in capsys.readouterr().out


def test_the_program_collects_garbage_rarely_and_lets_idle_threads_sleep() -> None:
    code = (
        "import gc, os, sys; from daguerre.cli import main; sys.argv = ['daguerre', '--version']; "
        "main(); print(gc.get_threshold()[0], os.environ['OPENBLAS_THREAD_TIMEOUT'])"
    )
    for given, timeout in ((None, "4"), ("26", "26")):
        surroundings = {k: v for k, v in os.environ.items() if k != "OPENBLAS_THREAD_TIMEOUT"}
        if given:
            surroundings["OPENBLAS_THREAD_TIMEOUT"] = given
        done = subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True,
            text=True,
            check=True,
            env=surroundings,
        )
        assert done.stdout.splitlines()[-1].split() == [str(CONTAINERS), timeout]


def test_a_call_from_python_leaves_the_garbage_collector_alone() -> None:
    before = gc.get_threshold()
    cli.main(["--version"])
    assert gc.get_threshold() == before


ENDS = """
import atexit, sys, threading, time
from daguerre.cli import main
sys.argv = ["daguerre", *sys.argv[1:]]
class Kept:
    def __del__(self): print("freed")
kept = Kept()
code = main()
atexit.register(print, "handler")
threading.Thread(target=lambda: (time.sleep(0.1), print("thread"))).start()
sys.stdout.write("unflushed ")
sys.exit(code)
"""


def test_the_program_ends_with_its_code_and_frees_nothing() -> None:
    for words, code in ((["--version"], 0), (["render", "nowhere.glb", "-o", "x.png"], 3)):
        done = subprocess.run(
            [sys.executable, "-c", ENDS, *words], capture_output=True, text=True, check=False
        )
        assert done.returncode == code
        assert done.stdout.endswith("unflushed thread\nhandler\n")
