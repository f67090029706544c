"""Files under faults: order of writes, what killed writers leave, disks that are full or gone."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import daguerre as dg
from daguerre.errors import InputError, MismatchError
from daguerre.files import atomic
from daguerre.files.json_file import read_json_file
from daguerre.rendering import Job, Output, Picture, RenderSettings, View, identity, loop
from daguerre.rendering.checkpoint import Checkpoint

from .process import ROOT, run
from .scene import write_scene

SMALL = ["--camera", "left", "--res", "96x64", "--sky", "1,0.9,0.8", "--filter", "box"]
SHOT = ["--sensor", "ideal", "--exposure-f-stop", "4", "--exposure-time", "1/50", "--iso", "100"]
LIMIT = "import resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)); "
RUN = "import sys; from daguerre.cli import main; sys.exit(main(sys.argv[1:]))"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_scene(tmp_path / "s.glb")
    (tmp_path / "out").mkdir()
    (tmp_path / "rescue").mkdir()
    return tmp_path


def render(
    folder: Path, *words: str, before: str = "", wrapper: tuple[str, ...] = ()
) -> subprocess.CompletedProcess[str]:
    """Runs the command line in a process; ``before`` is Python that comes first."""
    program = [*wrapper, sys.executable, "-c", before + RUN, "render", "s.glb", *SMALL]
    return run([*program, *words], folder, timeout=120, TMPDIR=str(folder / "rescue"))


def errors(text: str) -> list[str]:
    return [line for line in text.splitlines() if line.startswith("daguerre: error")]


def order_faults(trace: str) -> tuple[list[str], int]:
    """Renames whose file was not synced before, or whose folder was not after; number of renames.

    Args:
        trace: Calls as strace writes them with ``-y``: descriptors have their paths.
    """
    synced: set[str] = set()
    unsynced: dict[str, str] = {}
    faults, renames = [], 0
    for line in trace.splitlines():
        if found := re.search(r"write64?\(\d+<([^>]*)>", line):
            synced.discard(found[1])
        elif found := re.search(r"f(?:data)?sync\(\d+<([^>]*)>\)\s+= 0", line):
            synced.add(found[1])
            unsynced = {name: at for name, at in unsynced.items() if at != found[1]}
        elif found := re.search(
            r'rename\w*\((?:AT_\w+(?:<[^>]*>)?, )?"([^"]*)", .*"([^"]*)"', line
        ):
            renames += 1
            if found[1] not in synced:
                faults.append(f"{found[2]}: not synced before its rename")
            unsynced[found[2]] = str(Path(found[2]).parent)
        elif (found := re.search(r'unlink\w*\((?:AT_\w+(?:<[^>]*>)?, )?"([^"]*)".*= 0', line)) and (
            ".checkpoint.exr" in found[1] and ".tmp" not in found[1]
        ):
            faults += [f"{name}: its folder was not synced before" for name in unsynced]
    return faults + [f"{name}: its folder was never synced" for name in unsynced], renames


def whole_calls(lines: list[str]) -> list[str]:
    """Joins calls that strace wrote in two parts, since another thread called in between."""
    begun: dict[str, str] = {}
    whole = []
    for line in lines:
        thread = line.split(maxsplit=1)[0]
        if line.endswith(" <unfinished ...>"):
            begun[thread] = line.removesuffix(" <unfinished ...>")
        elif found := re.search(r"<\.\.\. \w+ resumed>(.*)", line):
            whole.append(begun.pop(thread, line) + found[1])
        else:
            whole.append(line)
    return whole


def test_calls_in_two_parts_are_joined() -> None:
    lines = ["7 fsync(3</a> <unfinished ...>", "8 fsync(4</b>) = 0", "7 <... fsync resumed>) = 0"]
    assert whole_calls(lines) == ["8 fsync(4</b>) = 0", "7 fsync(3</a>) = 0"]


@pytest.mark.skipif(shutil.which("strace") is None, reason="no strace here")
def test_lost_power_leaves_the_old_file_or_the_new_one(folder: Path) -> None:
    calls = "write,pwrite64,fsync,fdatasync,rename,renameat,renameat2,unlink,unlinkat"
    wrapper = ("strace", "-f", "-y", "-o", "trace", "-e", f"trace={calls}")
    files = ["-o", "out/a.exr", "-o", "out/a.dng", "-o", "out/a.png", "-o", "out/a.jpg"]
    run = render(folder, *files, *SHOT, "--spp", "8", "--checkpoint", "1us", wrapper=wrapper)
    if "ptrace" in run.stderr:
        pytest.skip("strace may not trace here")
    assert run.returncode == 0, run.stderr
    lines = whole_calls((folder / "trace").read_text().splitlines())
    trace = "\n".join(line for line in lines if str(folder / "out") in line)
    faults, renames = order_faults(trace)
    assert not faults
    assert renames >= 5  # four pictures, and checkpoints before them
    # The same calls without one kind of sync must be found at fault.
    without = [line for line in trace.splitlines() if not re.search(r"sync\(.*\.tmp", line)]
    assert len(order_faults("\n".join(without))[0]) == renames
    without = [line for line in trace.splitlines() if not re.search(r"sync\(\d+<[^>]*/out>", line)]
    assert any("folder" in fault for fault in order_faults("\n".join(without))[0])


def test_what_killed_writers_left_goes_and_what_others_write_stays(tmp_path: Path) -> None:
    target = tmp_path / "a.exr"
    left = [tmp_path / f".a.{word}.tmp.exr" for word in ("0123abcd", "89abcdef")]
    others = [tmp_path / name for name in (".b.0123abcd.tmp.exr", ".a.tmp.exr", "a.exr.tmp")]
    for path in (*left, *others):
        path.write_bytes(b"half")
    with atomic.atomic_path(target) as first:
        first.write_bytes(b"first")
        assert not any(path.exists() for path in left)
        with atomic.atomic_path(target) as second:
            second.write_bytes(b"second")
            assert first.read_bytes() == b"first"
        assert target.read_bytes() == b"second"
    assert target.read_bytes() == b"first"
    assert sorted(tmp_path.iterdir()) == sorted([target, *others])
    left[0].write_bytes(b"half")
    atomic.remove(target)
    atomic.remove(target)
    assert sorted(tmp_path.iterdir()) == sorted(others)


def test_what_a_killed_check_left_goes_with_the_next_one(tmp_path: Path) -> None:
    """A picture that is complete is not written again, but its names are tried."""
    (tmp_path / "a.00.png").touch()
    left = tmp_path / ".a.00.8948e161.tmp.png"
    left.touch()
    others = [tmp_path / name for name in (".a.01.8948e161.tmp.png", ".a.00.8948e16x.tmp.png")]
    for other in others:
        other.touch()
    atomic.check_writable(tmp_path / "a.00.png")
    assert not left.exists()
    assert all(other.exists() for other in others)


@pytest.mark.parametrize("ending", ["exr", "png", "jpg", "tif", "dng"])
def test_a_quota_is_one_error_for_each_format(folder: Path, ending: str) -> None:
    shot = SHOT if ending == "dng" else []
    run = render(folder, "-o", f"out/a.{ending}", *shot, "--spp", "1", before=LIMIT)
    assert run.returncode == 5, run.stderr
    (error,) = errors(run.stderr)
    assert f"out/a.{ending}: cannot write" in error
    assert ".tmp" not in run.stderr
    assert not list((folder / "out").iterdir())
    assert not list((folder / "rescue").iterdir())


def mounted(options: str, *words: str) -> tuple[str, ...]:
    """Runs a command with a small file system of its own at ``out``."""
    script = f'mount -t tmpfs {options} none out && exec "$0" "$@"'
    return ("unshare", "-m", "sh", "-c", script, *words)


def may_mount(folder: Path) -> bool:
    if shutil.which("unshare") is None or os.geteuid() != 0:
        return False
    return not subprocess.run(mounted("", "true"), cwd=folder, check=False).returncode


@pytest.mark.parametrize("full", [True, False], ids=["full", "read-only"])
def test_a_disk_that_takes_nothing(folder: Path, *, full: bool) -> None:
    if not may_mount(folder):
        pytest.skip("only root may mount")
    wrapper = mounted("-o size=4k" if full else "-o ro")
    run = render(folder, "-o", "out/a.exr", "--spp", "4", wrapper=wrapper)
    assert run.returncode == 5, run.stderr
    (error,) = errors(run.stderr)
    words = "No space left" if full else "Read-only file system"
    assert words in error
    kept = list((folder / "rescue").rglob("*.exr"))
    if not full:  # it was refused before anything was drawn
        assert not kept
        return
    assert f"the samples are kept in {kept[0]}" in run.stderr
    kept[0].rename(folder / "b.checkpoint.exr")
    assert render(folder, "-o", "b.exr", "--spp", "4", "--resume").returncode == 0
    assert render(folder, "-o", "c.exr", "--spp", "4").returncode == 0
    assert (folder / "b.exr").read_bytes() == (folder / "c.exr").read_bytes()


def started(folder: Path, *words: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", RUN, "render", "s.glb", *SMALL, *words],
        cwd=folder,
        env={**os.environ, "TMPDIR": str(folder / "rescue"), "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # nohup, under which tests may run, has children ignore it
        preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL),
    )


def wait_for(path: Path) -> None:
    end = time.monotonic() + 60
    while not path.exists():
        assert time.monotonic() < end
        time.sleep(0.02)


def test_a_folder_that_vanishes_does_not_take_the_samples_with_it(folder: Path) -> None:
    process = started(folder, "-o", "out/a.exr", "--spp", "3000", "--checkpoint", "50ms")
    wait_for(folder / "out/a.checkpoint.exr")
    (folder / "out").rename(folder / "gone")
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 75, said
    (kept,) = (folder / "rescue").rglob("*.exr")
    assert f"saved in {kept}" in said
    assert not errors(said)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_signals_keep_what_was_drawn(folder: Path, number: int) -> None:
    process = started(folder, "-o", "out/a.exr", "--spp", "3000", "--checkpoint", "50ms")
    wait_for(folder / "out/a.checkpoint.exr")
    process.send_signal(number)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 75, said
    assert not errors(said)
    assert [path.name for path in (folder / "out").iterdir()] == ["a.checkpoint.exr"]


def test_two_writers_of_one_output_leave_a_whole_one(folder: Path) -> None:
    words = [("-o", "out/a.exr", "--spp", "16", "--seed", n, "--checkpoint", "1us") for n in "12"]
    both = [started(folder, *more) for more in words]
    for process in both:
        _, said = process.communicate(timeout=60)
        assert process.returncode == 0, said
    assert [path.name for path in (folder / "out").iterdir()] == ["a.exr"]
    wanted = []
    for seed in "12":
        assert render(folder, "-o", "b.exr", "--spp", "16", "--seed", seed).returncode == 0
        wanted.append((folder / "b.exr").read_bytes())
    assert (folder / "out/a.exr").read_bytes() in wanted


def test_a_snapshot_that_cannot_be_written_does_not_end_the_render(folder: Path) -> None:
    process = started(folder, "-o", "out/a.exr", "--spp", "3000", "--checkpoint", "50ms")
    wait_for(folder / "out/a.checkpoint.exr")
    (folder / "out/a.snapshot.exr").mkdir()
    process.send_signal(signal.SIGUSR1)
    time.sleep(0.5)
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 75, said
    assert "snapshot not saved: " in said


def test_a_clock_that_goes_back_changes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    saves: list[float] = []
    monkeypatch.setattr(loop, "PASS_S", 0.001)
    monkeypatch.setattr(Checkpoint, "save", lambda self, session: saves.append(time.time()))
    now = [2e9]

    def back() -> float:
        now[0] -= 1000.0
        return now[0]

    monkeypatch.setattr(time, "time", back)
    scene = dg.load(write_scene(tmp_path / "s.glb"))
    settings = RenderSettings.of(resolution=(12, 8), spp=16)
    picture = Picture(View.of("left"), settings, Output((tmp_path / "a.exr",)))
    assert Job(scene, [picture], interval_s=1e-6).run()
    assert len(saves) >= 3


def test_a_checkpoint_of_another_build_is_refused_by_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    camera = dg.Camera(lens_model="pinhole")
    kept = tmp_path / "kept.exr"
    now = identity.key
    monkeypatch.setattr(identity, "key", lambda s: {**now(s), "build": "daguerre 0.8.0"})
    settings = {"resolution": (8, 6), "spp": 64}
    dg.render(scene, camera, checkpoint=kept, progress=lambda s: s.samples < 1, **settings)
    monkeypatch.setattr(identity, "key", now)
    with pytest.raises(MismatchError, match=r"kept.exr.*the build of daguerre \(daguerre 0\.8\.0"):
        dg.render(scene, camera, checkpoint=kept, **settings)
    assert kept.exists()
    kept.write_bytes(b"no picture")
    with pytest.raises(InputError, match=r"kept\.exr"):
        dg.render(scene, camera, checkpoint=kept, **settings)


def test_an_endless_file_name_is_a_short_error(tmp_path: Path) -> None:
    endless = tmp_path / ("[" * 6000 + ".json")
    with pytest.raises(dg.InputError, match="cannot read: File name too long") as caught:
        read_json_file(endless, "any", (), lambda root: root)
    assert len(str(caught.value)) < 1200
