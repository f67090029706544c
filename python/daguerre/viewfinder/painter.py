"""Painter: draws the newest wish, first small and grainy, then better until it rests."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, wait
from typing import Any

from daguerre.rendering import Cancelled, CancelToken

from .background import background_thread, under
from .drawn import Drawn, Wish
from .work import Work

#: Longest time between two wishes of a user who keeps turning, s.
TURNING_S = 0.5
#: How long the painter waits for the next wish of such a user, before it draws a better picture, s.
WAIT_S = 0.03


class Painter:
    """Two threads: one draws, the other takes wishes and shows pictures.

    The newest wish ends the work on those before, unless it asks for the same light.

    Args:
        show: Called in a thread of the painter with each picture.
        fail: Called there with a wish that cannot be drawn, and the reason.
        ready: Called there when a picture of a wish is drawn, before it is shown: the next wish may
            come while the picture is developed.
    """

    def __init__(
        self,
        show: Callable[[Drawn], None],
        fail: Callable[[Wish, Exception], None],
        ready: Callable[[Wish], None] = lambda _: None,
    ) -> None:
        self._show, self._fail, self._ready = show, fail, ready
        self._changed = threading.Condition()
        self._wish: Wish | None = None  # next wish
        self._taken: Wish | None = None  # previous wish
        self._taken_at = -TURNING_S  # time at which the previous wish came, s
        self._keeps_turning = False  # whether the user keeps turning a dial
        self._token = CancelToken()
        self._closed = False
        self._work: Work | None = None
        self._pictures: Iterator[Drawn] = iter(())
        self._hand = background_thread("viewfinder hand")
        self._thread = threading.Thread(target=self._run, name="viewfinder painter", daemon=True)
        self._thread.start()

    def wish(self, wish: Wish) -> None:
        """Asks for a picture, instead of all before."""
        with self._changed:
            self._wish = wish
            if self._taken is None or not wish.is_lit_as(self._taken):
                self._token.cancel()
            self._changed.notify()

    def rest(self) -> None:
        """Ends the work on the wish, and draws nothing until the next wish."""
        with self._changed:
            self._wish = None
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
        while (wish := self._next()) is not None:
            try:
                with self._token:
                    for drawn in self._begun(wish):
                        self._token.throw_if_cancelled()
                        self._ready(drawn.wish)
                        self._show(drawn)
                        self._wait_for_turn()
            except Cancelled:
                self._work = None  # its sums are torn
            except Exception as error:  # whatever it is, the next wish is drawn
                self._work = None
                assert self._taken is not None
                self._fail(self._taken, error)

    def _next(self) -> Wish | None:
        """Waits for a wish; None: the painter was closed."""
        with self._changed:
            while self._wish is None and not self._closed:
                self._changed.wait()
            self._token = CancelToken()
            return None if self._closed else self._take()

    def _take(self) -> Wish | None:
        now = time.monotonic()
        self._keeps_turning, self._taken_at = now - self._taken_at < TURNING_S, now
        self._taken, self._wish = self._wish, None
        return self._taken

    def _wait_for_turn(self) -> None:
        """Waits while the user keeps turning: a better picture would delay the next turn's."""
        with self._changed:
            if self._keeps_turning:
                self._changed.wait_for(lambda: self._wish is not None or self._closed, WAIT_S)
                self._keeps_turning = False
        self._token.throw_if_cancelled()

    def _begun(self, wish: Wish) -> Iterator[Drawn]:
        """Pictures of a wish, which reuse samples already drawn where they show the same light."""
        if self._work is None or not self._expose(self._work, wish):
            self._work = Work(wish)
            self._pictures = self._work.pictures(self._do)
        return self._pictures

    def _expose(self, work: Work, wish: Wish) -> bool:
        fits = work.expose(wish)
        if fits and work.drawn is not None:
            self._show(work.drawn)
        return fits

    def _do(self, step: Callable[[], Any]) -> Any:
        """Does a step in the other thread; meanwhile re-exposes the picture for new wishes."""
        token, work = self._token, self._work
        assert work is not None
        done = self._hand.submit(under, token, step)
        done.add_done_callback(self._wake)
        try:
            while (wish := self._next_during(done)) is not None:
                if not self._expose(work, wish):
                    self._put_back(wish)
        except BaseException:
            token.cancel()
            raise
        finally:
            wait([done])
        token.throw_if_cancelled()
        return done.result()

    def _next_during(self, done: Future[Any]) -> Wish | None:
        """Waits for a wish; None: the step is done, or was cancelled for the wish."""
        with self._changed:
            while self._wish is None and not done.done():
                self._changed.wait()
            return None if self._wish is None or self._token.cancelled else self._take()

    def _put_back(self, wish: Wish) -> None:
        """Ends the work for a wish, unless a newer one came."""
        with self._changed:
            self._wish = self._wish or wish
            self._token.cancel()

    def _wake(self, _: Future[Any]) -> None:
        with self._changed:
            self._changed.notify()
