"""Splits a CODE V sequence file into commands, each with its line."""

from __future__ import annotations

import re
from collections.abc import Iterator

from .text import Line, lines_of

_WORD = re.compile(r"'[^']*'|\"[^\"]*\"|[^\s;]+|;")


def commands(text: str, where: str) -> Iterator[Line]:
    """Yields commands, with the first word in capitals.

    ``!`` begins a comment, ``&`` at the end continues on the next line, ``;`` separates commands,
    and quotes protect text from being split.
    """
    held: list[str] = []
    begin = 0
    for i, raw in enumerate(lines_of(text, where), 1):
        content = _without_comment(raw).rstrip()
        begin = begin if held else i
        goes_on = content.endswith("&")
        held.append(content[:-1] if goes_on else content)
        if not goes_on:
            yield from _split(Line(where, begin, tuple(_WORD.findall(" ".join(held)))))
            held = []
    if held:
        yield from _split(Line(where, begin, tuple(_WORD.findall(" ".join(held)))))


def _without_comment(content: str) -> str:
    if "!" not in content:
        return content
    quote = ""
    for i, c in enumerate(content):
        if quote:
            quote = "" if c == quote else quote
        elif c in "'\"":
            quote = c
        elif c == "!":
            return content[:i]
    return content.split("!", 1)[0] if quote else content


def _split(line: Line) -> Iterator[Line]:
    words: list[str] = []
    for word in (*line.words, ";"):
        if word != ";":
            words.append(word)
        elif words:
            yield Line(line.file, line.number, (words[0].upper(), *words[1:]))
            words = []
