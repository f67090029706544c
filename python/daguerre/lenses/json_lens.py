"""Builds a lens from a JSON value of the schema ``daguerre-lens/0.1`` (mm)."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from daguerre.files.json_item import Item, clean, short

from . import foreign_json
from .configurations import Configuration, chosen, read_configurations
from .diameters import with_derived_diameters
from .dispersion_rule import DispersionRule
from .errors import LensError, reported
from .glass_json import glass_from_json
from .glass_rules import Origin, suppliers_of
from .groups import Group, placed
from .lens import Lens, Nominal
from .product import read_product
from .projections import PROJECTION_NAMES
from .reading import member, number, text, triple
from .remarks import eased
from .stop_size import probe, with_stop_of_other_diameters
from .surface import LensSurface
from .surface_reader import COATINGS, read_surfaces
from .zoom import standing_mm, stop_notes

SCHEMA = "daguerre-lens/0.1"


def lens_of(data: dict[str, Any], source: str, configuration: str | None = None) -> Lens:
    """Builds the lens from a lens file's value, parsed or made by a program.

    Raises:
        InputError: A member cannot be used; the message has the JSON path.
    """
    with reported(source, "lens-format"):
        return lens_from(Item(data, source), Path(source), configuration)


def lens_from(root: Item, path: Path, name: str | None) -> Lens:
    """Builds a lens from a file's value, at a configuration by name; None: the first."""
    foreign_json.refuse(root)
    root, told = eased(root)
    schema = root.need("schema")
    if schema.text() != SCHEMA:
        schema.fail(f"wanted {SCHEMA!r}, got {short(schema.value)}")
    items = root.list_of("surfaces")
    if not items:
        root.need("surfaces")
        root.fail("surfaces: the list is empty, wanted at least one")
    configurations = read_configurations(root, len(items))
    configuration = chosen(root, configurations, name)
    surfaces = read_surfaces(items, configuration.gaps, _origin(root))
    stops = [i for i, surface in enumerate(surfaces) if surface.stop]
    if len(stops) != 1:
        where = f" (surfaces {', '.join(map(str, stops[:8]))})" if stops else ""
        raise LensError(
            f"{path}: surfaces: wanted exactly one stop, got {len(stops)}{where}",
            "lens-two-stops" if stops else "lens-no-stop",
            stops[1] if stops else None,
        )
    if configuration.stop_semi_diameter is not None:
        surfaces[stops[0]] = surfaces[stops[0]].replaced(
            semi_diameter=configuration.stop_semi_diameter
        )
    for group in _groups(root, len(items), configurations):
        surfaces = placed(surfaces, group)
    nominal, stop = _nominal(root, configuration), surfaces[stops[0]]
    if configuration is not configurations[0]:  # the stated field belongs to the first
        nominal = dataclasses.replace(nominal, full_field_deg=None)
    unsized = stop.semi_diameter is None and nominal.f_number is None
    if unsized:
        surfaces[stops[0]] = probe(stop)
    lens = _assembled(root, path, surfaces, nominal, configurations)
    if unsized:
        lens = with_stop_of_other_diameters(lens, stop)
    zoom_mm = standing_mm(lens, configuration)
    notes = (*lens.notes, *told, *stop_notes(lens))
    lens = dataclasses.replace(lens, zoom_mm=zoom_mm, notes=notes)
    return with_derived_diameters(lens)


def _assembled(
    root: Item,
    path: Path,
    surfaces: list[LensSurface],
    nominal: Nominal,
    configurations: tuple[Configuration, ...],
) -> Lens:
    coating = member(root, "coating")
    coating_name = "mgf2" if coating is None else coating.choice(COATINGS)
    name = clean(text(root, "name") or path.stem)
    outside = glass_from_json(member(root, "object_medium"), _origin(root))
    return Lens(
        name=name,
        source=str(path),
        patent=text(root, "patent"),
        note=text(root, "note"),
        nominal=nominal,
        surfaces=tuple(surfaces),
        coating=coating_name,
        data=root.value,
        configurations=configurations,
        object_medium=outside.medium,
        notes=_glass_notes([*(s.dispersion for s in surfaces), outside.rule]),
        product=read_product(root),
    )


def _glass_notes(rules: list[DispersionRule | None]) -> tuple[str, ...]:
    """A note on all glasses that their names do not describe; empty: there are none."""
    notes = dict.fromkeys(rule.note for rule in rules if rule is not None and rule.note)
    return (f"glass: {'; '.join(notes)}",) if notes else ()


def _year(root: Item) -> int | None:
    """Year of the lens: a number, or the first one of a text (``c. 1959``); None: unknown."""
    found = member(root, "year")
    year = re.search(r"\d{4}", str(found.value)) if found is not None else None
    return int(year[0]) if year else None


def _origin(root: Item) -> Origin:
    """Facts of the lens by which its glasses are chosen."""
    return Origin(
        makers=suppliers_of(text(root, "maker") or ""),
        year=_year(root),
        keeps_line=text(root, "normal_line") is not None,
    )


def _groups(root: Item, count: int, configurations: Sequence[Configuration]) -> list[Group]:
    groups = member(root, "groups")
    return [_group(item, count, configurations) for item in groups or ()]


def _group(item: Item, count: int, configurations: Sequence[Configuration]) -> Group:
    span = item.need("surfaces")
    first, last = (int(v) for v in span.numbers(2, 0, count - 1))
    if last < first:
        span.fail(f"wanted [first, last] in ascending order, got [{first}, {last}]")
    inside = range(first, last)
    for i in inside:
        if len({c.gaps.get(i) for c in configurations}) > 1:
            span.fail(
                f"the group must be rigid, but the gap after surface {i} changes between "
                f"configurations"
            )
    return Group(
        first,
        last,
        triple(item, "decenter", 1e4),
        triple(item, "tilt", 90),
        number(item, "pivot_mm") or 0.0,
    )


def _projection(nominal: Item | None) -> str | None:
    found = None if nominal is None else member(nominal, "projection")
    return None if found is None else PROJECTION_NAMES[str(found.choice(PROJECTION_NAMES))]


def _nominal(root: Item, configuration: Configuration) -> Nominal:
    nominal = member(root, "nominal")

    def value(key: str) -> float | None:
        found = None if nominal is None else number(nominal, key)
        if found is not None and found < 0:
            root.need("nominal").need(key).fail(f"out of range: wanted at least 0, got {found:g}")
        return found or None

    return Nominal(
        efl_mm=configuration.efl_mm or value("efl_mm"),
        f_number=configuration.f_number or value("f_number"),
        full_field_deg=value("full_field_deg"),
        image_circle_mm=value("image_circle_mm"),
        projection=_projection(nominal),
        efl_x_mm=value("efl_x_mm"),
    )
