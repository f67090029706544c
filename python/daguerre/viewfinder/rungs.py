"""Rungs: what is drawn for a wish, one after another: small pictures, then the whole one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

from .drawn import Wish
from .shot import Shot

#: Divisors of the picture's size, before the whole picture with 1, 2, 4, ... samples.
LADDER = (6, 3)
#: Models of the lens that are compared, side by side, and the divisor of their pictures' size.
MODELS = ("pinhole", "thin", "exact")
BESIDE = 3


@dataclass(frozen=True)
class Rung:
    """Pictures that are drawn together.

    Attributes:
        shots: One, or several to show side by side.
        names: Names of those side by side; empty: there is one.
        last: Whether it is drawn with all samples, until it rests; others have one.
    """

    shots: tuple[Shot, ...]
    names: tuple[str, ...] = ()
    last: bool = True

    def is_lit_as(self, other: Rung) -> bool:
        """Whether the samples of another rung show this one, too."""
        pairs = zip(self.shots, other.shots, strict=False)
        return self.names == other.names and all(a.is_lit_as(b) for a, b in pairs)


def rungs_of(wish: Wish) -> Iterator[Rung]:
    """Rungs of a wish; automatic modes meter when theirs is asked for."""
    stage = wish.stage
    if wish.models:
        shot = stage.exposed(wish.shot)
        samples = shot.settings.sampling.most
        shots = tuple(shot.by_model(model, BESIDE, samples) for model in MODELS)
        yield Rung(shots, MODELS)
        return
    quick = stage.exposed(wish.shot, fresh=False)
    known = {quick.settings.film.resolution}
    for divisor in LADDER:
        small = quick.smaller(divisor)
        if (size := small.settings.film.resolution) not in known:
            known.add(size)
            yield Rung((small,), last=False)
    yield Rung((stage.exposed(wish.shot),))


def rung_of(wish: Wish, index: int) -> Rung:
    """One rung of a wish."""
    return next(islice(rungs_of(wish), index, None))
