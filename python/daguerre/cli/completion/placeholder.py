"""Placeholders of flags and arguments, such as ``LENS|thin|pinhole``, and the words they allow.

Bars separate alternatives. Lower-case alternatives are typed as they are; alternatives in capitals
are names of kinds: some kinds have words or files (``kinds`` in ``words.json``), others are free
text. ``FILE.svg|png`` are files of these suffixes. ``AOV,...`` and ``render,proxy`` are lists, with
commas. ``EFFECT:KEY=VALUE,...`` has keys after its word. Brackets enclose optional parts.
"""

from __future__ import annotations

import re
from typing import Any, NamedTuple

_LITERAL = re.compile(r"[a-z0-9][a-z0-9_-]*")
_BEGUN = re.compile(r"([a-z0-9_-]+:)[A-Z].*")
_SUFFIX = re.compile(r"[A-Z]+(\.[a-z0-9]+)")
_OPTIONAL = re.compile(r"(.*)\[(.*)\]")


class Takes(NamedTuple):
    """Values that a flag or an argument takes, as far as they are known.

    Attributes:
        words: Words that can be typed; a word that ends in ``:`` goes on.
        suffixes: Suffixes of its files; none: all files; None: it takes no files.
        folders: Whether it takes folders alone.
        several: Whether it takes several words, with commas between them.
        keys: Keys that may follow a word, after a colon.
    """

    words: tuple[str, ...] = ()
    suffixes: tuple[str, ...] | None = None
    folders: bool = False
    several: bool = False
    keys: dict[str, list[str]] = {}  # noqa: RUF012 - never changed


def takes(placeholder: str, kinds: dict[str, Any]) -> Takes:
    """Reads a placeholder."""
    found, after_suffix = Takes(), False
    for text in _alternatives(placeholder):
        suffix = _SUFFIX.fullmatch(text)
        if suffix or (after_suffix and _LITERAL.fullmatch(text)):
            one = Takes(suffixes=(suffix[1] if suffix else f".{text}",))
        else:
            one = _one(text, kinds)
        after_suffix = after_suffix or suffix is not None
        found = _either(found, one)
    return found


def _alternatives(placeholder: str) -> list[str]:
    """Parts between the bars that stand outside brackets."""
    text = placeholder if placeholder.endswith(",...") else placeholder.removesuffix("...")
    return re.findall(r"(?:[^|\[]|\[[^\]]*\])+", text)


def _one(text: str, kinds: dict[str, Any]) -> Takes:
    if optional := _OPTIONAL.fullmatch(text):
        head = _one(optional[1], kinds)
        tails = optional[2].removeprefix(":").split("|")
        more = tuple(f"{word}:{tail}" for word in head.words for tail in tails)
        return head._replace(words=head.words + more) if _LITERAL.fullmatch(optional[1]) else head
    if begun := _BEGUN.fullmatch(text):
        return Takes(words=(begun[1],))
    parts = [part for part in text.split(",") if part != "..."]
    noun, colon, _ = parts[0].partition(":")
    if colon and noun in kinds:
        return _kind(kinds[noun])
    found = Takes()
    for part in parts:
        if _LITERAL.fullmatch(part):
            found = _either(found, Takes(words=(part,)))
        elif part in kinds:
            found = _either(found, _kind(kinds[part]))
        else:
            return Takes()
    return found._replace(several="," in text)


def _kind(kind: dict[str, Any]) -> Takes:
    suffixes = kind.get("suffixes")
    return Takes(
        tuple(kind.get("words", ())) or tuple(kind.get("keys", ())),
        None if suffixes is None else tuple(suffixes),
        kind.get("folders", False),
        keys=kind.get("keys", {}),
    )


def _either(a: Takes, b: Takes) -> Takes:
    files = [one.suffixes for one in (a, b) if one.suffixes is not None]
    return Takes(
        a.words + b.words,
        None if not files else () if () in files else tuple(s for one in files for s in one),
        a.folders or b.folders,
        a.several or b.several,
        a.keys | b.keys,
    )
