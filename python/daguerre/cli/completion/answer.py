"""Answers to a TAB: words and files that can stand at the cursor of a command line."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

from .placeholder import Takes, takes

TABLE = Path(__file__).parent / "words.json"
#: Stands for the program itself among the commands of a flag; a flag of none is one of all.
PROGRAM = "-"
#: Words that redirect to or from a file.
REDIRECT = ("<", ">")


class Answer(NamedTuple):
    """Words and files that can stand at the cursor.

    Attributes:
        kept: Beginning of the word at the cursor that stays, such as ``--lens=``.
        typed: Rest of the word, which is completed.
        words: Words that begin so, with their meaning.
        suffixes: Suffixes of files that may follow; none: all files; None: no files.
        folders: Whether folders alone may follow.
    """

    kept: str = ""
    typed: str = ""
    words: tuple[tuple[str, str], ...] = ()
    suffixes: tuple[str, ...] | None = None
    folders: bool = False


class _Flag(NamedTuple):
    """Row of a flag in the table."""

    names: list[str]
    takes: str | None
    help: str
    again: bool
    of: list[str]


class _Read(NamedTuple):
    """Words between a command and the cursor: flags, a last flag without value, arguments."""

    given: list[_Flag]
    arguments: int
    open: _Flag | None
    ended: bool


def answer(before: list[str], current: str) -> Answer:
    """Finds what can stand at the cursor.

    Args:
        before: Words before the word at the cursor, without the name of the program.
        current: Part of the word at the cursor, up to the cursor.
    """
    if before and before[-1] in REDIRECT:
        return Answer("", current, suffixes=())
    table = json.loads(TABLE.read_text("utf-8"))
    name = next((word for word in before if not word.startswith("-")), "")
    command = table["commands"].get(name)
    flags = [_flag(row) for row in table["flags"]]
    flags = [flag for flag in flags if (name or PROGRAM) in flag.of or not flag.of]
    if not name:
        lines = {word: one["line"] for word, one in table["commands"].items()}
        return _flags(flags, [], current) if current[:1] == "-" else _words(lines, current)
    if command is None:
        return Answer(typed=current)
    return _of_command(command, flags, before[before.index(name) + 1 :], current, table["kinds"])


def _of_command(
    command: dict[str, Any], flags: list[_Flag], words: list[str], current: str, kinds: Any
) -> Answer:
    """Answers inside a command: a value of a flag, a flag, or an argument."""
    by_name = {name: flag for flag in flags for name in flag.names}
    read = _read(words, by_name)
    if read.open is not None:
        return _value(takes(read.open.takes or "", kinds), "", current)
    if current.startswith("-") and not read.ended:
        kept, flag = _attached(current, by_name)
        if flag is not None:
            return _value(takes(flag.takes or "", kinds), kept, current.removeprefix(kept))
        return _flags(flags, read.given, current)
    wanted = _argument(command["takes"], read.arguments)
    if wanted is None and not current and not read.ended:
        return _flags(flags, read.given, current)
    return _value(takes(wanted or "", kinds), "", current)


def _read(words: list[str], by_name: dict[str, _Flag]) -> _Read:
    """Reads the words between a command and the cursor."""
    given: list[_Flag] = []
    arguments, open_flag, ended = 0, None, False
    for word in words:
        if open_flag is not None:
            open_flag = None
        elif word == "--":
            ended = True
        elif word.startswith("-") and not ended:
            flag = by_name.get(word) or _attached(word, by_name)[1]
            given += [flag] if flag else []
            open_flag = flag if flag and flag.takes is not None and word in flag.names else None
        else:
            arguments += 1
    return _Read(given, arguments, open_flag, ended)


def _attached(word: str, by_name: dict[str, _Flag]) -> tuple[str, _Flag | None]:
    """Beginning and flag of a word that holds its value, too: ``--res=8x6`` or ``-oFILE``."""
    name, equals, _ = word.partition("=")
    if equals and name in by_name:
        return name + equals, by_name[name]
    short = by_name.get(word[:2]) if len(word) > 2 else None
    return word[:2], short if short and short.takes is not None else None


def _argument(placeholders: list[str], count: int) -> str | None:
    """Placeholder of an argument after ``count`` others; None: there are no more."""
    if count < len(placeholders):
        return placeholders[count]
    last = placeholders[-1] if placeholders else ""
    return last if last.endswith("...") else None


def _value(wanted: Takes, kept: str, typed: str) -> Answer:
    """Answers with values of a flag or an argument."""
    word, colon, _ = typed.partition(":")
    if colon and word in wanted.keys:
        return _keys(wanted.keys[word], kept, typed)
    words = wanted.words
    if wanted.several:
        done, comma, rest = typed.rpartition(",")
        kept, typed = kept + done + comma, rest
        words = tuple(one for one in words if one not in done.split(","))
    known = dict.fromkeys(words, "")
    found = _words(known, typed, kept)
    return found._replace(suffixes=wanted.suffixes, folders=wanted.folders)


def _keys(keys: list[str], kept: str, typed: str) -> Answer:
    """Answers with keys of a word, as in ``glow:strength=``."""
    cut = max(typed.rfind(":"), typed.rfind(",")) + 1
    used = {part.partition("=")[0] for part in typed[:cut].partition(":")[2].split(",")}
    known = {f"{key}=": "" for key in keys if key not in used}
    return _words(known, typed[cut:], kept + typed[:cut])


def _flags(flags: list[_Flag], given: list[_Flag], current: str) -> Answer:
    """Answers with flags that were not given, or may be repeated."""
    left = [flag for flag in flags if flag.again or flag not in given]
    names = {
        name: flag.help
        for flag in left
        for name in flag.names
        if name.startswith("--") or name == current
    }
    return _words(names, current)


def _words(known: dict[str, str], typed: str, kept: str = "") -> Answer:
    return Answer(kept, typed, tuple(item for item in known.items() if item[0].startswith(typed)))


def _flag(row: dict[str, Any]) -> _Flag:
    names, of = row["names"].split(), row["of"].split()
    return _Flag(names, row.get("takes"), row["help"], row.get("again", False), of)
