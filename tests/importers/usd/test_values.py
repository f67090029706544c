"""Attributes over time against USD's own value at any time code."""

from __future__ import annotations

import itertools
import pickle
from typing import Any

import numpy as np
import pytest
from pxr import Gf, Sdf, Ts, Usd, Vt

from daguerre.errors import InputError
from daguerre.importers.usd.values import Clock, authored, plain
from daguerre.motion.values import at as value_at
from daguerre.motion.values import is_dynamic
from daguerre.scene.over_time.quaternions import (
    QuaternionKeys,
    moving_turns,
    of_vectors,
    product,
    slerp,
)

_RATE = 24.0
_CODES = (-3.0, 0.0, 0.5, 2.0, 4.99, 5.0, 7.3, 10.0, 11.0, 12.0, 40.0)
_FLAGS = itertools.cycle((True, False, False))
_TYPES: dict[str, Any] = {
    "float": lambda r: float(r.normal()),
    "double": lambda r: float(r.normal()),
    "half": lambda r: float(r.integers(0, 100)),
    "int": lambda r: int(r.integers(0, 100)),
    "bool": lambda r: bool(next(_FLAGS)),
    "token": lambda r: str(r.choice(["red", "green", "blue"])),
    "string": lambda r: str(r.choice(["red", "green", "blue"])),
    "float3": lambda r: Gf.Vec3f(*r.normal(size=3)),
    "double2": lambda r: Gf.Vec2d(*r.normal(size=2)),
    "int2": lambda r: Gf.Vec2i(*map(int, r.integers(0, 9, 2))),
    "color3f": lambda r: Gf.Vec3f(*r.normal(size=3)),
    "float[]": lambda r: Vt.FloatArray(r.normal(size=4).tolist()),
    "int[]": lambda r: Vt.IntArray(r.integers(0, 9, 4).tolist()),
    "point3f[]": lambda r: Vt.Vec3fArray.FromNumpy(r.normal(size=(5, 3)).astype(np.float32)),
    "matrix4d": lambda r: Gf.Matrix4d(
        np.c_[r.normal(size=(4, 3)), (0, 0, 0, 1)].tolist()  # affine
    ),
}


def _stage() -> Usd.Stage:
    stage = Usd.Stage.CreateInMemory()
    stage.DefinePrim("/x")
    return stage


def _attribute(stage: Usd.Stage, kind: str) -> Usd.Attribute:
    return stage.GetPrimAtPath("/x").CreateAttribute("a", Sdf.ValueTypeNames.Find(kind))


def _clock(time: float = 0.0, *, holds: bool = False) -> Clock:
    return Clock("f.usda", _RATE, time, holds)


def _convert(value: Any) -> Any:
    made = plain(value)
    return np.asarray(made) if type(made).__module__ == "pxr.Vt" else made


def _same(ours: Any, theirs: Any, close: float = 1e-5) -> bool:
    if isinstance(theirs, str | bool):
        return bool(ours == theirs)
    return np.allclose(ours, _convert(theirs), atol=close)


@pytest.mark.parametrize("held", [False, True])
@pytest.mark.parametrize("kind", _TYPES)
def test_samples_are_interpolated_or_held_as_usd_does(kind: str, held: bool) -> None:
    if kind == "matrix4d" and held:
        pytest.skip("affine ones only, below")
    rng = np.random.default_rng(4)
    stage = _stage()
    attribute = _attribute(stage, kind)
    for code in (0, 5, 10, 12):
        attribute.Set(_TYPES[kind](rng), code)
    if held:
        stage.SetInterpolationType(Usd.InterpolationTypeHeld)
    value = _clock(holds=held).value(attribute, _convert)
    assert is_dynamic(value)
    for code in _CODES:
        close = 0.1 if kind == "half" else 1e-5  # USD rounds what lies between
        assert _same(value_at(value, code / _RATE), attribute.Get(code), close), code
    assert pickle.loads(pickle.dumps(value)) == value


def test_a_held_matrix_jumps() -> None:
    stage = _stage()
    attribute = _attribute(stage, "matrix4d")
    for code, x in ((0, 1), (5, 3), (10, 4)):
        attribute.Set(Gf.Matrix4d(1).SetTranslate(Gf.Vec3d(x, 0, 0)), code)
    stage.SetInterpolationType(Usd.InterpolationTypeHeld)
    value = _clock(holds=True).value(attribute)
    for code in _CODES:
        assert _same(value_at(value, code / _RATE), attribute.Get(code)), code


@pytest.mark.parametrize("kind", ["float", "token", "float3"])
def test_where_a_sample_is_blocked_the_one_before_goes_on(kind: str) -> None:
    rng = np.random.default_rng(1)
    attribute = _attribute(stage := _stage(), kind)
    assert stage
    for code in (0, 5, 10, 12, 20):
        blocked = code in (5, 20)
        attribute.Set(Sdf.ValueBlock() if blocked else _TYPES[kind](rng), code)
    value = _clock().value(attribute)
    last = None
    for code in _CODES:
        theirs = attribute.Get(code)
        last = last if theirs is None else theirs
        wanted = attribute.Get(0) if 5 <= code < 10 else last if code < 20 else attribute.Get(12)
        assert _same(value_at(value, code / _RATE), wanted), code


def test_one_sample_and_equal_samples_do_not_move() -> None:
    attribute = _attribute(stage := _stage(), "float")
    assert stage
    attribute.Set(3.5, 7)
    assert _clock().value(attribute) == 3.5
    assert _clock().codes(attribute) == []
    assert _clock().codes(attribute, single=True) == [7.0]
    attribute.Set(3.5, 9)
    assert _clock().value(attribute) == 3.5


def test_there_is_no_value_where_none_is_stated() -> None:
    attribute = _attribute(stage := _stage(), "float")
    assert _clock().value(attribute) is None
    assert _clock().value(stage.GetPrimAtPath("/x").GetAttribute("none")) is None
    assert not authored(attribute)
    attribute.Set(1.0)
    assert authored(attribute)
    assert _clock().value(attribute) == 1.0


def test_splines_are_followed() -> None:
    stage = _stage()
    attribute = _attribute(stage, "double")
    spline = Ts.Spline("double")
    kinds = (Ts.InterpHeld, Ts.InterpLinear, Ts.InterpCurve, Ts.InterpCurve)
    for time, value, kind in zip((0, 5, 10, 30), (1.0, 2.0, 4.0, -3.0), kinds, strict=True):
        spline.SetKnot(
            Ts.Knot(
                *("double",),
                **{"time": time, "value": value, "nextInterp": kind},
                **{"preTanWidth": 4.0, "postTanWidth": 6.0, "postTanSlope": 0.5},
            )
        )
    spline.SetPostExtrapolation(Ts.Extrapolation(Ts.ExtrapLinear))
    attribute.SetSpline(spline)
    stage.SetStartTimeCode(-5)
    stage.SetEndTimeCode(40)
    value = _clock().value(attribute)
    for code in np.linspace(-8, 40, 97):
        if not 4.999 < code < 5:
            assert value_at(value, code / _RATE) == pytest.approx(attribute.Get(code), abs=5e-3)
    assert value_at(value, 4.99 / _RATE) == pytest.approx(1.0)  # held until the jump


@pytest.mark.parametrize("code", [-1e300, 1e300])
def test_times_out_of_all_bounds_are_refused(code: float) -> None:
    attribute = _attribute(stage := _stage(), "float")
    assert stage
    attribute.Set(1.0, 0)
    attribute.Set(2.0, code)
    with pytest.raises(InputError, match=r"f\.usda: /x\.a: time samples: wanted finite times"):
        _clock().value(attribute)


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_numbers_that_are_not_finite_are_refused_with_their_place(value: float) -> None:
    attribute = _attribute(stage := _stage(), "float")
    assert stage
    attribute.Set(1.0, 0)
    attribute.Set(value, 1)
    with pytest.raises(InputError, match=r"^f\.usda: /x\.a: keys\[1\]: wanted a number"):
        _clock().value(attribute)


def test_arrays_that_change_their_length_are_refused_with_their_place() -> None:
    attribute = _attribute(stage := _stage(), "float[]")
    assert stage
    attribute.Set([1.0, 2.0], 0)
    attribute.Set([1.0, 2.0, 3.0], 1)
    with pytest.raises(InputError, match=r"^f\.usda: /x\.a: keys\[1\]: wanted shape"):
        _clock().value(attribute, np.asarray)


def test_samples_too_many_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("daguerre.importers.usd.values._MAX_SAMPLES", 3)
    attribute = _attribute(stage := _stage(), "float")
    assert stage
    for code in range(4):
        attribute.Set(float(code), code)
    with pytest.raises(InputError, match="wanted at most 3, got 4"):
        _clock().value(attribute)


# Quaternions ------------------------------------------------------------------------------------


def _xyzw(q: Any) -> tuple[float, ...]:
    return (*q.GetImaginary(), q.GetReal())


@pytest.mark.parametrize("kind", ["quatf", "quatd"])
def test_quaternions_turn_along_the_shorter_arc(kind: str) -> None:
    make = {"quatf": Gf.Quatf, "quatd": Gf.Quatd}[kind]
    rng = np.random.default_rng(8)
    attribute = _attribute(stage := _stage(), kind)
    assert stage
    for code in range(0, 40, 5):
        attribute.Set(make(*rng.normal(size=4)).GetNormalized(), code)
    value = moving_turns(_clock().value(attribute))
    assert isinstance(value, QuaternionKeys)
    for code in np.linspace(-2, 40, 43):
        ours, theirs = value.at(code / _RATE), np.array(_xyzw(attribute.Get(code)))
        assert min(np.abs(ours - theirs).max(), np.abs(ours + theirs).max()) < 2e-6, code
    assert value.breaks(0, 1) == pytest.approx([5 / 24, 10 / 24, 15 / 24, 20 / 24])
    assert moving_turns(_clock(holds=True).value(attribute)).at(7 / _RATE) == _xyzw(
        attribute.Get(5)
    )


def test_products_and_turns_of_quaternions_are_those_of_usd() -> None:
    rng = np.random.default_rng(2)
    a, b = (Gf.Quatd(*rng.normal(size=4)).GetNormalized() for _ in range(2))
    assert np.allclose(product(np.array(_xyzw(a)), np.array(_xyzw(b))), _xyzw(a * b))
    wanted = Gf.Slerp(0.3, a, b)
    ours = slerp(np.array(_xyzw(a)), np.array(_xyzw(b)), 0.3)
    assert np.allclose(ours, _xyzw(wanted)) or np.allclose(-ours, _xyzw(wanted))
    axis = Gf.Vec3d(1, 2, 2)
    turn = Gf.Rotation(axis, 75).GetQuat()
    assert np.allclose(of_vectors(np.radians(75) * np.array(axis) / 3), _xyzw(turn))
    assert np.allclose(of_vectors(np.zeros(3)), (0, 0, 0, 1))
