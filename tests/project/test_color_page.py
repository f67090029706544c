"""The table of colour spaces in the docs is that of the code."""

from __future__ import annotations

from pathlib import Path

from daguerre.color.encodings import encoding_of_space, title_of
from daguerre.color.spaces import COLOR_SPACES, LINEAR, ColorSpace

PAGE = Path(__file__).resolve().parents[2] / "docs" / "colour.md"


def row(space: ColorSpace) -> str:
    """Row of a space, as the page has it."""
    corners = "unknown"
    if space.primaries:
        name, white = title_of(encoding_of_space(space.name)).split(", white ")
        white = white if white != "ACES" else "ACES white"
        corners = f"{name}, {'white of a scene: ' * (space.neutral is not None)}{white}"
    kind = "light" if space.is_linear else "for a display"
    takers = "render, develop" if space.name in LINEAR else "develop"
    cells = (f"`{space.name}`", space.title, kind, corners, space.interop or "unknown", takers)
    return f"| {' | '.join(cells)} |"


def test_the_table_of_the_page_is_that_of_the_code() -> None:
    lines = PAGE.read_text().splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("|---"))
    rows = [line for line in lines[first + 1 :] if line.startswith("|")]
    assert rows == [row(space) for space in COLOR_SPACES.values()]
