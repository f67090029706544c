"""Notes of a reader on unsupported features: one sentence each, with a count."""

from __future__ import annotations


class Notes:
    """Counts remarks; ``sentences`` lists each once."""

    def __init__(self) -> None:
        self._counts: dict[str, int] = {}

    def add(self, sentence: str, count: int = 1) -> None:
        """Adds a remark ``count`` times; equal sentences are one remark."""
        self._counts[sentence] = self._counts.get(sentence, 0) + count

    def sentences(self) -> list[str]:
        """Remarks with their counts, in the order of first appearance."""
        return [
            f"{sentence} ({count} {'use' if count == 1 else 'uses'})"
            for sentence, count in self._counts.items()
        ]


class Silence(Notes):
    """Ignores remarks, for content that is read again."""

    def add(self, sentence: str, count: int = 1) -> None:
        """Does nothing."""
