"""Words that slow a reader down, in comments and docstrings: how often each stands in 1,000 words.

    python script/plain_words.py [FOLDER ...]

prints the rates of each room of the core and of Python, or of the folders; the limits are held by
``tests/project/test_plain_words.py``. On 2026-11-30, before the comments were rewritten, and in two
renderers that read well:

| | core | python | pbrt-v4 | Mitsuba 3, C++ |
|---|---|---|---|---|
| words | 89,531 | 174,143 | 22,950 | 156,461 |
| what | 7.04 | 1.64 | 0.39 | 0.16 |
| that of, those of | 1.64 | 1.96 | 0.00 | 0.06 |
| whose | 1.12 | 1.19 | 0.00 | 0.27 |
| one, as a pronoun | 2.65 | 2.99 | 0.31 | 0.34 |

Better: the noun ("the ray that hits the sphere", not "what hits it"), the repeated noun ("the
radius of the film", not "that of the film"), "with" or a relative clause ("a lamp with a near
bound", not "whose bound is near").
"""

from __future__ import annotations

import ast
import io
import re
import sys
import tokenize
from collections.abc import Iterator, Mapping
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
#: Words after a pronoun "one"; a noun there makes it a numeral, and so do the words before it.
_AFTER = (
    r"that|which|who|is|are|was|has|have|with|in|by|at|for|from|there|before|after|whose|as|than|so|where|it|may|can"
    r"|must|without|does|do|comes?|will"
)
_NUMERAL = r"(?<!least )(?<!exactly )(?<!only )(?<!by )(?<!or )(?<!than )(?<!most )(?<!one )"
#: Pattern and most occurrences in 1,000 words.
PATTERNS = {
    "what": (r"\bwhat\b", 0.5),
    "that of": (r"\b(?:that|those) of\b", 0.5),
    "whose": (r"\bwhose\b", 0.4),
    "one": (rf"\b{_NUMERAL}ones?\b(?=\s*(?:(?:{_AFTER})\b|[.,;:)]|$))", 0.6),
}
_CPP = re.compile(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
_DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def comments(path: Path) -> Iterator[str]:
    """Comments and docstrings of a file of C++ or Python, without code in backticks."""
    text = path.read_text()
    found = _python(text) if path.suffix == ".py" else _cpp(text)
    for comment in found:
        yield re.sub(r"``[^`]+``|`[^`\n]+`", " ", comment)


def _cpp(text: str) -> Iterator[str]:
    for match in _CPP.finditer(text):
        if match[0].startswith("/"):
            yield match[0].strip("/*!< ")


def _python(text: str) -> Iterator[str]:
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, _DOCUMENTED) and (found := ast.get_docstring(node)):
            yield found
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            yield token.string.lstrip("#: ")


def files(folder: Path) -> list[Path]:
    """Sources in a folder."""
    return sorted(p for kind in ("*.h", "*.cpp", "*.py") for p in folder.rglob(kind))


def counts(paths: list[Path]) -> tuple[int, Mapping[str, int]]:
    """Counts words, and the occurrences of each pattern."""
    text = "\n".join(comment for path in paths for comment in comments(path))
    words = len(re.findall(r"[A-Za-z][A-Za-z'-]*", text))
    return words, {name: len(re.findall(rule, text, re.I)) for name, (rule, _) in PATTERNS.items()}


def main() -> None:
    """Prints a line for each room."""
    rooms = [Path(word) for word in sys.argv[1:]] or [
        *sorted(p for p in (ROOT / "core").iterdir() if p.is_dir()),
        *sorted(p for p in (ROOT / "python" / "daguerre").iterdir() if files(p)),
        ROOT / "core",
        ROOT / "python" / "daguerre",
    ]
    for room in rooms:
        words, found = counts(files(room))
        each = "  ".join(f"{name} {1000 * n / max(words, 1):5.2f}" for name, n in found.items())
        print(f"{room.name:14} {words:6} words  {each}")


if __name__ == "__main__":
    main()
