"""Values over time as keys: as many as their bound asks for, jumps as jumps, and never too many."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest

import daguerre as dg
from daguerre.motion.resample import BOUND, resample, resample_shown, resample_transform
from daguerre.motion.values import Composite
from daguerre.scene.motion import Vertices
from daguerre.setup.vertices import resample_vertices

BOX = np.array([[x, y, z] for x in (-1.0, 1) for y in (-1, 1) for z in (-1, 1)])


class Over:
    """A function of time."""

    def __init__(self, value, breaks=()):
        self._value, self._breaks = value, breaks

    def at(self, time_s):
        return self._value(time_s)

    def breaks(self, begin, end):
        return [t for t in self._breaks if begin < t < end]


def turned(degrees: float) -> np.ndarray:
    """About z."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


# Numbers ---------------------------------------------------------------------------------------


def test_lines_need_no_more_keys_than_they_have():
    times, values = resample(dg.keys([(0, 1), (1, 3), (4, 0)]), 0.5, 2)
    assert times == [0.5, 1, 2]
    assert values == [2, 3, 2]


def test_what_the_interval_does_not_touch_is_still():
    assert resample(dg.keys([(0, 1), (1, 3)]), 1, 2) == ([1], [3])
    assert resample(dg.keys([(0, 1), (1, 3)]), 0.5, 0.5) == ([0.5], [2])


def test_steps_are_jumps():
    times, values = resample(dg.keys([(0, 1), (1, 3), (2, 5)], "step"), 0.5, 3)
    assert times == [0.5, 1, 1, 2, 2, 3]
    assert values == [1, 1, 3, 3, 5, 5]


def test_names_step_too():
    times, values = resample(dg.keys([(0, "a"), (1, "b")]), 0, 2)
    assert (times, values) == ([0, 1, 1, 2], ["a", "a", "b", "b"])


def test_curves_keep_the_bound():
    curve = Over(lambda t: (math.sin(9 * t), 0.0))
    times, values = resample(curve, 0, 1)
    assert 225 <= len(times) < 400  # the chord of h rad is off by h^2 / 8; it changes by 2
    at = np.linspace(0, 1, 1999)
    assert np.abs(np.interp(at, times, [v[0] for v in values]) - np.sin(9 * at)).max() < 2 * BOUND


def test_what_repeats_is_seen():
    times, _ = resample(Over(lambda t: math.cos(8 * math.pi * t)), 0, 1)  # 1 at each quarter
    assert len(times) > 100


def test_a_fade_to_nothing_ends():
    times, _ = resample(Over(lambda t: (1 - t) ** 3), 0, 1)
    assert len(times) < 200


def test_a_place_far_away_is_kept_as_well_as_one_nearby():
    def swings(t):
        return (1e4 + math.sin(3 * t), 5.0, 0.0)

    times, values = resample(Over(swings), 0, 1)
    at = np.linspace(0, 1, 999)
    gaps = np.interp(at, times, [v[0] for v in values]) - 1e4 - np.sin(3 * at)
    assert np.abs(gaps).max() < 1.1 * BOUND


def test_parts_of_a_material_and_an_infinite_range():
    light = dg.PointLight(intensity=dg.keys([(0, (1, 0, 0)), (1, (0, 1, 0))]))
    times, values = resample(Composite((light, np.eye(4))), 0, 1)
    assert times == [0, 1]
    assert values[1][0] == dg.PointLight((0, 1, 0))


def test_a_million_keys_become_some():
    saw = np.arange(1_000_000)
    many = dg.Keys(saw * 1e-6, tuple((saw % 7).tolist()), "linear")
    started = time.process_time()
    times, _ = resample(many, 0, 1)
    assert len(times) <= 4097
    assert time.process_time() - started < 5


# Transforms ------------------------------------------------------------------------------------


def worst(motion, dynamic, open_s, close_s) -> float:
    points = np.c_[BOX, np.ones(8)].T
    gaps = [
        np.linalg.norm(((motion.at(t) - dynamic.at(t)) @ points)[:3], axis=0).max()
        for t in np.linspace(open_s, close_s, 301)
    ]
    return max(gaps)


@pytest.mark.parametrize(
    "make",
    [
        lambda: dg.keys([(0, turned(0)), (0.4, turned(120)), (1, turned(-10))]),
        lambda: dg.spin((1, 2, 3), 2.5),
        lambda: Over(lambda t: turned(90 * t * t) + 5 * math.sin(t) * np.eye(4, 4, 3)),
    ],
    ids=["keys", "spin", "curve"],
)
def test_transforms_keep_the_bound(make):
    dynamic = make()
    motion = resample_transform(dynamic, 0.1, 0.9, BOX)
    assert motion.moves
    assert worst(motion, dynamic, 0.1, 0.9) < 1.2 * BOUND * math.sqrt(3)


def test_a_transform_that_jumps():
    jump = dg.keys([(0, np.eye(4)), (1, turned(90))], "linear")
    motion = resample_transform(Over(lambda t: jump.at(0 if t < 0.5 else 1), [0.5]), 0, 1, BOX)
    assert motion.at(0.4999) == pytest.approx(np.eye(4))
    assert motion.at(0.5001) == pytest.approx(turned(90))


def test_a_transform_that_stands():
    assert not resample_transform(dg.keys([(0, np.eye(4)), (1, turned(9))]), 1, 2, BOX).moves


def test_a_small_thing_on_a_long_way_has_a_bound_of_its_way():
    def orbit(t):
        place = np.eye(4)
        place[:2, 3] = 100 * math.cos(t), 100 * math.sin(t)
        return place

    keys = []
    motion = resample_transform(Over(lambda t: keys.append(t) or orbit(t)), 0, 0.5, 1e-3 * BOX)
    assert len(keys) < 1000
    for t in np.linspace(0, 0.5, 99):
        assert np.abs(motion.at(t) - orbit(t)).max() < 2e-5 * 50


# Presence and vertices -------------------------------------------------------------------------


def test_presence():
    there = dg.keys([(0, True), (1, False), (2, True), (3, True), (4, False)])
    assert resample_shown(there, 0.5, 5) == [(0.5, 1), (2, 4)]
    assert resample_shown(there, 2.5, 2.5) == [(2.5, 2.5)]
    assert resample_shown(there, 1.5, 1.5) == []


CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)


def steps(value, open_s=0.0, close_s=1.0, breaks=()):
    moving = Over(lambda t: Vertices(np.float32(value(t))), breaks)
    found, keeps = resample_vertices(moving, open_s, close_s)
    return len(found), keeps


def test_as_many_steps_as_it_takes():
    assert steps(lambda t: CORNERS) == (1, True)
    assert steps(lambda t: CORNERS + t) == (2, True)
    assert steps(lambda t: CORNERS + t, 0.5, 0.5) == (1, True)
    counts = [steps(lambda t, a=a: CORNERS @ turned(a * t)[:3, :3])[0] for a in (1, 10, 80)]
    assert counts == [2, 9, 65]


def test_vertices_keep_the_bound():
    def at(t):
        return np.float32(CORNERS @ turned(60 * t * t)[:3, :3])

    found, keeps = resample_vertices(Over(lambda t: Vertices(at(t))), 0, 1)
    assert keeps
    n = len(found) - 1
    for t in np.linspace(0, 1, 401):
        i = min(int(t * n), n - 1)
        between = (i + 1 - t * n) * found[i].positions + (t * n - i) * found[i + 1].positions
        assert np.linalg.norm(between - at(t), axis=1).max() < 1.3e-4 * math.sqrt(0.5)


def test_a_kink_between_steps_is_seen_and_a_jump_is_told():
    kink = dg.keys([(0, CORNERS), (0.5003, CORNERS + 1), (1, CORNERS)])
    assert steps(kink.at, breaks=[0.5003])[0] == 129
    jump = dg.keys([(0, CORNERS), (0.3, CORNERS + 1)], "step")
    assert steps(jump.at, breaks=[0.3]) == (129, False)
