"""Files that complete a path."""

from __future__ import annotations

import os

from .answer import Answer


def files(answer: Answer) -> list[str]:
    """Paths that begin as typed, folders with a slash at their end.

    Files have a wanted suffix; if there are neither such files nor folders, all files are shown.
    """
    if answer.suffixes is None and not answer.folders:
        return []
    folder, slash, start = answer.typed.rpartition("/")
    try:
        with os.scandir(os.path.expanduser(folder + slash) or ".") as entries:  # noqa: PTH111
            found = sorted((one.name, one.is_dir()) for one in entries if _fits(one.name, start))
    except OSError:
        return []
    names = [name + "/" for name, is_folder in found if is_folder]
    if not answer.folders:
        plain = [name for name, is_folder in found if not is_folder]
        wanted = tuple(answer.suffixes or ("",))
        good = [name for name in plain if name.lower().endswith(wanted)]
        names = sorted(names + good) or plain
    return [folder + slash + name for name in names]


def _fits(name: str, start: str) -> bool:
    """Whether a name is shown: hidden ones only if a dot was typed, odd ones never."""
    return name.startswith(start) and name.isprintable() and (start[:1] == "." or name[0] != ".")
