"""Free memory of a machine, by its own files: of all of it, and of control groups 1 and 2."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre import memory, units
from daguerre.cli import main
from daguerre.errors import UsageError
from daguerre.rendering.session import Session
from tests.support.formats.make_gltf import triangle

GB = 10**9


def machine(root: Path, group: str, files: dict[str, str]) -> int | None:
    """Free bytes of a machine with 8 GiB and swap of 1 GiB, and with these files of groups."""
    told = "MemTotal: 16777216 kB\nMemAvailable: 8388608 kB\nSwapFree: 1048576 kB\n"
    for name, text in {
        "proc/meminfo": told,
        "proc/self/cgroup": group,
        **{f"groups/{name}": text for name, text in files.items()},
    }.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return memory.free_bytes(root / "proc", root / "groups")


NEW = "0::/job/step\n"
OLD = "5:cpu,cpuacct:/x\n4:memory:/job/step\n0::/\n"


@pytest.mark.parametrize(
    ("group", "files", "free"),
    [
        ("", {}, 9 << 30),
        (NEW, {}, 9 << 30),
        (NEW, {"job/step/memory.max": "max\n", "job/step/memory.current": "5\n"}, 9 << 30),
        (NEW, {"job/step/memory.max": f"{4 * GB}", "job/step/memory.current": f"{GB}"}, 3 * GB),
        # The limit of a group above, and files that are cached and can go.
        (
            NEW,
            {
                "job/memory.max": f"{4 * GB}",
                "job/memory.current": f"{3 * GB}",
                "job/memory.stat": f"anon 7\ninactive_file {GB}\n",
            },
            2 * GB,
        ),
        # A container sees its own group at the root.
        (NEW, {"memory.max": f"{2 * GB}", "memory.current": f"{3 * GB}"}, 0),
        (
            OLD,
            {
                "memory/job/step/memory.limit_in_bytes": "9223372036854771712",
                "memory/job/step/memory.usage_in_bytes": "5",
                "memory/job/memory.limit_in_bytes": f"{4 * GB}",
                "memory/job/memory.usage_in_bytes": f"{3 * GB}",
                "memory/job/memory.stat": f"total_inactive_file {GB // 2}\n",
            },
            GB + GB // 2,
        ),
    ],
)
def test_free_memory(tmp_path: Path, group: str, files: dict[str, str], free: int) -> None:
    assert machine(tmp_path, group, files) == free


def test_where_nobody_tells(tmp_path: Path) -> None:
    assert memory.free_bytes(tmp_path, tmp_path) is None


@pytest.mark.parametrize(
    ("count", "words"),
    [(12, "12 B"), (1000, "1 kB"), (53.4e9, "53.4 GB"), (704e9, "704 GB"), (7e12, "7 TB")],
)
def test_words(count: float, words: str) -> None:
    assert memory.shown(count) == words


@pytest.mark.parametrize(
    ("limit", "group", "left"),
    [
        (None, None, 9 << 30),
        (None, 4 * GB, int(0.8 * 4 * GB) - GB),  # of the container, not of the machine
        (0.5, None, (8 << 30) - GB),
        (2 * GB, None, GB),
        (GB // 2, None, 0),
        (100 * GB, None, 9 << 30),  # what is free is all that there is
    ],
)
def test_a_process_stays_below_its_limit(
    tmp_path: Path, limit: float | None, group: int | None, left: int
) -> None:
    files = {"memory.max": "max\n" if group is None else f"{group}\n", "memory.current": "0\n"}
    machine(tmp_path, NEW, files)
    status = f"VmRSS:\t 5000000 kB\nRssAnon:\t {GB // 1024} kB\nVmSwap:\t 0 kB\n"
    (tmp_path / "proc/self/status").write_text(status)
    try:
        memory.set_limit(limit)
        found = memory.left_bytes(tmp_path / "proc", tmp_path / "groups")
    finally:
        memory.set_limit(None)
    assert found == pytest.approx(left, abs=1024)


def test_limits_as_people_type_them() -> None:
    for text, value in {"8GB": 8e9, "512 MiB": 2**29, "50%": 0.5, "1.5tb": 1.5e12}.items():
        assert units.memory_bytes("--memory", text) == pytest.approx(value)
    for text in ("0", "8", "-1GB", "150%", "0%", "8G B", "inf", "x", ""):
        with pytest.raises(UsageError, match="--memory: wanted an amount of memory above 0"):
            units.memory_bytes("--memory", text)
    with pytest.raises(UsageError, match="memory: wanted a number of bytes"):
        memory.set_limit(0)


def test_a_render_above_its_limit_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = str(triangle().glb(tmp_path / "one.glb"))
    out = tmp_path / "a.exr"
    command = ["render", scene, "--res", "4000x3000", "--lens", "pinhole", "-o", str(out), "-q"]
    kept = int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    limit = f"{kept / 1e9 + 0.5:.3f}GB"  # other tests may have filled this process
    try:
        assert main([*command, "--memory", limit]) == 3
    finally:
        memory.set_limit(None)
    told = capsys.readouterr().err
    assert "picture: memory: wanted at most the" in told
    assert "--memory" in told
    assert not out.exists()


def test_memory_that_ends_within_a_pass_is_one_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    scene = str(triangle().glb(tmp_path / "one.glb"))
    command = ["render", scene, "--res", "40x30", "--lens", "pinhole", "--sky", "1,1,1", "-q"]
    command += ["--spp", "64", "--checkpoint", "0.000001", "-o", "a.exr"]
    draw, passes = Session._add, 0

    def fails(self: Session, *arguments: object) -> bool:
        nonlocal passes
        passes += 1
        if passes == 3:
            raise MemoryError
        return draw(self, *arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(Session, "_add", fails)
    assert main(command) == 3
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "a.checkpoint.exr keeps the samples before; continue with --resume" in told
    monkeypatch.setattr(Session, "_add", draw)
    assert main([*command, "--resume"]) == 0
    resumed = dg.load_frame("a.exr")
    Path("a.exr").unlink()
    assert main(command) == 0
    assert np.array_equal(resumed.rgb, dg.load_frame("a.exr").rgb)


def test_a_thread_that_cannot_start_is_no_bug(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def start(self: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    scene = str(triangle().glb(tmp_path / "one.glb"))
    monkeypatch.setattr(threading.Thread, "start", start)
    out = str(tmp_path / "a.png")
    assert main(["render", scene, "--res", "40x30", "--sky", "1,1,1", "-q", "-o", out]) == 3
    told = capsys.readouterr().err
    assert told.startswith("daguerre: error: cannot start another thread: memory, or")
    assert told.count("\n") == 1
