"""``daguerre lenses`` and ``daguerre lens``: the library, and one lens on the bench."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Annotated, Any

import typer

from daguerre.errors import UsageError

from .flags import option


def lenses(json: Annotated[bool, option("--json", help="As a JSON list.")] = False) -> int:
    """Lists the lenses of the library, a line each."""
    from json import dumps

    from daguerre import lenses as library

    rows = []
    for name in library.names():
        order = first_order(library.load(name))
        rows.append({"name": name, **order})
    if json:
        print(dumps(rows, default=_plain))
        return 0
    width = max((len(row["name"]) for row in rows), default=0)
    for row in rows:
        facts = "  ".join(
            part.format(row[key])
            for key, part in (("efl", "{:8.2f} mm"), ("f_number", "f/{:.2f}"))
            if isinstance(row.get(key), float)
        )
        print(f"{row['name']:{width}}  {facts}")
    return 0


def lens(
    name: Annotated[str, typer.Argument(metavar="NAME|FILE", help="Of the library, or a file.")],
    json: Annotated[bool, option("--json", help="As one JSON object.")] = False,
    plot: Annotated[
        Path | None, option("--plot", metavar="FILE.svg", help="Drawing with rays.")
    ] = None,
) -> int:
    """Shows a lens: first-order properties at 587.56 nm (mm), and a drawing on request."""
    from json import dumps

    from daguerre import lenses as library
    from daguerre.io.atomic import check_writable, write_bytes

    if plot is not None:
        if plot.suffix.lower() != ".svg":
            raise UsageError(f"--plot: wanted a name ending in .svg, got {str(plot)!r}")
        check_writable(plot)
    item = library.load(name)
    order = first_order(item)
    if plot is not None:
        write_bytes(plot, item._repr_svg_().encode())
    if json:
        print(dumps({"name": getattr(item, "name", name), **order}, default=_plain))
        return 0
    print(getattr(item, "name", name))
    for key, value in order.items():
        print(f"  {key:28} {_show(value)}")
    return 0


def first_order(item: Any) -> dict[str, Any]:
    """First-order properties by name; lengths in mm."""
    order = item.first_order()
    if dataclasses.is_dataclass(order) and not isinstance(order, type):
        return dataclasses.asdict(order)
    return dict(order)


def _show(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, dict):
        return ", ".join(f"{key} {_show(inner)}" for key, inner in value.items())
    if isinstance(value, list | tuple):
        return ", ".join(_show(inner) for inner in value)
    return str(value)


def _plain(value: Any) -> Any:
    from daguerre.io.exr import jsonable

    return jsonable(value)
