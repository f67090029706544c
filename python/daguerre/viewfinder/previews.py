"""Previews: pictures on the way, denoised beside drawing where that keeps up."""

from __future__ import annotations

import math
import os
import time
from collections import deque
from collections.abc import Callable

from daguerre.errors import DaguerreError
from daguerre.files import extras
from daguerre.frame.frame import Frame
from daguerre.rendering.denoise import MODULE, check_available, preview

from .background import background_thread
from .drawn import Drawn

#: By how much the thread is nicer than the rest: drawing goes first, too.
NICE = 19
#: Longest time to denoise a picture, s: a quarter of the time between two pictures.
MOST_S = 0.25
#: Pause in the previews after a preview that took longer, s.
PAUSE_S = 60.0


class Previews:
    """A thread that denoises the newest picture, at most once per doubling of samples.

    Previews need the extra ``denoise`` and a second core beside the drawing thread's.
    """

    def __init__(self) -> None:
        able = (os.cpu_count() or 1) >= 2 and not extras.missing(MODULE)
        self._pause_end = -math.inf if able else math.inf
        self._turn, self._samples = -1, 0  # of the last preview
        self._newest: deque[tuple[Drawn, Callable[[Frame], None]]] = deque(maxlen=1)
        self._thread = background_thread("viewfinder previews", NICE)

    def offer(self, drawn: Drawn, show: Callable[[Frame], None]) -> None:
        """Takes a picture instead of those before, and returns at once.

        Args:
            drawn: The picture.
            show: Called in the thread with the denoised frame, if the picture is worth it.
        """
        self._newest.clear()
        if drawn.is_one and not drawn.rests and time.monotonic() >= self._pause_end:
            self._newest.append((drawn, show))
            self._thread.submit(self._make)

    def close(self) -> None:
        """Ends the thread and waits for it."""
        self._thread.shutdown(cancel_futures=True)

    def _make(self) -> None:
        try:
            drawn, show = self._newest.pop()
        except IndexError:  # another picture came instead
            return
        if time.monotonic() < self._pause_end:  # the last preview was slow
            return
        if drawn.request.number == self._turn and drawn.samples < 2 * self._samples:
            return
        self._turn, self._samples = drawn.request.number, drawn.samples
        try:
            check_available()  # loads the library, which is not timed
            begun = time.monotonic()
            clean = preview(drawn.frame)
        except DaguerreError:  # the button Denoise says why
            self._pause_end = math.inf
            return
        ended = time.monotonic()
        if ended - begun > MOST_S:
            self._pause_end = ended + PAUSE_S
        show(clean)
