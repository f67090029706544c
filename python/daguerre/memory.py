"""Memory that this machine still has for us, so that what cannot fit is refused and not killed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

PROC, GROUPS = Path("/proc"), Path("/sys/fs/cgroup")


def free_bytes(proc: Path = PROC, groups: Path = GROUPS) -> int | None:
    """Memory and swap that are free or can be had by dropping caches; None: nobody tells.

    Linux tells it of the machine, and of the control groups that we are in: those of a container or
    a cluster's job may allow less. Sources: proc(5); the kernel's admin-guide/cgroup-v1/memory.rst
    and cgroup-v2.rst.
    """
    found = [_of_machine(proc), *(_of_group(folder) for folder in _groups(proc, groups))]
    told = [free for free in found if free is not None]
    return max(min(told), 0) if told else None


def shown(count: float) -> str:
    """Bytes as people read them, such as 12.3 GB."""
    for unit in ("B", "kB", "MB", "GB"):
        if count < 1000:
            return f"{count:.3g} {unit}"
        count /= 1000
    return f"{count:.4g} TB"


def _of_machine(proc: Path) -> int | None:
    """MemAvailable and SwapFree, which are in kB."""
    facts = _numbers(proc / "meminfo")
    if "MemAvailable:" not in facts:
        return None
    return 1024 * (facts["MemAvailable:"] + facts.get("SwapFree:", 0))


def _groups(proc: Path, groups: Path) -> Iterator[Path]:
    """Folders of the groups with memory limits that this process is in, to the root of each.

    A container sees its own group at the root, by whatever name the machine has it.
    """
    for line in _lines(proc / "self" / "cgroup"):
        _, controllers, path = line.split(":", 2)
        if controllers and "memory" not in controllers.split(","):
            continue
        root = groups / "memory" if controllers else groups
        own = Path(path.lstrip("/"))
        yield from (root / part for part in (own, *own.parents))


def _of_group(folder: Path) -> int | None:
    """Limit less use, of either version; files that are cached and not in use can be dropped."""
    for limit, usage, cached in (
        ("memory.max", "memory.current", "inactive_file"),
        ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"),
    ):
        most, used = _number(folder / limit), _number(folder / usage)
        if most is not None and used is not None:
            return most - used + _numbers(folder / "memory.stat").get(cached, 0)
    return None


def _number(path: Path) -> int | None:
    """The number that a file holds; None: no file, or no limit ("max")."""
    word = next(iter(_lines(path)), "")
    return int(word) if word.isdecimal() else None


def _numbers(path: Path) -> dict[str, int]:
    """Lines of a name and a number."""
    words = (line.split() for line in _lines(path))
    return {w[0]: int(w[1]) for w in words if len(w) > 1 and w[1].isdecimal()}


def _lines(path: Path) -> list[str]:
    try:
        return path.read_text().splitlines()
    except OSError:
        return []
