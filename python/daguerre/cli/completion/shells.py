"""Questions and answers of each shell: ``daguerre __complete SHELL ...``."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence

from .answer import Answer, answer
from .files import files
from .line import split


def complete(arguments: Sequence[str]) -> int:
    """Answers on stdout; whatever goes wrong, it writes nothing: the user is typing."""
    try:
        text = "".join(f"{line}\n" for line in _SHELLS[arguments[0]](*arguments[1:]))
        sys.stdout.buffer.write(text.encode("utf-8", "surrogateescape"))
        sys.stdout.flush()
    except Exception:
        return 1
    return 0


def _bash(breaks: str, text: str) -> list[str]:
    """Options for compopt, then the words; bash adds slashes to folders itself."""
    line = split(text, breaks)
    found = answer(line.before[1:], line.current)
    paths = files(found)
    words = [found.kept + word for word, _ in found.words]
    words += [found.kept + path.removesuffix("/") for path in paths]
    takes_files = found.suffixes is not None or found.folders
    goes_on = len(words) == 1 and words[0].endswith(("=", ":"))
    options = ["-o filenames"] if paths else ["-o default"] if takes_files and not words else []
    options += ["-o nospace"] if goes_on else []
    return [" ".join(options), *(word.removeprefix(line.kept) for word in words)]


def _fish(*words: str) -> list[str]:
    """Words with their meanings."""
    found = answer(list(words[:-1]), split(words[-1], "").current)
    lines = [f"{found.kept}{word}\t{meaning}" for word, meaning in found.words]
    return lines + [found.kept + path for path in files(found)]


def _zsh(*words: str) -> list[str]:
    """Length of the part that stays, the pattern of files, then words with their meanings."""
    found = answer(list(words[:-1]), words[-1])
    lines = [f"{word.replace(':', chr(92) + ':')}:{meaning}" for word, meaning in found.words]
    return [str(len(found.kept)), _pattern(found), *lines]


def _pattern(found: Answer) -> str:
    """Pattern of zsh for files; a slash: folders alone; empty: none."""
    if found.folders:
        return "/"
    if found.suffixes is None:
        return ""
    return f"*.(#i)({'|'.join(s[1:] for s in found.suffixes)})" if found.suffixes else "*"


_SHELLS: dict[str, Callable[..., list[str]]] = {"bash": _bash, "fish": _fish, "zsh": _zsh}
