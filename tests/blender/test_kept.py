"""Patterns that are kept: computed once for the same numbers, and anew for all others."""

from __future__ import annotations

import numpy as np
import pytest

from daguerre.blender.patterns.kept import Kept

SIZE = 1 << 14


class Counted:
    """Doubles an array, and counts how often."""

    def __init__(self) -> None:
        self.calls = 0

    def __call__(self, *values):
        self.calls += 1
        return [values[0] * 2]


@pytest.fixture
def doubled():
    return Counted()


def numbers(seed, shape=(SIZE,)):
    return np.random.default_rng(seed).random(shape, np.float32)


def test_the_same_numbers_are_computed_once(doubled):
    apply = Kept().kept(doubled, "doubled")
    first = apply(numbers(1), 2.0)
    np.testing.assert_array_equal(apply(numbers(1), 2.0)[0], first[0])
    assert doubled.calls == 1


@pytest.mark.parametrize(
    "others", [(numbers(2), 2.0), (numbers(1), 3.0), (numbers(1, (SIZE // 64, 64)), 2.0)]
)
def test_other_numbers_and_shapes_are_computed(doubled, others):
    apply = Kept().kept(doubled, "doubled")
    apply(numbers(1), 2.0)
    np.testing.assert_array_equal(apply(*others)[0], others[0] * 2)
    assert doubled.calls == 2


def test_another_function_has_other_results(doubled):
    kept = Kept()
    kept.kept(doubled, "doubled")(numbers(1))
    halved = kept.kept(lambda x: [x / 2], "halved")
    np.testing.assert_array_equal(halved(numbers(1))[0], numbers(1) / 2)


def test_who_changes_a_result_changes_no_other(doubled):
    apply = Kept().kept(doubled, "doubled")
    apply(numbers(1))[0][:] = 0
    np.testing.assert_array_equal(apply(numbers(1))[0], numbers(1) * 2)


def test_the_results_that_nobody_asked_for_longest_go_first(doubled):
    apply = Kept(2 * 4 * SIZE).kept(doubled, "doubled")
    for seed in (1, 2, 1, 3):  # 2 goes
        apply(numbers(seed))
    assert doubled.calls == 3
    apply(numbers(1))
    assert doubled.calls == 3
    apply(numbers(2))
    assert doubled.calls == 4
