"""Issue forms have one id and one label for each question, and no flag that does not exist.

Their keys and types are checked by test_workflows.py.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from .test_docs import flags_in, flags_of_the_program

FOLDER = Path(__file__).resolve().parents[2] / ".github" / "ISSUE_TEMPLATE"
FORMS = sorted(path for path in FOLDER.glob("*.yml") if path.name != "config.yml")


def read(path: Path) -> Any:
    return yaml.safe_load(path.read_text())


def test_there_are_forms_with_names_of_their_own() -> None:
    assert len(FORMS) == len({read(path)["name"] for path in FORMS}) == 3


@pytest.mark.parametrize("path", FORMS, ids=lambda path: path.stem)
def test_questions_have_ids_and_labels_of_their_own(path: Path) -> None:
    asked = [element for element in read(path)["body"] if element["type"] != "markdown"]
    ids = [element["id"] for element in asked]
    labels = [element["attributes"]["label"] for element in asked]
    assert len(ids) == len(set(ids)) > 0
    assert len(labels) == len(set(labels))


@pytest.mark.parametrize("path", FORMS, ids=lambda path: path.stem)
def test_flags_in_forms_exist(path: Path) -> None:
    assert flags_in(path.read_text()) <= flags_of_the_program()
