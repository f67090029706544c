"""Few annotations are exactly ``Any``, and none in a public signature.

A value that is checked first, or only passed on, is ``object``: a type checker then sees that the
check comes before the use.
"""

from __future__ import annotations

import ast
import inspect
import runpy
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = next(folder for folder in Path(__file__).parents if (folder / "script").is_dir())
MOST = 400


def annotations_in(tree: ast.AST) -> Iterator[ast.expr]:
    """Annotations of parameters, results, fields and variables."""
    for node in ast.walk(tree):
        if isinstance(node, ast.arg | ast.AnnAssign) and node.annotation is not None:
            yield node.annotation
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.returns is not None:
            yield node.returns


def count_any(text: str) -> int:
    """Number of annotations that are exactly ``Any``."""
    return sum(ast.unparse(one).strip("'\"") == "Any" for one in annotations_in(ast.parse(text)))


def untyped(path: str, value: Any) -> Iterator[str]:
    """Parameters, results and fields that are ``Any``, of a public function or class."""
    if not inspect.isclass(value):
        if callable(value):
            yield from _annotated(path, inspect.unwrap(value))
        return
    for base in (one for one in value.__mro__ if one.__module__.startswith("daguerre")):
        yield from (
            name for name in _annotated(path, base) if not name.split(".")[-1].startswith("_")
        )
        for name, member in vars(base).items():
            if not name.startswith("_") or name == "__init__":
                yield from _annotated(f"{path}.{name}", inspect.unwrap(_function(member)))


def _function(member: Any) -> Any:
    """Function of a method, a class method or a property."""
    found = (getattr(member, name, None) for name in ("__func__", "fget", "func"))
    return next((one for one in found if one is not None), member)


def _annotated(path: str, owner: Any) -> Iterator[str]:
    if inspect.isclass(owner) or inspect.isfunction(owner):
        for name, annotation in inspect.get_annotations(owner).items():
            if annotation in ("Any", Any):
                yield f"{path}.{name}"


def test_few_annotations_are_any() -> None:
    files = sorted((ROOT / "python" / "daguerre").rglob("*.py"))
    counts = {path: count_any(path.read_text()) for path in files}
    assert sum(counts.values()) < MOST, {str(p): n for p, n in counts.items() if n}


def test_count_sees_every_kind_of_annotation() -> None:
    text = (
        "def f(a: Any, *b: Any, c: int, **d: Any) -> Any: e: Any\nclass G: h: 'Any'; i: list[Any]"
    )
    assert count_any(text) == 6


def test_no_public_signature_has_any() -> None:
    face = runpy.run_path(str(ROOT / "script" / "public-face"))
    named: dict[str, Any] = {}
    for module in (*face["MODULES"], *face["DOCUMENTED"]):
        there = face["module_named"](module)
        names = there.__all__ if module in face["MODULES"] else face["DOCUMENTED"][module]
        named |= {f"{module}.{n}": getattr(there, n) for n in names if hasattr(there, n)}
    assert len(named) > 200
    assert [one for path, value in named.items() for one in untyped(path, value)] == []


class _Loose:
    """A class with ``Any`` in each place."""

    field: Any

    def method(self, given: Any) -> int:
        """A method."""

    @property
    def value(self) -> Any:
        """A property."""


def test_each_place_of_a_public_class_is_seen() -> None:
    _Loose.__module__ = "daguerre.loose"
    assert sorted(untyped("L", _Loose)) == ["L.field", "L.method.given", "L.value.return"]
