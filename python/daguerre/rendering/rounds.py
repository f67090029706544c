"""Rounds of adaptive sampling: which pixels are drawn how often next."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from daguerre.errors import MismatchError

from .adaptive import DARK, PARTS, START, Round, check_noise, next_counts, noise_of

if TYPE_CHECKING:
    from .session import Session


#: How many times better than its samples a picture may become: beyond that nobody asks the judge,
#: who needs seconds. (Denoising was measured to make it up to 10 times better.)
HOPE = 16.0

#: Relative error that the picture of a session will have; None: it cannot know.
Judge = Callable[["Session"], float | None]


def rounds(session: Session, noise: float, spp: int | None = None) -> Iterator[Round]:
    """Draws round after round, and yields each, until the noise or ``spp`` is reached."""
    noise, ceiling = check_noise(noise, spp)
    while plan_round(session, noise, ceiling):
        session.draw_round(PARTS)
        assert session.round is not None
        yield session.round


def plan_round(session: Session, noise: float, ceiling: int, judge: Judge | None = None) -> bool:
    """Decides what is drawn next, unless a round is under way.

    Args:
        session: Session that draws.
        noise: Wanted relative error.
        ceiling: Most samples of a pixel.
        judge: Says what error the picture will have, where something comes after the samples.

    Returns:
        False if nothing: the noise is reached, or no pixel may have more.
    """
    if session.round is not None and not session.round.complete:
        return True
    counts = session.sample_counts()
    if session.round is None and session.ranges not in ([], [(0, int(counts.min()))]):
        raise MismatchError(f"noise: wanted samples from 0 on, got {session.ranges}")
    start = min(START, ceiling)
    if counts.min() < start:
        first = np.maximum(counts, np.uint32(start)) - counts
        session.round = Round(counts, first, expected=float(min(4 * START, ceiling)))  # a guess
        return True
    variance = session.relative_variance(DARK)
    reached = noise_of(variance, counts)
    if judge is not None and noise < reached < HOPE * noise:
        reached = min(reached, judge(session) or reached)
    more, expected = np.zeros_like(counts), float(counts.mean())
    if reached > noise:
        more, expected = next_counts(variance, counts, (noise / reached) ** 2, ceiling)
    session.round = Round(counts, more, 0 if more.any() else PARTS, reached, expected)
    return bool(more.any())
