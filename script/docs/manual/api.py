"""Pages of the Python API, from the docstrings of every public name.

Which names are public, ``script/public-face`` says; the test of the manual holds that each of them
has a place on a page.
"""

from __future__ import annotations

import dataclasses
import functools
import inspect
import re
import runpy
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from docstrings import Docstring, line_safe, parsed

ROOT = Path(__file__).resolve().parents[3]
FACE = runpy.run_path(str(ROOT / "script" / "public-face"))

#: Pages of the names of ``daguerre`` itself, by the rooms that make them.
ROOMS = {
    "camera": ("camera", "Cameras"),
    "scene": ("scene", "Scenes: meshes, materials, lights"),
    "motion": ("motion", "Motion: keys and spins"),
    "rendering": ("rendering", "Rendering"),
    "frame": ("frame", "Frames and raw files"),
    "maps": ("maps", "STMaps and raymaps"),
    "plates": ("plates", "Plates: match, light, composite"),
    "labels": ("labels", "Labels for learning"),
    "analysis": ("calibrate", "Calibrating a lens"),
    "errors": ("errors", "Errors"),
}
REST = ("package", "The package")


def pages() -> dict[str, str]:
    """Texts of the pages by their file names."""
    made: dict[str, list[str]] = {}
    titles = dict([*ROOMS.values(), REST])
    top = FACE["module_named"]("")
    for name in sorted(top.__all__, key=str.lower):
        value = getattr(top, name)
        made.setdefault(page_of(value), []).extend(entry(f"dg.{name}", value))
    texts = {stem: page(titles[stem], "", made[stem]) for stem in titles if stem in made}
    for module in filter(None, FACE["MODULES"]):
        texts[module] = module_page(module)
    texts["more"] = more_page()
    texts["README"] = index_page(texts)
    return {f"{stem}.md": text for stem, text in texts.items()}


def page_of(value: Any) -> str:
    """The page of a name of ``daguerre`` itself."""
    if inspect.ismodule(value):
        return REST[0]
    room = (
        (getattr(value, "__module__", "") or "").removeprefix("daguerre").strip(".").split(".")[0]
    )
    return ROOMS.get(room, REST)[0]


def page(title: str, head: str, blocks: list[str]) -> str:
    """A page with its title."""
    return "\n\n".join(filter(None, [f"# {title}", head, *blocks])) + "\n"


def module_page(module: str) -> str:
    """All names of one module."""
    found = FACE["module_named"](module)
    blocks: list[str] = []
    for name in sorted(found.__all__, key=str.lower):
        blocks += entry(f"dg.{module}.{name}", getattr(found, name))
    return page(f"daguerre.{module}", "\n\n".join(parsed(found.__doc__).markdown()), blocks)


def more_page() -> str:
    """Names that pages of this manual import from elsewhere."""
    blocks: list[str] = []
    for module, names in FACE["DOCUMENTED"].items():
        found = FACE["module_named"](module)
        for name in names:
            if hasattr(found, name):
                blocks += entry(f"dg.{module}.{name}", getattr(found, name))
    return page(
        "Other public names", "Names that pages of this manual use from other modules.", blocks
    )


def index_page(texts: dict[str, str]) -> str:
    """The page of docs/api, and under it every page with the names on it."""
    blocks = []
    for stem, text in texts.items():
        title = text.splitlines()[0].removeprefix("# ")
        names = re.findall(r'^<a id="([^"]+)"></a>\n\n## ', text, re.MULTILINE)
        links = ", ".join(f"[`{name.rsplit('.', 1)[1]}`]({stem}.md#{name})" for name in names)
        blocks.append(f"**[{title}]({stem}.md)**: {links}")
    head = (ROOT / "docs" / "api" / "README.md").read_text("utf-8")
    return "\n\n".join([head.rstrip(), "## Every public name", *blocks]) + "\n"


def entry(path: str, value: Any) -> list[str]:
    """A public name: a class with its members, a function, a module or a value."""
    head = [anchor(path), f"## {path.rsplit('.', 1)[1] if path.count('.') else path}"]
    if inspect.ismodule(value):
        name = path.removeprefix("dg.")
        target = f"{name}.md" if name in FACE["MODULES"] else "more.md"
        return [*head, f"Module, [described on its own page]({target}).", *first(value)]
    if inspect.isclass(value):
        return [*head, *class_blocks(path, value)]
    if callable(value):
        return [*head, signature(path, value), *parsed(value.__doc__).markdown()]
    return [*head, f"Value: `{FACE['default_text'](value)}`" if "version" not in path else "Text."]


def anchor(path: str) -> str:
    """A place that links can name."""
    return f'<a id="{path}"></a>'


def first(value: Any) -> list[str]:
    """The first paragraph of a docstring."""
    return parsed(value.__doc__).text.split("\n\n")[:1]


def class_blocks(path: str, cls: type) -> list[str]:
    """A class: how to make it, its fields, and its public members."""
    doc = parsed(cls.__doc__)
    fields = dataclasses.fields(cls) if dataclasses.is_dataclass(cls) else ()
    rows = [field_row(path, one, doc) for one in fields if not one.name.startswith("_")]
    members = list(member_blocks(path, cls, {one.name for one in fields}, doc))
    text, *rest = doc.markdown() or [""]
    blocks = [signature(path, cls) if not rows else "", text, *rest]
    if rows:
        blocks += ["**Fields**", "\n".join(rows)]
    return [block for block in [*blocks, *members] if block]


def field_row(path: str, one: dataclasses.Field[Any], doc: Docstring) -> str:
    """A field of a dataclass in one line."""
    said = doc.taken(one.name)
    default = " ".join(FACE["field_text"](one).split())
    kind = f" `{default}`" if default else ""
    return f"- {anchor(f'{path}.{one.name}')}**`{one.name}`**{kind}" + (f": {said}" if said else "")


def member_blocks(path: str, cls: type, known: set[str], doc: Docstring) -> Iterator[str]:
    """Methods, properties and values that a class has from us."""
    ours = [base for base in cls.__mro__ if base.__module__.startswith("daguerre")]
    for name in sorted({name for base in ours for name in vars(base)} - known):
        if not name.startswith("_"):
            member = inspect.getattr_static(cls, name)
            yield f"{anchor(f'{path}.{name}')}\n\n### {name}"
            yield from member_text(name, member, doc.taken(name))


def member_text(name: str, member: Any, said: str) -> list[str]:
    """Blocks under the head of a member."""
    if isinstance(member, staticmethod | classmethod):
        kind = "static method" if isinstance(member, staticmethod) else "class method"
        return [signature(name, member.__func__, kind), *parsed(member.__doc__).markdown()]
    if isinstance(member, property | functools.cached_property):
        kind = "Property, settable." if getattr(member, "fset", None) else "Property."
        return [kind, *(parsed(member.__doc__).markdown() or [said])]
    if inspect.isclass(member):
        return ["Class.", *parsed(member.__doc__).markdown()]
    if callable(member):
        return [signature(name, member), *parsed(member.__doc__).markdown()]
    if inspect.isdatadescriptor(member):
        return ["Attribute.", said or line_safe(member.__doc__ or "")]
    return [f"Value: `{FACE['default_text'](member)}`", said]


def signature(path: str, function: Any, kind: str = "") -> str:
    """How it is called: on one line where it fits, else a parameter a line."""
    name = path.rsplit(".", 1)[-1]
    try:
        found = inspect.signature(function)
    except (TypeError, ValueError):  # of the core: its docstring says it
        return ""
    parameters = [one for one in found.parameters.values() if one.name not in ("self", "cls")]
    texts = listed(parameters)
    back = found.return_annotation
    end = "" if back is inspect.Signature.empty else f" -> {shown(back)}"
    line = f"{name}({', '.join(texts)}){end}"
    if len(line) > 88:
        line = f"{name}(\n" + "".join(f"    {text},\n" for text in texts) + f"){end}"
    return (f"*{kind}*\n\n" if kind else "") + f"```python\n{line}\n```"


def listed(parameters: list[inspect.Parameter]) -> list[str]:
    """Parameters as they are written, with the marks that say how they are passed."""
    texts, starred = [], False
    for one in parameters:
        if one.kind is one.KEYWORD_ONLY and not starred:
            texts.append("*")
            starred = True
        starred = starred or one.kind is one.VAR_POSITIONAL
        mark = {one.VAR_POSITIONAL: "*", one.VAR_KEYWORD: "**"}.get(one.kind, "")
        kind = "" if one.annotation is one.empty else f": {shown(one.annotation)}"
        default = "" if one.default is one.empty else f" = {FACE['default_text'](one.default)}"
        texts.append(f"{mark}{one.name}{kind}{default}")
    return texts


def shown(annotation: Any) -> str:
    """A type as readers name it."""
    text = annotation if isinstance(annotation, str) else inspect.formatannotation(annotation)
    return re.sub(
        r"\b(?:daguerre|numpy|collections\.abc|typing|pathlib)(?:\.\w+)*\.(?=\w)", "", text
    )
