"""Imports the names of a package on first use, so that a program loads only the modules it uses."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def lazy_attributes(
    package: str, modules: Mapping[str, str]
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Makes ``__getattr__`` and ``__dir__`` of a package.

    Args:
        package: ``__name__`` of the package.
        modules: Module of each name, relative to the package.
    """
    names = sys.modules[package].__dict__

    def get(name: str) -> Any:
        if name not in modules:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        value = names[name] = getattr(import_module(f"{package}.{modules[name]}"), name)
        return value

    def listed() -> list[str]:
        return sorted({*names, *modules})

    return get, listed
