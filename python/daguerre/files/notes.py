"""Notes of a reader on unsupported features: one sentence each, with a count."""

from __future__ import annotations

from daguerre.checks import short

#: Maximum number of characters of a name.
_LONGEST = 60


class Notes:
    """Counts remarks; ``sentences`` lists each once."""

    def __init__(self) -> None:
        self._counts: dict[str, int] = {}
        self._names: dict[str, str] = {}

    def add(self, sentence: str, count: int = 1, name: str = "") -> None:
        """Adds a remark ``count`` times; equal sentences are one remark.

        Args:
            sentence: The remark.
            count: Number of uses.
            name: Name of the use, such as a file name; the remark gives the first.
        """
        self._counts[sentence] = self._counts.get(sentence, 0) + count
        if name:
            self._names.setdefault(sentence, name)

    def sentences(self) -> list[str]:
        """Remarks with their counts, in the order of first appearance."""
        return [
            f"{sentence} ({self._uses(sentence, count)})"
            for sentence, count in self._counts.items()
        ]

    def _uses(self, sentence: str, count: int) -> str:
        uses = "1 use" if count == 1 else f"{count} uses"
        if sentence not in self._names:
            return uses
        name = self._names[sentence]
        end = name if len(name) <= _LONGEST else f"...{name[-_LONGEST:]}"  # of a path
        return f"{uses}{': ' if count == 1 else ', the first '}{short(end, 2 * _LONGEST)}"


class Silence(Notes):
    """Ignores remarks, for content that is read again."""

    def add(self, sentence: str, count: int = 1, name: str = "") -> None:
        """Does nothing."""
