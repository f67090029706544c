"""History: the dials after each step, so that steps can be undone and done again."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

from .dials import Dials

#: Steps that can be undone.
MOST = 64
#: Turns of the same dials that follow each other within this time are one step, s.
PAUSE_S = 1.0


@dataclass(frozen=True)
class History:
    """The dials now, with those before and after.

    Attributes:
        now: The dials.
        past: Dials before each step, oldest first.
        future: Dials after each undone step, the next one last.
        step: Number of the step that led here; None: an undo or redo did.
    """

    now: Dials
    past: tuple[Dials, ...] = ()
    future: tuple[Dials, ...] = ()
    step: int | None = None

    def turned(self, dials: Dials, step: int) -> History:
        """Returns the history after a turn; several turns with one number are one step."""
        if dials == self.now:
            return self
        past = self.past if step == self.step else (*self.past, self.now)
        return History(dials, past[-MOST:], (), step)

    @property
    def undone(self) -> History | None:
        """The history after an undo; None: there is nothing to undo."""
        past = _without_tail(self.past, self.now)
        if not past:
            return None
        return History(past[-1], past[:-1], (*self.future, self.now))

    @property
    def redone(self) -> History | None:
        """The history after a redo; None: nothing was undone."""
        if not self.future:
            return None
        return History(self.future[-1], (*self.past, self.now), self.future[:-1])

    def without(self, dials: Dials) -> History:
        """Returns the history without dials that cannot be drawn."""
        past = tuple(one for one in self.past if one != dials)
        future = tuple(one for one in self.future if one != dials)
        return replace(self, past=past, future=future)


def _without_tail(past: tuple[Dials, ...], now: Dials) -> tuple[Dials, ...]:
    """Drops the last steps that changed nothing, as when a ring is turned and turned back."""
    while past and past[-1] == now:
        past = past[:-1]
    return past


class Steps:
    """Numbers of steps: turns of the same dials without a pause, or in a gesture, share a step."""

    def __init__(self) -> None:
        self._number = 0
        self._names: frozenset[str] = frozenset()
        self._last_s = 0.0
        self._held_s: float | None = None

    def of_turn(self, names: Collection[str], now_s: float) -> int:
        """Number of the step that a turn of dials at a time belongs to."""
        goes_on = now_s - self._last_s <= PAUSE_S
        in_gesture = self._held_s is not None and self._held_s <= self._last_s
        if self._names != frozenset(names) or not (goes_on or in_gesture):
            self._number += 1
            self._names = frozenset(names)
        self._last_s = now_s
        return self._number

    def hold(self, now_s: float) -> None:
        """Begins a gesture, in which pauses do not count."""
        self._held_s = now_s

    def let_go(self, now_s: float) -> None:
        """Ends the gesture; a turn that is still on its way belongs to it."""
        if self._held_s is not None and self._held_s <= self._last_s:
            self._last_s = now_s
        self._held_s = None
