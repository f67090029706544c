"""The integrator stays small: its subjects are parts, as docs/design.md says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

TRANSPORT = Path(__file__).resolve().parents[2] / "core" / "transport"
WALK = (TRANSPORT / "walk" / "walk.h").read_text()
FIELD = re.compile(r" {4}([\w:]+[*&]?) (\w+)(?: = [^;()]+|\{[^;]*\})?;")


def assert_small(text: str, record: str) -> None:
    """Checks the number of fields of a struct, and of booleans among them."""
    body = re.search(rf"\nstruct {record} {{\n(.*?)\n}};", text, re.DOTALL)
    assert body is not None, record
    found = [match[1] for line in body[1].splitlines() if (match := FIELD.match(line))]
    assert 0 < len(found) <= 14, found
    assert found.count("bool") <= 4, found


@pytest.mark.parametrize("record", ["WalkState", "LastVertex", "MediaState"])
def test_the_state_of_a_path_is_small(record):
    assert_small(WALK, record)


def test_the_integrator_is_one_short_file():
    assert len((TRANSPORT / "path.cpp").read_text().splitlines()) <= 350


@pytest.mark.parametrize(
    "fault",
    ["    bool bent = false;   // a fifth\n", "".join(f"    float a{i} = 0;\n" for i in range(4))],
)
def test_a_planted_fault_is_caught(fault):
    head = "\nstruct WalkState {\n"
    with pytest.raises(AssertionError):
        assert_small(WALK.replace(head, head + fault), "WalkState")
