"""Memory that we may still take, so that what cannot fit is refused and not killed.

That is what the machine and its control groups have free, as long as the process stays below its
limit: 80 % of what they give in all, or what was asked for (``set_limit``).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

from .errors import UsageError

PROC, GROUPS = Path("/proc"), Path("/sys/fs/cgroup")
#: Share of what there is in all that a process takes, if nobody says another limit.
SHARE = 0.8
_asked: float | None = None


def set_limit(limit: float | None) -> None:
    """Limits what this process takes.

    Args:
        limit: Bytes, or a share of what the machine or the control group gives if at most 1; None:
            ``SHARE``.

    Raises:
        UsageError: It is not above 0.
    """
    global _asked
    if limit is not None and not 0 < limit < math.inf:
        raise UsageError(f"memory: wanted a number of bytes, or a share up to 1; got {limit!r}")
    _asked = limit


def left_bytes(proc: Path = PROC, groups: Path = GROUPS) -> int | None:
    """Memory that this process may still take, bytes; None: nobody tells."""
    free, most = free_bytes(proc, groups), limit_bytes(proc, groups)
    told = [
        count
        for count in (free, None if most is None else most - own_bytes(proc))
        if count is not None
    ]
    return max(min(told), 0) if told else None


def limit_bytes(proc: Path = PROC, groups: Path = GROUPS) -> int | None:
    """Memory that this process may take in all, bytes; None: nobody tells what there is."""
    if _asked is not None and _asked > 1:
        return int(_asked)
    given = total_bytes(proc, groups)
    return None if given is None else int((SHARE if _asked is None else _asked) * given)


def total_bytes(proc: Path = PROC, groups: Path = GROUPS) -> int | None:
    """Memory of the machine, or less where a control group of ours has a limit; without swap."""
    facts = _numbers(proc / "meminfo")
    found = [1024 * facts["MemTotal:"]] if "MemTotal:" in facts else []
    for folder in _groups(proc, groups):
        limits = (_number(folder / name) for name in ("memory.max", "memory.limit_in_bytes"))
        found += [limit for limit in limits if limit is not None]
    return min(found) if found else None


def own_bytes(proc: Path = PROC) -> int:
    """Memory that is this process's own: files that it reads can be dropped."""
    facts = _numbers(proc / "self" / "status")
    return 1024 * (facts.get("RssAnon:", 0) + facts.get("VmSwap:", 0))


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
