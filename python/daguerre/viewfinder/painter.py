"""Painter: draws the newest request, first small and grainy, then better until it rests."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, wait
from typing import Any

from daguerre.rendering import Cancelled, CancelToken

from .background import background_thread, under
from .drawn import Drawn, PictureRequest
from .work import Work

#: Longest time between two requests of a user who keeps turning, s.
TURNING_S = 0.5
#: Wait for the next request of a user who keeps turning, before a better picture is drawn, s.
WAIT_S = 0.03


class Painter:
    """Two threads: one draws, the other takes requests and shows pictures.

    The newest request ends the work on earlier requests, unless it asks for the same light.

    Args:
        show: Called in a thread of the painter with each picture.
        fail: Called there with a request that cannot be drawn, and the reason.
        ready: Called there when a picture of a request is drawn, before it is shown: the next
            request may come while the picture is developed.
    """

    def __init__(
        self,
        show: Callable[[Drawn], None],
        fail: Callable[[PictureRequest, Exception], None],
        ready: Callable[[PictureRequest], None] = lambda _: None,
    ) -> None:
        self._show, self._fail, self._ready = show, fail, ready
        self._changed = threading.Condition()
        self._request: PictureRequest | None = None  # next request
        self._taken: PictureRequest | None = None  # previous request
        self._taken_at = -TURNING_S  # time at which the previous request came, s
        self._keeps_turning = False  # whether the user keeps turning a dial
        self._token = CancelToken()
        self._closed = False
        self._work: Work | None = None
        self._pictures: Iterator[Drawn] = iter(())
        self._hand = background_thread("viewfinder hand")
        self._thread = threading.Thread(target=self._run, name="viewfinder painter", daemon=True)
        self._thread.start()

    def request(self, request: PictureRequest) -> None:
        """Asks for a picture, instead of all before."""
        with self._changed:
            self._request = request
            if self._taken is None or not request.is_lit_as(self._taken):
                self._token.cancel()
            self._changed.notify()

    def rest(self) -> None:
        """Ends the work on the request, and draws nothing until the next request."""
        with self._changed:
            self._request = None
            self._token.cancel()

    def close(self) -> None:
        """Ends the threads and waits for them."""
        with self._changed:
            self._closed = True
            self._token.cancel()
            self._changed.notify()
        self._thread.join()
        self._hand.shutdown()

    def _run(self) -> None:
        while (request := self._next()) is not None:
            try:
                with self._token:
                    for drawn in self._begun(request):
                        self._token.throw_if_cancelled()
                        self._ready(drawn.request)
                        self._show(drawn)
                        self._wait_for_turn()
            except Cancelled:
                self._work = None  # its sums are torn
            except Exception as error:  # whatever it is, the next request is drawn
                self._work = None
                assert self._taken is not None
                self._fail(self._taken, error)

    def _next(self) -> PictureRequest | None:
        """Waits for a request; None: the painter was closed."""
        with self._changed:
            while self._request is None and not self._closed:
                self._changed.wait()
            self._token = CancelToken()
            return None if self._closed else self._take()

    def _take(self) -> PictureRequest | None:
        now = time.monotonic()
        self._keeps_turning, self._taken_at = now - self._taken_at < TURNING_S, now
        self._taken, self._request = self._request, None
        return self._taken

    def _wait_for_turn(self) -> None:
        """Waits while the user keeps turning: a better picture would delay the next turn's."""
        with self._changed:
            if self._keeps_turning:
                self._changed.wait_for(lambda: self._request is not None or self._closed, WAIT_S)
                self._keeps_turning = False
        self._token.throw_if_cancelled()

    def _begun(self, request: PictureRequest) -> Iterator[Drawn]:
        """Pictures of a request; reuses samples already drawn of the same light."""
        if self._work is None or not self._expose(self._work, request):
            self._work = Work(request)
            self._pictures = self._work.pictures(self._do)
        return self._pictures

    def _expose(self, work: Work, request: PictureRequest) -> bool:
        fits = work.expose(request)
        if fits and work.drawn is not None:
            self._show(work.drawn)
        return fits

    def _do(self, step: Callable[[], Any]) -> Any:
        """Does a step in the other thread; meanwhile re-exposes the picture for new requests."""
        token, work = self._token, self._work
        assert work is not None
        done = self._hand.submit(under, token, step)
        done.add_done_callback(self._wake)
        try:
            while (request := self._next_during(done)) is not None:
                if not self._expose(work, request):
                    self._put_back(request)
        except BaseException:
            token.cancel()
            raise
        finally:
            wait([done])
        token.throw_if_cancelled()
        return done.result()

    def _next_during(self, done: Future[Any]) -> PictureRequest | None:
        """Waits for a request; None: the step is done, or was cancelled for the request."""
        with self._changed:
            while self._request is None and not done.done():
                self._changed.wait()
            return None if self._request is None or self._token.cancelled else self._take()

    def _put_back(self, request: PictureRequest) -> None:
        """Ends the work for a request, unless a newer request came."""
        with self._changed:
            self._request = self._request or request
            self._token.cancel()

    def _wake(self, _: Future[Any]) -> None:
        with self._changed:
            self._changed.notify()
