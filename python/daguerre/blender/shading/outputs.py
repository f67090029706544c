"""Outputs of a node that are computed when they are read."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from daguerre.shading.channels import Value


class Outputs(Mapping[str, Value]):
    """Values by name of the output, each computed once, when something reads it.

    Args:
        makers: Functions that give the values, by name.
    """

    def __init__(self, makers: Mapping[str, Callable[[], Value]]) -> None:
        self._makers = makers
        self._done: dict[str, Value] = {}

    def __getitem__(self, name: str) -> Value:
        if name not in self._done:
            self._done[name] = self._makers[name]()
        return self._done[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)
