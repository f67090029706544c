"""Progress of a render, as plain numbers for any front end."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Status:
    """Progress of a render.

    Attributes:
        fraction: Share of the samples that is drawn, 0 .. 1.
        samples: Complete samples per pixel.
        samples_wanted: Samples per pixel at the end.
        samples_per_s: Camera samples (all pixels) per second.
        rays_per_s: Rays of all kinds per second.
        elapsed_s: Time since this run began to draw, s.
        left_s: Estimated time left, s; None until there is a rate.
        noise: Relative error reached by adaptive sampling; None until it is known.
        noise_wanted: Target relative error; None: not adaptive.
        workers: Number of workers that draw; None: this machine alone does.
        drawn_again: Number of their tasks that were lost, and began anew.
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
    workers: int | None = None
    drawn_again: int = 0

    @property
    def words(self) -> list[str]:
        """Samples and rates as text."""
        return [
            *([_noise(self)] if self.noise_wanted else []),
            f"{round(self.samples, 1):g}/{round(self.samples_wanted, 1):g} spp",
            f"{quantity(self.samples_per_s)} samples/s",
            f"{quantity(self.rays_per_s)} rays/s",
            *([f"{self.workers} workers"] if self.workers is not None else []),
            *([f"{self.drawn_again} tasks drawn again"] if self.drawn_again else []),
        ]


@dataclass(frozen=True)
class RowStatus:
    """Progress of a picture that is made row by row, from top to bottom.

    Attributes:
        fraction: Share of the rows that is complete, 0 .. 1.
        pixels_per_s: Pixels per second.
        elapsed_s: Time since the start of the first row, s.
        left_s: Estimated time left, s; None until there is a rate.
    """

    fraction: float
    pixels_per_s: float
    elapsed_s: float
    left_s: float | None

    @property
    def words(self) -> list[str]:
        """Rate as text."""
        return [f"{quantity(self.pixels_per_s)} pixels/s"]


@dataclass(frozen=True)
class FrameStatus:
    """Progress of a sequence that is made frame by frame.

    Attributes:
        fraction: Share of the frames that is complete, 0 .. 1.
        frames: Number of complete frames.
        frames_wanted: Number of frames at the end.
        elapsed_s: Time since the start of the first frame, s.
        left_s: Estimated time left, s; None until there is a rate.
    """

    fraction: float
    frames: int
    frames_wanted: int
    elapsed_s: float
    left_s: float | None

    @property
    def words(self) -> list[str]:
        """Number of frames as text."""
        return [f"{self.frames}/{self.frames_wanted} frames"]


AnyStatus = Status | RowStatus | FrameStatus


def _noise(status: Status) -> str:
    reached = "?" if status.noise is None else f"{status.noise:.3g}"
    return f"noise {reached} (wanted {status.noise_wanted:g})"


def quantity(value: float) -> str:
    """Formats a number with three digits and a letter, such as ``1.23 M``."""
    for limit, letter in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if value >= limit:
            return f"{value / limit:.3g} {letter}"
    return f"{value:.3g}"
