"""Collects the pages of the manual in a folder: those of docs, and those that are generated.

    python script/docs/manual/stage.py build/manual/pages

Files of the repository that pages link to (programs, scenes, SECURITY.md) become pages under
``source``, so that the site is whole by itself. A link that leads nowhere is an error.
"""

from __future__ import annotations

import html
import os
import re
import shutil
import sys
from pathlib import Path

import api

ROOT = Path(__file__).resolve().parents[3]
DOCS = ROOT / "docs"
PARTS = ("iframe-worker.js", "site.css", "site.js")
PIPES = re.compile(r"`([^`\n]*\\\|[^`\n]*)`")
LINK = re.compile(
    r"(\]\()([^)\s#]+)(#[^)\s]*)?((?: \"[^\"]*\")?\))"
    r"|((?:href|src)=\")([^\"#]+)(#[^\"]*)?(\")"
)
FENCE = re.compile(r"^(```+|~~~+).*?^\1", re.MULTILINE | re.DOTALL)
LANGUAGES = {".py": "python", ".json": "json", ".yaml": "yaml", ".diff": "diff", ".cpp": "cpp"}
LANGUAGES |= {".h": "cpp", ".toml": "toml", ".md": "markdown"}


class Pages:
    """The folder, and the files of the repository that its pages ask for."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.generated: set[str] = set()
        self.wanted: list[Path] = []
        self.missing: list[str] = []

    def write(self, place: str, text: str) -> None:
        """Writes a page; one that is unchanged keeps its time."""
        file = self.folder / place
        file.parent.mkdir(parents=True, exist_ok=True)
        if not file.exists() or file.read_text("utf-8") != text:
            file.write_text(text, "utf-8")

    def place(self, file: Path) -> str | None:
        """Where the site has a file of the repository; None where it has none."""
        if file.is_relative_to(DOCS) and file.relative_to(DOCS).as_posix() in self.generated:
            return file.relative_to(DOCS).as_posix()
        if file.is_dir():
            file = file / "README.md"
        if not file.is_file() or not file.is_relative_to(ROOT):
            return None
        if file.is_relative_to(DOCS):
            return file.relative_to(DOCS).as_posix()
        if file not in self.wanted:
            self.wanted.append(file)
        inside = file.relative_to(ROOT).as_posix()
        return (
            f"source/{inside}"
            if file.suffix == ".md" or is_picture(file)
            else f"source/{inside}.md"
        )

    def relinked(self, text: str, file: Path, place: str) -> str:
        """The text of a page with its links as the site has them."""
        parts, end = [], 0
        for fence in FENCE.finditer(text):
            parts += [self.links(pipes(text[end : fence.start()]), file, place), fence[0]]
            end = fence.end()
        return "".join([*parts, self.links(pipes(text[end:]), file, place)])

    def links(self, text: str, file: Path, place: str) -> str:
        """Links outside code."""

        def changed(match: re.Match[str]) -> str:
            begin, target, anchor, end = (match[k] or match[k + 4] or "" for k in (1, 2, 3, 4))
            if re.match(r"\w+:", target):
                return match[0]
            goal = Path(os.path.normpath(file.parent / target))
            found = self.place(goal)
            if found is None:
                if not goal.is_dir():
                    self.missing.append(f"{file.relative_to(ROOT)}: no such file: {target}")
                return match[0]
            return begin + os.path.relpath(found, Path(place).parent) + anchor + end

        return LINK.sub(changed, text)

    def add_sources(self) -> None:
        """Pages of the files that pages ask for, and of those that these ask for."""
        done = 0
        while done < len(self.wanted):
            file = self.wanted[done]
            done += 1
            place = self.place(file)
            assert place is not None
            if is_picture(file):
                copy(file, self.folder / place)
            elif file.suffix == ".md":
                self.write(place, self.relinked(file.read_text("utf-8"), file, place))
            else:
                self.write(place, listing(file))


def pipes(text: str) -> str:
    """Code with pipes in tables as HTML: a site shows the backslashes that a forge needs."""

    def changed(match: re.Match[str]) -> str:
        return f"<code>{html.escape(match[1], quote=False)}</code>".replace("\\|", "&#124;")

    return PIPES.sub(changed, text)


def is_picture(file: Path) -> bool:
    """Whether a file is shown as it is."""
    return file.suffix in (".jpg", ".png", ".svg", ".webp")


def listing(file: Path) -> str:
    """A page that shows a text file."""
    name = file.relative_to(ROOT).as_posix()
    text = file.read_text("utf-8").rstrip("\n")
    first = text.split("\n", 1)[0]
    scripts = "python" if "python" in first else "bash" if first.startswith("#!") else "text"
    return f"# {name}\n\n````{LANGUAGES.get(file.suffix, scripts)}\n{text}\n````\n"


def copy(file: Path, target: Path) -> None:
    """Copies a file that is not there yet, or is older."""
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy2(file, target)


def stage(folder: Path) -> list[str]:
    """Fills the folder; returns links that lead nowhere."""
    shutil.rmtree(folder, ignore_errors=True)
    pages = Pages(folder)
    made = {f"api/{name}": text for name, text in api.pages().items()}
    pages.generated = set(made)
    for file in sorted(DOCS.rglob("*")):
        place = file.relative_to(DOCS).as_posix()
        if file.suffix == ".md" and place not in made:
            made[place] = file.read_text("utf-8")
        elif file.is_file() and file.suffix != ".md":
            copy(file, folder / place)
    for place, text in made.items():
        generated = place.startswith("api/") and place != "api/README.md"
        pages.write(place, text if generated else pages.relinked(text, DOCS / place, place))
    pages.add_sources()
    for name in PARTS:
        copy(Path(__file__).with_name(name), folder / "manual" / name)
    return pages.missing


def main() -> int:
    """Stages the pages; names links that lead nowhere."""
    missing = stage(Path(sys.argv[1]))
    print("\n".join(missing), file=sys.stderr, end="\n" if missing else "")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
