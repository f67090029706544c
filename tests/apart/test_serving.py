"""The helper's side of a task."""

from __future__ import annotations

import contextlib
import socket
import threading

from daguerre.apart.link import ANSWER, READY, TASK, Link
from daguerre.apart.serving import packed, serve

from . import tasks


def test_an_owner_of_arrays_is_kept_until_they_are_sent_and_gone() -> None:
    ours, theirs = socket.socketpair()
    tasks.let_go.clear()
    with theirs:
        server = threading.Thread(target=serve, args=(theirs, contextlib.nullcontext))
        server.start()
        with ours:
            link = Link(ours)
            assert link.receive(lambda: 1e9)[0] == READY
            for _ in range(2):
                link.send(TASK, packed(("tests.apart.tasks:owned", None)))
                kind, blocks = link.receive(lambda: 1e9)
                assert (kind, len(blocks)) == (ANSWER, 4)
        server.join()
    assert tasks.let_go == ["array", "array", "array", "owner"] * 2
