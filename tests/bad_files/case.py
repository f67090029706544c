"""Cases of bad files: how each is made, the command that meets it, and how that must end."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.support.formats.make_gltf import Builder

#: 1 sample of 16 x 9 pixels, under a sky, so that whatever is seen has light to show.
DRAW = ("-o", "{out}.exr", "--spp", "1", "--res", "16x9", "--threads", "1")
SCENE = ("render", "{bad}", *DRAW, "--sky", "1,1,1")

Change = Callable[[Builder], Any]


@dataclass(frozen=True)
class Case:
    """One bad file.

    Attributes:
        name: Unique; the name of its folder.
        make: Writes the file, and what it needs, into an empty folder; returns its path.
        error: Error behind the file's name, a regular expression; if empty, a
            picture is drawn.
        warning: Warning then, a regular expression; if empty, there is none.
        code: The exit code of an error.
        command: Words of the command line; ``{bad}``, ``{folder}`` and ``{out}`` are filled in.
    """

    name: str
    make: Callable[[Path], Path]
    error: str = ""
    warning: str = ""
    code: int = 3
    command: tuple[str, ...] = SCENE

    def words(self, bad: Path, out: Path) -> list[str]:
        """The command line, for a file made by ``make`` and the stem of outputs."""
        return [w.format(bad=bad, folder=bad.parent, out=out) for w in self.command]


def scenes(
    theme: str, cases: dict[str, tuple[Change, str]], base: Callable[[], Builder]
) -> list[Case]:
    """Cases that change a good scene: name -> (change, error)."""

    def maker(change: Change) -> Callable[[Path], Path]:
        def make(folder: Path) -> Path:
            b = base()
            change(b)
            return b.glb(folder / "bad.glb")

        return make

    return [Case(f"{theme}-{name}", maker(c), error) for name, (c, error) in cases.items()]


def drawn(
    theme: str, cases: dict[str, tuple[Change, str]], base: Callable[[], Builder]
) -> list[Case]:
    """Cases that change a good scene and still give a picture: name -> (change, warning)."""
    return [Case(case.name, case.make, warning=case.error) for case in scenes(theme, cases, base)]


def files(theme: str, name: str, cases: dict[str, tuple[bytes, str]], **more: Any) -> list[Case]:
    """Cases of one file each, all of the same name: name -> (bytes, error)."""

    def maker(data: bytes) -> Callable[[Path], Path]:
        def make(folder: Path) -> Path:
            (folder / name).write_bytes(data)
            return folder / name

        return make

    return [
        Case(f"{theme}-{key}", maker(data), error, **more) for key, (data, error) in cases.items()
    ]


# Changes of a builder ---------------------------------------------------------------------------


def keys_of(path: str) -> list[str | int]:
    """``meshes.0.mode`` as ``["meshes", 0, "mode"]``."""
    return [int(key) if key.isdigit() else key for key in path.split(".")]


def put(path: str, value: Any) -> Change:
    """Sets the JSON value at a path such as ``meshes.0.primitives.0.mode``; ``...`` removes it.

    Objects on the way are made where there are none.
    """

    def change(b: Builder) -> None:
        *keys, last = keys_of(path)
        if keys[:1] == ["buffers"]:
            b.json.setdefault("buffers", [{"byteLength": len(b.binary)}])
        target: Any = b.json
        for key in keys:
            target = target.setdefault(key, {}) if isinstance(target, dict) else target[key]
        if value is ...:
            del target[last]
        elif isinstance(target, list) and last == len(target):
            target.append(value)
        else:
            target[last] = value

    return change


def both(*changes: Change) -> Change:
    """One change after the other."""

    def change(b: Builder) -> None:
        for one in changes:
            one(b)

    return change


def floats(accessor: int, offset: int, value: float) -> Change:
    """Overwrites one float of an accessor's bytes."""

    def change(b: Builder) -> None:
        view = b.json["bufferViews"][b.json["accessors"][accessor]["bufferView"]]
        struct.pack_into("<f", b.binary, view["byteOffset"] + 4 * offset, value)

    return change


def primitive(key: str, make: Callable[[Builder], Any]) -> Change:
    """Sets an attribute, or another member, of the first primitive."""

    def change(b: Builder) -> None:
        target = b.json["meshes"][0]["primitives"][0]
        if key.isupper() or key.endswith(("_0", "_1")):
            target = target["attributes"]
        target[key] = make(b)

    return change


def unique(cases: Iterable[Case]) -> list[Case]:
    """The cases; no name stands twice."""
    found = list(cases)
    names = [case.name for case in found]
    assert len(set(names)) == len(names), sorted(n for n in names if names.count(n) > 1)
    return found
