"""Texts generated from tables: flags on pages, docstrings of records, words of completion.

``script/docs/make-cli-reference`` writes these texts; a test fails if a text is stale.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import completion_words
from page_tables import page_table, put_between_marks

from daguerre.camera.camera import Camera
from daguerre.camera.parameters import CAMERA, CAMERA_FLAGS, SHUTTER
from daguerre.parameters.table import Table
from daguerre.parameters.texts import attributes
from daguerre.plates.match.parameters import MATCH
from daguerre.plates.probe.parameters import LIGHT_PROBE
from daguerre.rendering.parameters import FLAGS

PAGE = Path("docs", "cli.md")
WORDS = Path("python", "daguerre", "cli", "completion", "words.json")
_BEGIN, _END = "    Attributes:\n", '    """\n'


@dataclass(frozen=True)
class Section:
    """A table of flags on the page of the command line.

    Attributes:
        name: Name in the marks around it.
        table: Rows of the flags.
        names: Table of the parameters that their texts refer to.
    """

    name: str
    table: Table
    names: Table


SECTIONS = (
    Section("flags of the camera", CAMERA_FLAGS, CAMERA),
    Section("flags of the shutter", SHUTTER, CAMERA),
    Section("flags of rendering", FLAGS, FLAGS),
    Section("flags of match-plate", MATCH, MATCH),
    Section("flags of light-probe", LIGHT_PROBE, LIGHT_PROBE),
)
#: Files with the docstring of a record: the record's class and the table of its fields.
RECORDS = {Path("python", "daguerre", "camera", "camera.py"): (Camera, CAMERA)}


def texts(root: Path) -> dict[Path, str]:
    """Generates the text of every such file, by its path below ``root``."""
    page = (root / PAGE).read_text("utf-8")
    for section in SECTIONS:
        page = put_between_marks(page, section.name, page_table(section.table, section.names))
    made = {PAGE: page, WORDS: completion_words.text()}
    for path, (record, table) in RECORDS.items():
        text = (root / path).read_text("utf-8")
        made[path] = with_attributes(text, record.__name__, table, record.__dataclass_fields__)
    return made


def with_attributes(text: str, record: str, table: Table, names: Iterable[str]) -> str:
    """Generates the attributes in the docstring of a class; returns the source."""
    before, start, rest = text.partition(f"\nclass {record}")
    head, begin, rest = rest.partition(_BEGIN)
    _, end, after = rest.partition(_END)
    return "".join([before, start, head, begin, attributes(table, names), end, after])
