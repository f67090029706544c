"""Auxiliary channels of a frame: a table of names, units and producers.

A new channel needs a row here and a plane of that name in the core. The flag, the film, ground
truth and pass files read this table.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum


class Source(Enum):
    """Producers of channels."""

    FILM = "means over the samples"
    GUIDES = "means over the samples, for a denoiser"
    TRUTH = "ground truth"
    MEANS = "ground truth of means alone"
    MOTION = "ground truth of two moments"
    STEREO = "depth of a stereo pair"
    EXPOSURE = "exposure of a photograph"
    ALWAYS = "every picture"


#: Producers that depend on scene and camera only, not on the samples.
EXACT = (Source.TRUTH, Source.MEANS, Source.MOTION)


@dataclass(frozen=True)
class Aov:
    """A group of channels that one name selects.

    Attributes:
        name: Name for ``--aov``, and of the channels in files.
        parts: Letters appended to the name for each channel; empty: the name is the channel.
        unit: Unit such as m or px; empty: none.
        sources: Producers; ground truth replaces the film's values where both exist.
        aliases: Other names for ``--aov``.
        frames: For motion: number of frames to the other picture.
    """

    name: str
    parts: str
    unit: str
    sources: tuple[Source, ...]
    aliases: tuple[str, ...] = ()
    frames: int = 0

    @property
    def channels(self) -> tuple[str, ...]:
        """Names in files."""
        return tuple(f"{self.name}.{part}" for part in self.parts) or (self.name,)


#: In the order of messages.
TABLE = (
    Aov("depth", "Z", "m", (Source.FILM, Source.TRUTH)),
    Aov("P", "XYZ", "m", (Source.FILM, Source.TRUTH), ("position",)),
    Aov("N", "XYZ", "", (Source.FILM, Source.TRUTH), ("normal",)),
    Aov("albedo", "RGB", "", (Source.FILM,)),
    Aov("denoise_albedo", "RGB", "", (Source.GUIDES,)),
    Aov("denoise_normal", "XYZ", "", (Source.GUIDES,)),
    Aov("object_id", "", "", (Source.FILM, Source.TRUTH), ("id",)),
    Aov("distance", "Z", "m", (Source.TRUTH,)),
    Aov("material_id", "", "", (Source.TRUTH,)),
    Aov("motion", "UV", "px", (Source.MOTION,), frames=1),
    Aov("motion_back", "UV", "px", (Source.MOTION,), frames=-1),
    Aov("coverage", "Y", "", (Source.MEANS,)),
    Aov("exposure", "Y", "lx s", (Source.EXPOSURE,)),
    Aov("saturated", "", "", (Source.EXPOSURE,)),  # .R and so on, as the sensor's channels are
    Aov("disparity", "X", "px", (Source.STEREO,)),
    Aov("variance", "RGB", "", (Source.ALWAYS,)),
    Aov("samples", "Y", "", (Source.ALWAYS,)),
)


def made_by(*sources: Source) -> Iterator[Aov]:
    """Rows that any of these sources produces."""
    return (row for row in TABLE if any(source in row.sources for source in sources))


def channels_of(*sources: Source) -> tuple[str, ...]:
    """Names in files of the channels that any of these sources produces."""
    return tuple(channel for row in made_by(*sources) for channel in row.channels)


def names_of(*sources: Source) -> tuple[str, ...]:
    """Names of the groups that any of these sources produces."""
    return tuple(row.name for row in made_by(*sources))


#: Rows by each of their names and aliases.
BY_NAME = {name: row for row in TABLE for name in (row.name, *row.aliases)}

#: Names in files: channels of the film, of ground truth at one moment, and of means over time.
FILM_CHANNELS = channels_of(Source.FILM, Source.GUIDES)
TRUTH_CHANNELS = channels_of(Source.TRUTH)
MEANS_CHANNELS = channels_of(Source.TRUTH, Source.MEANS)
#: Groups that only ground truth has: asking for one turns ground truth on.
EXACT_ONLY = tuple(row.name for row in made_by(*EXACT) if Source.FILM not in row.sources)


def channels_named(name: str, there: Iterable[str]) -> list[str]:
    """Channels of a frame by the name of their group, in the order of its row, or by their own."""
    row, known = BY_NAME.get(name), list(there)
    listed = [] if row is None else [channel for channel in row.channels if channel in known]
    return listed or [part for part in known if name in (part, part.partition(".")[0])]
