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
    r"(?:has|have|had|draws?|with) the bits of": "'is bit-identical to'",
    r"(?<!here\s)(?<!here\n\s\s)(?<!here\n\s\s\s)(?:is|are) no (?!longer|more|less|better|worse"
    r"|different|other|exception|guarantee|substitute|problem|surprise|larger|smaller|faster|slower)"
    r"[a-z]+": "'is not a ...'",
    r"for who|Who [a-z]+s the": "'if you ...', 'anyone who ...'",
    r"as (?:the stage|the camera|USD) says?": "'that the stage specifies', 'USD's default'",
    r"few mean it": "'it is rarely meant'",
    r"(?:does|do) without(?=[,.;])": "say what the flag removes",
    r"whatever number": "'for any number'",
    r"notes? tells?": "'a note names', 'with a note'",
    r"lost in silence": "'dropped silently'",
    r"lie in (?:the|its) (?:\w+ )?(?:\w+'s )?folder": "'be in the folder'",
    r"(?:clouds?|scenes?|files?|stages?) wants?": "'needs'",
    r"seldomer": "'less often'",
    r"pays? nothing": "'has no extra cost'",
    r"[Hh]eld against": "'compared with'",
    r"will do as well": "'works as well'",
    r"takes? that back": "'compensates that'",
    r"mends?": "'fixes', 'corrects'",
    r"it counts for": "'it affects'",
    r"what it makes of": "name the result",
    r"(?:has|have) not(?=[.;,])": "'lacks'",
    r"says? nothing of": "'does not set'",
    r"where you say": "'where you choose'",
    r"in another way than|are others than": "'differently from'",
    r"(?:until|what) (?:it )?rests": "'until it is done', 'static objects'",
    r"what is (?:refused|drawn) (?:ends|has|gets)": "name it: 'a refused stage'",
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
        pattern = rf"\b(?:{phrase})\b".replace(" ", r"(?: |\n *)")
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
        *("The picture has\nthe bits of F12.", "The sun is no point.", "Who reaches the scheduler"),
        *("clockwise for who looks along it", "The focus is as the stage says.", "few mean it"),
        *("the flag does without.", "A note tells which.", "Nothing is lost in silence."),
        *(
            "Files must lie in its folder.",
            "must lie in the stage's folder",
            "thick clouds want more",
        ),
        *("whatever number of workers", "It is drawn seldomer.", "It refines until it rests."),
        *("losses that pbrt has not.", "a stage that says nothing of blur", "it counts for depth"),
    ],
)
def test_planted_phrase_is_found(planted: str) -> None:
    assert len(faults(planted)) >= 1
    assert faults(f"```\n{planted}\n```") == []
    assert faults(f"# Changelog\n\n## 2\n\nGood.\n\n## 1\n\n{planted}\n") == []


def test_good_phrases_pass() -> None:
    good = """They are told apart. Of the 121 lenses, three fail. Each name `the the` is code.
    There is no network. The lens is no longer sharp. Lamps are chosen for whole ways. There
  is no gap. The point must lie in the plane, as the specification says. Do without a filter."""
    assert faults(good) == []
