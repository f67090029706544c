"""Errors of the core as those of users."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from daguerre.errors import InputError


@contextmanager
def core_errors(where: str) -> Iterator[None]:
    """The core raises plain ``ValueError`` for input that it cannot use."""
    try:
        yield
    except ValueError as error:
        if type(error) is not ValueError:
            raise
        raise InputError(f"{where}: {error}") from error
