"""Rounds of adaptive sampling: plans how many samples each pixel gets next."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from daguerre.errors import MismatchError

from .adaptive import DARK, PARTS, START, Round, check_noise, next_counts, noise_of

if TYPE_CHECKING:
    from .session import Session


#: Largest ratio of noise before and after denoising at which the judge, which takes seconds, is
#: called. (Denoising was measured to reduce the error up to 10 times.)
HOPE = 16.0

#: Function for the relative error of a session's final picture; it returns None if unknown.
Judge = Callable[["Session"], float | None]


def rounds(session: Session, noise: float, spp: int | None = None) -> Iterator[Round]:
    """Draws and yields round after round, until the noise or ``spp`` is reached."""
    noise, ceiling = check_noise(noise, spp)
    while plan_round(session, noise, ceiling):
        session.draw_round(PARTS)
        assert session.round is not None
        yield session.round


def plan_round(session: Session, noise: float, ceiling: int, judge: Judge | None = None) -> bool:
    """Plans the next round, unless a round is under way.

    Args:
        session: Session that draws.
        noise: Target relative error.
        ceiling: Maximum samples of a pixel.
        judge: Function for the error of the final picture, if a step such as denoising follows.

    Returns:
        False if there is nothing to draw: the noise is reached, or all pixels have the maximum.
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
