"""``daguerre stocks``: the library of film."""

from __future__ import annotations

from typing import Annotated

from . import console
from .flags.groups import option


def stocks(json: Annotated[bool, option("--json", help="Print a JSON list.")] = False) -> int:
    """Lists the film stocks of the library.

    Columns: name, kind, colour, ISO, colour temperature of the balance, RMS granularity.
    """
    from json import dumps

    from daguerre.stocks import load, names

    found = [load(name) for name in names()]
    if json:
        keys = ("name", "kind", "iso", "balance", "granularity", "source")
        console.show(
            dumps([{key: getattr(stock, key) for key in keys} for stock in found], indent=2)
        )
        return 0
    width = max(len(stock.name) for stock in found)
    for stock in found:
        colours = "colour" if len(stock.layers) == 3 else "black and white"
        console.show(
            f"{stock.name.ljust(width)}  {stock.kind:8}  {colours:15}  ISO {stock.iso:<5g}  "
            f"{stock.balance:.0f} K  RMS granularity {stock.granularity:g}"
        )
    return 0
