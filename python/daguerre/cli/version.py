"""``daguerre version``."""

from __future__ import annotations

from typing import Annotated

from . import console
from .flags.groups import option


def version(json: Annotated[bool, option("--json", help="Print one JSON object.")] = False) -> int:
    """Prints the versions of daguerre and its libraries."""
    import platform
    from importlib import metadata
    from json import dumps

    from daguerre import __version__

    facts = {"daguerre": __version__, "python": platform.python_version()}
    for name in ("numpy", "OpenImageIO", "deflate", "tifffile", "rawpy", "pyoidn", "opencolorio"):
        try:
            facts[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    if json:
        console.show(dumps(facts))
    else:
        console.show("\n".join(f"{name} {value}" for name, value in facts.items()))
    return 0
