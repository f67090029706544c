"""Issue forms are valid: known keys and types, one id each, and no flag that does not exist."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from .test_docs import flags_in, flags_of_the_program

FOLDER = Path(__file__).resolve().parents[2] / ".github" / "ISSUE_TEMPLATE"
FORMS = sorted(path for path in FOLDER.glob("*.yml") if path.name != "config.yml")
#: Attributes by type of a form's element, those that it needs first.
TYPES = {
    "markdown": ["value"],
    "textarea": ["label", "description", "placeholder", "value", "render"],
    "input": ["label", "description", "placeholder", "value"],
    "dropdown": ["label", "options", "description", "multiple", "default"],
    "checkboxes": ["label", "options", "description"],
}
NEEDED = {"markdown": 1, "textarea": 1, "input": 1, "dropdown": 2, "checkboxes": 2}


def read(path: Path) -> Any:
    return yaml.safe_load(path.read_text())


def test_config() -> None:
    assert set(read(FOLDER / "config.yml")) <= {"blank_issues_enabled", "contact_links"}


def test_there_are_forms_with_names_of_their_own() -> None:
    assert len(FORMS) == len({read(path)["name"] for path in FORMS}) == 3


@pytest.mark.parametrize("path", FORMS, ids=lambda path: path.stem)
def test_form(path: Path) -> None:
    form = read(path)
    assert set(form) == {"name", "description", "labels", "body"}
    assert all(isinstance(label, str) for label in form["labels"])
    asked = [element for element in form["body"] if element["type"] != "markdown"]
    ids = [element["id"] for element in asked]
    labels = [element["attributes"]["label"] for element in asked]
    assert len(ids) == len(set(ids)) > 0
    assert len(labels) == len(set(labels))
    for element in form["body"]:
        kind, attributes = element["type"], element["attributes"]
        assert set(element) <= {"type", "id", "attributes", "validations"}
        assert set(TYPES[kind][: NEEDED[kind]]) <= set(attributes) <= set(TYPES[kind])
        assert set(element.get("validations", {})) <= {"required"}
        for option in attributes.get("options", []):
            assert (
                isinstance(option, str)
                if kind == "dropdown"
                else set(option) <= {"label", "required"}
            )


@pytest.mark.parametrize("path", FORMS, ids=lambda path: path.stem)
def test_flags_in_forms_exist(path: Path) -> None:
    assert flags_in(path.read_text()) <= flags_of_the_program()
