"""Checks a site: links resolve, nothing comes from another host, ids and headings are in order.

python script/docs/manual/check.py build/manual/site
"""

from __future__ import annotations

import itertools
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

#: Elements whose address a browser asks for by itself; an `a` is followed by hand.
FETCHED = {"script", "img", "iframe", "source", "video", "audio", "embed", "object"}
LINKS = {"stylesheet", "icon", "preload", "prefetch", "preconnect", "dns-prefetch", "manifest"}
_STYLE = re.compile(r"(?:url\(\s*|@import\s+)['\"]?((?:https?:)?//[^)'\"\s]+)")


class Page(HTMLParser):
    """Addresses and anchors of one page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.twice: list[str] = []  # ids of two elements
        self.headings: list[int] = []  # their levels, in order
        self.followed: list[str] = []
        self.fetched: list[str] = _STYLE.findall(text)
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Keeps what an element names, asks for or leads to."""
        given = {name: value or "" for name, value in attrs}
        self.twice += {given["id"]} & self.anchors if "id" in given else ()
        if re.fullmatch(r"h[1-6]", tag):
            self.headings.append(int(tag[1]))
        self.anchors |= {given[name] for name in ("id", "name") if name in given}
        if tag in FETCHED and (given.get("src") or given.get("data")):
            self.fetched.append(given.get("src") or given["data"])
        elif tag == "link" and LINKS & set(given.get("rel", "").split()):
            self.fetched.append(given.get("href", ""))
        elif tag == "a" and "href" in given:
            self.followed.append(given["href"])


def faults(site: Path) -> list[str]:
    """A line for each broken link, foreign address, repeated id and skipped level of headings."""
    pages = {file: Page(file.read_text("utf-8")) for file in sorted(site.rglob("*.html"))}
    found = []
    for file, page in pages.items():
        name = file.relative_to(site)
        if name.name == "404.html":  # a server shows it at any depth
            continue
        found += [f"{name}: asks another host: {url}" for url in page.fetched if is_other(url)]
        found += [f"{name}: two elements have the id {anchor}" for anchor in page.twice]
        found += [
            f"{name}: a heading of level {below} follows one of level {above}"
            for above, below in itertools.pairwise(page.headings)
            if below > above + 1
        ]
        for url in [*page.followed, *page.fetched]:
            if not is_other(url) and not reached(file, url, pages):
                found.append(f"{name}: leads nowhere: {url}")
    for file in site.rglob("*.css"):
        asked = _STYLE.findall(file.read_text("utf-8"))
        found += [f"{file.relative_to(site)}: asks another host: {url}" for url in asked]
    return found


def is_other(url: str) -> bool:
    """Whether an address is not of the site."""
    parts = urlsplit(url)
    return bool(parts.scheme or parts.netloc)


def reached(file: Path, url: str, pages: dict[Path, Page]) -> bool:
    """Whether there are such a file and such an anchor."""
    parts = urlsplit(url)
    goal = (file.parent / unquote(parts.path)).resolve() if parts.path else file
    if goal.is_dir():
        goal /= "index.html"
    anchor = unquote(parts.fragment)
    if goal in pages:
        return not anchor or anchor == "__top" or anchor in pages[goal].anchors
    return goal.is_file()


def main() -> int:
    """Prints the faults."""
    found = faults(Path(sys.argv[1]).resolve())
    print("\n".join(found), file=sys.stderr, end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
