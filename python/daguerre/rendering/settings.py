"""How a picture is rendered: one record, in groups, which is checked once and travels anywhere.

A ``RenderSettings`` is plain values: it compares, prints, pickles, and goes to and from JSON. Scene
and camera say what is seen; everything else that a picture depends on stands here.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any

from daguerre.camera.overscan import Overscan
from daguerre.checks import short, shown
from daguerre.doors import guarded
from daguerre.errors import UsageError, suggest
from daguerre.files.value import Value

from .adaptive import MAX_SPP
from .diffraction import Diffraction, with_bands
from .parameters import DEFAULT, DEFAULT_SPP, TABLE, THREADS
from .rules import Named, check_together
from .truth import GT_RAYS

OverscanLike = Overscan | str | float | tuple[int, int, int, int]


class _Group:
    """A group of settings: the table checks each of them."""

    def __post_init__(self) -> None:
        for name in names_in(type(self)):
            object.__setattr__(self, name, TABLE[name].check(getattr(self, name), name))


@dataclass(frozen=True)
class Sampling(_Group):
    """Samples: how many, where in the pixel, and their random numbers."""

    spp: int | None = DEFAULT["spp"]
    noise: float | None = DEFAULT["noise"]
    seed: int = DEFAULT["seed"]
    filter: str = DEFAULT["filter"]

    @property
    def most(self) -> int:
        """Samples of each pixel; with ``noise`` the most that one may get."""
        return self.spp or (DEFAULT_SPP if self.noise is None else MAX_SPP)


@dataclass(frozen=True)
class Film(_Group):
    """Pixels: which ones are drawn, and what is kept of each."""

    resolution: tuple[int, int] = DEFAULT["resolution"]
    crop: tuple[int, int, int, int] | None = DEFAULT["crop"]
    overscan: OverscanLike | None = DEFAULT["overscan"]
    aovs: bool = DEFAULT["aovs"]
    halves: bool = DEFAULT["halves"]
    cryptomatte: str | Sequence[str] = DEFAULT["cryptomatte"]
    cryptomatte_ranks: int = DEFAULT["cryptomatte_ranks"]
    bands: int = DEFAULT["bands"]


@dataclass(frozen=True)
class Light(_Group):
    """Light transport: which paths are followed, and how far."""

    max_depth: int = DEFAULT["max_depth"]
    light_paths: str | float | tuple[float, float] = DEFAULT["light_paths"]
    flare: str | float = DEFAULT["flare"]
    flare_order: int = DEFAULT["flare_order"]
    flare_highlights: bool | str = DEFAULT["flare_highlights"]
    scatter: str | float = DEFAULT["scatter"]
    diffraction: bool | Diffraction = DEFAULT["diffraction"]


@dataclass(frozen=True)
class Backdrop(_Group):
    """Background of the scene, and glass before it."""

    background: str = DEFAULT["background"]
    see_through: bool = DEFAULT["see_through"]


@dataclass(frozen=True)
class Truth(_Group):
    """Ground truth: at which moment, and through which rays."""

    gt_time: str | None = DEFAULT["gt_time"]
    gt_lens: str = DEFAULT["gt_lens"]
    gt_rays: int | None = DEFAULT["gt_rays"]
    motion: bool = DEFAULT["motion"]

    @property
    def moment(self) -> str | None:
        """The moment; motion and means without one ask for that of the middle."""
        asked = self.motion or self.gt_lens == "mean"
        return self.gt_time or ("mid" if asked else None)

    @property
    def rays(self) -> int:
        """Rays of each pixel."""
        return 1 if self.gt_lens == "chief" else self.gt_rays or GT_RAYS


@dataclass(frozen=True)
class Reference(_Group):
    """Switches that check one way to render against another."""

    strategy: str = DEFAULT["strategy"]
    technique: str = DEFAULT["technique"]
    dispersion: str = DEFAULT["dispersion"]


@guarded(init=True)
@dataclass(frozen=True)
class RenderSettings(Value):
    """How a picture is rendered.

    Attributes:
        sampling: Samples: spp, noise, seed, filter.
        film: Pixels: resolution, crop, overscan, aovs, halves, cryptomatte, bands.
        light: Light transport: max_depth, light_paths, flare, scatter, diffraction and more.
        backdrop: Background of the scene: background, see_through.
        truth: Ground truth: gt_time, gt_lens, gt_rays, motion.
        reference: Switches for checks: strategy, technique, dispersion.
        threads: Number of threads; 0: all cores.

    Raises:
        UsageError: A value is out of its range, or does not go with another.
    """

    sampling: Sampling = field(default_factory=Sampling)
    film: Film = field(default_factory=Film)
    light: Light = field(default_factory=Light)
    backdrop: Backdrop = field(default_factory=Backdrop)
    truth: Truth = field(default_factory=Truth)
    reference: Reference = field(default_factory=Reference)
    threads: int = THREADS.default

    def __post_init__(self) -> None:
        object.__setattr__(self, "threads", THREADS.check(self.threads, THREADS.name))
        check_together(self.values())

    @classmethod
    def of(cls, **values: Any) -> RenderSettings:
        """Settings by the names of their parameters, whatever group they are in."""
        return cls().with_(**values)

    def with_(self, **changes: Any) -> RenderSettings:
        """A copy with other values, by the names of their parameters."""
        refuse_unknown(changes, TABLE, "settings", TypeError)
        groups: dict[str, Any] = {
            group: replace(getattr(self, group), **given)
            for group, kind in GROUPS.items()
            if (given := {name: changes[name] for name in names_in(kind) if name in changes})
        }
        return replace(self, **groups, threads=changes.get("threads", self.threads))

    def values(self) -> dict[str, Any]:
        """All parameters by name."""
        found = {
            n: getattr(getattr(self, g), n) for g, kind in GROUPS.items() for n in names_in(kind)
        }
        return {**found, "threads": self.threads}

    @classmethod
    def read(cls, values: Mapping[str, Any], named: Named) -> RenderSettings:
        """Settings by the names of their parameters; messages call each as ``named`` does."""
        if isinstance(named, type) and named is not str:
            raise UsageError(f"settings: named: wanted a function, got {shown(named)}")
        for name, value in values.items():
            if name not in TABLE:
                raise UsageError(f"settings: {short(name)}: no such parameter")
            TABLE[name].check(value, named(name))
        check_together({**DEFAULT, **values}, named)
        return cls.of(**values)

    @property
    def diffraction(self) -> Diffraction | None:
        """Diffraction, in the bands that the film keeps; None: light is no wave."""
        asked = self.light.diffraction
        return with_bands(asked, self.film.bands) if isinstance(asked, Diffraction) else None

    def to_json(self) -> dict[str, Any]:
        """The record as JSON's values, by group."""
        found = asdict(self)
        if isinstance(self.film.overscan, Overscan):
            found["film"]["overscan"] = str(self.film.overscan)
        return found

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> RenderSettings:
        """Settings from ``to_json``; groups and values that are absent have their defaults.

        Raises:
            UsageError: A group or parameter that there is not, or a value that it cannot have.
        """
        refuse_unknown(data, (*GROUPS, "threads"), "settings")
        groups: dict[str, Any] = {}
        for group in GROUPS.keys() & data.keys():
            refuse_unknown(data[group], names_in(GROUPS[group]), f"settings: {group}")
            given = dict(data[group])
            if isinstance(given.get("diffraction"), dict):
                refuse_unknown(given["diffraction"], names_in(Diffraction), "settings: diffraction")
                given["diffraction"] = Diffraction(**given["diffraction"])
            groups[group] = GROUPS[group](**given)
        return cls(**groups, threads=data.get("threads", THREADS.default))


GROUPS: dict[str, Any] = {
    "sampling": Sampling, "film": Film, "light": Light, "backdrop": Backdrop, "truth": Truth,
    "reference": Reference,
}  # fmt: skip


def names_in(group: Any) -> tuple[str, ...]:
    """Parameters of a group."""
    return tuple(item.name for item in fields(group))


def refuse_unknown(
    given: Any, known: Iterable[str], where: str, error: type[Exception] = UsageError
) -> None:
    """Refuses names that are none of the known ones, and what has no names."""
    if not isinstance(given, Mapping):
        raise error(f"{where}: wanted parameters by name, got {short(given)}")
    names = list(known)
    for name in given:
        if name not in names:
            raise error(f"{where}: no parameter {short(name)}{suggest(short(name), names)}")
