"""Sums on their way: nothing changes, damage is found, strangers are refused by name."""

from __future__ import annotations

import json
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import daguerre as dg
from daguerre.cluster.answers import Failed, Needs, Sums, answer_of, packed_sums
from daguerre.errors import InputError, MismatchError
from daguerre.rendering.columns import columns_of
from daguerre.rendering.session import Session
from tests.viewfinder.test_painter import scene

HOW = dg.RenderSettings.of(resolution=(24, 16), spp=8, aovs=True, cryptomatte=("object",))


def drawn(begin: int, end: int) -> Session:
    made = scene()
    session = Session(made, made.camera(), settings=HOW)
    session.draw(begin, end)
    return session


def test_they_arrive_as_they_were() -> None:
    session = drawn(0, 2)
    data = packed_sums("worker", session.key, session.state(), {"seconds": 0.5})
    found, parts = answer_of(data), columns_of(session.state())
    assert isinstance(found, Sums)
    assert (found.worker, found.key, found.facts) == ("worker", session.key, {"seconds": 0.5})
    assert found.parts.keys() == parts.keys()
    for name, one in parts.items():
        there = found.parts[name]
        assert there.shape == one.shape
        assert np.array_equal(there.kept, one.kept)
        assert np.array_equal(there.words, one.words)
    assert len(data) < sum(words.nbytes for words in session.state().values())


@pytest.mark.parametrize("answer", [Needs("a:1", ["x", "y"]), Failed("b:2", "no \n such \u2603")])
def test_so_do_wishes_and_failures(answer: Needs | Failed) -> None:
    assert answer_of(answer.to_bytes()) == answer


def test_damage_is_found() -> None:
    session = drawn(0, 1)
    data = bytes(packed_sums("worker", session.key, session.state(), {}))
    for wrong in (data[:-1], data[:-5] + b"x" + data[-4:], data[:-1] + b"x", b"", b"{}\n"):
        with pytest.raises(InputError, match="damaged answer"):
            answer_of(wrong)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("key", True), ("key", "x"), ("key", ["scene"]), ("facts", None), ("facts", [["rays", 1]]),
        ("facts", {"rays": "many"}), ("facts", {"seconds": -1}), ("facts", {"tasks": 1e300}),
        ("facts", {"piloted": 3}), ("facts", {"piloted": [1, "x"]}), ("facts", {"seconds": True}),
        ("parts", [["x" * 100, [1], 0, 0]]), ("parts", 7),
    ],
)  # fmt: skip
def test_heads_of_another_form_are_damage(name: str, value: object) -> None:
    session = drawn(0, 1)
    line, words = bytes(packed_sums("worker", session.key, session.state(), {})).split(b"\n", 1)
    data = json.dumps(json.loads(line) | {name: value}).encode() + b"\n" + words
    with pytest.raises(InputError, match="damaged answer"):
        answer_of(data)
    with pytest.raises(InputError, match="damaged answer"):
        answer_of(b'{"failed": ' + b"[" * 100_000 + b"\n")


def test_facts_that_are_missing_are_zero() -> None:
    sums = Sums("worker", {}, {}, {"seconds": 0.5, "piloted": [1, 2]})
    assert (sums.fact("seconds"), sums.fact("tasks"), sums.piloted) == (0.5, 0, (1, 2))
    assert Sums("worker", {}, {}, {"piloted": None}).piloted is None


@pytest.mark.parametrize("name", ["scene", "camera", "settings", "build"])
def test_strangers_are_refused(name: str) -> None:
    session = drawn(0, 1)
    sums = Sums("worker", session.key | {name: "another"}, columns_of(session.state()), {})
    with pytest.raises(MismatchError, match=f"{name}: wanted the same as the client's"):
        sums.check_key(session.key)
    if name == "build":
        sums.check_key(session.key, mixed=True)


@settings(deadline=None, max_examples=30)
@given(order=st.permutations(range(8)), cuts=st.sets(st.integers(1, 7)))
def test_any_order_and_split_gives_the_same_bits(order: list[int], cuts: set[int]) -> None:
    whole = drawn(0, 8).frame()
    ends = [0, *sorted(cuts), 8]
    parts = list(pairwise(ends))
    made = scene()
    merged = Session(made, made.camera(), settings=HOW)
    for part in sorted(parts, key=lambda part: order[part[0]]):
        merged.add(columns_of(drawn(*part).state()), [part])
    assert merged.ranges == [(0, 8)]
    assert np.array_equal(merged.frame().rgb, whole.rgb)
    with pytest.raises(MismatchError, match="drawn already"):
        merged.add(columns_of(merged.state()), parts[:1])
