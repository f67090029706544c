"""Values that nobody wants: of other kinds, of other shapes, without end, without content."""

from __future__ import annotations

import datetime
import decimal
import fractions
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

import daguerre as dg

from .world import World

Maker = Callable[[World], Any]


class Stranger:
    """An object of a class that nobody knows."""


def _huge(*shape: int) -> Any:
    """An array of many numbers that takes no memory."""
    return np.broadcast_to(np.float32(0.5), shape)


#: By the name that a case shows.
ANY: dict[str, Maker] = {
    "None": lambda w: None,
    "True": lambda w: True,
    "False": lambda w: False,
    "''": lambda w: "",
    "'abc'": lambda w: "abc",
    "'nan'": lambda w: "nan",
    "'1'": lambda w: "1",
    "'a\\0b'": lambda w: "a\0b",
    "'\\udcff'": lambda w: "\udcff",
    "'x' * 9999": lambda w: "x" * 9999,
    "b'xyz'": lambda w: b"xyz",
    "bytearray": lambda w: bytearray(b"\xff\xfe"),
    "0": lambda w: 0,
    "1": lambda w: 1,
    "-1": lambda w: -1,
    "2**31": lambda w: 2**31,
    "2**63": lambda w: 2**63,
    "-2**63-1": lambda w: -(2**63) - 1,
    "10**400": lambda w: 10**400,
    "-10**400": lambda w: -(10**400),
    "0.5": lambda w: 0.5,
    "-0.0": lambda w: -0.0,
    "nan": lambda w: float("nan"),
    "inf": lambda w: float("inf"),
    "-inf": lambda w: float("-inf"),
    "1e308": lambda w: 1e308,
    "5e-324": lambda w: 5e-324,
    "1j": lambda w: 1j,
    "np.float32(nan)": lambda w: np.float32("nan"),
    "np.float64(-3)": lambda w: np.float64(-3),
    "np.int8(-1)": lambda w: np.int8(-1),
    "np.uint64(2**64-1)": lambda w: np.uint64(2**64 - 1),
    "np.bool_(True)": lambda w: np.bool_(True),
    "np.str_('abc')": lambda w: np.str_("abc"),
    "np.datetime64": lambda w: np.datetime64("2026-01-01"),
    "Decimal('NaN')": lambda w: decimal.Decimal("NaN"),
    "Decimal('sNaN')": lambda w: decimal.Decimal("sNaN"),
    "Fraction(1, 3)": lambda w: fractions.Fraction(1, 3),
    "datetime": lambda w: datetime.datetime(2026, 1, 1),
    "()": lambda w: (),
    "[]": lambda w: [],
    "{}": lambda w: {},
    "[[]]": lambda w: [[]],
    "[1, [2, 3]]": lambda w: [1, [2, 3]],
    "[None]": lambda w: [None],
    "[None, None]": lambda w: [None, None],
    "['a', 'b']": lambda w: ["a", "b"],
    "('', '')": lambda w: ("", ""),
    "(0, 0)": lambda w: (0, 0),
    "(-1, 2)": lambda w: (-1, 2),
    "(nan, inf)": lambda w: (float("nan"), float("inf")),
    "(10**30, 10**30)": lambda w: (10**30, 10**30),
    "(1, 2, 3, 4, 5)": lambda w: (1, 2, 3, 4, 5),
    "{'a': 1}": lambda w: {"a": 1},
    "{1: None}": lambda w: {1: None},
    "{(): ()}": lambda w: {(): ()},
    "{'a': {'b': [1]}}": lambda w: {"a": {"b": [1]}},
    "{3}": lambda w: {3},
    "range(3)": lambda w: range(3),
    "generator": lambda w: (n for n in (1.0, 2.0)),
    "endless list": lambda w: _endless(),
    "lambda": lambda w: lambda *a, **k: None,
    "print": lambda w: print,
    "int": lambda w: int,
    "object()": lambda w: Stranger(),
    "Path('none/x')": lambda w: Path("none/x.exr"),
    "Path('.')": lambda w: Path(),
    "a folder": lambda w: w.out,
    "slice": lambda w: slice(None),
    "...": lambda w: ...,
    "Scene": lambda w: dg.Scene(),
    "Camera": lambda w: dg.Camera(),
    "Frame": lambda w: w.frame,
    "Lens": lambda w: w.lens,
    "Material": lambda w: dg.Material(),
    "Diffuse": lambda w: dg.Diffuse(),
    "PointLight": lambda w: dg.PointLight(),
    "Sensor": lambda w: w.sensor,
    "Projection": lambda w: w.projection,
    "Keys": lambda w: dg.keys([(0.0, 1.0), (1.0, 2.0)]),
    "Keys of matrices": lambda w: dg.keys([(0.0, np.eye(4)), (1.0, np.eye(4))]),
    "Spin": lambda w: dg.spin((0, 1, 0), 1.0),
    "dg.Camera": lambda w: dg.Camera,
    "array of zero": lambda w: np.zeros(0),
    "array (0, 3)": lambda w: np.zeros((0, 3)),
    "array (0, 0, 3)": lambda w: np.zeros((0, 0, 3), np.float32),
    "array ()": lambda w: np.array(2.0),
    "array of one": lambda w: np.array([0.25]),
    "array (2,)": lambda w: np.array([0.25, 0.5]),
    "array (4, 4) of 0": lambda w: np.zeros((4, 4)),
    "array (6, 8)": lambda w: np.ones((6, 8), np.float32),
    "array (6, 8, 3) nan": lambda w: np.full((6, 8, 3), np.nan, np.float32),
    "array (6, 8, 3) 1e38": lambda w: np.full((6, 8, 3), 1e38, np.float32),
    "array (6, 8, 3) -1": lambda w: np.full((6, 8, 3), -1, np.int64),
    "array (1, 1, 1)": lambda w: np.ones((1, 1, 1), np.float32),
    "array of 6 axes": lambda w: np.ones((1, 2, 1, 2, 1, 2)),
    "array of objects": lambda w: np.array([None, {}], object),
    "array of texts": lambda w: np.array(["a", "b"]),
    "array of flags": lambda w: np.array([True, False, True]),
    "array of complex": lambda w: np.array([1j, 2.0]),
    "array of times": lambda w: np.array(["2026-01-01"], "datetime64[D]"),
    "record array": lambda w: np.zeros(2, [("a", "f4"), ("b", "i4")]),
    "masked array": lambda w: np.ma.masked_all((2, 2)),
    "big-endian": lambda w: np.arange(4, dtype=">f8"),
    "uint64 max": lambda w: np.full((3, 3), 2**64 - 1, np.uint64),
    "huge (2**17, 2**17, 3)": lambda w: _huge(1 << 17, 1 << 17, 3),
    "huge (2**36, 3)": lambda w: _huge(1 << 36, 3),
    "huge (2**36,)": lambda w: _huge(1 << 36),
}


def _endless() -> list[Any]:
    """A list that holds itself."""
    value: list[Any] = []
    value.append(value)
    return value


def spoiled(good: Any, random: Random) -> tuple[str, Any]:
    """A good value with something wrong, and what is wrong."""
    ways = [way for kind, way in _WAYS if isinstance(good, kind)]
    if not ways:
        return "its class", type(good)
    name, change = random.choice([pair for way in ways for pair in way.items()])
    try:
        return f"good, {name}", change(good)
    except (TypeError, ValueError, OverflowError, IndexError, KeyError):
        return "its class", type(good)


def _filled(value: Any) -> Callable[[Any], Any]:
    def change(good: Any) -> Any:
        made = np.array(good)
        if made.dtype.kind == "f" and made.size:
            made.flat[made.size // 2] = value
        return made

    return change


def _readonly(good: Any) -> Any:
    made = np.array(good)
    made.flags.writeable = False
    return made


_ARRAY: dict[str, Callable[[Any], Any]] = {
    "one nan": _filled(np.nan),
    "one inf": _filled(np.inf),
    "one 1e30": _filled(1e30),
    "read-only": _readonly,
    "turned": lambda a: np.asarray(a).T,
    "in Fortran's order": lambda a: np.asfortranarray(a),
    "backward": lambda a: np.asarray(a)[::-1],
    "every second": lambda a: np.repeat(np.asarray(a), 2, axis=0)[::2],
    "one short": lambda a: np.asarray(a)[:-1],
    "nothing": lambda a: np.asarray(a)[:0],
    "flat": lambda a: np.asarray(a).ravel(),
    "an axis more": lambda a: np.asarray(a)[None],
    "a column short": lambda a: np.asarray(a)[..., :-1],
    "a column more": lambda a: np.repeat(np.asarray(a), 2, axis=-1),
    "as int8": lambda a: np.asarray(a).astype(np.int8),
    "as float16": lambda a: np.asarray(a).astype(np.float16),
    "as longdouble": lambda a: np.asarray(a).astype(np.longdouble),
    "as big-endian": lambda a: np.asarray(a).astype(">f4"),
    "as objects": lambda a: np.asarray(a).astype(object),
    "as texts": lambda a: np.asarray(a).astype(str),
    "as complex": lambda a: np.asarray(a).astype(complex),
    "as list": lambda a: np.asarray(a).tolist(),
    "times 1e300": lambda a: np.asarray(a, np.float64) * 1e300,
    "times 0": lambda a: np.asarray(a) * 0,
    "times -1": lambda a: np.asarray(a) * -1,
}
_NUMBER: dict[str, Callable[[Any], Any]] = {
    "negative": lambda v: -v,
    "times 1e300": lambda v: v * 1e300,
    "times 1e6": lambda v: v * 1e6,
    "as text": str,
    "as bytes": lambda v: str(v).encode(),
    "as array ()": np.array,
    "as array (1,)": lambda v: np.array([v]),
    "as list": lambda v: [v],
    "as float32": np.float32,
    "as float16": np.float16,
    "as Decimal": decimal.Decimal,
    "and a half": lambda v: v + 0.5,
    "as complex": complex,
}
_TEXT: dict[str, Callable[[Any], Any]] = {
    "in capitals": str.upper,
    "as bytes": str.encode,
    "and more": lambda v: v + "x",
    "as Path": Path,
    "in a list": lambda v: [v],
    "as np.str_": np.str_,
    "with a space": lambda v: v + " ",
}
_SEQUENCE: dict[str, Callable[[Any], Any]] = {
    "one short": lambda v: v[:-1],
    "one more": lambda v: v + v[:1],
    "as list": list,
    "as generator": lambda v: (x for x in v),
    "as set": set,
    "as array": np.array,
    "as array of objects": lambda v: np.array(v, object),
    "as texts": lambda v: tuple(str(x) for x in v),
    "with None": lambda v: type(v)([None, *v[1:]]),
    "with nan": lambda v: type(v)([float("nan"), *v[1:]]),
    "with a text": lambda v: type(v)(["x", *v[1:]]),
    "in a tuple": lambda v: (v,),
    "negative": lambda v: type(v)(-x for x in v),
    "times 1e300": lambda v: type(v)(x * 1e300 for x in v),
    "ten thousand times": lambda v: v * 10_000,
}
_MAPPING: dict[str, Callable[[Any], Any]] = {
    "empty": lambda v: {},
    "without one": lambda v: dict(list(v.items())[1:]),
    "keys only": list,
    "values None": dict.fromkeys,
    "values text": lambda v: dict.fromkeys(v, "x"),
    "values inf": lambda v: dict.fromkeys(v, float("inf")),
    "values lists": lambda v: {key: [] for key in v},
    "values nested": lambda v: {key: {"a": [None]} for key in v},
    "keys numbers": lambda v: dict(enumerate(v.values())),
    "one more": lambda v: {**v, "more": object()},
}
_PATH: dict[str, Callable[[Any], Any]] = {
    "its folder": lambda p: p.parent,
    "missing": lambda p: p.with_name("missing" + p.suffix),
    "below a file": lambda p: p / "x.exr",
    "without ending": lambda p: p.with_suffix(""),
    "of another ending": lambda p: p.with_suffix(".txt"),
    "as bytes": bytes,
    "as text": str,
    "with a zero byte": lambda p: str(p) + "\0",
    "with half a character": lambda p: str(p) + "\ud800",
    "very long": lambda p: p.with_name("x" * 300 + p.suffix),
    "in a list": lambda p: [p],
}
_BYTES: dict[str, Callable[[Any], Any]] = {
    "cut": lambda v: v[: len(v) // 2],
    "empty": lambda v: b"",
    "turned": lambda v: v[::-1],
    "zeros": lambda v: bytes(len(v)),
    "as text": lambda v: v.decode("latin-1"),
    "as array": lambda v: np.frombuffer(v, np.uint8),
    "writable": bytearray,
    "more": lambda v: v + b"x" * 100,
}
_WAYS: tuple[tuple[Any, dict[str, Callable[[Any], Any]]], ...] = (
    (np.ndarray, _ARRAY),
    ((int, float), _NUMBER),
    (str, _TEXT),
    ((tuple, list), _SEQUENCE),
    (dict, _MAPPING),
    (Path, _PATH),
    (bytes, _BYTES),
)


def chosen(good: Any, world: World, random: Random) -> tuple[str, Any]:
    """A value to put in the place of a good one, and its name; seeded by ``random``."""
    if random.random() < 0.4 and good is not None:
        return spoiled(good, random)
    name = random.choice(list(ANY))
    return name, ANY[name](world)
