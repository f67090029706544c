"""Zoom and focus positions of a lens: the gaps that change, as its file gives them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from daguerre.argument_checks import guarded
from daguerre.checks import short
from daguerre.errors import suggest
from daguerre.files.json_item import Item, clean

from .errors import LensError
from .reading import flag, member, number


@guarded
@dataclass(frozen=True)
class Configuration:
    """One zoom or focus position of the moving groups. Lengths in mm.

    Attributes:
        name: Name in the file.
        gaps: Thickness after a surface, by the surface's index.
        efl_mm: Focal length that the source states.
        f_number: F-number that the source states.
        object_distance_mm: Distance from the object plane to the first vertex; None: infinity.
        object_to_image_mm: Distance from the object plane to the film; None: infinity.
        stop_semi_diameter: Semi-diameter of the open iris; None: as in the table.
        fitted: Whether the gaps were fitted to the product's closest focus, not printed.
    """

    name: str
    gaps: dict[int, float] = field(default_factory=dict)
    efl_mm: float | None = None
    f_number: float | None = None
    object_distance_mm: float | None = None
    object_to_image_mm: float | None = None
    stop_semi_diameter: float | None = None
    fitted: bool = False

    @property
    def at_infinity(self) -> bool:
        """Whether it is focused at infinity, which makes it a zoom position."""
        return self.object_distance_mm is None and self.object_to_image_mm is None

    @property
    def distance_mm(self) -> float:
        """Object distance from the first vertex or the film, as the file gives it; a sort key."""
        return self.object_to_image_mm or self.object_distance_mm or float("inf")

    def like(self, other: Configuration) -> int:
        """Number of gaps that are the same in another configuration."""
        return sum(other.gaps.get(i) == gap for i, gap in self.gaps.items())


def read_configurations(root: Item, count: int) -> tuple[Configuration, ...]:
    """Configurations of a file with ``count`` surfaces; default: a configuration without gaps."""
    items = root.list_of("configurations")
    return tuple(_configuration(item, count) for item in items) or (Configuration("infinity"),)


def chosen(root: Item, configurations: Sequence[Configuration], name: str | None) -> Configuration:
    """Configuration of that name; the first if None."""
    if name is None:
        return configurations[0]
    for configuration in configurations:
        if configuration.name == name:
            return configuration
    known = [configuration.name for configuration in configurations]
    root.fail(
        f"configurations: no configuration named {short(name)}{suggest(name, known, few=True)}"
    )


def _configuration(item: Item, count: int) -> Configuration:
    to_image = number(item, "object_to_image_m", above=0)
    name = item.get("name")
    return Configuration(
        name=f"{item.key}" if name is None else clean(name.text()),
        gaps=_gaps(item, count),
        efl_mm=number(item, "efl_mm", above=0),
        f_number=number(item, "f_number", above=0),
        object_distance_mm=number(item, "object_distance_mm", above=0),
        object_to_image_mm=None if to_image is None else 1000 * to_image,
        stop_semi_diameter=number(item, "stop_semi_diameter", above=0),
        fitted=flag(item, "fitted"),
    )


def _gaps(item: Item, count: int) -> dict[int, float]:
    out: dict[int, float] = {}
    gaps = member(item, "gaps")
    for gap in gaps.members() if gaps else []:
        key = str(gap.key)
        if not key.isdecimal() or int(key) >= count:
            gap.fail(f"wanted the index of a surface, 0 to {count - 1}, got {short(key)}")
        value = gap.number(-1e5, 1e5)
        if value < 0 and int(key) < count - 1:
            raise LensError(
                f"{gap.file}: {gap.path}: wanted at least 0 mm after surface {key}, got {value:g}",
                "lens-overlap",
                int(key),
            )
        out[int(key)] = value
    return out
