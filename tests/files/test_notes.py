"""Notes of readers: counted, and the first use by name."""

from __future__ import annotations

from daguerre.files.notes import Notes


def test_a_note_tells_its_count_and_the_first_name() -> None:
    notes = Notes()
    notes.add("left out")
    for name in ("a.png", "b.png"):
        notes.add("missing", name=name)
    notes.add("lost", name="x\n" * 500)
    assert notes.sentences()[:2] == ["left out (1 use)", "missing (2 uses, the first 'a.png')"]
    assert len(notes.sentences()[2]) < 300
