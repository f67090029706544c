"""Keywords of a render for type checkers, and the signatures that people see.

``Session``, ``render`` and their kin take every parameter of ``RenderSettings`` as a keyword. Type
checkers read :class:`SettingsKeywords`; ``help()`` and ``inspect.signature`` get theirs from the
table, so that a parameter is written down once.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from typing import Any, TypedDict, TypeVar

from daguerre.parameters.table import Table
from daguerre.parameters.texts import attributes

from .diffraction import Diffraction
from .parameters import ROWS, TABLE
from .settings import OverscanLike, RenderSettings

Function = TypeVar("Function", bound=Callable[..., Any])


class ViewKeywords(TypedDict, total=False):
    """Parameters of any picture, each with the type of its field in ``RenderSettings``."""

    seed: int
    filter: str
    aovs: bool
    gt_time: str | None
    gt_lens: str
    gt_rays: int | None
    motion: bool
    crop: tuple[int, int, int, int] | None
    overscan: OverscanLike | None
    threads: int
    max_depth: int
    strategy: str
    dispersion: str
    light_paths: str | float | tuple[float, float]
    flare: str | float
    flare_order: int
    flare_highlights: bool | str
    scatter: str | float
    technique: str
    diffraction: bool | Diffraction
    bands: int


class SettingsKeywords(ViewKeywords, total=False):
    """Those of one picture."""

    resolution: tuple[int, int]


class RenderKeywords(SettingsKeywords, total=False):
    """The same, and how many samples are drawn."""

    spp: int | None
    noise: float | None


class RigKeywords(ViewKeywords, total=False):
    """Those of several pictures, whose sizes may differ."""

    spp: int | None
    noise: float | None


def takes(keywords: Any, *, without: Iterable[str] = ()) -> Callable[[Function], Function]:
    """Shows the keywords of a TypedDict in the signature and the docstring of a function.

    They stand where the function has ``**keywords``, and where its docstring says ``{keywords}``.
    """
    types = {n: kind for n, kind in keywords.__annotations__.items() if n not in without}

    def decorate(function: Function) -> Function:
        signature = inspect.signature(function)
        own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
        made = [
            inspect.Parameter(
                name, inspect.Parameter.KEYWORD_ONLY,
                default=TABLE[name].default, annotation=kind.__forward_arg__,
            )
            for name, kind in types.items()
        ]  # fmt: skip
        shown = signature.replace(parameters=[*own, *made])
        function.__signature__ = shown  # type: ignore[attr-defined]
        function.__doc__ = with_rows(function.__doc__, types)
        return function

    return decorate


def with_rows(text: str | None, names: Iterable[str]) -> str | None:
    """A docstring with a line of each parameter in the place of ``{keywords}``."""
    if text is None or "{keywords}" not in text:
        return text
    line = next(line for line in text.splitlines() if "{keywords}" in line)
    indent = line[: len(line) - len(line.lstrip())]
    rows = attributes(Table(ROWS), names, indent).rstrip("\n")
    return text.replace(line, rows)


def settings_of(given: RenderSettings | None, keywords: Any) -> RenderSettings:
    """The record, with the keywords in it."""
    made = RenderSettings() if given is None else given
    return made.with_(**keywords)
