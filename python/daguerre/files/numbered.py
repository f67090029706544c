"""File names with a placeholder for the frame number: ``shot.####.exr``."""

from __future__ import annotations

import re
from collections.abc import Iterable

#: Placeholder of the number: the last run of #.
PLACE = re.compile(r"#+(?=[^#]*$)")


def has_place(name: str) -> bool:
    """Whether a name has a placeholder for the frame number."""
    return PLACE.search(name) is not None


def with_number(name: str, frame: int) -> str:
    """Replaces # by the frame number, with at least as many digits."""
    return PLACE.sub(lambda place: f"{frame:0{len(place[0])}d}", name, count=1)


def numbers_in(names: Iterable[str], pattern: str) -> dict[int, str]:
    """Names that match a pattern with some number, by that number, rising."""
    head, tail = (re.escape(part) for part in PLACE.split(pattern, maxsplit=1))
    named = re.compile(rf"{head}(-?\d{{1,12}}){tail}")
    matches = [(name, match) for name in names if (match := named.fullmatch(name))]
    found = {int(m[1]): name for name, m in matches if with_number(pattern, int(m[1])) == name}
    return dict(sorted(found.items()))
