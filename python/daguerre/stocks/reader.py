"""Reads stock files: JSON of the schema ``daguerre-stock/0.1``; see docs/film-stocks.md."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from daguerre.argument_checks import guarded
from daguerre.color import illuminants
from daguerre.files.json_file import read_json_file
from daguerre.files.json_item import MAX_NAME, Item
from daguerre.sensors.curve import rising

from .curve import CharacteristicCurve
from .stock import Halation, Layer, Stock

SCHEMA = "daguerre-stock/0.1"
MEMBERS = (
    *("schema", "name", "kind", "source", "note", "iso", "balance_k", "wavelengths_nm", "layers"),
    *("granularity", "spread_um", "halation", "paper"),
)


@guarded
def read(path: str | Path) -> Stock:
    """Reads a film stock file.

    Raises:
        InputError: The file cannot be used; the message has the file and JSON path.
    """
    return read_json_file(path, SCHEMA, MEMBERS, _stock)


def _stock(root: Item) -> Stock:
    name, paper = root.need("name").text(MAX_NAME), root.get("paper")
    nm = _list(root.need("wavelengths_nm"))
    return Stock(
        name=name,
        kind=root.need("kind").text(),
        source=root.need("source").text(),
        iso=root.need("iso").number(),
        balance=root.number_of("balance_k", illuminants.D65_KELVIN),
        wavelengths=rising(f"stock {name}: wavelengths_nm", nm),
        layers=tuple(_layer(layer) for layer in root.need("layers").members()),
        granularity=root.number_of("granularity", 0.0),
        spread=root.number_of("spread_um", 0.0),
        halation=_halation(root.get("halation")),
        paper=None if paper is None else _curve(paper),
    )


def _layer(item: Item) -> Layer:
    return Layer(str(item.key), _list(item.need("sensitivity")), _curve(item.need("curve")))


def _curve(item: Item) -> CharacteristicCurve:
    return CharacteristicCurve(
        least=item.need("least").number(),
        gamma=item.need("gamma").number(),
        toe=item.need("toe").number(),
        shoulder=item.need("shoulder").number(),
        toe_bend=item.number_of("toe_bend", 0.2),
        shoulder_bend=item.number_of("shoulder_bend", 0.3),
    )


def _halation(item: Item | None) -> Halation | None:
    if item is None or item.value is None:
        return None
    share = tuple(part.number() for part in item.need("share"))
    return Halation(item.need("base_mm").number(), share, item.number_of("index", 1.5))


def _list(item: Item) -> Any:
    import numpy as np

    return np.array([element.number() for element in item])
