"""Parameters of a scene file: ``$name`` in attributes, from ``<default>`` and from the caller."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from daguerre.errors import UsageError

from .ledger import Entry

#: Longest attribute after substitution: parameters in parameters could double it without end.
MAX_LENGTH = 1 << 20
#: Longest name of a default.
MAX_NAME = 200
_NAME = re.compile(r"\w+\Z", re.ASCII)


def defined(define: Iterable[str] | Mapping[str, object] | str) -> dict[str, str]:
    """Values by name, from texts such as ``spp=16`` or from a mapping.

    Raises:
        UsageError: A text has no ``=``, or a name is none.
    """
    if isinstance(define, str):
        define = (define,)
    pairs: list[tuple[str, str]] = []
    if isinstance(define, Mapping):
        pairs = [(str(name), _text(value)) for name, value in define.items()]
    else:
        for text in define:
            name, equals, value = str(text).partition("=")
            if not equals:
                raise UsageError(f"define: wanted name=value, got {text!r}")
            pairs.append((name.strip(), value))
    for name, _ in pairs:
        if not _NAME.match(name):
            raise UsageError(f"define: wanted a name of letters, digits and _, got {name[:40]!r}")
    return dict(pairs)


def _text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


class Parameters:
    """Values of parameters, and which of the caller's were asked for."""

    def __init__(self, given: Mapping[str, str]) -> None:
        self._values = dict(given)
        self._unused = set(given)
        self._lengths = {len(name) for name in given}

    def default(self, name: str, value: str) -> None:
        """Sets a parameter that has no value yet."""
        if name not in self._values:
            self._values[name] = value
            self._lengths.add(len(name))

    def fill(self, text: str, entry: Entry) -> str:
        r"""Text with the values of its parameters; ``\\$`` is a plain ``$``.

        Raises:
            InputError: A parameter has no value, or the text becomes too long.
        """
        if "$" not in text:
            return text
        made, total = [], 0
        first, *rest = re.split(r"(\\?\$)", text)
        for sign, after in zip(["", *rest[::2]], [first, *rest[1::2]], strict=True):
            made.append(self._part(sign, after, entry))
            total += len(made[-1])
            if total > MAX_LENGTH:
                entry.fail(f"too long: the limit is {MAX_LENGTH} characters")
        return "".join(made)

    def _part(self, sign: str, after: str, entry: Entry) -> str:
        """Expands a sign and the longest parameter name after it; keeps the rest of the text."""
        if sign != "$":
            return sign.removeprefix("\\") + after
        for length in sorted(self._lengths, reverse=True):
            name = after[:length]
            if name in self._values:
                self._unused.discard(name)
                return self._values[name] + after[length:]
        name = re.split(r"\W", after, maxsplit=1)[0]
        entry.fail(f"the parameter ${name[:40]} has no value")

    def check_used(self) -> None:
        """Checks that the file has every parameter of the caller.

        Raises:
            UsageError: The file lacks a parameter.
        """
        if self._unused:
            name = min(self._unused)
            raise UsageError(f"define: {name}: the file has no parameter ${name}")
