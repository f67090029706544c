"""YAML of calibrations: values, places of faults, and files that would take long."""

from __future__ import annotations

import time
from typing import Any

import pytest

from daguerre.errors import InputError
from daguerre.files.yaml_text import parse

VALUES = {
    "5": 5,
    "# nothing": None,
    "a: 08": {"a": 8},
    "a: [1, 1e-08, .5, 2., -3]": {"a": [1, 1e-8, 0.5, 2.0, -3]},
    "a: {b: ~, c: no, d: 'true', e: true, f: \"1\"}": {
        "a": {"b": None, "c": "no", "d": "true", "e": True, "f": "1"}
    },
    "a:\nb: -.inf\n": {"a": None, "b": float("-inf")},
    "- |\n  x\n  y\n- >\n  x\n  y\n": ["x\ny\n", "x y\n"],
    "%YAML:1.0\n---\nm: !!opencv-matrix\n  rows: 1\n": {"m": {"rows": 1}},
    "x: 1\n---\n": {"x": 1},
}


@pytest.mark.parametrize("text", VALUES)
def test_values(text: str) -> None:
    found = parse(text.encode(), "f").value
    assert repr(found) == repr(VALUES[text])


FAULTS = {
    "a: &x 1\nb: *x": "line 1, column 4: anchors and aliases are not supported, got anchor 'x'",
    "b: *x": "line 1, column 4: anchors and aliases are not supported, got alias 'x'",
    "&x a: 1": "line 1, column 1: anchors",
    "a: !!python/object:os.system x": "line 1, column 4: the only supported tag is !!opencv-matrix",
    "a: !!opencv-matrix [1]": "!!opencv-matrix: wanted rows, cols, dt and data",
    "a: 1\na: 2": "line 2, column 1: 'a' appears twice",
    "? [1, 2]\n: 3": "line 1, column 3: names must be text",
    "a: 1\n---\nb: 2": "line 2, column 1: wanted one document: another document begins here",
    "a: [1, 2": "line 2, column 1: did not find expected",
    "a: " + "9" * 5000: "a whole number has too many digits",
    "[" * 5000: "nested too deeply",
    "- " * 5000: "nested too deeply",
}


@pytest.mark.parametrize("text", FAULTS, ids=lambda text: str(text)[:12])
def test_faults_have_a_place(text: str) -> None:
    with pytest.raises(InputError, match="f: YAML: ") as caught:
        parse(text.encode(), "f")
    assert FAULTS[text] in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        "a:\n" + "".join(f"  k{i}: [1.0, 2.5e-3, {i}]\n" for i in range(30000)),
        "- a: b\n" * 100_000,
        "a\n" * 500_000,
        "[" + "a: b,\n" * 150_000,
    ],
    ids=["rows", "names", "folded", "flow"],
)
def test_a_megabyte_takes_no_time(text: str) -> None:
    """PyYAML's own parser takes half a minute of CPU time; this bound is far from both."""
    began = time.process_time()
    result: Any = None
    try:
        result = parse(text.encode(), "f").value
    except InputError as error:
        result = error
    assert result
    assert time.process_time() - began < 5
