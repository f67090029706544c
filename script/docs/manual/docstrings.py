"""Google docstrings as Markdown: text, parameters as lists, code as blocks."""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass, field

SECTIONS = ("Args", "Attributes", "Raises", "Returns", "Yields", "Example", "Examples", "Note")
TITLES = {"Args": "Parameters"}
_HEAD = re.compile(rf"({'|'.join(SECTIONS)}):$")
_ITEM = re.compile(r"([*\w][\w, *.\[\]]*?)(?: \([^)]*\))?: ?(.*)", re.DOTALL)
_CODE = re.compile(r"(`+)(.+?)\1(?!`)", re.DOTALL)
_ROLE = re.compile(r":\w+:`~?([^`]+)`")


@dataclass
class Docstring:
    """A docstring, taken apart: its text, and its sections by title."""

    text: str = ""
    items: dict[str, dict[str, str]] = field(default_factory=dict)
    sections: dict[str, str] = field(default_factory=dict)

    def taken(self, name: str) -> str:
        """The text of a field, which then is not listed again."""
        for section in ("Attributes", "Args"):
            if name in self.items.get(section, {}):
                return self.items[section].pop(name)
        return ""

    def markdown(self) -> list[str]:
        """Blocks: the text, then each section."""
        blocks = [self.text] if self.text else []
        for title, items in self.items.items():
            if items:
                rows = [
                    f"- `{name}`: {text}" if text else f"- `{name}`" for name, text in items.items()
                ]
                blocks += [f"**{TITLES.get(title, title)}**", "\n".join(rows)]
        return blocks + [f"**{title}**\n\n{text}" for title, text in self.sections.items()]


def parsed(doc: str | None) -> Docstring:
    """Takes a docstring apart."""
    found = Docstring()
    title, lines = "", []
    for line in [*inspect.cleandoc(doc or "").splitlines(), "End:"]:
        head = _HEAD.match(line)
        if head or line == "End:":
            add(found, title, lines)
            title, lines = (head[1] if head else ""), []
        else:
            lines.append(line)
    return found


def add(found: Docstring, title: str, lines: list[str]) -> None:
    """Adds the lines of one section."""
    text = inspect.cleandoc("\n".join(lines)).strip()
    if not text:
        return
    if title in ("Args", "Attributes", "Raises"):
        items = found.items.setdefault(title, {})
        for entry in re.split(r"\n(?=\S)", text):
            match = _ITEM.fullmatch(entry)
            name, said = (match[1], match[2]) if match else (entry, "")
            said = markdown(" ".join(said.split()))
            for one in name.split(", "):
                items[one] = said
    elif title:
        found.sections[title] = markdown(text)
    else:
        found.text = markdown(text)


def markdown(text: str) -> str:
    """Text of a docstring as Markdown: code blocks after ``::``, nothing that reads as HTML."""
    blocks = []
    code = False
    for block in re.split(r"\n\s*\n", text):
        if code and block.startswith("    "):
            blocks.append(f"```text\n{inspect.cleandoc(block)}\n```")
            continue
        code = block.endswith("::")
        blocks.append(line_safe(block.removesuffix(":") if code else block))
    return "\n\n".join(blocks)


def line_safe(text: str) -> str:
    """Escapes what Markdown would take for a tag or for emphasis, outside code."""
    text = _ROLE.sub(r"`\1`", text)
    parts, end = [], 0
    for match in _CODE.finditer(text):
        parts += [escaped(text[end : match.start()]), code_or_page(" ".join(match[2].split()))]
        end = match.end()
    return "".join([*parts, escaped(text[end:])])


def code_or_page(text: str) -> str:
    """Code; a page of docs becomes a link to it, from the folder beside it."""
    page = re.fullmatch(r"docs/([\w/-]+\.md)", text)
    return f"[{page[1]}](../{page[1]})" if page else f"`{text}`"


def escaped(text: str) -> str:
    """Plain text: ``<``, ``*`` and ``_`` mean themselves; a list keeps its marks."""
    text = text.replace("&", "&amp;").replace("<", "&lt;")
    return re.sub(r"(?<!^)(?<!\n)\*|(?<!\w)_|_(?!\w)", lambda m: "\\" + m[0], text)
