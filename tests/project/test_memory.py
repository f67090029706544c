"""Free memory of a machine, by its own files: of all of it, and of control groups 1 and 2."""

from __future__ import annotations

from pathlib import Path

import pytest

from daguerre import memory

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
