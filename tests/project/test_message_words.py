"""Errors, warnings and notes are in plain English: none has a phrase that users stumbled over."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
#: Phrases that are bad in every message, and the better wording.
BAD = {
    r"got (?:others|another|(?:damaged|larger) ones|something|some that)": (
        "say what was found, or give the rule alone: 'X must be finite', 'X is missing'"
    ),
    r"(?:finite|wanted|the) ones": "name the things: 'finite numbers'",
    r"wanted (?:it|them|one|some), got": "name what is wanted",
    r"wanted no": "'X is not supported', 'X is not allowed'",
    r"wanted each \w+ once": "'X appears twice'",
    r"missing: wanted": "'missing'",
    r"missing file|cannot be read|(?:an |not an )?ordinary file": (
        "the wording of files/reading.py: 'no such file', 'cannot read: ...', 'not a regular file'"
    ),
    r"wanted the package": "the wording of files/extras.py: 'needs the package ...'",
    r"wanted a text,": "'a string'",
    r"that (?:do not )?(?:rise|fall)(?: strictly)?": "'must increase', 'must not decrease'",
    r"of (?:some|one|another) length": "'must have the same length', 'must not have zero length'",
    r"(?<!there )(?<!There )(?:is|are|of|into) no (?!longer)[a-z]+": "'is not a ...'",
    r"(?:is|are|as|was|were) told": "who reports what",
    r"lies (?:at|in|inside|beyond|on)|would lie": "'is in', 'would be in'",
    r"to nothing": "'scaled to zero', 'to a missing node'",
    r"counts? (?:as|by|for)": "'is read as'",
    r"(?:is|are) not (?:known|understood)": "'is unknown', 'is not supported'",
    r"(?:that|those) of one moment|as at one moment": "'as at the scene's time'",
    r"\(--allow-dir widens\)": "'--allow-dir allows more folders'",
    r"(?:in|without) a circle": "'form a cycle'",
    r"(?:within|inside) (?:each other|one another|files|blocks|mixtures|textures)": (
        "'too many nested ...: the limit is ...'"
    ),
    r"\(one a \w+": "'one per vertex'",
    r"shines? (?:evenly|alone|by)": "'equally in all directions', 'emits'",
    r"but alike": "'almost alike'",
    r"as ours": "'as here'",
    r"for want of|whatever there is|comes? upon|else than|shall not": "see test_words.py",
}


def messages_of_python(source: str) -> Iterator[tuple[int, str]]:
    """Line and text of each string that is not documentation; values become ``{}``."""
    tree = ast.parse(source)
    silent: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr):  # documentation
            silent.add(id(node.value))
        elif isinstance(node, ast.JoinedStr):
            silent.update(map(id, node.values))
            for part in node.values:
                if isinstance(part, ast.FormattedValue) and part.format_spec is not None:
                    silent.add(id(part.format_spec))
    for node in ast.walk(tree):
        if id(node) in silent:
            continue
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value
        elif isinstance(node, ast.JoinedStr):
            parts = (p.value if isinstance(p, ast.Constant) else "{}" for p in node.values)
            yield node.lineno, "".join(map(str, parts))


_CPP = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<mark>\w*)\(.*?\)(?P=mark)"|(?P<text>"(?:[^"\\\n]|\\.)*")', re.DOTALL
)


def messages_of_cpp(source: str) -> Iterator[tuple[int, str]]:
    """Line and text of each string; strings that follow one another are one, and so are those
    of ``wanted`` and ``got`` that ``input_error`` joins."""
    end, line, text = 0, 0, ""
    for match in _CPP.finditer(source):
        if match["text"] is None:
            continue
        between = source[end : match.start()]
        if text and not re.fullmatch(r"[\s,]*", between):
            yield line, text
            text = ""
        if not text:
            line = 1 + source.count("\n", 0, match.start())
        text += (", got " if text and "," in between else "") + match["text"][1:-1]
        end = match.end()
    if text:
        yield line, text


def faults(messages: Iterator[tuple[int, str]]) -> list[str]:
    """Line, phrase and better wording of each bad phrase."""
    return [
        f"{line}: '{match[0]}'; better: {better}"
        for line, text in messages
        for phrase, better in BAD.items()
        for match in re.finditer(rf"(?<![\w-]){phrase}(?![\w-])", text)
    ]


def sources(folder: str, *suffixes: str) -> list[Path]:
    """Source files without tests and generated tables, by path in the repository."""
    found = (path for suffix in suffixes for path in (ROOT / folder).rglob(f"*{suffix}"))
    return sorted(path for path in found if not path.stem.endswith("_test"))


def test_messages_of_python_are_in_plain_words() -> None:
    found = [
        f"{path.relative_to(ROOT)}:{fault}"
        for path in sources("python/daguerre", ".py")
        for fault in faults(messages_of_python(path.read_text()))
    ]
    assert not found, "\n".join(found)


def test_messages_of_the_core_are_in_plain_words() -> None:
    found = [
        f"{path.relative_to(ROOT)}:{fault}"
        for path in sources("core", ".cpp", ".h")
        if path.parent.name != "bind"  # its strings are docstrings
        for fault in faults(messages_of_cpp(path.read_text()))
    ]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    "planted",
    [
        "transform: wanted axes of some length, got others",
        "instances: wanted lists of one length",
        "a.bin: wanted an ordinary file",
        "a.bin: cannot be read: Permission denied",
        "camera: wanted one, got 2",
        "wanted each id once",
        "the name is not known",
        "a shape that is scaled to nothing",
    ],
)
def test_planted_phrases_are_found(planted: str) -> None:
    assert len(faults(messages_of_python(f'raise E(f"{{where}}: {planted}")'))) >= 1
    assert len(faults(messages_of_cpp(f'throw Error("x: " /* y */ "{planted}");'))) >= 1
    assert faults(messages_of_python(f'"""{planted}"""')) == []
    assert faults(messages_of_cpp(f"int x;  // {planted}")) == []


def test_wanted_and_got_of_the_core_are_read_together() -> None:
    assert len(faults(messages_of_cpp('input_error("a", "b", "finite numbers", "others");'))) == 1
    assert faults(messages_of_cpp('input_error("a", "b", "1 to 16", std::to_string(n));')) == []


def test_good_messages_pass() -> None:
    good = "scene.glb: nodes[0].mesh: wanted 0 .. 3, got 7 (1 such element); set one per vertex"
    assert faults(messages_of_python(f'raise E("{good}")')) == []
