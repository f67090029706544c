"""`frame.show()`: the viewer that it starts, its file, notebooks, and its errors."""

from __future__ import annotations

import shutil
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.development import Picture
from daguerre.errors import OutputError
from daguerre.frame import viewer as opening

FRAME = dg.Frame(np.full((4, 6, 3), 0.5, np.float32))
PICTURES = [FRAME, Picture(np.full((4, 6, 3), 0.5, np.float32))]


@pytest.fixture
def desktop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A desktop whose viewers are those that a test puts into this folder."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for name in ("sh", "rm", "sleep", "cp"):
        (folder / name).symlink_to(str(shutil.which(name)))
    monkeypatch.setenv("PATH", str(folder))
    monkeypatch.setenv("DISPLAY", ":99")
    (tmp_path / "tmp").mkdir()
    monkeypatch.setattr(opening.tempfile, "tempdir", str(tmp_path / "tmp"))
    return tmp_path


def viewer(desktop: Path, body: str, name: str = "xdg-open") -> None:
    program = desktop / "bin" / name
    program.write_text(f"#!/bin/sh\n{body}\n")
    program.chmod(0o755)


def gone(folder: Path, seconds: float = 10.0) -> bool:
    """Whether no file is left in a folder, at the latest after some time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end and list(folder.iterdir()):
        time.sleep(0.05)
    return not list(folder.iterdir())


@pytest.mark.parametrize("picture", PICTURES)
def test_the_viewer_gets_the_picture_and_its_file_goes(
    picture: Any, desktop: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(opening, "KEPT_S", 2)
    viewer(desktop, f'cp "$1" {desktop}/seen.png')
    picture.show()
    assert len((desktop / "seen.png").read_bytes()) == len(picture._repr_png_())
    assert len(list((desktop / "tmp").iterdir())) == 1  # a viewer may read it later
    assert gone(desktop / "tmp")


def test_a_viewer_that_stays_open_does_not_hold_up(
    desktop: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(opening, "KEPT_S", 0)
    viewer(desktop, "exec sleep 4", "feh")
    begin = time.monotonic()
    FRAME.show()
    assert time.monotonic() - begin < 3
    assert len(list((desktop / "tmp").iterdir())) == 1
    assert gone(desktop / "tmp")


def test_a_viewer_that_fails_is_an_error(desktop: Path) -> None:
    viewer(desktop, "exit 3")
    with pytest.raises(
        OutputError, match=r"xdg-open cannot open the picture \(exit code 3\); save"
    ):
        FRAME.show()
    assert gone(desktop / "tmp", 0)


def test_a_desktop_without_a_viewer_is_an_error(desktop: Path) -> None:
    with pytest.raises(OutputError, match=r"wanted one of xdg-open, eog, .*got none"):
        FRAME.show()
    assert gone(desktop / "tmp", 0)


def test_no_desktop_is_an_error(desktop: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    viewer(desktop, "exit 0")
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    with pytest.raises(OutputError, match="wanted a notebook or a desktop, got neither"):
        FRAME.show()
    assert gone(desktop / "tmp", 0)


def test_a_full_disk_is_an_error(desktop: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    viewer(desktop, "exit 0")

    def refuse(*given: Any, **more: Any) -> Any:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(opening.os, "fdopen", refuse)
    with pytest.raises(OutputError, match="cannot write: No space left on device"):
        FRAME.show()
    assert gone(desktop / "tmp", 0)


def test_the_picture_outlives_the_session(desktop: Path) -> None:
    """A script may end at once: the viewer still finds the file, and Python says nothing."""
    viewer(desktop, f'sleep 2; cp "$1" {desktop}/seen.png')
    code = "import numpy as np, daguerre as dg; dg.Frame(np.ones((4, 6, 3), np.float32)).show()"
    done = subprocess.run(
        [sys.executable, "-X", "dev", "-W", "error", "-c", code],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert (done.returncode, done.stderr) == (0, "")
    end = time.monotonic() + 10
    while time.monotonic() < end and not (desktop / "seen.png").exists():
        time.sleep(0.05)
    assert (desktop / "seen.png").read_bytes().startswith(b"\x89PNG")


def test_a_notebook_displays_it(desktop: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    display = pytest.importorskip("IPython.display", reason="notebooks have it")
    import IPython

    seen: list[Any] = []
    monkeypatch.setattr(display, "display", seen.append)
    monkeypatch.setattr(IPython, "get_ipython", lambda: SimpleNamespace(kernel=object()))
    FRAME.show()
    assert seen == [FRAME]
    assert gone(desktop / "tmp", 0)
    monkeypatch.setattr(IPython, "get_ipython", lambda: SimpleNamespace())  # in a terminal
    viewer(desktop, "exit 3")
    with pytest.raises(OutputError, match="xdg-open"):
        FRAME.show()
