"""Passes drawn in parts, by way of files, in the form that `daguerre merge` finds."""

from __future__ import annotations

from pathlib import Path

from daguerre.rendering.passes import Pass, pass_of, read_pass, write_pass
from daguerre.rendering.session import Session


def through_files(folder: Path, *drawn: Session) -> list[Pass]:
    """The pass of each session, written to the folder and read again."""
    files = [folder / f"{i}.exr" for i in range(len(drawn))]
    for file, session in zip(files, drawn, strict=True):
        write_pass(file, session.frame(), pass_of(session))
    return [read_pass(file) for file in files]
