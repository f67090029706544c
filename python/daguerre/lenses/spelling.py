"""Slips of spelling: a letter too many, missing, wrong, or two in the wrong order."""

from __future__ import annotations


def is_slip(text: str, word: str) -> bool:
    """Whether a text is a word or its start with a typing slip; with two from eight letters on."""
    most = 0 if len(text) < 4 else 1 if len(text) < 8 else 2
    if not most or len(word) < len(text) - most:
        return False
    whole = len(word) <= len(text) + most and distance(text, word) <= most
    return whole or distance(text, word[: len(text)]) <= most


def distance(a: str, b: str) -> int:
    """Number of slips between two words (optimal string alignment)."""
    before: list[int] = []
    last = list(range(len(b) + 1))
    for i, letter in enumerate(a, 1):
        row = [i]
        for j, other in enumerate(b, 1):
            steps = [last[j] + 1, row[j - 1] + 1, last[j - 1] + (letter != other)]
            if i > 1 and j > 1 and letter == b[j - 2] and a[i - 2] == other:
                steps.append(before[j - 2] + 1)
            row.append(min(steps))
        before, last = last, row
    return last[-1]
