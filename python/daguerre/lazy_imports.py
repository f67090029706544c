"""Imports the names of a package on first use, so that a program loads only the modules it uses."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

_IMPORT = re.compile(r"^from (\S+) import (\w+) as \2$", re.MULTILINE)


def lazy_names(
    package: str, file: str
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Makes ``__getattr__``, ``__dir__`` and ``__all__`` of a package from its stub.

    The stub ``__init__.pyi``, which type checkers read, lists each name once, as
    ``from .module import name as name``.

    Args:
        package: ``__name__`` of the package.
        file: ``__file__`` of the package.
    """
    stub = Path(file).with_suffix(".pyi").read_text(encoding="utf-8")
    modules = {name: module for module, name in _IMPORT.findall(stub)}
    names = sys.modules[package].__dict__

    def get(name: str) -> Any:
        if name not in modules:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        module = modules[name]
        if module == ".":
            return import_module(f".{name}", package)
        level = len(module) - len(module.lstrip("."))
        loaded = __import__(module[level:], names, fromlist=[name], level=level)
        value = names[name] = getattr(loaded, name)
        return value

    listed = sorted(modules)
    return get, lambda: listed, listed
