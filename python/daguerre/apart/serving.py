"""Runs tasks in the helper in turn, until the connection closes."""

from __future__ import annotations

import contextlib
import ctypes
import gc
import importlib
import itertools
import socket
import threading
import traceback
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any

from daguerre.errors import (
    DaguerreError,
    InputError,
    MismatchError,
    OutputError,
    UsageError,
)
from daguerre.files.packing import pack, unpack

from .link import ANSWER, ERROR, FAULT, HEARD, READY, TASK, TOLD, DamagedError, Link

#: Classes of errors that cross, by name.
ERRORS = {kind.__name__: kind for kind in (InputError, UsageError, MismatchError, OutputError)}
_telling = threading.Lock()  # any thread of a task may send a text


@dataclass(frozen=True)
class Owned:
    """Result of a task with arrays in the memory of an object, which is kept until they are sent.

    Attributes:
        value: Plain values and arrays.
        owner: The object.
    """

    value: Any
    owner: Any


def serve(end: socket.socket, needed: Callable[[], AbstractContextManager[None]]) -> None:
    """Runs tasks until the other end closes.

    Args:
        end: Connection to the parent.
        needed: Context in which this process ends at once when the parent ends.
    """
    end.setblocking(True)
    link = Link(end)
    link.send(READY, [])
    with contextlib.suppress(EOFError, ConnectionError):
        while True:
            kind, blocks = link.receive(lambda: float("inf"))
            if kind == TASK:
                with needed():
                    kind, answer, owner = _answer(link, blocks)
                link.send(kind, answer)
                del blocks, answer  # before their owner, which would copy arrays still in use
                del owner
                gc.collect()  # so that libraries close their files
                _trim()


def _trim() -> None:
    """Gives freed memory back to the system, where the C library can; else it counts as worn."""
    with contextlib.suppress(AttributeError, OSError):
        ctypes.CDLL(None).malloc_trim(0)


def _answer(link: Link, blocks: list[Any]) -> tuple[bytes, list[Any], Any]:
    """Runs a task and returns the message that answers it, and the owner of its arrays."""
    try:
        name, request = unpack(bytes(blocks[0]), lambda number: blocks[int(number)])
        found = _function(name)(request, lambda text: _tell(link, text))
        value, owner = (found.value, found.owner) if isinstance(found, Owned) else (found, None)
        return ANSWER, packed(value), owner
    except DaguerreError as error:
        kind = next(
            base for base in type(error).__mro__ if base in (*ERRORS.values(), DaguerreError)
        )
        name = kind.__name__ if kind.__name__ in ERRORS else InputError.__name__
        return ERROR, [_bytes(name), _bytes(str(error))], None
    except Exception as error:
        words = " ".join(str(error).split())
        told = [
            *(_bytes(type(error).__name__), _bytes(words)),
            _bytes("".join(traceback.format_exception(error))),
        ]
        return FAULT, told, None


def packed(value: object) -> list[Any]:
    """Blocks of a message: a packed value, and its large arrays, by the number of their block."""
    numbers = itertools.count(1)
    made = pack(value, lambda array: str(next(numbers)))
    return [made.data, *(made.large[name] for name in sorted(made.large, key=int))]


def _function(name: str) -> Any:
    module, _, function = name.partition(":")
    return getattr(importlib.import_module(module), function)


def _tell(link: Link, text: str) -> None:
    """Sends a text and waits for the reply: the parent has set new limits by then."""
    with _telling:
        link.send(TOLD, [_bytes(text)])
        kind, _ = link.receive(lambda: float("inf"))
        if kind != HEARD:
            raise DamagedError("a text is not heard")


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogateescape")
