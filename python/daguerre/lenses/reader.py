"""Reads lens files: JSON of the schema ``daguerre-lens/0.1`` (mm), and those of other programs."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from daguerre.errors import InputError
from daguerre.files.json_item import Item, clean
from daguerre.files.json_text import parse

from . import formats
from .checking import checked
from .configurations import Configuration, chosen, read_configurations
from .diameters import with_derived_diameters
from .errors import LensError, reported
from .glass_json import glass_from_json
from .groups import Group, placed
from .lens import Lens, Nominal
from .reading import member, number, text, triple
from .surface import LensSurface
from .surface_reader import COATINGS, read_surfaces
from .unknown import unknown_members
from .zoom import standing_mm

SCHEMA = "daguerre-lens/0.1"
MAX_BYTES = 16_000_000


def read(path: str | Path, configuration: str | None = None) -> Lens:
    """Reads one lens.

    Args:
        path: The file.
        configuration: Zoom or focus position by name; the first one if None.

    Raises:
        InputError: With file and JSON path of what cannot be used.
    """
    path = Path(path)
    data = _bytes(path)
    with reported(str(path), "lens-format"):
        root, notes = _root(data, path)
        lens = _lens(root, path, configuration)
        return checked(replace(lens, notes=(*notes, *unknown_members(root))))


def lens_of(data: dict[str, Any], source: str, configuration: str | None = None) -> Lens:
    """The lens of a lens file's value, parsed or made by a program.

    Raises:
        InputError: With JSON path of what cannot be used.
    """
    with reported(source, "lens-format"):
        return _lens(Item(data, source), Path(source), configuration)


def _root(data: bytes, path: Path) -> tuple[Item, list[str]]:
    """The file's value, and what could not be honoured of another program's."""
    if formats.is_foreign(path):
        value, notes = formats.parse(data, path)
        return Item(value, str(path)), notes
    return parse(data, str(path)), []


def _bytes(path: Path) -> bytes:
    if path.suffix.lower() not in (".json", *formats.SUFFIXES):
        known = ", ".join((".json", *formats.SUFFIXES))
        got = path.suffix or "no suffix"
        raise LensError(f"{path}: lens file: wanted {known}, got {got}", "lens-format")
    try:
        if path.exists() and not path.is_file():  # a pipe or a device would never end
            raise InputError(f"{path}: lens file: wanted an ordinary file")
        if path.stat().st_size > MAX_BYTES:
            raise InputError(f"{path}: lens file: wanted at most {MAX_BYTES} bytes")
        return path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None


def _lens(root: Item, path: Path, name: str | None) -> Lens:
    schema = root.need("schema")
    if schema.text() != SCHEMA:
        schema.fail(f"wanted {SCHEMA!r}, got {schema.value!r}")
    items = root.list_of("surfaces")
    if not items:
        root.need("surfaces")
        root.fail("surfaces: wanted at least one surface, got none")
    configurations = read_configurations(root, len(items))
    configuration = chosen(root, configurations, name)
    surfaces = read_surfaces(items, configuration.gaps)
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
    lens = _assembled(root, path, surfaces, configurations, configuration)
    lens = dataclasses.replace(lens, zoom_mm=standing_mm(lens, configuration))
    return with_derived_diameters(lens)


def _assembled(
    root: Item,
    path: Path,
    surfaces: list[LensSurface],
    configurations: tuple[Configuration, ...],
    configuration: Configuration,
) -> Lens:
    coating = member(root, "coating")
    coating_name = "mgf2" if coating is None else coating.choice(COATINGS)
    name = clean(text(root, "name") or path.stem)
    nominal = _nominal(root, configuration)
    if configuration is not configurations[0]:  # the field is that of the first
        nominal = dataclasses.replace(nominal, full_field_deg=None)
    medium, _ = glass_from_json(member(root, "object_medium"))
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
        object_medium=medium,
    )


def _groups(root: Item, count: int, configurations: Sequence[Configuration]) -> list[Group]:
    groups = member(root, "groups")
    return [_group(item, count, configurations) for item in groups or ()]


def _group(item: Item, count: int, configurations: Sequence[Configuration]) -> Group:
    span = item.need("surfaces")
    first, last = (int(v) for v in span.numbers(2, 0, count - 1))
    if last < first:
        span.fail(f"wanted [first, last], got [{first}, {last}]")
    inside = range(first, last)
    for i in inside:
        if len({c.gaps.get(i) for c in configurations}) > 1:
            span.fail(f"wanted surfaces that keep their distances; the gap after {i} changes")
    return Group(
        first,
        last,
        triple(item, "decenter", 1e4),
        triple(item, "tilt", 90),
        number(item, "pivot_mm") or 0.0,
    )


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
        projection=None if nominal is None else text(nominal, "projection"),
        efl_x_mm=value("efl_x_mm"),
    )
