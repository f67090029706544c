"""Reads each stage of these tests with and without the wall, and compares."""

from __future__ import annotations

import re
from typing import Any

import pytest

pytest.importorskip("pxr")

from daguerre.errors import DaguerreError
from daguerre.importers.usd import wall

from .walls import differences, differences_within

#: Intervals that each stage is read for alone, s from the scene's time.
_INTERVALS = ((0.0, 0.0), (-0.02, 0.3))


@pytest.fixture(autouse=True)
def both_sides(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every stage that ``dg.load`` reads is the same to the bit on both sides of the wall.

    So it is within an interval for which alone it is read.

    Tests that change the reader, or measure time, have the mark ``in_process``; those of damaged
    bytes, of which USD may read what was never written, ``behind_wall``.
    """
    of_wall = request.node.path.name == "test_wall.py"  # its stages would end this process
    if of_wall or request.node.get_closest_marker("behind_wall"):
        return
    behind, here = wall.read, request.node.get_closest_marker("in_process") is not None

    def read(path: Any, **options: Any) -> Any:
        plain = _tried(behind, path, options | {"in_process": True})
        found = plain if here else _tried(behind, path, options)
        if isinstance(plain, DaguerreError) or isinstance(found, DaguerreError):
            assert (type(found), _words(found)) == (type(plain), _words(plain))
            raise found
        assert here or differences(plain, found) == []
        if not here and "moments" not in options:
            _compare_within(path, options, plain)
        return found

    def _compare_within(path: Any, options: dict[str, Any], plain: Any) -> None:
        for begin, end in _INTERVALS:
            moments = plain.time + begin, plain.time + end
            part = behind(path, **options | {"in_process": True, "moments": moments})
            assert differences_within(plain, part, *moments) == []

    monkeypatch.setattr(wall, "read", read)


def _tried(read: Any, path: Any, options: dict[str, Any]) -> Any:
    try:
        return read(path, **options)
    except DaguerreError as error:
        return error


def _words(error: Any) -> str:
    """Text of an error, without the random names of temporary files."""
    return re.sub(r"daguerre-\w+", "", str(error))
