"""Work of a render, in passes: a range of samples, or rounds until a noise is reached.

Both measure work in mean samples per pixel, so that they are timed and shown in the same way.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from daguerre.errors import MismatchError

from . import rounds
from .ranges import missing_ranges

if TYPE_CHECKING:
    from .adaptive import Round
    from .passes import Pass
    from .rounds import Judge
    from .session import Session


class Work(Protocol):
    """Interface of work to draw."""

    def check(self, saved: Pass) -> None:
        """Refuses a checkpoint from which this work cannot continue."""

    def prepare(self, limit: float) -> float:
        """Plans the next pass, of at most about ``limit`` samples; its size, or 0 at the end."""

    def draw(self, progress: Callable[[float], bool]) -> bool:
        """Draws the planned pass; False: stopped midway."""

    def done(self) -> float:
        """Samples drawn so far."""

    def total(self) -> float:
        """Samples at the end, or an estimate."""

    def facts(self) -> dict[str, Any]:
        """Further values for a ``Status``."""


class Range:
    """Samples [begin, end) of every pixel."""

    def __init__(self, session: Session, wanted: tuple[int, int]) -> None:
        self.session, self.wanted = session, wanted
        self._next = (0, 0)

    def check(self, saved: Pass) -> None:
        """Refuses checkpoints with samples outside of the range."""
        if saved.round is not None:
            raise MismatchError(
                f"{saved.path}: drawn with --noise; continue with --noise, or remove the file"
            )
        begin, end = self.wanted
        for a, b in saved.ranges:
            if a < begin or b > end:
                raise MismatchError(
                    f"{saved.path}: holds samples {a}:{b}, wanted only {begin}:{end}; "
                    f"ask for {min(a, begin)}:{max(b, end)} or remove the file"
                )

    def prepare(self, limit: float) -> float:
        """Plans the next aligned power of two."""
        missing = self._missing()
        if not missing:
            return 0.0
        begin = missing[0][0]
        self._next = begin, begin + pass_size(missing[0], limit)
        return self._next[1] - begin

    def draw(self, progress: Callable[[float], bool]) -> bool:
        """Draws that."""
        return self.session.draw(*self._next, progress)

    def done(self) -> int:
        """Samples of the range that are drawn."""
        return self.total() - sum(b - a for a, b in self._missing())

    def total(self) -> int:
        """Samples of the range."""
        return self.wanted[1] - self.wanted[0]

    def facts(self) -> dict[str, Any]:
        """No further values."""
        return {}

    def _missing(self) -> list[tuple[int, int]]:
        return missing_ranges(self.session.ranges, self.wanted)


class Rounds:
    """Adaptive sampling to a target noise, with at most ``ceiling`` samples per pixel."""

    def __init__(
        self, session: Session, noise: float, ceiling: int, judge: Judge | None = None
    ) -> None:
        self.session, self.noise, self.ceiling, self.judge = session, noise, ceiling, judge
        self._until = 0

    def check(self, saved: Pass) -> None:
        """Accepts checkpoints with rounds, or with samples 0:n of every pixel."""
        if saved.round is None and saved.ranges and (len(saved.ranges) > 1 or saved.ranges[0][0]):
            raise MismatchError(
                f"{saved.path}: holds samples {saved.ranges}; --noise can only continue from 0:N"
            )

    def prepare(self, limit: float) -> float:
        """Plans a part of the round under way, or of the next round."""
        from . import adaptive

        if not rounds.plan_round(self.session, self.noise, self.ceiling, self.judge):
            return 0.0
        now = self._round
        part = float(now.count.mean()) / adaptive.PARTS
        parts = max(1, min(int(limit / part), adaptive.PARTS - now.drawn))
        self._until = now.drawn + parts
        return parts * part

    def draw(self, progress: Callable[[float], bool]) -> bool:
        """Draws that."""
        return self.session.draw_round(self._until, progress)

    def done(self) -> float:
        """Mean samples per pixel."""
        if self.session.round is None:
            return float(sum(b - a for a, b in self.session.ranges))
        return self._round.samples()

    def total(self) -> float:
        """Total samples, as estimated before the round."""
        if self.session.round is None:
            return max(1.0, self.done())
        end = float(self._round.begin.mean() + self._round.count.mean())
        return max(end, self._round.expected)

    def facts(self) -> dict[str, Any]:
        """Noise before this round, and target noise."""
        known = self.session.round is not None and bool(self._round.begin.any())
        return {"noise": self._round.noise if known else None, "noise_wanted": self.noise}

    @property
    def _round(self) -> Round:
        assert self.session.round is not None
        return self.session.round


#: Type of :func:`work_of`, and of its replacements that draw on other machines.
WorkOf = Callable[["Session", tuple[int, int], "float | None", "Judge | None"], Work]


def work_of(
    session: Session, wanted: tuple[int, int], noise: float | None, judge: Judge | None = None
) -> Work:
    """Makes the work: samples [begin, end), or rounds to a noise with at most ``end`` per pixel."""
    return Range(session, wanted) if noise is None else Rounds(session, noise, wanted[1], judge)


def pass_size(missing: tuple[int, int], limit: float) -> int:
    """Size of the next pass: a power of two, aligned to its multiples.

    Args:
        missing: First missing range, [begin, end).
        limit: Maximum samples; the size is at least 1.
    """
    begin, end = missing
    size = 1
    while size * 2 <= limit and begin % (size * 2) == 0:
        size *= 2
    return min(size, end - begin)
