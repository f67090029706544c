"""Comments and docstrings are in plain words: rates of hard words, room by room."""

from __future__ import annotations

import math
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
WORDS = runpy.run_path(str(ROOT / "script" / "plain_words.py"))
PATTERNS, comments, files, counts = (WORDS[k] for k in ("PATTERNS", "comments", "files", "counts"))
#: Files of each room; those at the root of the package are rooms, too.
ROOMS = {
    room.relative_to(ROOT).as_posix(): files(room) if room.is_dir() else [room]
    for folder in ("core", "python/daguerre")
    for room in (ROOT / folder).iterdir()
    if room.suffix in {"", ".h", ".cpp", ".py"}
}


def too_many(paths: list[Path]) -> dict[str, int]:
    """Counts above the limits; a word may stand once in any room."""
    words, found = counts(paths)
    most = {name: math.ceil(limit * words / 1000) for name, (_, limit) in PATTERNS.items()}
    return {name: count for name, count in found.items() if count > most[name]}


@pytest.mark.parametrize("room", sorted(name for name, paths in ROOMS.items() if paths))
def test_room_is_in_plain_words(room: str) -> None:
    assert not too_many(ROOMS[room])


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("// Finds what the ray hits.", "what"),
        ("/* The radius is that of\n the film. */", "that of"),
        ("/// A lamp whose bound is near.", "whose"),
        ("// The one that is nearest.", "one"),
    ],
)
def test_hard_word_is_counted(tmp_path: Path, text: str, name: str) -> None:
    path = tmp_path / "a.h"
    path.write_text(f"{text}\nint what = 1;\n")
    assert [key for key, count in counts([path])[1].items() if count] == [name]


def test_numerals_strings_and_code_are_not_counted(tmp_path: Path) -> None:
    path = tmp_path / "a.py"
    path.write_text('"""One of two; at least one. ``what``: `whose`."""\nTEXT = "what # whose"\n')
    assert not any(counts([path])[1].values())
    assert list(comments(path))
