"""Help pages with flags in groups; a long page shows common flags, ``--help-all`` shows all.

Texts, groups and their order come from the flags; this module knows commands only by name.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import typer.core

from . import console
from .values import OwnValues

ALL = "--help-all"
HELP_FLAGS = ("-h", "--help", ALL)
_CAMERA = ("--camera", "--lens", "--f-stop", "--focus", "--shutter", "--sensor")
#: Flags that the page of a command shows first, if all of them would make it long; --help-all
#: shows the others, too.
FIRST = {
    "render": ("--output", "--res", *_CAMERA, "--exposure", "--env", "--noise", "--denoise",
               "--frames"),
    "view": ("--output", "--res", *_CAMERA, "--exposure", "--env", "--spp", "--denoise", "--host",
             "--port"),
    "info": ("--json", "--res", *_CAMERA, "--focal-length", "--zoom", "--time"),
    "lens": ("--plot", "--drawing", "--export", "--psf", "--through-focus", "--flare", "--json",
             "--zoom", "--focus", "--f-stop", "--wavelength"),
    "export-camera": ("--output", "--times", *_CAMERA, "--focal-length", "--calibration"),
    "export-scene": ("--output", "--res", "--spp", *_CAMERA, "--focal-length"),
    "light-probe": ("--output", "--ball", "--ev", "--response", "--scale", "--wb", "--sun",
                    "--illuminance", "--grey", "--rotate", "--res", "--sun-out", "--json"),
}  # fmt: skip
EXAMPLES = {
    "render": "daguerre render scene.glb --lens double-gauss-50mm-f2 --f-stop 2 --focus 1.5 "
    "--noise 0.05 -o out.exr -o out.png",
}
#: Heading of flags and commands without a group.
OTHER = "Other"

Rows = list[tuple[str, str]]


class InOrder:
    """Shows the names of the help flag in a fixed order; typer's own order differs between runs."""

    def get_help_option_names(self, ctx: Any) -> list[str]:
        """Returns the names in the order of the settings."""
        return list(ctx.help_option_names)


class HelpGroup(OwnValues, InOrder, typer.core.TyperGroup):
    """The program; its help shows commands in groups."""

    def format_commands(self, ctx: object, formatter: object) -> None:
        """Writes the commands."""
        groups: dict[str, Rows] = {}
        for name, command in self.commands.items():
            rows = groups.setdefault(_panel(command), [])
            rows.append((name.ljust(max(map(len, self.commands))), command.short_help or ""))
        for title, rows in groups.items():
            _write(formatter, title, rows)


class HelpCommand(OwnValues, InOrder, typer.core.TyperCommand):
    """A command; its help shows flags in groups."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Writes the arguments and the flags."""
        name = self.name or ""
        first = FIRST.get(name, ())
        whole = ALL in console.argv or not first
        if name in EXAMPLES:
            with formatter.section("Example"):
                formatter.write_text(EXAMPLES[name])
        _write(formatter, "Arguments", _rows(ctx, self._of_kind("argument", ctx)))
        flags = self._of_kind("option", ctx)
        common = [flag for word in first for flag in flags if word in flag.opts]
        _write(formatter, "Common options", _rows(ctx, common))
        if not whole:
            _write(formatter, "Help", _rows(ctx, flags[-1:]))
            formatter.write_paragraph()
            formatter.write_text(f"`{ctx.command_path} {ALL}` lists all {len(flags)} flags.")
            return
        groups: dict[str, list[Any]] = {}
        for flag in flags:
            if flag not in common:
                groups.setdefault(_panel(flag), []).append(flag)
        other = groups.pop(OTHER, [])
        for title, members in groups.items():
            _write(formatter, title, _rows(ctx, members))
        _write(formatter, OTHER if groups else "Options", _rows(ctx, other))

    def _of_kind(self, kind: str, ctx: object) -> list[Any]:
        return [one for one in self.get_params(ctx) if one.param_type_name == kind]


def _panel(one: object) -> str:
    """Heading above a flag or a command."""
    return getattr(one, "rich_help_panel", None) or OTHER


def _rows(ctx: object, parameters: Iterable[Any]) -> Rows:
    """Names and texts of the parameters to show."""
    return [row for one in parameters if (row := one.get_help_record(ctx)) is not None]


def _write(formatter: Any, title: str, rows: Rows) -> None:
    if rows:
        with formatter.section(title):
            formatter.write_dl(rows)
