"""Render settings: one record, in groups, with all parameters except scene and camera.

A ``RenderSettings`` has plain values and is checked once: it can be compared, printed, pickled, and
converted to and from JSON.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any

from daguerre.argument_checks import guarded
from daguerre.camera.overscan import Overscan
from daguerre.checks import short, shown
from daguerre.errors import UsageError, suggest
from daguerre.files.value import Value

from .adaptive import MAX_SPP
from .diffraction import Diffraction, with_bands
from .parameters import DEFAULT, DEFAULT_SPP, TABLE, THREADS
from .pixels import CropLike
from .rules import Named, check_together
from .truth import GT_RAYS

OverscanLike = Overscan | str | float | tuple[int, int, int, int]


class _Group:
    """A group of settings, each checked by the table."""

    def __post_init__(self) -> None:
        for name in names_in(type(self)):
            object.__setattr__(self, name, TABLE[name].check(getattr(self, name), name))


@dataclass(frozen=True)
class Sampling(_Group):
    """Sampling: number of samples, pixel filter and random numbers."""

    spp: int | None = DEFAULT["spp"]
    noise: float | None = DEFAULT["noise"]
    seed: int = DEFAULT["seed"]
    filter: str = DEFAULT["filter"]

    @property
    def most(self) -> int:
        """Samples of each pixel; with ``noise`` the maximum."""
        return self.spp or (DEFAULT_SPP if self.noise is None else MAX_SPP)


@dataclass(frozen=True)
class Film(_Group):
    """Film: the pixels that are drawn, and the channels that are kept."""

    resolution: tuple[int, int] = DEFAULT["resolution"]
    crop: CropLike | None = DEFAULT["crop"]
    overscan: OverscanLike | None = DEFAULT["overscan"]
    aovs: bool = DEFAULT["aovs"]
    halves: bool = DEFAULT["halves"]
    cryptomatte: str | Sequence[str] = DEFAULT["cryptomatte"]
    cryptomatte_ranks: int = DEFAULT["cryptomatte_ranks"]
    bands: int = DEFAULT["bands"]


@dataclass(frozen=True)
class Light(_Group):
    """Light transport: kinds, numbers and lengths of paths."""

    max_depth: int = DEFAULT["max_depth"]
    light_paths: str | float | tuple[float, float] = DEFAULT["light_paths"]
    flare: str | float = DEFAULT["flare"]
    flare_order: int = DEFAULT["flare_order"]
    flare_highlights: bool | str = DEFAULT["flare_highlights"]
    scatter: str | float = DEFAULT["scatter"]
    diffraction: bool | Diffraction = DEFAULT["diffraction"]


@dataclass(frozen=True)
class Backdrop(_Group):
    """Background of the picture, and glass in front of it."""

    background: str = DEFAULT["background"]
    see_through: bool = DEFAULT["see_through"]


@dataclass(frozen=True)
class Truth(_Group):
    """Ground truth: its moment and its rays."""

    gt_time: str | None = DEFAULT["gt_time"]
    gt_lens: str = DEFAULT["gt_lens"]
    gt_rays: int | None = DEFAULT["gt_rays"]
    motion: bool = DEFAULT["motion"]

    @property
    def moment(self) -> str | None:
        """Moment of ground truth; motion and means use mid-exposure if none is given."""
        asked = self.motion or self.gt_lens == "mean"
        return self.gt_time or ("mid" if asked else None)

    @property
    def rays(self) -> int:
        """Number of rays per pixel."""
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
    """Settings of a render.

    Attributes:
        sampling: Samples: spp, noise, seed, filter.
        film: Pixels: resolution, crop, overscan, aovs, halves, cryptomatte, bands.
        light: Light transport: max_depth, light_paths, flare, scatter, diffraction and more.
        backdrop: Background of the scene: background, see_through.
        truth: Ground truth: gt_time, gt_lens, gt_rays, motion.
        reference: Switches for checks: strategy, technique, dispersion.
        threads: Number of threads; 0: all cores.

    Raises:
        UsageError: A value is out of its range, or excludes another.
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
    def of(cls, **values: object) -> RenderSettings:
        """Makes settings from parameters by name, of any group."""
        return cls().with_(**values)

    def with_(self, **changes: object) -> RenderSettings:
        """Returns a copy with some parameters changed, by name."""
        refuse_unknown(changes, TABLE, "settings", TypeError)
        groups: dict[str, Any] = {
            group: replace(getattr(self, group), **given)
            for group, kind in GROUPS.items()
            if (given := {name: changes[name] for name in names_in(kind) if name in changes})
        }
        groups["threads"] = changes.get("threads", self.threads)
        return replace(self, **groups)

    def values(self) -> dict[str, Any]:
        """All parameters by name."""
        found = {
            n: getattr(getattr(self, g), n) for g, kind in GROUPS.items() for n in names_in(kind)
        }
        return {**found, "threads": self.threads}

    @classmethod
    def read(cls, values: Mapping[str, Any], named: Named) -> RenderSettings:
        """Makes settings from parameters by name; ``named`` names them in messages."""
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
        """Diffraction settings, with the bands that the film keeps; None: off."""
        asked = self.light.diffraction
        return with_bands(asked, self.film.bands) if isinstance(asked, Diffraction) else None

    def to_json(self) -> dict[str, Any]:
        """Converts the settings to JSON values, by group."""
        found = asdict(self)
        if isinstance(self.film.overscan, Overscan):
            found["film"]["overscan"] = str(self.film.overscan)
        return found

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> RenderSettings:
        """Makes settings from the result of ``to_json``; missing values have their defaults.

        Raises:
            UsageError: Unknown group or parameter, or a value out of its range.
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


def names_in(group: type[Any]) -> tuple[str, ...]:
    """Names of the parameters of a group."""
    return tuple(item.name for item in fields(group))


def refuse_unknown(
    given: object, known: Iterable[str], where: str, error: type[Exception] = UsageError
) -> None:
    """Refuses unknown names, and values that are not mappings."""
    if not isinstance(given, Mapping):
        raise error(f"{where}: wanted parameters by name, got {short(given)}")
    names = list(known)
    for name in given:
        if name not in names:
            raise error(f"{where}: no parameter {short(name)}{suggest(short(name), names)}")
