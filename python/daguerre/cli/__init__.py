"""The command line: ``main`` turns every failure into one line and an exit code.

Exit codes: 0 complete, 2 wrong command line, 3 unreadable or invalid input, 4 hash or range
mismatch, 5 output or disk, 70 internal, 75 interrupted and resumable.
"""

from __future__ import annotations

import errno
import os
import re
import sys
import traceback
from collections.abc import Sequence
from functools import cache
from importlib import import_module
from typing import Any, NamedTuple

import typer

from daguerre.errors import DaguerreError, InputError, OutputError, suggest
from daguerre.memory import left_bytes, shown

from . import console
from .help import ALL, HelpCommand, HelpGroup

INTERNAL = 70
INTERRUPTED = 75


class Command(NamedTuple):
    """A command: the module that holds it, and its line in `daguerre --help`."""

    module: str
    line: str


#: By headings, in the order of `daguerre --help`; a module is loaded when its command is called.
GROUPS = {
    "Make pictures": {
        "demo": Command(".demo", "Render a first picture, without any file of your own."),
        "render": Command(".render.command", "Render a scene to pictures or a sequence."),
        "merge": Command(".merge", "Add passes of one picture into one file."),
        "post": Command(".post", "Add effects of a lens to any picture, or remove them."),
        "develop": Command(".develop", "Develop photographs from a frame or a raw file."),
        "composite": Command(".composite", "Put rendered objects into a photograph."),
    },
    "Look at a scene": {
        "view": Command(".view", "Show the picture in a browser, with rings to turn."),
        "info": Command(".info", "Describe a scene and its cameras."),
    },
    "Measure": {
        "chart": Command(".chart", "Write a test chart as a scene."),
        "calibrate": Command(".calibrate", "Fit a projection to a lens."),
        "match-plate": Command(".match_plate", "Find the camera settings of a photograph."),
        "light-probe": Command(".light_probe", "Build an environment from photographs of a probe."),
    },
    "Lenses, sensors and film": {
        "lenses": Command(".lenses", "List the lenses of the library."),
        "lens": Command(".lens.command", "Show, measure, convert or fit a lens."),
        "sensors": Command(".sensors", "List the sensors of the library."),
        "sensor": Command(".sensor", "Show a sensor."),
        "stocks": Command(".stocks", "List the film stocks of the library."),
    },
    "Files for other programs": {
        "export-camera": Command(".export_camera", "Write cameras as a USD stage."),
        "export-scene": Command(".export_scene", "Write a scene for pbrt-v4 or Mitsuba 3."),
    },
    "Clusters": {
        "scheduler": Command(".cluster", "Start the scheduler of a cluster."),
        "worker": Command(".cluster", "Start a worker of a cluster."),
    },
    "This program": {
        "version": Command(".version", "Print the version and the libraries in use."),
    },
}
COMMANDS = {name: command for group in GROUPS.values() for name, command in group.items()}


def program(*names: str) -> typer.Typer:
    """The program with some of its commands; default: all."""
    app = _empty()
    for name in names or COMMANDS:
        command = app.command(name=name, cls=HelpCommand, short_help=COMMANDS[name].line)
        command(_function(name))
    return app


def _outline() -> typer.Typer:
    """The program for its help and for wrong commands: names and lines, with nothing loaded."""
    app = _empty()
    for heading, group in GROUPS.items():
        for name, command in group.items():
            add = app.command(name=name, short_help=command.line, rich_help_panel=heading)
            add(lambda: None)
    return app


def _empty() -> typer.Typer:
    app = typer.Typer(
        name="daguerre",
        cls=HelpGroup,
        help="Renders what a real camera would have recorded.",
        add_completion=False,
        no_args_is_help=False,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,  # its tables cut long flags off on a narrow terminal
        context_settings={"help_option_names": ["-h", "--help", ALL]},
    )
    app.callback(invoke_without_command=True)(_top)
    return app


def _function(name: str) -> Any:
    """The function of a command, whose name has underscores."""
    return getattr(import_module(COMMANDS[name].module, __name__), name.replace("-", "_"))


def __getattr__(name: str) -> Any:
    """The whole program as ``app``, for who reads its help."""
    if name == "app":
        return program()
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def _top(
    context: typer.Context,
    version: bool = typer.Option(False, "--version", help="Print the version."),
) -> int | None:
    if version:
        from daguerre import __version__

        console.show(f"daguerre {__version__}")
        raise typer.Exit(0)
    if context.invoked_subcommand is None:
        console.show(context.get_help())
        raise typer.Exit(2)
    return None


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs a command line; returns its exit code."""
    console.argv = list(sys.argv[1:] if arguments is None else arguments)
    console.quiet, console.writer = False, None
    console.open_streams()
    try:
        name = next((word for word in console.argv if not word.startswith("-")), "")
        code = _command(name)(args=console.argv, prog_name="daguerre", standalone_mode=False)
        sys.stdout.flush()
        return int(code or 0)
    except DaguerreError as error:
        return _fail(_with_flag(str(error)), error.exit_code)
    except BrokenPipeError:
        # Whoever read our output has seen enough, as in `daguerre lenses | head -1`.
        console.nobody_reads(sys.stdout)
        return 0
    except (KeyboardInterrupt, typer.Abort):
        return _fail("interrupted", INTERRUPTED)
    except MemoryError:
        return _out_of_memory()
    except UnicodeEncodeError as error:  # readers of pictures take names as text alone
        return _fail(f"{error.object}: wanted a name in UTF-8", InputError.exit_code)
    except Exception as error:
        if hasattr(error, "format_message"):  # Typer's own: a wrong command line
            return _fail(_usage(error), 2)
        if isinstance(error, OSError) and console.is_stuck(error):
            console.nobody_reads(sys.stdout)
            reason = error.strerror or str(error)
            return _fail(f"standard output: cannot write: {reason}", OutputError.exit_code)
        if isinstance(error, OSError) and error.errno == errno.ENOMEM:
            return _out_of_memory()
        return _internal(error)


def _out_of_memory() -> int:
    return _fail(
        f"memory: wanted more than there is ({shown(left_bytes() or 0)} are left); "
        "try smaller pictures or files",
        InputError.exit_code,
    )


@cache
def _command(name: str) -> Any:
    """Makes the program, with one command alone if there is one of that name.

    Signatures are read once, however often `main` runs in a process.
    """
    return typer.main.get_command(program(name) if name in COMMANDS else _outline())


def _usage(error: Any) -> str:
    """Typer's message, without the full stop and with a hint where to find help."""
    text = str(error.format_message()).strip().rstrip(".")
    value = re.match(r"Invalid value for (?:.* / )?'(.*)': (wanted .*)", text)
    if value:
        text = f"{value[1]}: {value[2]}"
    unknown = re.match(r"No such command '(.*)'$", text)
    if unknown:  # older releases of Typer suggest nothing
        text += suggest(unknown[1], COMMANDS)
    text = re.sub(r"\(Possible options: (.*)\)$", r"(did you mean \1?)", text)
    context = getattr(error, "ctx", None)
    where = context.command_path if context is not None else _named()
    return f"{text[:1].lower()}{text[1:]} (see `{where} --help`)"


def _named() -> str:
    """The program's name, and the command's if the command line begins with it."""
    return " ".join(["daguerre", *(word for word in console.argv[:1] if word in COMMANDS)])


def _with_flag(text: str) -> str:
    """Adds the flag to an error of a camera's parameter: ``camera: zoom (--zoom): wanted ...``."""
    found = re.match(r"camera: (\w+)(?=:)", text)
    if not found:
        return text
    from daguerre.camera.parameters import CAMERA

    flags = CAMERA[found[1]].flags if found[1] in CAMERA else ()
    return f"{found[0]} ({flags[0]}){text[found.end() :]}" if flags else text


def _internal(error: Exception) -> int:
    if os.environ.get("DAGUERRE_DEBUG") == "1":
        traceback.print_exception(error)
    what = f"{type(error).__name__}: {error}"
    return _fail(
        f"internal: {what}; this is a fault of daguerre, please report it with the command "
        "and the output of DAGUERRE_DEBUG=1",
        INTERNAL,
    )


def _fail(text: str, code: int) -> int:
    if os.environ.get("DAGUERRE_DEBUG") == "1" and code != INTERNAL and sys.exc_info()[0]:
        traceback.print_exc()
    console.writer = None
    console.error(text)
    return code
