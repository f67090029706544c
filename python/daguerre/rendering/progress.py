"""Progress of a render, as plain numbers that any front end can show."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Status:
    """How far a render is.

    Attributes:
        fraction: Share of the wanted samples that is drawn, 0 .. 1.
        samples: Samples per pixel that are complete.
        samples_wanted: Samples per pixel in the end.
        samples_per_s: Camera samples (all pixels) per second.
        rays_per_s: Rays of all kinds per second.
        elapsed_s: Since this run began to draw.
        left_s: Estimated time left; None until there is a rate.
        noise: Relative error reached, of adaptive sampling; None until it is known.
        noise_wanted: The one to reach; None: a number of samples is wanted.
    """

    fraction: float
    samples: float
    samples_wanted: float
    samples_per_s: float
    rays_per_s: float
    elapsed_s: float
    left_s: float | None
    noise: float | None = None
    noise_wanted: float | None = None

    @property
    def words(self) -> list[str]:
        """Samples and rates."""
        return [
            *([_noise(self)] if self.noise_wanted else []),
            f"{round(self.samples, 1):g}/{round(self.samples_wanted, 1):g} spp",
            f"{quantity(self.samples_per_s)} samples/s",
            f"{quantity(self.rays_per_s)} rays/s",
        ]


@dataclass(frozen=True)
class RowStatus:
    """How far a picture is whose rows are made once, from top to bottom.

    Attributes:
        fraction: Share of the rows that is made, 0 .. 1.
        pixels_per_s: Pixels per second.
        elapsed_s: Since the first row was asked for.
        left_s: Estimated time left; None until there is a rate.
    """

    fraction: float
    pixels_per_s: float
    elapsed_s: float
    left_s: float | None

    @property
    def words(self) -> list[str]:
        """The rate."""
        return [f"{quantity(self.pixels_per_s)} pixels/s"]


@dataclass(frozen=True)
class FrameStatus:
    """How far a sequence is whose frames are made once, one after the other.

    Attributes:
        fraction: Share of the frames that is made, 0 .. 1.
        frames: Frames that are made.
        frames_wanted: Frames in the end.
        elapsed_s: Since the first one was begun.
        left_s: Estimated time left; None until there is a rate.
    """

    fraction: float
    frames: int
    frames_wanted: int
    elapsed_s: float
    left_s: float | None

    @property
    def words(self) -> list[str]:
        """How many frames."""
        return [f"{self.frames}/{self.frames_wanted} frames"]


AnyStatus = Status | RowStatus | FrameStatus


def _noise(status: Status) -> str:
    reached = "?" if status.noise is None else f"{status.noise:.3g}"
    return f"noise {reached} (wanted {status.noise_wanted:g})"


def quantity(value: float) -> str:
    """``1.23 M``: three digits and a letter."""
    for limit, letter in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if value >= limit:
            return f"{value / limit:.3g} {letter}"
    return f"{value:.3g}"
