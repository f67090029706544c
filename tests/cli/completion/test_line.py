"""Words of unfinished lines of bash."""

from __future__ import annotations

import pytest

from daguerre.cli.completion.line import Line, split

BREAKS = " \t\n\"'><=;|&(:"


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("d ren", Line(["d"], "ren", "")),
        ("d render ", Line(["d", "render"], "", "")),
        (r"d a\ b", Line(["d"], "a b", "")),
        ('d "a b', Line(["d"], "a b", "")),
        ("d 'a b' c", Line(["d", "a b"], "c", "")),
        ("d x'a b", Line(["d"], "xa b", "x")),
        ("d --lens=can", Line(["d"], "--lens=can", "--lens=")),
        ('d --env="a b', Line(["d"], "--env=a b", "--env=")),
        (r"d a\:b:c", Line(["d"], "a:b:c", "a:b:")),
        ('d "a:b', Line(["d"], "a:b", "")),
        (r'd "a\\b', Line(["d"], r"a\b", "")),
        (r"d 'a\b", Line(["d"], r"a\b", "")),
        ("d x > y", Line(["d", "x", ">"], "y", "")),
        ("d x > y z", Line(["d", "x"], "z", "")),
        ("d '' x", Line(["d", ""], "x", "")),
        ("", Line([], "", "")),
    ],
)
def test_words_and_what_bash_keeps(text: str, wanted: Line) -> None:
    assert split(text, BREAKS) == wanted
