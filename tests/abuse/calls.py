"""Every public call, and what random arguments make of it.

The list of names is that of ``script/public-face``. A case is a path and a number: it says by
itself which arguments are replaced, by which values, so a failure is found again by its name.
"""

from __future__ import annotations

import contextlib
import functools
import inspect
import os
import runpy
import traceback
import types
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

import daguerre
from daguerre.errors import DaguerreError

from .bad import chosen
from .good import ARGS, BY_NAME, RECEIVERS
from .keywords import KEYWORDS
from .uses import USES
from .world import World

ROOT = Path(__file__).resolve().parents[2]
#: Classes of the core, abstract bases, errors, and callbacks of what cannot be called alone.
SKIPPED = {
    "dg.polynomial.Iris": "a class of the core without a constructor",
    "dg.distortion.Distortion": "an abstract base",
    "dg.distortion.Radial": "an abstract base",
    "dg.analysis.Figures": "a record that data_sheet makes, which takes seconds for each case",
    "dg.analysis.data_sheet": "takes seconds for each case",
    "dg.Frame.show": "needs a desktop",
    "dg.development.Picture.show": "needs a desktop",
}


@dataclass(frozen=True)
class Target:
    """Something public that can be called.

    Attributes:
        path: Such as ``dg.Lens.trace``.
        owner: Path of its class; empty: it needs no object.
        call: The function; of a method, by the object.
    """

    path: str
    owner: str
    call: Callable[..., Any]

    def bound(self, world: World) -> Callable[..., Any]:
        """The function of an object."""
        if not self.owner:
            return self.call
        return getattr(RECEIVERS[self.owner](world), self.path.rpartition(".")[2])

    @property
    def signature(self) -> inspect.Signature:
        return inspect.signature(self.call)

    def arguments(self, world: World) -> dict[str, Any]:
        """Good arguments."""
        if self.path in ARGS:
            return dict(ARGS[self.path](world))
        return {
            name: BY_NAME[name](world)
            for name, p in self.signature.parameters.items()
            if p.default is p.empty
            and p.kind not in (p.VAR_KEYWORD, p.VAR_POSITIONAL)
            and name not in ("self", "cls")
        }

    def places(self, given: dict[str, Any]) -> list[str]:
        """Names of arguments that can be replaced: given ones, others, those of tables."""
        kinds = inspect.Parameter
        own = [
            name
            for name, p in self.signature.parameters.items()
            if p.kind not in (kinds.VAR_KEYWORD, kinds.VAR_POSITIONAL)
            and name not in ("self", "cls")
        ]
        rows = KEYWORDS.get(self.path, lambda: ())()
        return list(dict.fromkeys([*given, *own, *rows]))


@functools.cache
def targets() -> dict[str, Target]:
    """Every public function, class, and method, by path."""
    face = runpy.run_path(str(ROOT / "script" / "public-face"))
    found: dict[str, Target] = {}
    for module in face["MODULES"]:
        there = face["module_named"](module)
        _collect(found, f"dg.{module}." if module else "dg.", there, there.__all__)
    for module, names in face["DOCUMENTED"].items():
        there = face["module_named"](module)
        _collect(found, f"dg.{module}.", there, [n for n in names if hasattr(there, n)])
    return dict(sorted(found.items()))


def _collect(found: dict[str, Target], prefix: str, module: Any, names: list[str]) -> None:
    for name in names:
        value, path = getattr(module, name), prefix + name
        if path in SKIPPED or not callable(value):
            continue
        if isinstance(value, type) and issubclass(value, BaseException):
            continue
        if any(target.call is value for target in found.values()):
            continue
        found[path] = Target(path, "", value)
        if isinstance(value, type):
            for method in _methods(path, value):
                if method.path not in SKIPPED:
                    found[method.path] = method


def _methods(path: str, cls: type) -> Iterator[Target]:
    ours = [base for base in cls.__mro__ if base.__module__.startswith("daguerre")]
    for name in sorted({name for base in ours for name in vars(base)}):
        member = inspect.getattr_static(cls, name)
        if name.startswith("_") or isinstance(member, property | functools.cached_property):
            continue
        if isinstance(member, staticmethod | classmethod):
            yield Target(f"{path}.{name}", "", getattr(cls, name))
        elif isinstance(member, types.FunctionType):
            yield Target(f"{path}.{name}", path, member)


@dataclass(frozen=True)
class Outcome:
    """Outcome of a case.

    Attributes:
        call: The call in words.
        kind: accepted, refused, or the fault.
        where: Words of an error, and where it was raised.
    """

    call: str
    kind: str
    where: str = ""

    @property
    def good(self) -> bool:
        return self.kind in ("accepted", "refused")


def run(path: str, number: int, world: World, began: Callable[[str], None]) -> Outcome:
    """One case; 0 has good arguments alone.

    Args:
        path: Path of a target.
        number: Seed of the arguments.
        world: Things to call with.
        began: Told the call before it is made.
    """
    target = targets()[path]
    random = Random(f"{path} {number}")
    given = target.arguments(world)
    places = target.places(given)
    shown = dict.fromkeys(given, "good")
    if number:
        for name in random.sample(places, min(len(places), random.choice((1, 1, 1, 2)))):
            shown[name], given[name] = chosen(given.get(name), world, random)
    call = f"{path}({', '.join(f'{k}=<{v}>' for k, v in shown.items())})"
    began(call)
    function = target.bound(world)
    return _outcome(call, path, function, given, world)


def _outcome(
    call: str, path: str, function: Callable[..., Any], given: Any, world: World
) -> Outcome:
    planted = os.environ.get("DG_ABUSE_PLANT", "")
    try:
        if path == "dg.keys" and planted:  # a fault on purpose, for the test of the tests
            exec(planted, {"dg": daguerre})
        with warnings.catch_warnings(), contextlib.redirect_stdout(None):
            warnings.simplefilter("ignore")
            result = function(**given)
            if path in USES:
                USES[path](world, result)
    except DaguerreError as error:
        text = str(error)
        if not text.strip() or len(text) > 11_000:  # a text of 9999 letters may be said
            return Outcome(call, "an error without words, or with too many", text[:200])
        return Outcome(call, "refused", text)
    except Exception as error:  # the one place where any class of error is looked for
        frames = traceback.extract_tb(error.__traceback__)
        places = [f for f in frames if "/daguerre/" in f.filename] or list(frames)
        at = " < ".join(f"{Path(f.filename).name}:{f.lineno} {f.name}" for f in places[:-4:-1])
        return Outcome(call, type(error).__name__, f"{str(error)[:200]} at {at}")
    return Outcome(call, "accepted")
