"""Refusals of the core are bad input, told with its place; any other ValueError is a fault."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Any

import pytest

import daguerre as dg
from daguerre import _core
from daguerre.errors import CoreError, InputError, UsageError, core_errors

PACKAGE = Path(dg.__file__).parent


@pytest.fixture
def session() -> dg.Session:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    return dg.Session(scene, dg.Camera(), resolution=(4, 3))


def test_the_place_comes_first() -> None:
    with pytest.raises(UsageError, match=r"^filter: kind: wanted box"), core_errors(UsageError):
        _core.Filter("triangle")
    expected = pytest.raises(InputError, match=r"^a\.glb: filter: kind: wanted box")
    with expected as caught, core_errors(InputError, "a.glb"):
        _core.Filter("triangle")
    assert not isinstance(caught.value, CoreError)


def test_errors_of_the_package_pass_as_they_are() -> None:
    mine = UsageError("camera: iso: wanted a number")
    with pytest.raises(UsageError) as caught, core_errors(InputError, "render"):
        raise mine
    assert caught.value is mine


def test_a_session_tells_what_the_core_refuses(session: dg.Session) -> None:
    def refuses(*_: Any) -> Any:
        return _core.Filter("triangle")

    with pytest.raises(InputError, match=r"^render: filter: kind"):
        session._add(refuses, (0, 1), None)
    with pytest.raises(UsageError, match="stopped midway"):
        session.frame()


def test_a_session_takes_no_fault_for_bad_input(session: dg.Session) -> None:
    def fails(*_: Any) -> Any:
        raise ValueError("a fault")

    with pytest.raises(ValueError, match=r"^a fault$") as caught:
        session._add(fails, (0, 1), None)
    assert type(caught.value) is ValueError


def test_no_message_is_parsed() -> None:
    assert "import re" not in (PACKAGE / "lenses" / "errors.py").read_text()


def test_calls_of_the_core_are_not_under_a_catch_of_all_values() -> None:
    found = 0
    for path in PACKAGE.rglob("*.py"):
        for block in ast.walk(ast.parse(path.read_text())):
            if isinstance(block, ast.Try) and catches(block, "ValueError"):
                found += 1
                assert not any(named(part, "_core") for part in block.body), (path, block.lineno)
    assert found > 20  # those around int(), float() and other people's packages


def catches(block: ast.Try, name: str) -> bool:
    return any(handler.type and named(handler.type, name) for handler in block.handlers)


def named(tree: ast.AST, name: str) -> bool:
    return any(isinstance(node, ast.Name) and node.id == name for node in ast.walk(tree))
