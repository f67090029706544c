"""Values over time: keys of numbers, tuples, arrays and matrices, spins, and bad ones; by hand."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import InputError
from daguerre.motion.values import Composite, at, moves
from daguerre.scene.materials import Gltf, TextureSlot


def turned(degrees: float, x: float = 0.0) -> np.ndarray:
    """About z, then moved along x."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, -s, 0, x], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


@pytest.mark.parametrize(
    ("mode", "when", "wanted"),
    [
        (None, -1, 10),
        (None, 1, 10),
        (None, 1.5, 12.5),
        ("linear", 3, 20),
        ("linear", 4, 35),
        ("linear", 9, 50),
        ("step", 2.999, 10),
        ("step", 3, 20),
        ("step", 5, 50),
    ],
)
def test_numbers(mode, when, wanted):
    value = dg.keys([(1, 10), (3, 20), (5, 50)], mode).at(when)
    assert isinstance(value, int if mode == "step" else float)
    assert value == wanted


def test_tuples_arrays_names_and_flags():
    pair = dg.keys([(0, (0, 1)), (1, (4, 3))]).at(0.25)
    assert pair == (1, 1.5)
    points = dg.keys([(0, np.zeros((2, 3), np.float32)), (1, np.ones((2, 3), np.float32))]).at(0.5)
    assert points.dtype == np.float32
    assert points.tolist() == [[0.5] * 3] * 2
    assert dg.keys([(0, True), (1, False)]).at(0.999) is True
    assert dg.keys([(0, "thin"), (1, "pinhole")]).at(1) == "pinhole"


def test_matrices_are_interpolated_by_the_core():
    pair = [(2.0, turned(0)), (4.0, turned(90, 6))]
    assert dg.keys(pair).at(3.0) == pytest.approx(turned(45, 3))
    assert dg.keys(pair, "linear").at(3.0) == pytest.approx((turned(0) + turned(90, 6)) / 2)
    assert dg.keys(pair).at(1.0) == pytest.approx(turned(0))
    assert dg.keys(pair).at(5.0) == pytest.approx(turned(90, 6))
    assert dg.keys(pair[:1]).at(7.0) == pytest.approx(turned(0))


def test_a_pivot_goes_straight():
    """A turn about (1, 0, 0): that point stays, the origin goes round it."""
    key = turned(90)
    key[:3, 3] = (1, -1, 0)  # (1, 0, 0) -> (0, 1, 0) -> (1, 0, 0)
    middle = dg.keys([(0, np.eye(4)), (1, key)], pivot=(1, 0, 0)).at(0.5)
    assert middle @ (1, 0, 0, 1) == pytest.approx((1, 0, 0, 1))
    half = math.sqrt(0.5)
    assert middle @ (0, 0, 0, 1) == pytest.approx((1 - half, -half, 0, 1))


def test_a_spin_turns_more_than_once():
    wheel = dg.spin((0, 0, 2), 3, center=(1, 0, 0), time=0.5)
    assert wheel.at(0.5) == pytest.approx(np.eye(4))
    quarter = wheel.at(0.5 + 1 / 12)  # counter-clockwise as seen from +z
    assert quarter @ (2, 0, 0, 1) == pytest.approx((1, 1, 0, 1))
    assert wheel.at(0.5 + 1 / 12 + 5 / 3) == pytest.approx(quarter)
    rolling = dg.spin((0, 0, 1), 1, transform=dg.keys([(0, turned(0)), (1, turned(0, 4))]))
    assert rolling.at(0.5) == pytest.approx(turned(180, 2))
    assert list(rolling.breaks(-1, 0.5)) == [0]


def test_breaks_lie_inside():
    assert dg.keys([(t, t) for t in range(6)]).breaks(1, 4) == [2, 3]
    assert list(dg.spin((0, 1, 0), 1).breaks(0, 1)) == []


def test_at_goes_into_dataclasses_and_tuples_and_leaves_what_is_still():
    gold = dg.keys([(0, (1, 0, 0)), (1, (0, 1, 0))])
    slot = TextureSlot(3, transform=(1, 0, dg.keys([(0, 0), (2, 1)]), 0, 1, 0))
    material = dg.Material(Gltf(base_color=gold, base_color_texture=slot), name="gold")
    now = at(material, 0.5)
    assert now.kind.base_color == (0.5, 0.5, 0)
    assert now.kind.base_color_texture.transform == (1, 0, 0.25, 0, 1, 0)
    assert Composite(material).breaks(0, 9) == [1, 2]
    assert moves(material)
    assert not moves(now)
    assert at(now, 7.0) is now
    still = [1, (2, 3), "a"]
    assert at(still, 1.0) is still


def test_a_dynamic_value_may_be_of_any_class():
    @dataclass
    class Wave:
        size: float

        def at(self, time_s):
            return self.size * math.sin(time_s)

        def breaks(self, begin, end):
            return ()

    assert at(dg.PointLight(radius=Wave(2)), math.pi / 2).radius == 2


@pytest.mark.parametrize(
    ("pairs", "options", "message"),
    [
        ([(0, 1), (0, 2)], {}, r"keys\[1\]: time: times must increase, got 0 s then"),
        ([(1, 1), (0.5, 2)], {}, "times must increase, got 1 s then 0.5 s"),
        ([(math.nan, 1)], {}, r"keys\[0\]: time: wanted a number .*, got nan"),
        ([(0, math.inf)], {}, r"keys\[0\]: wanted a number, got inf"),
        ([(0, (0, math.nan))], {}, r"keys\[0\]: wanted finite numbers"),
        ([(0, 1), (1, (1, 2))], {}, r"keys\[1\]: wanted shape \(\) like keys\[0\], got \(2,\)"),
        ([(0, object())], {}, "wanted numbers, a name or a flag"),
        ([], {}, "keys: wanted 1 .. 1000000 keys, got 0"),
        (3, {}, "keys: wanted .*, got 3"),
        ([(0, 1, 2)], {}, r"keys\[0\]: wanted \(time in s, value\)"),
        ([(0, 1)], {"interpolation": "twist"}, "wanted linear, step for these values, got 'twist'"),
        ([(0, "a")], {"interpolation": "linear"}, "wanted step for these values"),
        ([(0, np.eye(4))], {"interpolation": "twisted"}, r"did you mean 'twist'"),
        ([(0, 1)], {"pivot": (0, 0, 0)}, "pivot: only keys of matrices"),
        ([(0, np.eye(4))], {"pivot": (0, 0)}, "pivot: wanted three finite numbers"),
        (
            [(0, np.eye(4)), (1, np.diag((2.0, 1, 1, 1)))],
            {"interpolation": "twist"},
            "rigid",
        ),
    ],
)
def test_bad_keys(pairs, options, message):
    with pytest.raises(InputError, match=message):
        dg.keys(pairs, **options)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (((0, 0, 0), 1), "spin: axis: wanted a length above 0"),
        (((0, 1), 1), "spin: axis: wanted three finite numbers"),
        (((0, 1, 0), math.nan), "spin: revolutions_per_second: wanted a number"),
        (((0, 1, 0), 1, (0, 0, math.inf)), "spin: center: wanted three finite numbers"),
        (((0, 1, 0), 1, (0, 0, 0), np.ones((3, 3))), r"spin: transform: wanted shape \(4, 4\)"),
    ],
)
def test_bad_spins(arguments, message):
    with pytest.raises(InputError, match=message):
        dg.spin(*arguments)


def test_a_spin_of_keys_that_are_no_matrices():
    with pytest.raises(InputError, match="keys must be matrices"):
        dg.spin((0, 1, 0), 1, transform=dg.keys([(0, 1)]))


def test_a_million_keys_and_not_one_more():
    started = time.process_time()
    many = dg.keys((i * 1e-3, i) for i in range(1_000_000))
    assert many.at(500.0005) == pytest.approx(500000.5)
    assert time.process_time() - started < 10
    with pytest.raises(InputError, match=r"wanted 1 \.\. 1000000 keys, got 1000001"):
        dg.keys([(i, 0) for i in range(1_000_001)])
