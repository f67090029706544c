"""Pages are in plain English: none has a phrase of ours that readers have stumbled over."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
#: Phrases that are bad in every use, and the better wording.
BAD = {
    r"(?:is|are|was|were|be) told(?! apart)": "who reports what: 'the command reports the ISO'",
    r"what is broken is": "'the error names the fault'",
    r"shall not": "'must not', 'should not' or 'does not'",
    r"comes? upon": "'find', 'hit'",
    r"(?:is|are) come": "'has come', 'arrives'",
    r"(?:for|by|of) such means": "name the mode or the flag",
    r"whatever there is": "say which input or scene",
    r"for want of": "'for lack of', 'without'",
    r"wants some that": "'needs ... to be on'",
    r"(?:refuse[ds]?|say|says|said|ends?) in words": "'gives an error'",
    r"else than": "'other than'",
    r"Of (?:the|an?|each|it|them|what|every)(?! \d)": "'For each ...' or the subject first",
    r"(?P<word>[a-z]{2,}) (?P=word)": "a doubled word",
}
NAMES = ("README", "CONTRIBUTING", "SECURITY", "CODE_OF_CONDUCT", "CHANGELOG", "paper")
PAGES = sorted(
    [
        *(ROOT / f"{name}.md" for name in NAMES),
        *(ROOT / folder / "README.md" for folder in ("examples", "scenes", "script/docs")),
        *(ROOT / "docs").rglob("*.md"),
    ]
)


def prose(text: str) -> str:
    """Text with blanks for code, of unchanged length; of a changelog, the newest section."""
    if text.startswith("# Changelog"):
        text = "\n## ".join(text.split("\n## ")[:2])

    def blank(match: re.Match[str]) -> str:
        return re.sub(r"[^\n]", "~", match[0])

    text = re.sub(r"^(```+).*?^\1", blank, text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"`[^`\n]+`", blank, text)


def faults(text: str) -> list[str]:
    """Line, phrase and better wording of each bad phrase; a phrase may run over a line's end."""
    text = prose(text)
    found = []
    for phrase, better in BAD.items():
        pattern = rf"\b{phrase}\b".replace(" ", r"(?: |\n *)")
        for match in re.finditer(pattern, text):
            line = 1 + text.count("\n", 0, match.start())
            found.append(f"{line}: '{' '.join(match[0].split())}'; better: {better}")
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_page_is_in_plain_words(page: Path) -> None:
    assert faults(page.read_text()) == []


@pytest.mark.parametrize(
    "planted",
    [
        *(
            "The ISO is told with it.",
            "what is broken is named",
            "It shall\nnot be.",
            "is come upon",
        ),
        *("Rays for such means.", "from whatever there is.", "An error for want of memory."),
        *("| x | all. Of a mesh: once |", "Of each pixel, its light.", "It is in the\n  the film."),
    ],
)
def test_planted_phrase_is_found(planted: str) -> None:
    assert len(faults(planted)) >= 1
    assert faults(f"```\n{planted}\n```") == []
    assert faults(f"# Changelog\n\n## 2\n\nGood.\n\n## 1\n\n{planted}\n") == []


def test_good_phrases_pass() -> None:
    good = "They are told apart. Of the 121 lenses, three fail. Each name `the the` is code."
    assert faults(good) == []
