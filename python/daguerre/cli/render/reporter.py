"""Reporter of the command line: notes on stderr, progress as a bar, lines or JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from daguerre.cli import console, progress
from daguerre.rendering.job import shown
from daguerre.rendering.progress import Status
from daguerre.rendering.reporter import Finished, PreviewPicture, Reporter, Stopped

from .preview import Preview


class ConsoleReporter(Reporter):
    """Reports to people, or with ``--json-progress`` to programs.

    Args:
        quiet: Whether ``--quiet`` was given.
        as_json: Whether to print progress as JSON lines.
        stats: Whether to print counts and times.
        preview: Whether to show previews.
    """

    def __init__(self, *, quiet: bool, as_json: bool, stats: bool, preview: bool = False) -> None:
        self._quiet, self._as_json, self._stats = quiet, as_json, stats
        self._shown = progress.Silent()
        self._preview = Preview() if preview else None

    @property
    def previews(self) -> bool:
        """Whether previews are shown."""
        return self._preview is not None and self._preview.works

    def preview(self, look: PreviewPicture) -> None:
        """Shows a preview in a file."""
        if self._preview is not None and self._preview.works:
            self._preview.show(look)

    @contextmanager
    def drawing(self, facts: Mapping[str, Any]) -> Iterator[None]:
        """Shows progress of a picture."""
        self._shown = progress.choose(quiet=self._quiet, as_json=self._as_json, which=dict(facts))
        with self._shown:
            yield

    def progress(self, status: Status) -> None:
        """Shows the progress."""
        self._shown.update(status)

    def note(self, text: str) -> None:
        """A line, unless quiet."""
        console.note(text)

    def warning(self, text: str) -> None:
        """A line, unless quiet."""
        console.warn(text)

    def saved(self, path: Path, samples: float, *, rescued: bool = False) -> None:
        """Reports a checkpoint as an event, and as a line if it holds rescued samples."""
        self._shown.event("checkpoint", path=str(path), samples=samples)
        if rescued:
            console.say(f"daguerre: the samples are kept in {path}")

    def finished(self, result: Finished) -> None:
        """Reports a complete picture: lines about it, and an event."""
        count, places = result.frame.bad_samples
        if count:
            console.warn(bad_samples(count, places))
        names, samples = ", ".join(map(str, result.paths)), shown(result.samples)
        console.note(f"wrote {names} ({samples} samples per pixel, {result.seconds:.1f} s)")
        self._exposure(result)
        self._noise(result)
        if self._stats:
            from .stats import stats

            for name, value in stats(result).items():
                console.say(f"daguerre: {name}: {value}")
        paths = [str(path) for path in result.paths]
        self._shown.event("done", outputs=paths, samples=result.samples)

    def _exposure(self, result: Finished) -> None:
        if self._quiet:
            return
        from daguerre.rendering.over_meter import exposure_in_words

        if text := exposure_in_words(result.session, result.frame):
            console.note(text)

    def _noise(self, result: Finished) -> None:
        sampling, reached = result.session.settings.sampling, result.frame.metadata.get("noise")
        if sampling.noise is None or reached is None:
            return
        console.note(f"noise {reached:.3g} (wanted {sampling.noise:g})")
        if reached > sampling.noise:
            console.warn(
                f"--noise {sampling.noise:g} was not reached: --spp {sampling.most} ended the "
                "render before"
            )

    def stopped(self, result: Stopped) -> None:
        """Reports a stopped picture: the saved checkpoint, how to resume, and an event."""
        kept = "nothing was saved"
        if result.checkpoint is not None:
            kept = f"{'saved in' if result.saved else 'the last checkpoint is'} {result.checkpoint}"
        command = console.command_line("--resume")
        console.say(
            f"daguerre: interrupted after {shown(result.samples)} of {result.total:.6g} samples; "
            f"{kept}; resume with:"
        )
        console.say(command)
        self._shown.event("interrupted", samples=result.samples, resume=command)


def bad_samples(count: int, places: list[tuple[int, int, int]]) -> str:
    """Message with the number of dropped samples, and the first of them."""
    named = ", ".join(f"sample {sample} of pixel ({x}, {y})" for x, y, sample in places[:4])
    more = ", ..." if len(places) > 4 else ""
    return f"{count} samples were NaN or infinite and were left out: {named}{more}"
