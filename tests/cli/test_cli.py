"""The command line: messages, exit codes, progress, signals and resuming, on a fake session."""

from __future__ import annotations

import json
import os
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import OpenEXR
import pytest

import daguerre
from daguerre import _core
from daguerre.cli import console, main
from daguerre.cli.help import EXAMPLES
from daguerre.files import extras
from daguerre.rendering.schedule import pass_size
from tests.support.program import fake_denoiser, fake_session
from tests.support.program.pseudo_terminal import open_terminal

SMALL = ["--res", "8x6"]


@pytest.fixture(autouse=True)
def _fake(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(
        sys.modules, "daguerre.rendering.session", sys.modules.get("daguerre.rendering.session")
    )
    fake_session.install(lambda where, name, value: monkeypatch.setattr(where, name, value))
    monkeypatch.chdir(tmp_path)


def pixels(path: Path) -> dict[str, np.ndarray]:
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return {name: c.pixels.copy() for name, c in file.channels().items()}


def spawn(*arguments: str, seconds: float = 0.0, **env: str) -> subprocess.Popen[str]:
    root = Path(__file__).parents[2]
    paths = [str(root), os.environ.get("PYTHONPATH", "")]
    return subprocess.Popen(
        [sys.executable, "-m", "tests.support.program.fake_session", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={
            **os.environ,
            **env,
            "FAKE_SECONDS": str(seconds),
            "PYTHONPATH": os.pathsep.join(filter(None, paths)),
        },
    )


def wait_for_samples(process: subprocess.Popen[str], count: int) -> None:
    """Reads JSON lines until so many samples are complete."""
    assert process.stdout is not None
    for line in process.stdout:
        event = json.loads(line)
        if event["event"] == "progress" and event["samples"] >= count:
            return
    raise AssertionError(f"ended early: {process.stderr.read() if process.stderr else ''}")


def test_renders_exr_and_png(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "s.glb", "-o", "a.exr", "-o", "a.png", "--spp", "5", *SMALL]) == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.exr", "a.png"]
    channels = pixels(tmp_path / "a.exr")
    expected = sum(fake_session.sample_value(i, 6, 8) for i in range(5)) / 5 / 65521
    np.testing.assert_array_equal(channels["R"], expected.astype(np.float32))
    assert set(channels) == {*"RGBA", "variance.R", "variance.G", "variance.B", "samples.Y"}
    err = capsys.readouterr().err
    assert "autofocus: centre ray hit at 1.532 m" in err
    assert "wrote a.exr, a.png" in err


def test_quiet_says_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "s.glb", "-o", "a.exr", "--spp", "1", "--quiet", *SMALL]) == 0
    out = capsys.readouterr()
    assert out.out == ""
    assert out.err == ""


@pytest.mark.parametrize(
    ("flags", "groups"),
    [
        (["--aov", "all"], {"depth", "P", "N", "albedo", "object_id"}),
        (["--aov", "depth,normal", "--aov", "id,variance"], {"depth", "N", "object_id"}),
        (["--aov", "position"], {"P"}),
    ],
)
def test_aovs(tmp_path: Path, flags: list[str], groups: set[str]) -> None:
    assert main(["render", "s.glb", "-o", "a.exr", "--spp", "1", *SMALL, *flags]) == 0
    names = {name.split(".")[0] for name in pixels(tmp_path / "a.exr")}
    assert names - {*"RGBA", "variance", "samples"} == groups


@pytest.mark.parametrize(
    ("text", "box", "said"),
    [
        ("left=10,top=20,right=17,bottom=25", (10, 20, 17, 25), ""),
        ("bottom=25, right=17, top=20, left=10", (10, 20, 17, 25), ""),
        ("left=30", (30, 0, 40, 30), ""),
        ("top=20,bottom=25", (0, 20, 40, 25), ""),
        ("10,20,17,25", (10, 20, 17, 25), ""),
        ("10,17,2,25", None, "left < right within 0..40 and top < bottom within 0..30"),
        ("10,12,35,36", None, "left < right within 0..40 and top < bottom within 0..30"),
    ],
)
def test_crop(
    text: str,
    box: tuple[int, ...] | None,
    said: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    words = ["render", "s.glb", "-o", "a.exr", "--spp", "1", "--res", "40x30", "--crop", text]
    assert main(words) == (0 if box else 2)
    lines = [line for line in capsys.readouterr().err.splitlines() if "--crop" in line]
    assert len(lines) == bool(said)
    assert said in "".join(lines)
    if box is None:
        return
    with OpenEXR.File(str(tmp_path / "a.exr")) as file:
        low, high = file.header()["dataWindow"]
        assert (*low, *(high + 1)) == box
        assert tuple(file.header()["displayWindow"][1]) == (39, 29)
    assert main([*words, "--quiet"]) == 0
    assert capsys.readouterr().err == ""


WRONG = {
    "unknown flag": (["render", "s.glb", "-o", "a.exr", "--foccus", "1"], 2, "--focus"),
    "misspelt flag": (["lenses", "--jsn"], 2, "--jsn (did you mean --json?)"),
    "no value": (["render", "s.glb", "-o"], 2, "(see `daguerre render --help`)"),
    "unknown command": (["rendr"], 2, "'render'"),
    "no output": (["render", "s.glb"], 2, "nothing to write: name a picture with -o NAME.exr"),
    "no scene": (["render", "-o", "a.exr"], 2, "SCENE"),
    "format": (["render", "s.glb", "-o", "a.gif"], 2, "ending in .exr, .png"),
    "channels in a png": (
        ["render", "s.glb", "-o", "a.png", "--aov", "depth"],
        2,
        "--aov needs an .exr output",
    ),
    "allowed folder": (
        ["render", "s.glb", "-o", "a.exr", "--allow-dir", "no"],
        2,
        "--allow-dir: wanted a folder, got 'no'",
    ),
    "no suffix": (
        ["render", "s.glb", "-o", "a"],
        2,
        "ending in .exr, .png, .jpg, .jpeg, .tif, .tiff",
    ),
    "no folder": (["render", "s.glb", "-o", "no/a.exr"], 5, "no such folder"),
    "camera": (["render", "s.glb", "-o", "a.exr", "-c", "Camra"], 3, "did you mean 'Camera'"),
    "focus": (["render", "s.glb", "-o", "a.exr", "--focus", "2 parsec"], 2, "--focus"),
    "two focuses": (
        ["render", "s.glb", "-o", "a.exr", "--focus", "2", "--focus-on", "x"],
        2,
        "--focus and --focus-on",
    ),
    "sensor": (["render", "s.glb", "-o", "a.exr", "--sensor", "apcs"], 2, "did you mean 'apsc'"),
    "res": (["render", "s.glb", "-o", "a.exr", "--res", "big"], 2, "960x540"),
    "res 0": (["render", "s.glb", "-o", "a.exr", "--res", "0x5"], 2, "1 to 65536"),
    "spp": (["render", "s.glb", "-o", "a.exr", "--spp", "0"], 2, "--spp"),
    "spp text": (
        ["render", "s.glb", "-o", "a.exr", "--spp", "many"],
        2,
        "--spp: wanted a whole number, got 'many'",
    ),
    "iso text": (
        ["render", "s.glb", "-o", "a.exr", "--iso=fast"],
        2,
        "--iso: wanted a number, got 'fast'",
    ),
    "flag of a parameter": (
        ["info", "s.glb", "--focus", "-1"],
        2,
        "camera: focus_distance (--focus): wanted a number above 0, got -1.0",
    ),
    "samples": (["render", "s.glb", "-o", "a.exr", "--samples", "8:8"], 2, "a < b"),
    "noise": (["render", "s.glb", "-o", "a.exr", "--noise", "0"], 2, "--noise: wanted"),
    "noise text": (["render", "s.glb", "-o", "a.exr", "--noise", "low"], 2, "--noise"),
    "noise spp": (["render", "s.glb", "-o", "a.exr", "--noise", "0.1", "--spp", "1"], 2, "spp"),
    "noise and samples": (
        ["render", "s.glb", "-o", "a.exr", "--noise", "0.1", "--samples", "0:8"],
        2,
        "--noise and --samples",
    ),
    "samples png": (["render", "s.glb", "-o", "a.png", "--samples", "0:8"], 2, ".exr"),
    "aov": (["render", "s.glb", "-o", "a.exr", "--aov", "dept"], 2, "did you mean 'depth'"),
    "crop": (["render", "s.glb", "-o", "a.exr", "--crop", "left=5,right=5"], 2, "got left=5,"),
    "edge": (["render", "s.glb", "-o", "a.exr", "--crop", "lft=5"], 2, "got 'lft' (did you mean"),
    "edge twice": (
        ["render", "s.glb", "-o", "a.exr", "--crop", "top=5,top=6"],
        2,
        "top appears twice",
    ),
    "edge in words": (["render", "s.glb", "-o", "a.exr", "--crop", "top=a"], 2, "--crop: top: "),
    "three edges": (["render", "s.glb", "-o", "a.exr", "--crop", "1,2,3"], 2, "or 100,50,400,300"),
    "env and sky": (
        ["render", "s.glb", "-o", "a.exr", "--env", "a.hdr", "--sky", "1,1,1"],
        2,
        "--env and --sky",
    ),
    "env missing": (["render", "s.glb", "-o", "a.exr", "--env", "no.hdr"], 3, "no.hdr"),
    "env scale alone": (["render", "s.glb", "-o", "a.exr", "--env-scale", "2"], 2, "--env"),
    "tone": (["render", "s.glb", "-o", "a.png", "--tone", "sof"], 2, "did you mean 'soft'"),
    "other tone": (
        ["render", "s.glb", "-o", "a.png", "--tone", "vivid"],
        2,
        "--tone: wanted srgb or soft; got 'vivid'",
    ),
    "seed": (["render", "s.glb", "-o", "a.exr", "--seed", "-1"], 2, "--seed"),
    "core": (["render", "s.glb", "-o", "a.exr", "--f-stop", "0"], 3, "wanted a number above 0"),
    "same output twice": (["render", "s.glb", "-o", "a.exr", "-o", "./a.exr"], 2, "twice"),
    "merge nothing": (["merge", "-o", "a.exr"], 2, "PASS"),
    "merge missing": (["merge", "no.exr", "-o", "a.exr"], 3, "no.exr"),
    "merge format": (["merge", "no.exr", "-o", "a.gif"], 2, "ending in .exr, .png"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_input_is_one_line_and_a_code(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments, code, text = WRONG[name]
    assert main(arguments) == code
    out = capsys.readouterr()
    lines = out.err.strip().splitlines()
    assert len(lines) == 1, out.err
    assert lines[0].startswith("daguerre: error: ")
    assert text in lines[0]
    assert "Traceback" not in out.err
    assert out.out == ""
    assert not list(tmp_path.iterdir())


def test_internal_errors_ask_for_a_report(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("FAKE_CRASH", "1")
    assert main(["render", "s.glb", "-o", "a.exr", "--quiet", *SMALL]) == 70
    err = capsys.readouterr().err
    assert "RuntimeError: the moon fell down" in err
    assert "please report" in err
    assert "Traceback" not in err
    monkeypatch.setenv("DAGUERRE_DEBUG", "1")
    assert main(["render", "s.glb", "-o", "a.exr", "--quiet", *SMALL]) == 70
    assert "Traceback" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_an_unexpected_value_error_is_internal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def draw(*_: Any) -> bool:
        raise ValueError("operands could not be broadcast together")

    monkeypatch.setattr(sys.modules["daguerre.rendering.session"].Session, "draw", draw)
    assert main(["render", "s.glb", "-o", "a.exr", "--quiet", *SMALL]) == 70
    err = capsys.readouterr().err
    assert "ValueError: operands could not be broadcast together" in err
    assert "please report" in err
    assert not list(tmp_path.iterdir())


def test_a_failed_run_keeps_the_old_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a.exr").write_bytes(b"old")
    monkeypatch.setenv("FAKE_CRASH", "1")
    assert main(["render", "s.glb", "-o", "a.exr", "--quiet", *SMALL]) == 70
    assert (tmp_path / "a.exr").read_bytes() == b"old"


def test_dry_run_draws_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    flags = ["--dry-run", "--f-stop", "f/2.8", "--samples", "4:8"]
    assert main(["render", "s.glb", "-o", "a.exr", *flags]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["samples"] == [4, 8]
    assert facts["key"]["camera"] == "2.8"
    assert not list(tmp_path.iterdir())


def test_bad_samples_are_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("FAKE_BAD", "1")
    assert main(["render", "s.glb", "-o", "a.exr", "--spp", "1", *SMALL]) == 0
    assert "sample 5 of pixel (2, 1)" in capsys.readouterr().err
    with OpenEXR.File(str(tmp_path / "a.exr")) as file:
        assert file.header()["daguerre:bad_samples"] == 1


def test_the_example_of_a_help_runs(capsys: pytest.CaptureFixture[str]) -> None:
    words = EXAMPLES["render"].replace("scene.glb", "s.glb").split()
    assert main([*words[1:], "--dry-run"]) == 0


def test_no_command_shows_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    assert "render" in capsys.readouterr().out
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"daguerre {daguerre.__version__}\n"


def test_interrupted_and_resumed_has_the_bits_of_a_whole_run(tmp_path: Path) -> None:
    flags = ["--spp", "60", "--json-progress", *SMALL]
    process = spawn("render", "s.glb", "-o", "a.exr", *flags, seconds=0.04)
    wait_for_samples(process, 3)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=20)
    assert process.returncode == 75, err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.checkpoint.exr"]

    # JSON progress carries what is said; the last event has the command.
    again = spawn("render", "s.glb", "-o", "a.exr", *flags, "--resume")
    out, err = again.communicate(timeout=20)
    assert again.returncode == 0, err
    events = [json.loads(line) for line in out.splitlines()]
    resumed = next(e for e in events if e["event"] == "progress")
    assert 3 <= resumed["samples"] < 60
    assert events[-1]["event"] == "done"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.exr"]

    assert main(["render", "s.glb", "-o", "whole.exr", "--spp", "60", "--quiet", *SMALL]) == 0
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "whole.exr").read_bytes()


def test_the_printed_command_resumes(tmp_path: Path) -> None:
    name = "a b.exr"
    flags = ["--spp", "400", "--checkpoint", "50ms", *SMALL]
    process = spawn("render", "s.glb", "-o", name, *flags, seconds=0.02)
    deadline = time.monotonic() + 20
    while not (tmp_path / "a b.checkpoint.exr").exists() and time.monotonic() < deadline:
        time.sleep(0.02)
    process.send_signal(signal.SIGTERM)
    _, err = process.communicate(timeout=20)
    assert process.returncode == 75, err
    command = shlex.split(err.strip().splitlines()[-1])
    assert command == ["daguerre", "render", "s.glb", "-o", name, *flags, "--resume"]
    again = spawn(*command[1:])
    _, err = again.communicate(timeout=20)
    assert again.returncode == 0, err
    assert "resuming at" in err
    assert (tmp_path / name).exists()


def test_nohup_survives_the_terminal(tmp_path: Path) -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # inherited by the child
    try:
        flags = ["--spp", "40", "--checkpoint", "50ms", *SMALL]
        process = spawn("render", "s.glb", "-o", "a.exr", *flags, seconds=0.02)
    finally:
        signal.signal(signal.SIGHUP, before)
    deadline = time.monotonic() + 20
    while not (tmp_path / "a.checkpoint.exr").exists() and time.monotonic() < deadline:
        time.sleep(0.02)
    process.send_signal(signal.SIGHUP)
    process.communicate(timeout=20)
    assert process.returncode == 0


def test_twice_stops_at_once_and_writes_nothing(tmp_path: Path) -> None:
    flags = ["--spp", "64", "--json-progress", *SMALL]
    process = spawn("render", "s.glb", "-o", "a.exr", *flags, seconds=1.5)
    assert process.stdout is not None
    for _ in range(2):  # the second line comes while a pass is drawn
        json.loads(process.stdout.readline())
    before = time.monotonic()
    process.send_signal(signal.SIGINT)
    time.sleep(0.2)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=20)
    assert process.returncode == 75
    assert time.monotonic() - before < 1.4
    assert not list(tmp_path.iterdir())


def test_usr1_writes_a_snapshot(tmp_path: Path) -> None:
    flags = ["--spp", "40", "--json-progress", *SMALL]
    process = spawn("render", "s.glb", "-o", "a.exr", *flags, seconds=0.03)
    wait_for_samples(process, 2)
    process.send_signal(signal.SIGUSR1)
    deadline = time.monotonic() + 10
    while not (tmp_path / "a.snapshot.exr").exists() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert (tmp_path / "a.snapshot.exr").exists()
    assert not (tmp_path / "a.exr").exists()
    process.communicate(timeout=20)
    assert process.returncode == 0


def test_killed_leaves_no_half_picture_and_the_checkpoint_goes_on(tmp_path: Path) -> None:
    flags = ["--spp", "60", "--checkpoint", "50ms", "--json-progress", *SMALL]
    process = spawn("render", "s.glb", "-o", "a.exr", *flags, seconds=0.02)
    deadline = time.monotonic() + 20
    while not (tmp_path / "a.checkpoint.exr").exists() and time.monotonic() < deadline:
        time.sleep(0.02)
    process.kill()
    process.communicate(timeout=20)
    assert not (tmp_path / "a.exr").exists()
    assert main(["render", "s.glb", "-o", "a.exr", *flags[:2], *SMALL, "--resume", "--quiet"]) == 0
    assert main(["render", "s.glb", "-o", "b.exr", *flags[:2], *SMALL, "--quiet"]) == 0
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()


def interrupted_checkpoint() -> None:
    """A checkpoint of the first samples, made by the parts that the loop uses."""
    from daguerre.camera.camera import Camera
    from daguerre.rendering.passes import pass_of, write_pass
    from daguerre.scene.scene import Scene

    session = fake_session.FakeSession(Scene(), Camera(), resolution=(8, 6))
    session.draw(0, 4)
    write_pass("a.checkpoint.exr", session.frame(), pass_of(session))


@pytest.mark.parametrize(
    ("flags", "text"),
    [
        (["--f-stop", "4"], "they differ in the camera"),
        (["--seed", "3"], "they differ in seed 0 (wanted 3)"),
        (["--spp", "2"], "holds samples 0:4, wanted only 0:2"),
    ],
)
def test_a_checkpoint_that_does_not_fit(
    flags: list[str], text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    interrupted_checkpoint()
    assert main(["render", "s.glb", "-o", "a.exr", "--resume", "-q", *SMALL, *flags]) == 4
    assert text in capsys.readouterr().err
    assert (tmp_path / "a.checkpoint.exr").exists()
    assert not (tmp_path / "a.exr").exists()


def test_a_damaged_checkpoint(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    interrupted_checkpoint()
    path = tmp_path / "a.checkpoint.exr"
    whole = path.read_bytes()
    for size in (0, 3, 100, len(whole) // 2, len(whole) - 5):
        path.write_bytes(whole[:size])
        assert main(["render", "s.glb", "-o", "a.exr", "--resume", "-q", *SMALL]) == 3
        lines = capsys.readouterr().err.strip().splitlines()
        assert len(lines) == 1
        assert "a.checkpoint.exr" in lines[0]


def test_resume_without_a_checkpoint_starts(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "s.glb", "-o", "a.exr", "--spp", "1", "--resume", *SMALL]) == 0
    assert "nothing to resume" in capsys.readouterr().err


def test_json_progress_is_json_only(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "s.glb", "-o", "a.exr", "--spp", "8", "--json-progress", *SMALL]) == 0
    lines = capfd.readouterr().out.splitlines()
    events = [json.loads(line) for line in lines]
    progress = [e for e in events if e["event"] == "progress"]
    assert progress[-1]["fraction"] == 1
    assert progress[-1]["samples"] == 8
    assert {"samples_per_s", "rays_per_s", "elapsed_s", "left_s"} <= set(progress[-1])
    assert events[-1] == {"event": "done", "outputs": ["a.exr"], "samples": 8}


def test_a_log_gets_plain_lines(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from daguerre.cli import progress

    monkeypatch.setattr(progress.Lines, "period_s", 0.1)
    monkeypatch.setenv("FAKE_SECONDS", "0.02")
    assert main(["render", "s.glb", "-o", "a.exr", "--spp", "30", *SMALL]) == 0
    lines = [line for line in capsys.readouterr().err.splitlines() if " samples/s" in line]
    assert lines
    assert all("%" in line and "left" in line and "\x1b" not in line for line in lines)


def test_a_terminal_gets_a_bar() -> None:
    leader, follower = open_terminal()
    root = Path(__file__).parents[2]
    paths = os.pathsep.join(filter(None, [str(root), os.environ.get("PYTHONPATH", "")]))
    process = subprocess.Popen(
        [
            sys.executable,
            "-m",
            "tests.support.program.fake_session",
            "render",
            "s.glb",
            "-o",
            "a.exr",
            *SMALL,
        ],
        stderr=follower,
        stdout=subprocess.DEVNULL,
        env={
            **os.environ,
            "FAKE_SECONDS": "0.01",
            "PYTHONPATH": paths,
            "TERM": "xterm",
            "COLUMNS": "120",
        },
    )
    os.close(follower)
    seen = b""
    try:
        while data := os.read(leader, 65536):
            seen += data
    except OSError:
        pass  # the other end was closed
    assert process.wait(timeout=20) == 0
    text = seen.decode()
    assert "samples/s" in text
    assert "rays/s" in text
    assert "left" in text
    assert "\x1b[" in text


def test_stats(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "s.glb", "-o", "a.exr", "--spp", "4", "--stats", *SMALL]) == 0
    err = capsys.readouterr().err
    assert "peak memory" in err
    assert "camera samples: 192 (" in err
    assert "light paths: off" in err


def test_stats_count_light_beside_the_frame(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    class Lit(fake_session.FakeSession):
        def __init__(self, *args: Any, **options: Any) -> None:
            super().__init__(*args, **options)
            self.light_paths = (50.0, 0.0)
            self.flare_spots, self.survey_rays = 3, 1000
            self.counters = _core.RenderCounters(
                camera_rays=400,
                stopped_rays=100,
                light_paths=200,
                splats_off_film=30,
                flare_paths=100,
                flare_rays=400,
                flare_hits=300,
                flare_arrivals=5000,
            )
            core = SimpleNamespace(flare_map_error=0.0042, flare_ghosts_by_rays=2)
            self.light_plan = SimpleNamespace(core=core)

    monkeypatch.setattr(sys.modules["daguerre.rendering.session"], "Session", Lit)
    assert main(["render", "s.glb", "-o", "a.exr", "--spp", "4", "--stats", *SMALL]) == 0
    said = capsys.readouterr().err
    assert "light paths: 200 (50,0 per sample), 30 beside the frame" in said
    assert "flare maps: 5000 arrivals, maps off by 0.4%, 2 ghosts by rays alone" in said
    assert "flare: 100 paths, 75% of their rays on the frame" in said
    assert "highlights: 3 bright spots, by 1000 rays" in said
    assert "stopped: 25.0% of the camera's rays" in said


def test_passes_grow_on_aligned_powers_of_two() -> None:
    begin, size, sizes = 0, 0, []
    while begin < 100:
        size = pass_size((begin, 100), 2 * size)
        assert begin % size == 0 or begin + size == 100
        sizes.append(size)
        begin += size
    assert sizes == [1, 1, 2, 4, 8, 16, 32, 36]
    assert pass_size((64, 200), 3.9) == 2
    assert pass_size((64, 200), 0.03) == 1
    assert pass_size((7, 200), 8) == 1


def test_command_line_is_quoted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(console, "argv", ["render", "a b.glb", "--resume"])
    assert console.command_line("--resume") == "daguerre render 'a b.glb' --resume"


def test_help_does_not_load_what_it_does_not_need() -> None:
    code = (
        "import sys; from daguerre.cli import main; main(['--help']);"
        "heavy = ('numpy', 'OpenEXR', 'OpenImageIO', 'matplotlib');"
        "print([m for m in heavy if m in sys.modules], file=sys.stderr)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stderr.strip() == "[]"


def test_the_package_runs_as_the_command() -> None:
    run = subprocess.run(
        [sys.executable, "-m", "daguerre", "rendr"], capture_output=True, text=True, check=False
    )
    assert run.returncode == 2
    assert "render" in run.stderr
    assert "Traceback" not in run.stderr


def test_denoising_without_the_extra_says_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("daguerre.files.extras.find_spec", lambda name: None)
    assert main(["render", "s.glb", "-o", "a.exr", "--denoise", *SMALL]) == 2
    assert extras.hint("mitsuba_oidn") in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_denoising_needs_the_picture_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    library = fake_denoiser.install(monkeypatch.setitem, monkeypatch.setattr)
    assert main(["render", "s.glb", "-o", "a.exr", "--denoise", "--spp", "2", *SMALL]) == 0
    assert [sorted(images) for images in library.runs] == [
        ["albedo"],
        ["normal"],
        ["albedo", "color", "normal"],
    ]
    planes = pixels(tmp_path / "a.exr")
    assert (planes["R"] == 0.5).all()
    assert not [name for name in planes if "albedo" in name]
    with OpenEXR.File(str(tmp_path / "a.exr"), header_only=True) as file:
        assert file.header()["daguerre:denoised"] == "mitsuba-oidn 0.1.2"
        assert "daguerre:denoised_noise" not in file.header()


def test_the_picture_before_denoising_can_be_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    fake_denoiser.install(monkeypatch.setitem, monkeypatch.setattr)
    run = ["render", "s.glb", "-o", "a.exr", "--spp", "2", *SMALL]
    assert main([*run, "--denoise", "--noisy", "b.exr"]) == 0
    assert "a.exr, b.exr" in capsys.readouterr().err
    assert main([*run[:3], "c.exr", *run[4:]]) == 0
    noisy, plain = pixels(tmp_path / "b.exr"), pixels(tmp_path / "c.exr")
    assert (pixels(tmp_path / "a.exr")["R"] == 0.5).all()
    np.testing.assert_array_equal(noisy["R"], plain["R"])
    assert set(noisy) == set(plain)


def test_a_noisy_picture_needs_a_clean_one(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "s.glb", "-o", "a.exr", "--noisy", "b.exr", *SMALL]) == 2
    assert "--noisy needs --denoise" in capsys.readouterr().err


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_a_reader_that_leaves_does_not_end_the_render(tmp_path: Path, stream: str) -> None:
    flags = ["--json-progress"] if stream == "stdout" else []
    run = ["render", "s.glb", "-o", str(tmp_path / "a.exr"), "--spp", "8", *flags, *SMALL]
    with spawn(*run, seconds=0.05) as process:
        getattr(process, stream).close()
        assert process.wait(60) == 0
    assert (tmp_path / "a.exr").exists()
