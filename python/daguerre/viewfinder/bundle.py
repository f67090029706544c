"""Bundle: joins the page's modules into a single file, as each request of a page takes time."""

from __future__ import annotations

import re
from pathlib import Path

PAGE = Path(__file__).parent / "page"
_IMPORT = re.compile(r"^import (\{[^}]*\}|\* as \w+) from '\./(\w+)\.js';$", re.MULTILINE)
_EXPORT = re.compile(r"^export (?=(?:async )?(?:class|function|const) (\w+))", re.MULTILINE)


def bundled(name: str) -> str:
    """Joins a module of the page and all that it imports into one module."""
    done: dict[str, str] = {}

    def add(module: str) -> None:
        text = (PAGE / f"{module}.js").read_text("utf-8")
        for _, other in _IMPORT.findall(text):
            if other not in done:
                add(other)
        names = _EXPORT.findall(text)
        text = _IMPORT.sub(_from_module, _EXPORT.sub("", text))
        done[module] = (
            f"const module_{module} = (() => {{\n{text}\nreturn {{{', '.join(names)}}};\n}})();\n"
        )

    add(name)
    return "".join(done.values())


def _from_module(found: re.Match[str]) -> str:
    names = found[1].removeprefix("* as ")
    return f"const {names} = module_{found[2]};"
