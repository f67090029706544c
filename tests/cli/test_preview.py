"""``--preview``: pictures in terminals that can, in a file elsewhere, and no bit of the picture."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from base64 import b64decode
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.cli.preview.protocols import drawn, palette_index, png
from daguerre.cli.preview.screen import Cells
from daguerre.cli.preview.terminal import Way, guess, read_answer
from daguerre.pictures.png_chunks import is_complete
from daguerre.rendering.coarse import coarse
from daguerre.rendering.job import Job
from daguerre.rendering.output import Output
from daguerre.rendering.picture import Picture, View
from daguerre.rendering.reporter import PreviewPicture, Reporter
from tests.support import scenes
from tests.support.terminal import ANSWERS, ROOT, Terminal

BEGINS = {"kitty": b"\x1b_Ga=T,f=100,", "iterm": b"\x1b]1337;File=inline=1;", "sixel": b"\x1bPq"}
RUN = ("render", "s.glb", "--res", "48x32", "--preview")


@pytest.fixture(autouse=True)
def _here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def colours() -> np.ndarray:
    """A picture with every hue and some grey, (30, 40, 3)."""
    y, x = np.mgrid[:30, :40]
    return np.stack([x * 6, y * 8, (x + y) * 3], axis=2).astype(np.uint8)


def read_png(data: bytes, path: Path) -> np.ndarray:
    path.write_bytes(data)
    with path.open("rb") as file:
        assert is_complete(file)
    return np.asarray(oiio.ImageBuf(str(path)).get_pixels(oiio.UINT8))


def read_sixel(data: bytes) -> np.ndarray:
    """Pixels of a picture in Sixel, by the manual; black where nothing is drawn."""
    width, height = map(int, re.match(rb'\x1bPq"1;1;(\d+);(\d+)', data).groups())  # type: ignore[union-attr]
    seen = np.zeros((height, width, 3))
    palette = {
        int(c): np.array([int(r), int(g), int(b)]) * 2.55
        for c, r, g, b in re.findall(rb"#(\d+);2;(\d+);(\d+);(\d+)", data)
    }
    body = data[data.rindex(b";2;") :].lstrip(b";0123456789")
    x = top = colour = 0
    for token in re.findall(rb"#\d+|!\d+[?-~]|[?-~]|\$|-", body.removesuffix(b"\x1b\\")):
        if token[:1] == b"#":
            colour = int(token[1:])
        elif token in (b"$", b"-"):
            x, top = 0, top + 6 * (token == b"-")
        else:
            count = int(token[1:-1]) if token[:1] == b"!" else 1
            for bit in range(6):
                if (token[-1] - 63) >> bit & 1:
                    seen[top + bit, x : x + count] = palette[colour]
            x += count
    return seen


# Protocols --------------------------------------------------------------------------------------


def test_answers_of_terminals_are_understood() -> None:
    found = {name: read_answer(answer) for name, answer in ANSWERS.items()}
    assert found == {
        "kitty": Way.KITTY,
        "iterm": Way.ITERM,
        "sixel": Way.SIXEL,
        "plain": None,
        "silent": None,
    }
    assert read_answer(b"\x1b_Gi=31;ENOTSUPPORTED\x1b\\\x1b[?64;22c") is None
    assert read_answer(b"\x1b[?4;22c") is None  # the first number is the class, and no attribute


def test_environments_of_terminals_that_cannot_be_asked() -> None:
    assert guess({"KITTY_WINDOW_ID": "1"}) is Way.KITTY
    assert guess({"TERM_PROGRAM": "iTerm.app"}) is Way.ITERM
    assert guess({"TERM": "xterm-256color"}) is None


def test_kitty_gets_a_png_in_pieces(tmp_path: Path) -> None:
    noise = np.random.default_rng(1).integers(0, 256, (60, 80, 3), np.uint8)
    data = drawn(Way.KITTY, noise, 10, 4)
    pieces = re.findall(rb"\x1b_G([^;]*);([^\x1b]*)\x1b\\", data)
    assert len(pieces) > 2
    assert all(len(piece) <= 4096 for _, piece in pieces)
    assert [b"m=1" in keys for keys, _ in pieces] == [True] * (len(pieces) - 1) + [False]
    assert b"C=1,c=10,r=4," in pieces[0][0]
    whole = b64decode(b"".join(piece for _, piece in pieces))
    np.testing.assert_array_equal(read_png(whole, tmp_path / "k.png"), noise)


def test_iterm_gets_a_png_with_its_cells(tmp_path: Path) -> None:
    data = drawn(Way.ITERM, colours(), 10, 4)
    head, _, rest = data.partition(b":")
    assert b"width=10;height=4" in head
    whole = b64decode(rest.removesuffix(b"\x07"))
    assert whole == png(colours())
    np.testing.assert_array_equal(read_png(whole, tmp_path / "i.png"), colours())


def test_sixel_has_the_colours_on_average() -> None:
    pixels = colours()
    seen = read_sixel(drawn(Way.SIXEL, pixels, 10, 4))
    assert seen.shape == pixels.shape
    assert np.abs(seen - pixels).max() <= 256 / 5 + 2
    for y in range(0, 28, 4):  # dither keeps means over its tile
        assert np.abs(seen[y : y + 4].mean((0, 1)) - pixels[y : y + 4].mean((0, 1))).max() < 6
    assert len(np.unique(palette_index(pixels))) > 40


def test_a_picture_keeps_its_shape_in_the_terminal() -> None:
    cells = Cells(80, 24, 8, 16)
    assert cells.box(320, 160) == (40, 10)  # as large as it is
    columns, rows = cells.box(4000, 2000)
    assert rows <= 24 - 3
    assert columns <= 79
    assert columns * 8 / (rows * 16) == pytest.approx(2, rel=0.1)


# Terminals --------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", BEGINS)
def test_a_terminal_that_can_shows_the_picture_in_place(tmp_path: Path, kind: str) -> None:
    flags = ("--spp", "16", "-o", "a.exr")
    with Terminal(kind, *RUN, *flags, seconds=0.15) as terminal:
        terminal.read()
        assert terminal.process.returncode == 0, terminal.lines()
        assert terminal.written.count(BEGINS[kind]) >= 3
        up = re.findall(rb"\x1b\[(\d+)A\x1b7", terminal.written)
        down = re.findall(rb"\x1b8\x1b\[(\d+)B", terminal.written)
        assert up == down
        # The note about the focus is said once, below the first picture.
        assert len(set(up)) == 2
        assert "wrote a.exr" in terminal.lines()
    assert [path.name for path in tmp_path.iterdir()] == ["a.exr"]


def test_the_terminal_is_left_as_it_was() -> None:
    import termios

    with Terminal("sixel", *RUN, "--spp", "2", "-o", "a.png") as terminal:
        terminal.read()
        assert termios.tcgetattr(terminal._slave) == terminal.before
        assert terminal.written.count(b"\x1b[c") == 1


@pytest.mark.parametrize("kind", ["plain", "silent"])
def test_a_terminal_that_cannot_leaves_it_to_a_file(tmp_path: Path, kind: str) -> None:
    with Terminal(kind, *RUN, "--spp", "24", "-o", "a.png", seconds=0.1) as terminal:
        terminal.read(until=b"preview: a.preview.png")
        with (tmp_path / "a.preview.png").open("rb") as file:
            assert is_complete(file)
        terminal.read()
        assert terminal.process.returncode == 0
        assert not [begin for begin in BEGINS.values() if begin in terminal.written]
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


@pytest.mark.parametrize("env", [{"TERM": "dumb"}, {"TERM": "screen-256color"}, {"TMUX": "/tmp/t"}])
def test_who_would_print_the_question_is_not_asked(env: dict[str, str]) -> None:
    with Terminal("kitty", *RUN, "--spp", "2", "-o", "a.png", **env) as terminal:
        terminal.read()
        assert terminal.process.returncode == 0
        assert b"\x1b[c" not in terminal.written


def test_interrupted_it_leaves_a_whole_picture(tmp_path: Path) -> None:
    with Terminal("plain", *RUN, "--spp", "4096", "-o", "a.png", seconds=0.1) as terminal:
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
        [sys.executable, "-m", "tests.support.fake_session", *RUN, *flags],
        capture_output=True,
        check=False,
        env={"PATH": "", "PYTHONPATH": str(ROOT), "TERM": "xterm-kitty", "KITTY_WINDOW_ID": "1"},
    )


def test_no_control_sequence_goes_into_a_pipe(tmp_path: Path) -> None:
    run = piped("--spp", "4", "-o", "a.png")
    assert run.returncode == 0
    assert b"\x1b" not in run.stdout + run.stderr
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


def test_the_first_look_is_the_picture_in_squares() -> None:
    camera = dg.Camera(f_stop=8.0, focus_distance=5.0)
    settings = dg.RenderSettings.of(resolution=(480, 320), crop=(100, 20, 400, 300), spp=16)
    frame, built = coarse(scenes.lamp_room(), camera, settings)
    fine = dg.render(scenes.lamp_room(), camera, settings=settings)
    assert frame.rgb.shape == fine.rgb.shape == (280, 300, 3)
    blocks = [f.rgb.clip(0, 2).reshape(7, 40, 10, 30, 3).mean((1, 3)) for f in (frame, fine)]
    assert np.abs(blocks[0] - blocks[1]).mean() < 0.15 * blocks[1].mean()
    assert len(np.unique(frame.rgb[..., 1])) <= 20_000
    again, _ = coarse(scenes.lamp_room(), camera, settings, built)
    np.testing.assert_array_equal(again.rgb, frame.rgb)


def test_signals_are_as_without(tmp_path: Path) -> None:
    with Terminal("kitty", *RUN, "--spp", "4096", "-o", "a.png", seconds=0.1) as terminal:
        terminal.read(until=BEGINS["kitty"])
        time.sleep(1.0)
        terminal.process.send_signal(signal.SIGTERM)
        terminal.read()
        assert terminal.process.returncode == 75
    assert {path.name for path in tmp_path.iterdir()} == {"a.checkpoint.exr"}
