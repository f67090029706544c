"""All that draws lets the server and the browser go first."""

from __future__ import annotations

import subprocess
import sys
import threading

import pytest

from daguerre.rendering import CancelToken
from daguerre.viewfinder.background import in_background

#: Draws as a viewfinder that opens, and checks how nice the threads are that it leaves.
OPENING = """
import os
import numpy.linalg
import daguerre as dg
from daguerre.viewfinder.background import NICE
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.opening import opened
from daguerre.viewfinder.stage import Stage
from tests.viewfinder.test_painter import scene

def threads():
    return {int(name) for name in os.listdir("/proc/self/task")}

made = scene()
before, mine = threads(), os.getpriority(os.PRIO_PROCESS, 0)
settings = dg.RenderSettings.of(resolution=(120, 80), spp=8, threads=2)
dials, _ = opened(Stage(made, made.camera(), settings), Dials())
assert dials.texts["exposure"] == "manual", dials
new = threads() - before
assert new
found = {one: os.getpriority(os.PRIO_PROCESS, one) for one in new}
assert set(found.values()) == {min(mine + NICE, 19)}, found
assert os.getpriority(os.PRIO_PROCESS, 0) == mine
"""


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no priority of threads")
def test_threads_that_meter_yield_to_others() -> None:
    pytest.importorskip("simplejpeg", reason="needs the extra view")
    done = subprocess.run([sys.executable, "-c", OPENING], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_what_the_work_raises_is_raised() -> None:
    with pytest.raises(ZeroDivisionError):
        in_background(lambda: 1 // 0)


def test_an_interrupt_cancels_the_work(monkeypatch: pytest.MonkeyPatch) -> None:
    token, begun = CancelToken(), threading.Event()
    monkeypatch.setattr("daguerre.viewfinder.background.CancelToken", lambda: token)
    ended = []

    def work() -> None:
        begun.set()
        while not token.cancelled:
            pass
        ended.append(True)

    def interrupted(*_: object) -> None:
        assert begun.wait(10)
        raise KeyboardInterrupt

    monkeypatch.setattr("concurrent.futures.Future.result", interrupted)
    with pytest.raises(KeyboardInterrupt):
        in_background(work)
    assert ended == [True]
