"""Notes on what a reader did not understand: one sentence each, with a count, never a flood."""

from __future__ import annotations


class Notes:
    """Counts remarks; ``sentences`` gives each once."""

    def __init__(self) -> None:
        self._counts: dict[str, int] = {}

    def add(self, sentence: str, count: int = 1) -> None:
        """Counts a remark ``count`` times more; equal sentences are one remark."""
        self._counts[sentence] = self._counts.get(sentence, 0) + count

    def sentences(self) -> list[str]:
        """Each remark with its count, in the order of first appearance."""
        return [
            f"{sentence} ({count} {'use' if count == 1 else 'uses'})"
            for sentence, count in self._counts.items()
        ]


class Silence(Notes):
    """For what is read again: its remarks have been counted."""

    def add(self, sentence: str, count: int = 1) -> None:
        """Does nothing."""
