"""Parses lists of effects: ``NAME:key=value,...`` on a command line, or a JSON recipe."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from daguerre import lenses
from daguerre.errors import InputError, UsageError, suggest
from daguerre.files.json_item import Item, short
from daguerre.files.uris import Folder

from .effect import Effect, Values
from .effects.catalogue import EFFECTS

_MOST_BYTES = 1_000_000


@dataclass(frozen=True)
class Planned:
    """An effect with all its values."""

    effect: Effect
    values: Values
    where: str
    given: Values

    @property
    def written(self) -> list[str]:
        """Files that it writes beside the picture."""
        rows = (row for row in self.effect.parameters if row.kind == "output")
        return [self.values[row.name] for row in rows if self.values[row.name] is not None]


def from_words(words: Sequence[str]) -> list[Planned]:
    """Parses the words of ``--effect``.

    Args:
        words: Words such as ``vignetting:model=natural,inverse=1``.

    Raises:
        UsageError: An effect or parameter is unknown, or a value is invalid.
    """
    planned = []
    for word in words:
        name, _, rest = word.partition(":")
        where = f"--effect {name}"
        given: dict[str, Any] = {}
        key = ""
        for part in filter(None, rest.split(",")):
            if "=" not in part and key:  # a comma in a value, such as the name of a file
                given[key] += f",{part}"
                continue
            key, equals, value = part.partition("=")
            key = key.strip()
            if not equals:
                raise UsageError(f"{where}: wanted key=value, got {part!r}")
            if key in given:
                raise UsageError(f"{where}: {key}: wanted once, got twice")
            given[key] = value.strip()
        planned.append(plan(name.strip(), given, where, UsageError))
    return planned


def from_file(path: Path) -> list[Planned]:
    """Reads a recipe: a list of objects such as ``{"effect": "vignetting", "model": "natural"}``.

    Recipes may come from strangers: an effect reads files of the recipe's folder alone, and writes
    none beside the picture.

    Raises:
        InputError: The file cannot be read, or an effect, parameter or value is invalid; the
            message has its place in the file.
    """
    from daguerre.files.json_text import parse
    from daguerre.files.reading import read_bytes

    root = parse(read_bytes(path, _MOST_BYTES), str(path)).value
    if not isinstance(root, list) or not all(isinstance(entry, dict) for entry in root):
        raise InputError(f'{path}: wanted a list of objects such as {{"effect": "vignetting"}}')
    folder = Folder(path, what="recipe", way="--effect may name others")
    planned = []
    for k, entry in enumerate(root):
        where = f"{path}: [{k}]"
        given = {key: value for key, value in entry.items() if key != "effect"}
        one = plan(entry.get("effect"), given, where, InputError)
        planned.append(replace(one, values={**one.values, **_files(one, folder)}))
    return planned


def _files(planned: Planned, folder: Folder) -> dict[str, str]:
    """Files that an effect of a recipe may read, by parameter.

    Raises:
        InputError: A file is outside of the recipe's folder or missing, or the effect writes files.
    """
    found = {}
    for row in planned.effect.parameters:
        if row.name not in planned.given:
            continue
        item = Item(planned.values[row.name], row.name, Item(None, planned.where))
        if row.kind == "output":
            item.fail(
                f"a recipe writes no file: write it by --effect {planned.effect.name}:...,"
                f"{row.name}=FILE"
            )
        if row.kind == "file" or (row.kind == "library" and item.value not in lenses.names()):
            found[row.name] = str(folder.resolve(item))
    return found


def plan(
    name: object, given: Values, where: str, error: type[InputError | UsageError] = UsageError
) -> Planned:
    """Returns an effect of the catalogue with values for all its parameters."""
    if not isinstance(name, str) or name not in EFFECTS:
        raise error(
            f"{where}: effect: wanted a name from `daguerre post --list`, got {short(name)}"
            f"{suggest(short(name), EFFECTS)}"
        )
    effect = EFFECTS[name]
    return Planned(effect, effect.values(given, where, error), where, dict(given))


def in_order(planned: Sequence[Planned]) -> tuple[list[Planned], list[str]]:
    """Moves film effects after lens effects; also returns the names of the moved effects."""
    first = [p for p in planned if not p.effect.last]
    last = [p for p in planned if p.effect.last]
    done = [*first, *last]
    moved = sorted({p.effect.name for p, q in zip(planned, done, strict=True) if p is not q})
    return done, [name for name in moved if EFFECTS[name].last]


def as_json(planned: Sequence[Planned]) -> str:
    """Formats effects as a recipe, for the metadata of the result."""
    entries: list[Mapping[str, Any]] = []
    for one in planned:
        writes = {row.name for row in one.effect.parameters if row.kind == "output"}
        given = {name: value for name, value in one.given.items() if name not in writes}
        entries.append({"effect": one.effect.name, **given})
    return json.dumps(entries)
