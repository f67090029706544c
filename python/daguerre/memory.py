"""Memory that the process may still use, so that too large tasks get an error and are not killed.

It is the free memory of the machine and its control groups, as long as the process stays below its
limit: 80 % of their total memory, or the limit of ``set_limit``.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

from .errors import InputError, UsageError

PROC, GROUPS = Path("/proc"), Path("/sys/fs/cgroup")
#: Default limit: share of the total memory that a process uses.
SHARE = 0.8
_asked: float | None = None


def set_limit(limit: float | None) -> None:
    """Limits the memory that this process uses.

    Args:
        limit: Bytes; or, if at most 1, a share of the memory of the machine or its control group;
            None: ``SHARE``.

    Raises:
        UsageError: The limit is not above 0.
    """
    global _asked
    if limit is not None and not 0 < limit < math.inf:
        raise UsageError(f"memory: wanted a number of bytes, or a share up to 1; got {limit!r}")
    _asked = limit


def left_bytes(proc: Path = PROC, groups: Path = GROUPS) -> int | None:
    """Memory that this process may still use, bytes; None: unknown."""
    free, most = free_bytes(proc, groups), limit_bytes(proc, groups)
    told = [
        count
        for count in (free, None if most is None else most - own_bytes(proc))
        if count is not None
    ]
    return max(min(told), 0) if told else None


def limit_bytes(proc: Path = PROC, groups: Path = GROUPS) -> int | None:
    """Memory that this process may use in all, bytes; None: unknown."""
    if _asked is not None and _asked > 1:
        return int(_asked)
    given = total_bytes(proc, groups)
    return None if given is None else int((SHARE if _asked is None else _asked) * given)


def total_bytes(proc: Path = PROC, groups: Path = GROUPS) -> int | None:
    """Memory of the machine, or the limit of a control group of the process; without swap."""
    facts = _numbers(proc / "meminfo")
    found = [1024 * facts["MemTotal:"]] if "MemTotal:" in facts else []
    for folder in _groups(proc, groups):
        limits = (_number(folder / name) for name in ("memory.max", "memory.limit_in_bytes"))
        found += [limit for limit in limits if limit is not None]
    return min(found) if found else None


def own_bytes(proc: Path = PROC) -> int:
    """Private memory of this process, without cached files, which can be dropped."""
    facts = _numbers(proc / "self" / "status")
    return 1024 * (facts.get("RssAnon:", 0) + facts.get("VmSwap:", 0))


def free_bytes(proc: Path = PROC, groups: Path = GROUPS) -> int | None:
    """Memory and swap that are free, or become free by dropping caches; None: unknown.

    Linux reports it for the machine and for the control groups of the process; those of a container
    or a cluster's job may allow less. Sources: proc(5); the kernel's
    admin-guide/cgroup-v1/memory.rst and cgroup-v2.rst.
    """
    found = [_of_machine(proc), *(_of_group(folder) for folder in _groups(proc, groups))]
    told = [free for free in found if free is not None]
    return max(min(told), 0) if told else None


def need_addresses(least: int) -> None:
    """Checks that this process may map enough memory.

    Args:
        least: Bytes.

    Raises:
        InputError: The limit of the process (``ulimit -v``) is lower.
    """
    try:
        import resource
    except ImportError:  # Windows
        return
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    if limit != resource.RLIM_INFINITY and limit < least:
        raise InputError(
            f"too little address space: wanted at least {shown(least)}, got a limit of this "
            f"process (ulimit -v) of {shown(limit)}"
        )


def shown(count: float) -> str:
    """Formats bytes for people, such as 12.3 GB."""
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
    """Folders of the control groups of this process that limit memory, up to the root of each.

    A container sees its own group at the root, whatever the machine calls it.
    """
    for line in _lines(proc / "self" / "cgroup"):
        _, controllers, path = line.split(":", 2)
        if controllers and "memory" not in controllers.split(","):
            continue
        root = groups / "memory" if controllers else groups
        own = Path(path.lstrip("/"))
        yield from (root / part for part in (own, *own.parents))


def _of_group(folder: Path) -> int | None:
    """Limit minus use of a group, of either version; inactive cached files do not count."""
    for limit, usage, cached in (
        ("memory.max", "memory.current", "inactive_file"),
        ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"),
    ):
        most, used = _number(folder / limit), _number(folder / usage)
        if most is not None and used is not None:
            return most - used + _numbers(folder / "memory.stat").get(cached, 0)
    return None


def _number(path: Path) -> int | None:
    """Reads the number in a file; None: no file, or no limit ("max")."""
    word = next(iter(_lines(path)), "")
    return int(word) if word.isdecimal() else None


def _numbers(path: Path) -> dict[str, int]:
    """Reads lines of a name and a number."""
    words = (line.split() for line in _lines(path))
    return {w[0]: int(w[1]) for w in words if len(w) > 1 and w[1].isdecimal()}


def _lines(path: Path) -> list[str]:
    try:
        return path.read_text().splitlines()
    except OSError:
        return []
