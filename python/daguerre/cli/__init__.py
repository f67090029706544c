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
from typing import TYPE_CHECKING, Any

from daguerre.errors import DaguerreError, InputError, OutputError, suggest
from daguerre.memory import left_bytes, need_addresses, shown

from . import console, ended, short_process
from .commands import COMMANDS, COMPLETE

if TYPE_CHECKING:
    from daguerre.parameters.table import Table
    from daguerre.rendering.parameters import Setting

INTERNAL = 70
INTERRUPTED = 75
#: Typer's own exit code of a command that Ctrl-C ended.
_OF_TYPER = 130
#: Addresses that a command needs, bytes: with fewer, threads of libraries (OpenUSD's, OpenBLAS's)
#: end the process; and commands that start none.
_ADDRESSES = 1_600_000 << 10
_SMALL = ("version",)


def __getattr__(name: str) -> Any:
    """The program, which loads Typer: ``program``, and as ``app`` with all commands."""
    if name in ("app", "program"):
        from .build import program

        return program() if name == "app" else program
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs a command line; returns the exit code of the program.

    Args:
        arguments: Words after the program's name; None: the arguments of this process, which ends
            with the command.
    """
    if arguments is not None:
        return _run(arguments)
    short_process.tune()
    ended.by_signals()
    short_process.code = _run(sys.argv[1:])
    return short_process.code


def _run(arguments: Sequence[str]) -> int:
    console.argv = list(arguments)
    if console.argv[:1] == [COMPLETE]:
        from .completion.shells import complete

        return complete(console.argv[1:])
    from daguerre.files import in_use

    console.quiet, console.writer = False, None
    console.open_streams()
    try:
        name = next((word for word in console.argv if not word.startswith("-")), "")
        if name in COMMANDS and name not in _SMALL:
            need_addresses(_ADDRESSES)
        with in_use.command():
            code = _command(name)(args=console.argv, prog_name="daguerre", standalone_mode=False)
        sys.stdout.flush()
        if code == _OF_TYPER:
            return _fail(ended.told(), INTERRUPTED)
        return int(code or 0)
    except DaguerreError as error:
        return _fail(_with_flag(str(error)), error.exit_code)
    except BrokenPipeError:
        # Whoever read our output has seen enough, as in `daguerre lenses | head -1`.
        console.nobody_reads(sys.stdout)
        return 0
    except KeyboardInterrupt:
        return _fail(ended.told(), INTERRUPTED)
    except MemoryError:
        return _out_of_memory()
    except UnicodeEncodeError as error:  # readers of pictures take names as text alone
        return _fail(f"{error.object}: wanted a name in UTF-8", InputError.exit_code)
    except Exception as error:
        if type(error).__name__ == "Abort":  # Typer's own, for Ctrl-C
            return _fail(ended.told(), INTERRUPTED)
        if hasattr(error, "format_message"):  # Typer's own: a wrong command line
            return _fail(_usage(error), 2)
        if isinstance(error, OSError) and console.is_stuck(error):
            console.nobody_reads(sys.stdout)
            reason = error.strerror or str(error)
            return _fail(f"standard output: cannot write: {reason}", OutputError.exit_code)
        if isinstance(error, OSError) and error.errno == errno.ENOMEM:
            return _out_of_memory()
        if isinstance(error, ImportError) and "failed to map segment" in str(error):
            return _out_of_memory()  # of a library, by the dynamic loader
        if str(error) == "can't start new thread":  # Python's RuntimeError has no code
            return _fail(
                "cannot start another thread: memory, or the number of processes of this user "
                "(ulimit -u), is at its limit",
                InputError.exit_code,
            )
        return _internal(error)


def _out_of_memory() -> int:
    return _fail(
        f"out of memory ({shown(left_bytes() or 0)} are left): use smaller pictures or files",
        InputError.exit_code,
    )


@cache
def _command(name: str) -> Any:
    """Makes the program, with one command alone if there is one of that name.

    Signatures are read once, however often `main` runs in a process.
    """
    from typer.main import get_command

    from .build import outline, program

    return get_command(program(name) if name in COMMANDS else outline())


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
    """Adds the flag to an error of a parameter: ``camera: zoom (--zoom): wanted ...``."""
    found = re.match(r"(?:(camera|develop|light_probe): )?(\w+)(?=:)", text)
    if not found:
        return text
    table = _table(found[1])
    flags = table[found[2]].flags if found[2] in table else ()
    return f"{found[0]} ({flags[0]}){text[found.end() :]}" if flags else text


def _table(owner: str | None) -> Table | dict[str, Setting]:
    """Parameters of a camera, of development, of a light probe, or of a render."""
    if owner == "camera":
        from daguerre.camera.parameters import CAMERA

        return CAMERA
    if owner == "develop":
        from daguerre.development.parameters import DEVELOP

        return DEVELOP
    if owner == "light_probe":
        from daguerre.plates.probe.parameters import LIGHT_PROBE

        return LIGHT_PROBE
    from daguerre.rendering.parameters import TABLE

    return TABLE


def _internal(error: Exception) -> int:
    if os.environ.get("DAGUERRE_DEBUG") == "1":
        traceback.print_exception(error)
    what = f"{type(error).__name__}: {error}"
    return _fail(
        f"internal error: {what}; this is a bug in daguerre: please report it with the "
        "command and the output of DAGUERRE_DEBUG=1",
        INTERNAL,
    )


def _fail(text: str, code: int) -> int:
    if os.environ.get("DAGUERRE_DEBUG") == "1" and code != INTERNAL and sys.exc_info()[0]:
        traceback.print_exc()
    console.writer = None
    console.error(text)
    return code
