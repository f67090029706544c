"""Values of unlike kinds have names: they are records, not tuples that calls unpack by a star.

``draw(*shot)`` with a scene, a camera and settings hides what the parameters get, and a parameter
``tuple[str, int]`` hides what its parts mean. A NamedTuple or a dataclass says both.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "python" / "daguerre"
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
KINDS = (ast.Subscript, ast.Name)
#: Parameters that may be tuples of unlike types.
ALLOWED = {
    "analysis/off_axis.py: off_axis: moves",  # as users write ``Camera.decenter``
    "camera/lens_scatter.py: _made: barrel",  # as the core takes it
    "camera/lens_scatter.py: _made: blades",
    "importers/volumes/nanovdb_tree.py: _layout: fields",  # rows of a table
    "scene/over_time/crowds.py: _place: one",  # an index of arrays
    "scene/over_time/crowds.py: _place: other",
    "scene/over_time/crowds.py: _turn: one",
    "scene/over_time/crowds.py: _turn: other",
}


@cache
def tree(text: str) -> ast.Module:
    return ast.parse(text)


def types_in(annotation: ast.expr) -> list[str]:
    """Types of the items of a tuple, if the annotation is a tuple of fixed length; else none."""
    if not isinstance(annotation, ast.Subscript) or ast.unparse(annotation.value) != "tuple":
        return []
    items = annotation.slice
    found = [ast.unparse(one) for one in (items.elts if isinstance(items, ast.Tuple) else [items])]
    return [] if found[-1] == "..." else found


def is_unlike(annotation: ast.expr) -> bool:
    """Whether an annotation is a tuple of items that differ in type; numbers are alike."""
    types = {"float" if one == "int" else one for one in types_in(annotation)}
    return len(types) > 1


def aliases(text: str) -> dict[str, ast.expr]:
    """Tuples that a module names by an assignment."""
    return {
        ast.unparse(node.targets[0]): node.value
        for node in tree(text).body
        if isinstance(node, ast.Assign) and types_in(node.value)
    }


def options(annotation: ast.expr) -> Iterator[ast.expr]:
    """Members of a union, or the annotation itself."""
    if isinstance(annotation, ast.BinOp):
        yield from options(annotation.left)
        yield from options(annotation.right)
    else:
        yield annotation


def unlike_in(annotation: ast.expr, named: dict[str, ast.expr]) -> bool:
    """Whether an annotation has a tuple of unlike items; a container may have pairs."""
    parts = [named.get(ast.unparse(p), p) for p in ast.walk(annotation) if isinstance(p, KINDS)]
    whole = [named.get(ast.unparse(p), p) for p in options(annotation)]
    return any(map(is_unlike, whole)) or any(is_unlike(p) and len(types_in(p)) > 2 for p in parts)


def unlike_parameters(text: str, named: dict[str, ast.expr]) -> Iterator[str]:
    """Parameters that are tuples of unlike items, with their functions."""
    for node in ast.walk(tree(text)):
        if isinstance(node, FUNCTIONS):
            given = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
            for one in [*given, node.args.vararg, node.args.kwarg]:
                if one is not None and one.annotation and unlike_in(one.annotation, named):
                    yield f"{node.name}: {one.arg}"


def returns(texts: dict[str, str]) -> dict[str, bool]:
    """Whether all functions of a name return tuples of unlike items."""
    found: dict[str, bool] = {}
    for text in texts.values():
        named = aliases(text)
        for node in ast.walk(tree(text)):
            if isinstance(node, FUNCTIONS) and node.returns is not None:
                made = named.get(ast.unparse(node.returns), node.returns)
                found[node.name] = found.get(node.name, True) and is_unlike(made)
    return found


def called(value: ast.expr) -> str:
    """Name of the function that a call calls; empty: it is no call of a name."""
    function = value.func if isinstance(value, ast.Call) else None
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""


def assigned(function: ast.FunctionDef | ast.AsyncFunctionDef) -> dict[str, ast.expr]:
    """Values of the names that a function assigns."""
    return {
        node.targets[0].id: node.value
        for node in ast.walk(function)
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
    }


def is_written(value: ast.expr) -> bool:
    """Whether a value is a tuple of three or more values that are no constants."""
    plain = (ast.Constant, ast.Starred)
    return isinstance(value, ast.Tuple) and sum(not isinstance(v, plain) for v in value.elts) > 2


def unlike_stars(text: str, returned: dict[str, bool]) -> Iterator[str]:
    """Starred arguments that are tuples written in the function, or results of unlike items."""
    for function in ast.walk(tree(text)):
        if not isinstance(function, FUNCTIONS):
            continue
        values = assigned(function)
        for node in ast.walk(function):
            for star in node.args if isinstance(node, ast.Call) else ():
                if isinstance(star, ast.Starred):
                    value = star.value
                    source = values.get(value.id, value) if isinstance(value, ast.Name) else value
                    written = isinstance(value, ast.Tuple) or is_written(source)
                    if written or returned.get(called(source)):
                        yield f"{function.name}: {ast.unparse(star)}"


def texts() -> dict[str, str]:
    return {str(path.relative_to(PACKAGE)): path.read_text() for path in PACKAGE.rglob("*.py")}


def test_parameters_of_the_package() -> None:
    every = texts()
    found = {
        f"{path}: {line}"
        for path, text in every.items()
        for line in unlike_parameters(text, aliases(text))
    }
    assert len(every) > 300
    assert found == ALLOWED


def test_stars_of_the_package() -> None:
    every = texts()
    returned = returns(every)
    assert sum(returned.values()) > 50
    found = [
        f"{path}: {line}" for path, text in every.items() for line in unlike_stars(text, returned)
    ]
    assert found == []


@pytest.mark.parametrize(
    ("annotation", "unlike"),
    [
        ("tuple[str, int]", True),
        ("tuple[float, Array] | None", True),
        ("Pair", True),
        ("list[tuple[str, int, bool]]", True),
        ("list[tuple[float, Array]]", False),
        ("tuple[int, float]", False),
        ("tuple[str, ...]", False),
        ("Mapping[str, int]", False),
    ],
)
def test_planted_parameters(annotation: str, unlike: bool) -> None:
    text = f"Pair = tuple[str, bytes]\ndef one(a: {annotation}, *, b: int): pass"
    assert list(unlike_parameters(text, aliases(text))) == ["one: a"] * unlike


@pytest.mark.parametrize(
    ("code", "unlike"),
    [
        ("draw(*(scene, camera))", True),
        ("draw(*self.made())", True),
        ("shot = made()\n    draw(*shot)", True),
        ("shot = scene, camera, settings\n    draw(*shot)", True),
        ("names = 'f_stop', 't_stop', 'iso'\n    draw(*names)", False),
        ("draw(*size())", False),
        ("draw(*shape)", False),
    ],
)
def test_planted_stars(code: str, unlike: bool) -> None:
    text = (
        f"def made() -> tuple[str, Array]: pass\ndef size() -> tuple[int, int]: pass\n"
        f"def one():\n    {code}"
    )
    assert len(list(unlike_stars(text, returns({"": text})))) == unlike
