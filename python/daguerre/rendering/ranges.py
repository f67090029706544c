"""Ranges of sample indices, [begin, end): joined, compared and shown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

Range = tuple[int, int]


def join_ranges(ranges: Iterable[Range]) -> list[Range]:
    """Sorts ranges [begin, end) and joins adjacent ranges."""
    joined: list[Range] = []
    for begin, end in sorted(ranges):
        if joined and begin <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(end, joined[-1][1]))
        elif end > begin:
            joined.append((begin, end))
    return joined


def missing_ranges(ranges: Sequence[Range], wanted: Range | None = None) -> list[Range]:
    """Gaps of ``ranges`` within ``wanted``, by default from 0 to the last sample drawn."""
    begin, end = wanted or (0, max((e for _, e in ranges), default=0))
    gaps: list[Range] = []
    for a, b in join_ranges(ranges):
        if a > begin:
            gaps.append((begin, min(a, end)))
        begin = max(begin, b)
        if begin >= end:
            break
    if begin < end:
        gaps.append((begin, end))
    return [(a, b) for a, b in gaps if b > a]


def show_ranges(ranges: Iterable[Range]) -> str:
    """Formats ranges, such as ``0:32, 64:96``."""
    return ", ".join(f"{a}:{b}" for a, b in ranges) or "none"
