"""Table of commands, flags and words for completion, made from the program itself.

``script/docs/make-cli-reference`` writes it; a test fails when it is out of date.
"""

from __future__ import annotations

import json
from textwrap import shorten
from typing import Any

from typer.main import get_command

from daguerre.analysis.calibrate import names_of_models
from daguerre.charts import KINDS as CHARTS
from daguerre.cli.build import program
from daguerre.cli.commands import COMMANDS
from daguerre.cli.completion.answer import PROGRAM
from daguerre.cli.help import HELP_FLAGS
from daguerre.development.looks import LOOKS
from daguerre.files import formats
from daguerre.frame.aovs import Source, names_of
from daguerre.lenses import library as lenses
from daguerre.lenses.formats import SUFFIXES
from daguerre.post.effects.catalogue import EFFECTS
from daguerre.rendering.pixels import FILTERS
from daguerre.sensors import library as sensors
from daguerre.stocks import library as stocks

#: Producers of the channels that a user chooses.
_CHOSEN = [one for one in Source if one not in (Source.GUIDES, Source.ALWAYS)]
#: Columns of the meaning of a flag.
WIDTH = 60


def text() -> str:
    """The table as JSON, with a line for each row."""
    table = {"commands": {}, "flags": [], "kinds": kinds()} | _read()
    parts = []
    for name, rows in table.items():
        if isinstance(rows, list):
            lines = ",\n".join(f"  {_line(row)}" for row in rows)
            parts.append(f' "{name}": [\n{lines}\n ]')
        else:
            lines = ",\n".join(f"  {_line(key)}: {_line(row)}" for key, row in rows.items())
            parts.append(f' "{name}": {{\n{lines}\n }}')
    return "{\n" + ",\n".join(parts) + "\n}\n"


def kinds() -> dict[str, Any]:
    """Words, keys and files of the kinds that placeholders name."""
    scenes = [suffix for row in formats.formats("scene") if row.reads for suffix in row.suffixes]
    return {
        "SCENE": {"suffixes": scenes},
        "LENS": {"words": lenses.names(), "suffixes": [".json", *SUFFIXES]},
        "SENSOR": {"words": sensors.names(), "suffixes": [".json"]},
        "STOCK": {"words": stocks.names(), "suffixes": [".json"]},
        "CHART": {"words": list(CHARTS)},
        "MODEL": {"words": names_of_models()},
        "LOOK": {"words": [*LOOKS, "ocio:"]},
        "FILTER": {"words": list(FILTERS)},
        "AOV": {"words": ["all", *names_of(*_CHOSEN)]},
        "EFFECT": {
            "keys": {name: [p.name for p in one.parameters] for name, one in EFFECTS.items()}
        },
        **{noun: {"suffixes": []} for noun in ("FILE", "PHOTO", "PLATE")},
        **{noun: {"folders": True} for noun in ("DIR", "FOLDER")},
    }


def _read() -> dict[str, Any]:
    """Commands and flags of the program."""
    root: Any = get_command(program())
    help_flags = {"names": " ".join(HELP_FLAGS), "help": "Show the help", "of": ""}
    flags = {_line(help_flags): help_flags}
    commands = {}
    for name, command in [("", root), *root.commands.items()]:
        parameters = [(p.param_type_name, p) for p in command.params]
        for row in (_flag(p) for kind, p in parameters if kind == "option"):
            merged = flags.setdefault(_line(row), {**row, "of": ""})
            merged["of"] = f"{merged['of']} {name or PROGRAM}".strip()
        if name:
            taken = [_placeholder(p) for kind, p in parameters if kind == "argument"]
            commands[name] = {"line": COMMANDS[name].line.rstrip("."), "takes": taken}
    return {"commands": commands, "flags": list(flags.values())}


def _flag(parameter: Any) -> dict[str, Any]:
    row: dict[str, Any] = {"names": " ".join([*parameter.opts, *parameter.secondary_opts])}
    if not parameter.is_flag:
        row["takes"] = parameter.metavar or ""
    if parameter.multiple:
        row["again"] = True
    return {**row, "help": _summary(parameter.help or "")}


def _placeholder(argument: Any) -> str:
    text = str(argument.metavar)
    return text if argument.nargs == 1 else text.removesuffix("...") + "..."


def _summary(text: str) -> str:
    """First phrase of a help."""
    phrase = text.partition(" [")[0].partition("; ")[0].partition(". ")[0]
    return shorten(phrase.rstrip("."), WIDTH, placeholder=" ...")


def _line(row: object) -> str:
    return json.dumps(row, ensure_ascii=False)
