"""The paper cites what its bibliography has, and its figures stand in the pages it names."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
HEAD, BODY = (ROOT / "paper.md").read_text().split("---\n", 2)[1:]
BIBLIOGRAPHY = (ROOT / "paper.bib").read_text()


def test_head() -> None:
    head = yaml.safe_load(HEAD)
    assert head["bibliography"] == "paper.bib"
    assert {author["affiliation"] for author in head["authors"]} == {1}
    assert [place["index"] for place in head["affiliations"]] == [1]


def test_sections_of_the_journal() -> None:
    sections = re.findall(r"^# (.*)$", BODY, re.MULTILINE)
    wanted = {"Summary", "Statement of need", "State of the field", "Acknowledgements"}
    assert wanted < set(sections)
    assert sections[-1] == "References"
    assert 750 <= len(BODY.split()) <= 1750  # its rule


def test_every_citation_is_in_the_bibliography_and_back() -> None:
    keys = re.findall(r"^@\w+\{(\w+),$", BIBLIOGRAPHY, re.MULTILINE)
    assert len(keys) == len(set(keys))
    assert set(re.findall(r"@(\w+)", BODY)) == set(keys)
    assert BIBLIOGRAPHY.count("{") == BIBLIOGRAPHY.count("}")


@pytest.mark.parametrize(
    ("page", "figures"),
    [
        (
            "benchmarks",
            ["33.8 M", "92.3 %", "1.22", "1.36", "2.37 M", "0.63", "0.44", "0.55", "0.40"],
        ),
        ("benchmarks", ["3.2", "5.0"]),
        ("verification", ["Mitsuba 3.9.1", "49152", "1 nm", "0.007 waves", "within 2 %"]),
    ],
)
def test_figures_are_those_of_the_pages(page: str, figures: list[str]) -> None:
    text = (ROOT / "docs" / f"{page}.md").read_text()
    paper = BODY.replace("million", "M").replace("49,152", "49152").replace("\n", " ")
    for figure in figures:
        assert figure in text, figure
        assert figure.removesuffix(" M") in paper, figure
