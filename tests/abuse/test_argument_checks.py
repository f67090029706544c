"""Checks of arguments of public functions: accepted values, errors, and unchanged signatures."""

from __future__ import annotations

import inspect
import os
import pickle
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import annotation_kinds, argument_checks, lenses
from daguerre.argument_checks import guarded


@guarded
def joined(first: int, *rest: str, last: float = 0.5) -> tuple[Any, ...]:
    """Says what it was given."""
    return first, rest, last


@guarded
def opened(path: str | os.PathLike[str], at: tuple[float, float] | None = None) -> Any:
    """Says what it was given."""
    return path, at


def test_the_rest_of_the_arguments_is_not_that_of_a_keyword() -> None:
    assert joined(1, "a", "b", last=2) == (1, ("a", "b"), 2)
    with pytest.raises(dg.UsageError, match=r"^joined: last: wanted a number, got 'b'$"):
        joined(1, "a", last="b")
    with pytest.raises(TypeError, match="positional"):
        dg.load("a.glb", 3.0)  # type: ignore[misc]


def test_any_object_with_a_path_is_one(tmp_path: Path) -> None:
    (tmp_path / "a").touch()
    with os.scandir(tmp_path) as entries:
        assert opened(next(entries))[0] == str(tmp_path / "a")
    for bad in (b"a", os.fsencode(tmp_path), 3, "a\0b", tmp_path / "a\0b", None):
        with pytest.raises(dg.UsageError, match="opened: path: wanted a path, got"):
            opened(bad)  # type: ignore[arg-type]


def test_numbers_of_numpy_are_numbers() -> None:
    assert opened("a", np.array([1, 2], np.float32))[1] == (1, 2)  # type: ignore[arg-type]
    assert joined(np.int8(3), last=np.float32(0.25)) == (3, (), 0.25)  # type: ignore[arg-type]


def test_first_calls_of_many_threads_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """None of them sees a half-made plan."""
    whole = argument_checks._plan

    def slow(*args: Any) -> Any:
        time.sleep(0.01 * (1 + threading.get_ident() % 3))
        return whole(*args)

    monkeypatch.setattr(argument_checks, "_plan", slow)

    @guarded
    def twice(count: int, name: str = "a") -> str:
        return count * name

    start = threading.Barrier(8)

    def call(n: int) -> str:
        start.wait()
        if n % 2:
            return twice(n, "b")
        with pytest.raises(dg.UsageError, match="twice: name: wanted a string, got 3"):
            twice(n, 3)  # type: ignore[arg-type]
        return ""

    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(call, range(8))) == ["", "b", "", "bbb", "", "bbbbb", "", "bbbbbbb"]


def test_checks_do_not_show() -> None:
    """Names, signatures, docstrings and pickles are those of what stands behind."""
    assert "scene" in inspect.signature(dg.render).parameters
    assert "spp" in inspect.signature(dg.render).parameters
    assert str(inspect.signature(lenses.load)).startswith("(name_or_path: 'str | Path | Lens'")
    assert (dg.load.__name__, dg.load.__module__) == ("load", "daguerre.importers.load")
    assert "Args:" in (inspect.getdoc(dg.load) or "")
    assert inspect.getsource(lenses.load).startswith("@guarded")
    for value in (dg.load, dg.render, lenses.load, dg.Scene.add_mesh, lenses.Lens.focused):
        assert pickle.loads(pickle.dumps(value)) is value
    lens = lenses.load("canon-serenar-50mm-f1.8")
    focused = pickle.loads(pickle.dumps(lens.focused))(2.0)
    assert focused.film_z_mm == lens.focused(2.0).film_z_mm


def test_a_named_type_is_checked_as_what_it_names() -> None:
    """``NDArray`` is such a name in NumPy 2.5 on Python 3.12 and newer."""

    class Alias:
        __value__ = np.ndarray

    found = annotation_kinds.of(Alias)
    assert found is not None
    assert found.words == "numbers"
    optional = annotation_kinds.of(Alias, none=True)
    assert optional is not None
    assert optional.take(Path("x")) is annotation_kinds.REFUSED


def test_a_message_stays_short(tmp_path: Path) -> None:
    """Random files found it: a name of thousands of letters in a settings or a stock file."""
    folder = Path(dg.stocks.__file__).parent / "library"
    text = (folder / "generic-colour-negative-400.json").read_text()
    (tmp_path / "stock.json").write_text(text.replace('"R"', f'"{"[" * 20_000}"'))
    for wrong in (
        lambda: dg.RenderSettings.of(filter="[" * 20_000),
        lambda: dg.stocks.read(tmp_path / "stock.json"),
    ):
        with pytest.raises(dg.DaguerreError) as caught:
            wrong()
        assert len(str(caught.value)) < 2000
        assert "..." in str(caught.value)
