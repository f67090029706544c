"""``--preview``: pictures in a file while the picture is drawn, and no bit of the picture."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.pictures.png_chunks import is_complete
from daguerre.rendering.job import Job
from daguerre.rendering.output import Output
from daguerre.rendering.picture import Picture, View
from daguerre.rendering.reporter import PreviewPicture, Reporter
from tests.support.program.terminal import ROOT, Terminal
from tests.support.scene import scenes

RUN = ("render", "s.glb", "--res", "48x32", "--preview")


@pytest.fixture(autouse=True)
def _here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_interrupted_it_leaves_a_whole_picture(tmp_path: Path) -> None:
    with Terminal(*RUN, "--spp", "4096", "-o", "a.png", seconds=0.1) as terminal:
        terminal.read(until=b"preview: a.preview.png")
        time.sleep(0.5)
        terminal.types(b"\x03")
        terminal.read()
        assert terminal.process.returncode == 75
        assert "interrupted after" in terminal.lines()
    assert {p.name for p in tmp_path.iterdir()} == {"a.preview.png", "a.checkpoint.exr"}
    with (tmp_path / "a.preview.png").open("rb") as file:
        assert is_complete(file)


# Files ------------------------------------------------------------------------------------------


def piped(*flags: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(
        [sys.executable, "-m", "tests.support.program.fake_session", *RUN, *flags],
        capture_output=True,
        check=False,
        env={"PATH": "", "PYTHONPATH": str(ROOT)},
    )


def test_it_goes_into_a_file_that_ends_with_the_picture(tmp_path: Path) -> None:
    run = piped("--spp", "4", "-o", "a.png")
    assert run.returncode == 0
    assert b"preview: a.preview.png" in run.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


def test_a_preview_that_cannot_be_written_stops_no_render(tmp_path: Path) -> None:
    (tmp_path / "a.preview.png").mkdir()
    run = piped("--spp", "64", "-o", "a.png")
    assert run.returncode == 0
    assert run.stderr.count(b"--preview:") == 1
    assert b"the preview stops" in run.stderr
    assert (tmp_path / "a.png").exists()


@pytest.mark.parametrize(
    ("flags", "words"),
    [
        (("-o", "nowhere/a.png"), b"no such folder"),
        (("-o", "a.png", "-o", "a.preview.png"), b"this name is reserved for --preview"),
        (("--export-raymap", "a.exr"), b"--preview need a picture"),
    ],
)
def test_a_preview_without_a_place_is_refused(flags: tuple[str, ...], words: bytes) -> None:
    run = piped(*flags)
    assert run.returncode in (2, 5), run.stderr
    assert words in run.stderr
    assert run.stderr.count(b"\n") == 1


# The picture ------------------------------------------------------------------------------------


class Watcher(Reporter):
    """Keeps what it is shown."""

    previews = True  # type: ignore[assignment]

    def __init__(self) -> None:
        self.seen: list[tuple[dg.Frame, bool]] = []

    def preview(self, look: PreviewPicture) -> None:
        self.seen.append((look.frame, look.complete))


def test_the_picture_has_the_same_bits_with_and_without(tmp_path: Path) -> None:
    settings = dg.RenderSettings.of(resolution=(48, 32), spp=32, aovs=True)
    files = []
    for reporter in (Reporter(), Watcher()):
        files.append(tmp_path / f"{len(files)}.exr")
        output = Output((files[-1],), ("denoise_albedo",))
        view = View.of(dg.Camera(f_stop=2.0, focus_distance=5.0))
        assert Job(scenes.lamp_room(), [Picture(view, settings, output)], reporter).run()
    one, other = (oiio.ImageBuf(str(file)).get_pixels() for file in files)
    np.testing.assert_array_equal(one, other)
    assert isinstance(reporter, Watcher)
    assert [complete for _, complete in reporter.seen] == [False] * (len(reporter.seen) - 1) + [
        True
    ]
    assert {frame.rgb.shape for frame, _ in reporter.seen} == {(32, 48, 3)}
