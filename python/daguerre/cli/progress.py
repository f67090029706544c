"""Display of progress: a bar on a terminal, lines in a log, JSON for programs."""

from __future__ import annotations

import json
import sys
import time
from dataclasses import asdict
from types import TracebackType
from typing import Any, Self

from daguerre.rendering.progress import AnyStatus

from . import console

Which = dict[str, Any]


class Silent:
    """Shows nothing; base of the other displays."""

    def update(self, status: AnyStatus) -> None:
        """Shows the newest status."""

    def event(self, name: str, **facts: object) -> None:
        """Reports a single event: done, checkpoint, interrupted."""

    def start(self) -> None:
        """Starts the display."""

    def stop(self) -> None:
        """Removes the display from the screen."""

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        tb: TracebackType | None,
    ) -> None:
        self.stop()
        console.writer = None


class Lines(Silent):
    """Prints a plain line every ten seconds, for logs."""

    period_s = 10.0

    def __init__(self, which: Which) -> None:
        self._which = named(which)
        self._next = time.monotonic() + self.period_s

    def update(self, status: AnyStatus) -> None:
        """Prints a line if it is time."""
        if time.monotonic() >= self._next:
            self._next = time.monotonic() + self.period_s
            console.say(f"daguerre: {self._which}{describe(status)}")


class JsonLines(Silent):
    """Prints a JSON object a line on stdout: ``{"event": "progress", "fraction": 0.25, ...}``."""

    period_s = 0.5

    def __init__(self, which: Which) -> None:
        self._which, self._next = which, 0.0
        console.writer = lambda line: self.event("message", text=line)

    def update(self, status: AnyStatus) -> None:
        """Prints an object twice a second, and at the end."""
        if time.monotonic() >= self._next or status.fraction >= 1:
            self._next = time.monotonic() + self.period_s
            self.event("progress", **asdict(status))

    def event(self, name: str, **facts: object) -> None:
        """Prints one object."""
        try:
            print(json.dumps({"event": name, **self._which, **facts}), flush=True)
        except OSError as error:  # the picture is still wanted
            console.nobody_reads(sys.stdout)
            console.writer = None
            if not isinstance(error, BrokenPipeError):
                console.warn(
                    f"--json-progress: {error.strerror or error}; progress is no longer reported"
                )


class Bar(Silent):
    """Shows a bar on a terminal, with rates and time left."""

    def __init__(self, which: Which) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn

        self._which = named(which)
        screen = Console(stderr=True)
        self._progress = Progress(
            TextColumn("[progress.percentage]{task.percentage:>3.0f}%"),
            BarColumn(),
            TextColumn("{task.description}"),
            console=screen,
            transient=True,
        )
        self._task = self._progress.add_task("starting", total=1.0)

    def update(self, status: AnyStatus) -> None:
        """Moves the bar."""
        text = self._which + describe(status, percent=False)
        self._progress.update(self._task, completed=status.fraction, description=text)

    def start(self) -> None:
        """Shows the bar; messages are printed above it."""
        self._progress.start()
        screen = self._progress.console
        console.writer = lambda line: screen.print(
            line, markup=False, highlight=False, soft_wrap=True
        )

    def stop(self) -> None:
        """Removes the bar."""
        self._progress.stop()


def choose(*, quiet: bool, as_json: bool, which: Which | None = None) -> Silent:
    """Chooses the display: JSON if requested, none if quiet, else a bar on a terminal, or lines.

    Args:
        quiet: Whether ``--quiet`` was given.
        as_json: Whether ``--json-progress`` was given.
        which: ``frame`` and ``camera`` of this picture, if there are several.
    """
    one = which or {}
    if as_json:
        return JsonLines(one)
    if quiet:
        return Silent()
    return Bar(one) if sys.stderr.isatty() else Lines(one)


def named(which: Which) -> str:
    """Label such as ``frame 7, camera left:``, or empty."""
    return ", ".join(f"{name} {value}" for name, value in which.items()) + ": " * bool(which)


def describe(status: AnyStatus, *, percent: bool = True) -> str:
    """Describes progress in a line: percentage, rates, time elapsed and left."""
    left = "?" if status.left_s is None else duration(status.left_s)
    words = [*status.words, f"elapsed {duration(status.elapsed_s)}", f"left {left}"]
    return ", ".join([f"{100 * status.fraction:.1f}%", *words] if percent else words)


def duration(seconds: float) -> str:
    """Formats a time: ``42 s``, ``3:07``, ``1:02:03``."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    minutes, s = divmod(whole, 60)
    hours, m = divmod(minutes, 60)
    return f"{hours}:{m:02}:{s:02}" if hours else f"{m}:{s:02}"
