"""Rungs: steps of progressive drawing, from small pictures to the full size."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import islice

from daguerre.errors import DaguerreError

from .beside import other_of
from .drawn import PictureRequest
from .reasons import reason_of
from .shot import Shot
from .stage import Stage

#: Divisors of the picture's size, before the whole picture with 1, 2, 4, ... samples.
LADDER = (6, 3)
#: Models of the lens that are compared, side by side, and the divisor of their pictures' size.
MODELS = ("pinhole", "thin", "exact")
BESIDE = 3


@dataclass(frozen=True)
class Rung:
    """Pictures of the same size that are drawn together.

    Attributes:
        shots: A shot, or several to show side by side.
        names: Names of pictures side by side; empty: a single picture.
        last: Whether the rung is drawn with all samples; earlier rungs have one sample per pixel.
        main: Number of the shot at the dials.
        ghosts: Layer of live ghosts of each shot; empty: no layers.
        note: Why the second picture that was asked for is missing.
    """

    shots: tuple[Shot, ...]
    names: tuple[str, ...] = ()
    last: bool = True
    main: int = 0
    ghosts: tuple[Shot, ...] = ()
    note: str = ""

    def is_lit_as(self, other: Rung) -> bool:
        """Whether samples of another rung are samples of this rung, too."""
        if (self.names, len(self.ghosts)) != (other.names, len(other.ghosts)):
            return False
        return all(a.is_lit_as(b) for a, b in zip(self.shots, other.shots, strict=False))


def rungs_of(request: PictureRequest) -> Iterator[Rung]:
    """Rungs of a request; automatic modes meter when theirs is asked for."""
    stage = request.stage
    if request.models:
        shot = stage.exposed(request.shot)
        samples = shot.settings.sampling.most
        shots = tuple(shot.by_model(model, BESIDE, samples) for model in MODELS)
        yield Rung(shots, MODELS, main=len(shots) - 1)
        return
    quick = stage.exposed(request.shot, fresh=False)
    ghosts = () if (layer := quick.ghosts()) is None else (layer,)
    # Exact ghosts take long to set up: a picture on the way must come first, however small.
    known = set() if ghosts else {quick.settings.film.resolution}
    for divisor in LADDER:
        small = quick.smaller(divisor)
        if (size := small.settings.film.resolution) not in known:
            known.add(size)
            yield Rung((small,), last=False, ghosts=ghosts)
    yield Rung((stage.exposed(request.shot),))


def rung_of(request: PictureRequest, index: int) -> Rung:
    """A rung of a request, the last rung if it has fewer."""
    *_, rung = islice(rungs_of(request), index + 1)
    return rung if request.beside is None else _paired(rung, request.stage, request.beside)


def _paired(rung: Rung, stage: Stage, change: Mapping[str, str]) -> Rung:
    """Returns a rung with the picture beside its own, or a note why there is none."""
    try:
        other = other_of(stage, rung.shots[0], change)
    except DaguerreError as error:
        return replace(rung, note=f"No picture beside this one: {reason_of(error)}")
    ghosts = (*rung.ghosts, *(layer.through(other.shot) for layer in rung.ghosts))
    return replace(rung, shots=(*rung.shots, other.shot), names=other.labels, ghosts=ghosts)
