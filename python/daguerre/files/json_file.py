"""JSON files of libraries, with checks of schema and members; errors name the place."""

from __future__ import annotations

from collections.abc import Callable, Collection
from pathlib import Path
from typing import TypeVar

from daguerre.errors import DaguerreError, InputError, suggest

from .json_item import Item, short
from .json_text import parse
from .reading import read_bytes

Made = TypeVar("Made")
MAX_BYTES = 16_000_000


def read_json_file(
    path: str | Path, schema: str, members: Collection[str], make: Callable[[Item], Made]
) -> Made:
    """Reads a library file and makes its object.

    Args:
        path: The file.
        schema: Schema that the file must name.
        members: Members that its JSON object may have.
        make: Function that makes the result from the JSON object.

    Raises:
        InputError: The file cannot be used; the message names file and JSON path.
    """
    path = Path(path)
    return checked_json(read_bytes(path, MAX_BYTES), str(path), schema, members, make)


def checked_json(
    data: bytes, where: str, schema: str, members: Collection[str], make: Callable[[Item], Made]
) -> Made:
    """Makes an object from the bytes of a library file; see :func:`read_json_file`.

    Args:
        data: The bytes.
        where: The file, for messages.
        schema: Schema that the bytes must name.
        members: Members that the JSON object may have.
        make: Function that makes the result from the JSON object.

    Raises:
        InputError: The bytes cannot be used.
    """
    root = parse(data, where)
    named = root.need("schema")
    if named.value != schema:
        named.fail(f"wanted {schema!r}, got {short(named.value)}")
    for member in root.members():
        if member.key not in members:
            member.fail(f"unknown member{suggest(str(member.key), members, few=True)}")
    try:
        return make(root)
    except DaguerreError as error:
        text = str(error)
        raise InputError(text if text.startswith(where) else f"{where}: {text}") from None
