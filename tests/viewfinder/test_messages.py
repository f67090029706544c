"""Messages of the page: the known ones are read, any other is one error."""

from __future__ import annotations

import json
import re
from importlib.resources import files
from typing import Any

import pytest

import daguerre as dg
from daguerre.viewfinder import messages as m


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"turn": {"f_stop": "2", "zoom": null}}', m.Turn({"f_stop": "2", "zoom": None})),
        ('{"got": 12}', m.Got(12)),
        ('{"probe": [3, 4.5]}', m.Probe(3, 4)),
        ('{"save": "png"}', m.Save("png")),
        ('{"draw": 256}', m.Draw(256)),
        ('{"section": [3, 4.5]}', m.Section(3, 4.5)),
        ('{"reload": true}', m.Reload()),
        ('{"undo": true}', m.Undo()),
        ('{"redo": true}', m.Redo()),
        ('{"hold": false}', m.Hold(False)),
        ('{"find": "canon zoom"}', m.Find("canon zoom")),
        ('{"facts": true}', m.Facts()),
        ('{"show": {"tint": "depth"}}', m.ShowOtherwise({"tint": "depth"})),
        ('{"show": {"denoised": null}}', m.ShowOtherwise({"denoised": None})),
        ('{"photograph": "double-gauss-50mm-f2"}', m.Photograph("double-gauss-50mm-f2")),
    ],
)
def test_a_message_is_read(text: str, message: Any) -> None:
    assert m.parse(text) == message


def test_page_and_server_agree_on_what_changes_the_picture() -> None:
    """The page counts answers: one of its messages without an answer would keep it waiting."""
    page = files("daguerre.viewfinder") / "page" / "main.js"
    listed = re.findall(r"const CHANGES = \[(.*)\]", page.read_text("utf-8"))[0]
    read = {
        "turn": {}, "draw": 1, "undo": True, "redo": True, "reload": True, "show": {"models": True},
        "got": 1, "probe": [1, 1], "save": "png", "hold": True, "section": [1, 1], "facts": True,
        "drawing": "fisheye-16mm-f2.8", "photograph": "fisheye-16mm-f2.8", "find": "zoom",
    }  # fmt: skip
    assert read.keys() == m._READERS.keys()
    changes = [k for k, v in read.items() if isinstance(m.parse(json.dumps({k: v})), m.Change)]
    assert changes == [name.strip(" '") for name in listed.split(",")]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "null",
        "[]",
        "12",
        '"turn"',
        "{}",
        b'{"got": 1}',
        "\ud800",
        "[" * 60000,
        '{"turn": ' * 5000,
        '{"turn": {}, "got": 1}',
        '{"turn": {}, "turn": {}}',
        '{"turn": {"f_stop": "2", "f_stop": "4"}}',
        '{"__proto__": {"role": "turns"}}',
        '{"constructor": {"prototype": {"x": 1}}}',
        '{"turn": {"__proto__": "1"}}',
        '{"turn": {"f_stop": 2}}',
        '{"turn": {"f_stop": ["2"]}}',
        '{"turn": "f_stop"}',
        '{"got": -1}',
        '{"show": {}}',
        '{"show": "models"}',
        '{"show": {"sepia": true}}',
        '{"show": {"models": 1}}',
        '{"show": {"models": null}}',
        '{"show": {"denoised": 0}}',
        '{"show": {"tint": ["depth"]}}',
        '{"show": {"beside": "f_stop"}}',
        '{"show": {"models": true, "beside": {"f_stop": "4"}}}',
        '{"got": 1.5}',
        '{"got": true}',
        '{"got": NaN}',
        '{"got": 1e400}',
        '{"probe": [1]}',
        '{"facts": 1}',
        '{"photograph": "../index"}',
        '{"photograph": null}',
        '{"probe": [1, "2"]}',
        '{"probe": [1, Infinity]}',
        '{"probe": {"0": 1, "1": 2, "length": 2}}',
        '{"save": "../../x.png"}',
        '{"save": ["png"]}',
        '{"draw": 0}',
        '{"draw": 99999999999}',
        '{"reload": 1}',
        '{"undo": 1}',
        '{"redo": null}',
        '{"hold": "yes"}',
        '{"find": 50}',
        '{"find": "' + "a" * 201 + '"}',
        '{"eval": "1"}',
    ],
)
def test_any_other_message_is_one_error(text: Any) -> None:
    with pytest.raises(dg.UsageError, match="wanted"):
        m.parse(text)


def test_a_message_beyond_the_limit_is_not_parsed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(m.json, "loads", lambda *given, **options: pytest.fail("it is"))
    text = '{"got": ' + "[" * m.MAX_BYTES
    with pytest.raises(dg.UsageError, match=f"message: wanted at most {m.MAX_BYTES} characters"):
        m.parse(text)


def test_long_messages_are_shortened_in_errors() -> None:
    with pytest.raises(dg.UsageError) as caught:
        m.parse(json.dumps({"x" * 50000: 1}))
    assert len(str(caught.value)) < 300
