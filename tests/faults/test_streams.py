"""Standard streams that are closed, full or left: the picture is drawn, words are lost."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import OpenEXR
import pytest

from .process import run
from .scene import write_scene

RENDER = "render s.glb -o a.exr --camera left --res 12x8 --sky 1,1,1 --spp 4"


def shell(folder: Path, words: str, streams: str) -> subprocess.CompletedProcess[str]:
    """Runs the command line with streams as a shell redirects them."""
    write_scene(folder / "s.glb")
    program = f'exec "$0" -m daguerre.cli {words} {streams}'
    return run(["sh", "-c", program, sys.executable], folder, timeout=120)


@pytest.mark.parametrize(
    "streams",
    ["<&-", ">&-", "2>&-", "<&- >&- 2>&-", ">/dev/full", "2>/dev/full", ">/dev/full 2>/dev/full"],
)
@pytest.mark.parametrize("more", ["", "--json-progress", "--preview"])
def test_streams_that_take_nothing_do_not_end_a_render(
    tmp_path: Path, streams: str, more: str
) -> None:
    run = shell(tmp_path, f"{RENDER} {more}", streams)
    assert run.returncode == 0, run.stderr
    assert "error" not in run.stderr
    with OpenEXR.File(str(tmp_path / "a.exr")) as file:
        assert file.channels()  # words would have gone into it
    if more == "--json-progress" and streams == ">/dev/full":
        assert run.stderr.count("progress is no longer reported") == 1
    if more == "--json-progress" and ">" not in streams:
        assert json.loads(run.stdout.splitlines()[-1])["event"] == "done"


@pytest.mark.parametrize("words", ["lenses", "--help", "info s.glb --camera left --json"])
def test_answers_that_cannot_be_printed_are_one_error(tmp_path: Path, words: str) -> None:
    run = shell(tmp_path, words, ">/dev/full")
    assert run.returncode == 5, run.stderr
    (line,) = run.stderr.strip().splitlines()
    assert line == "daguerre: error: standard output: cannot write: No space left on device"
    assert shell(tmp_path, words, ">&-").returncode == 0
