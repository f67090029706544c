"""Messages of workers of a cluster and of pages of the viewfinder: good ones, and their use."""

from __future__ import annotations

import asyncio
import json
import warnings
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any
from zlib import crc32

import daguerre as dg
from daguerre.cluster.answers import Failed, Needs, Sums, answer_of, packed_sums
from daguerre.errors import InputError
from daguerre.files.packing import pack, unpack
from daguerre.rendering.session import Session

#: A file's name and bytes.
Seed = tuple[str, bytes]
_TINY = dg.RenderSettings.of(resolution=(12, 8), spp=2, aovs=True, cryptomatte=("object",))
_CHECKSUM = 4


@lru_cache
def _session() -> Session:
    from .seeds import small_scene

    return Session(small_scene(), dg.Camera(lens_model="pinhole"), settings=_TINY)


def answers(folder: Path) -> Iterator[Seed]:
    """Answers of workers, and packed values."""
    session = _session()
    session.clear()
    session.draw(0, 2)
    facts = {"seconds": 0.5, "rays": 12, "tasks": 1}
    yield "sums.answer", bytes(packed_sums("a:1", session.key, session.state(), facts))
    yield "needs.answer", Needs("a:1", ["x", "y"]).to_bytes()
    yield "failed.answer", Failed("a:1", "no \n such \u2603").to_bytes()
    yield "values.packed", pack((session.scene, _TINY), lambda array: None).data


def with_checksum(data: bytes) -> bytes:
    """An answer whose sums have the right checksum again."""
    line, mark, words = data.partition(b"\n")
    if not mark or len(words) < _CHECKSUM:
        return data
    body = words[:-_CHECKSUM]
    return line + mark + body + crc32(body).to_bytes(_CHECKSUM, "little")


def answered(path: Path) -> None:
    """Uses an answer as the client of a cluster does, or a value as a worker does."""
    data = path.read_bytes()
    if path.suffix == ".packed":
        unpack(data, lambda name: b"")
        return
    found = answer_of(data)
    if isinstance(found, Sums):
        session = _session()
        session.clear()
        found.check_key(session.key)
        session.add(found.parts)
        session.frame()


def requests(folder: Path) -> Iterator[Seed]:
    """Messages of pages."""
    for value in (
        {"turn": {"f_stop": "2", "zoom": None}}, {"turn": {"iso": "400", "focus_distance": "3m"}},
        {"turn": {"lens": "double-gauss-50mm-f2"}}, {"got": 12}, {"probe": [3, 4.5]},
        {"probe": [3, 4, 1]}, {"save": "png"}, {"draw": 16}, {"section": [3, 4.5]},
        {"reload": True}, {"undo": True}, {"redo": True}, {"hold": False}, {"facts": True},
        {"find": "canon zoom"}, {"show": {"tint": "depth"}}, {"show": {"denoised": None}},
        {"photograph": "double-gauss-50mm-f2"}, {"drawing": "fisheye-16mm-f2.8"},
    ):  # fmt: skip
        yield "request.json", json.dumps(value).encode()


class _Page:
    """Connection of a page that keeps nothing."""

    async def send(self, message: str | bytes) -> None:
        """Takes a message."""


class _Viewfinder:
    """A hub with one page, and the internal errors that it told the page."""

    def __init__(self, folder: Path) -> None:
        from daguerre.viewfinder import hub as rooms
        from daguerre.viewfinder.dials import Dials
        from daguerre.viewfinder.stage import Stage
        from tests.viewfinder.test_painter import scene

        made = scene()
        self.faults: list[str] = []
        told = rooms.reason_of

        def reason_of(error: Exception) -> str:
            reason = told(error)
            if reason.startswith("internal error"):
                self.faults.append(reason)
            return reason

        rooms.reason_of = reason_of
        self._loop = asyncio.new_event_loop()
        self._loop.run_until_complete(
            self._begin(rooms, Stage(made, made.camera(), _TINY), Dials, folder)
        )

    async def _begin(self, rooms: Any, stage: Any, dials: Any, folder: Path) -> None:
        self._hub = rooms.Hub(stage, dials(), ["scene.glb"], asyncio.get_running_loop(), folder)
        self._client = self._hub.join(_Page())

    def hear(self, text: str) -> None:
        """Lets the hub act on a message."""
        self._loop.run_until_complete(self._hub.hear(self._client, text))


@lru_cache
def _viewfinder(folder: Path) -> _Viewfinder:
    return _Viewfinder(folder)


def requested(path: Path) -> None:
    """Sends a message to a hub, which acts on it or refuses it."""
    from daguerre.viewfinder.messages import parse

    try:
        text = path.read_bytes().decode()
    except UnicodeDecodeError:
        raise InputError("no text, which the protocol refuses") from None
    viewfinder = _viewfinder(path.parent)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        viewfinder.hear(text)
    if viewfinder.faults:
        raise RuntimeError(viewfinder.faults.pop())
    parse(text)
