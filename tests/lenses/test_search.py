"""Search for lenses, as photographers ask for them."""

from __future__ import annotations

import json
import time

import pytest

import daguerre as dg
from daguerre import lenses
from daguerre.cli import main
from daguerre.lenses import index, search
from daguerre.lenses.kinds import KINDS, kinds_of
from daguerre.lenses.spelling import distance, is_slip
from daguerre.lenses.words import words_of

ENTRIES = index.entries()


def found(words: str) -> list[str]:
    return [entry.name for entry in lenses.find(words)]


def kinds(name: str) -> set[str]:
    (entry,) = [entry for entry in ENTRIES if entry.name == name]
    return {kind.words[0] for kind in kinds_of(entry)}


@pytest.mark.parametrize(
    ("words", "names"),
    [
        ("canon 50 1.2", ["canon-new-fd-50mm-f1.2", "canon-rf-50mm-f1.2"]),
        ("1.2 CANON 50mm", ["canon-new-fd-50mm-f1.2", "canon-rf-50mm-f1.2"]),
        ("canon 5cm f/1.2", ["canon-new-fd-50mm-f1.2", "canon-rf-50mm-f1.2"]),
        ("canon 50 mm 1:1.2", ["canon-new-fd-50mm-f1.2", "canon-rf-50mm-f1.2"]),
        ("canon 50 mm f 1,2", ["canon-new-fd-50mm-f1.2", "canon-rf-50mm-f1.2"]),
        ("canon zoom", ["canon-ef-11-24mm-f4", "canon-ef-24-70mm-f2.8"]),
        ("canon 35mm zoom", ["canon-ef-24-70mm-f2.8"]),
        ("70-200", ["nikon-af-s-70-200mm-f2.8", "sony-fe-70-200mm-f2.8"]),
        ("EF24-70mm f/2.8L II USM", ["canon-ef-24-70mm-f2.8"]),
        ("canon fish-eye", ["canon-ef-15mm-f2.8-fisheye"]),
        ("zeiss wide-angle 15", ["zeiss-hologon-15mm-f8"]),
        ("nikon micro", ["nikon-uv-105mm-f4.5"]),
        ("anamorphic", ["schneider-anamorphic-60mm"]),
        ("aps-c", ["sigma-17-40mm-f1.8"]),
        ("24x36 pancolar", ["zeiss-jena-pancolar-50mm-f2"]),
        ("1956", ["canon-35mm-f1.8", "nikon-nikkor-n-50mm-f1.1"]),
        ("1950s canon", ["canon-35mm-f1.8", "canon-serenar-100mm-f3.5", "canon-serenar-50mm-f1.8"]),
        ("US 2,701,982", ["angenieux-s1-50mm-f1.1"]),
        ("us2701982a", ["angenieux-s1-50mm-f1.1"]),
        ("voigtländer dynar", ["voigtlander-dynar-100mm-f6"]),
        ("VOIGTLANDER dynar", ["voigtlander-dynar-100mm-f6"]),
        ("bertele", ["sonnar-50mm-f2", "zeiss-jena-biogon-35mm-f2.8"]),
        ("helios", ["zeiss-biotar-50mm-f1.4"]),
        ("cooke", ["rodenstock-geronar-210mm-f6.8"]),
        ("t1.3", ["zeiss-master-prime-100mm-f1.24"]),
        ("super takumar 50", ["asahi-super-takumar-50mm-f1.4"]),
        ("cannon zoom", ["canon-ef-11-24mm-f4", "canon-ef-24-70mm-f2.8"]),
        ("ziess hologn", ["zeiss-hologon-15mm-f8"]),
        ("canon 50 1.4", []),
        ("noctilux", []),
    ],
)
def test_words_find_lenses(words: str, names: list[str]) -> None:
    assert found(words) == names


def test_each_lens_is_found_first_by_its_name_and_title() -> None:
    for entry in ENTRIES:
        assert found(entry.name)[0] == entry.name
        assert found(entry.title)[0] == entry.name


def test_each_maker_year_speed_and_focal_length_finds_its_lenses() -> None:
    for entry in ENTRIES:
        efl = f"{entry.efl_mm}mm"
        for word in (entry.maker, str(entry.year), f"f/{entry.f_number:g}", efl, entry.patent):
            assert entry.name in found(word), (entry.name, word)


def test_a_focal_length_at_an_end_of_a_zoom_comes_before_one_within() -> None:
    names = found("nikon zoom 200mm")
    assert names[0] in {"nikon-af-s-70-200mm-f2.8", "nikon-ai-80-200mm-f4"}
    assert names[2:] == ["nikon-af-s-120-300mm-f2.8", "nikon-af-s-180-400mm-f4"]


def test_no_words_find_all() -> None:
    assert found("") == found(" lens ") == lenses.names()


@pytest.mark.parametrize(
    ("name", "those", "not_those"),
    [
        ("canon-ef-11-24mm-f4", {"zoom", "wide", "ultrawide"}, {"prime", "normal", "tele"}),
        ("canon-ef-24-70mm-f2.8", {"zoom", "wide", "normal"}, {"tele"}),
        ("nikon-af-s-70-200mm-f2.8", {"zoom", "tele", "bokeh"}, {"wide", "normal", "supertele"}),
        ("canon-ef-600mm-f4", {"prime", "tele", "supertele"}, {"zoom", "portrait"}),
        ("canon-ef-85mm-f1.8", {"tele", "portrait"}, {"normal", "fast"}),
        ("olympus-xa-35mm-f2.8", {"wide"}, {"tele"}),
        ("canon-ef-100mm-f2.8-macro", {"macro", "tele"}, {"wide"}),
        ("panasonic-leica-dg-25mm-f1.4", {"normal", "mft", "fast"}, {"wide"}),
        ("rodenstock-geronar-210mm-f6.8", {"normal", "large"}, {"tele"}),
        ("hasselblad-hc-80mm-f2.8", {"normal", "medium"}, {"tele"}),
        ("schneider-anamorphic-60mm", {"anamorphic", "s35"}, {"tele"}),
        ("laikin-wide-angle-17mm-f4", {"wide"}, {"tele"}),
        ("nikon-fisheye-6mm-f5.6", {"fisheye", "ultrawide"}, {"tele"}),
        ("nikon-nikkor-50mm-f1.2", {"normal", "fast", "bokeh", "fullframe"}, {"wide", "tele"}),
    ],
)
def test_kinds_come_from_the_numbers(name: str, those: set[str], not_those: set[str]) -> None:
    assert those <= kinds(name)
    assert not not_those & kinds(name)


def test_a_telephoto_construction_with_a_wide_angle_is_wide() -> None:
    for words in ("tele", "telephoto", "telepho"):
        assert "olympus-xa-35mm-f2.8" not in found(words)
    assert "olympus-xa-35mm-f2.8" in found("wide compact")


def test_each_kind_has_a_lens_and_each_lens_a_kind() -> None:
    used = {kind.words for entry in ENTRIES for kind in kinds_of(entry)}
    assert used == {kind.words for kind in KINDS}
    assert all(kinds_of(entry) for entry in ENTRIES)


@pytest.mark.parametrize(
    ("text", "word", "slip"),
    [
        ("cannon", "canon", True), ("canno", "canon", True), ("cnaon", "canon", True),
        ("canin", "canon", True), ("zies", "zeiss", True), ("cnaan", "canon", False),
        ("voightlaender", "voigtlander", True), ("cam", "can", False), ("leica", "leitz", False),
    ],
)  # fmt: skip
def test_slips(text: str, word: str, slip: bool) -> None:
    assert is_slip(text, word) is slip


def test_distance_counts_each_slip_once() -> None:
    assert [distance("abcd", other) for other in ("abcd", "abdc", "abc", "xbcdy", "")] == [
        0, 1, 1, 2, 4
    ]  # fmt: skip


def test_odd_texts_are_words_too() -> None:
    for text in ("'\"\x00()", "\ud800", "½ ²", "9" * 190, "1.2.3-4x5", "f", "-", "ﬁsheye"):
        assert isinstance(found(text), list), text
        assert isinstance(search.suggest(text), str)
    assert [word.text for word in words_of("ﬁsheye")] == ["fisheye"]
    with pytest.raises(dg.UsageError, match="at most 200 characters, got 201"):
        lenses.find("a" * 201)
    with pytest.raises(dg.UsageError, match="find"):
        lenses.find(50)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("canon 50mm 1.4", "did you mean 'canon-rf-50mm-f1.2', 'canon-new-fd-50mm-f1.2' or "),
        ("cannon", "did you mean 'canon-35mm-f1.8', .* or 14 others"),
        ("canon 50 1.2", "'canon-new-fd-50mm-f1.2' or 'canon-rf-50mm-f1.2'"),
        ("helios 44", "did you mean 'zeiss-biotar-50mm-f1.4'"),
        ("nikon-50mm-f1.8", "'nikon-ai-s-50mm-f1.8' or 'nikon-z-50mm-f1.8'"),
        ("qwertz", "$"),
    ],
)
def test_a_wrong_name_suggests_what_a_search_finds(name: str, hint: str) -> None:
    with pytest.raises(dg.InputError, match=f"no lens of the library .*{hint}"):
        lenses.load(name)


def test_an_empty_name_suggests_nothing() -> None:
    assert search.suggest("") == ""


def test_the_command_lists_what_is_found(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lenses", "canon", "50", "1.2"]) == 0
    rows = capsys.readouterr().out.splitlines()
    assert [row.split()[0] for row in rows] == ["canon-new-fd-50mm-f1.2", "canon-rf-50mm-f1.2"]
    assert main(["lenses", "helios"]) == 0
    assert capsys.readouterr().out.split()[-1] == "Helios"
    assert main(["lenses", "canon zoom", "wide", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert [item["name"] for item in listed] == ["canon-ef-11-24mm-f4", "canon-ef-24-70mm-f2.8"]
    assert listed[0]["kinds"] == ["zoom", "wide", "ultrawide", "fullframe"]


@pytest.mark.parametrize("more", [[], ["--json"]])
def test_nothing_found_is_an_error_like_an_unknown_lens(
    capsys: pytest.CaptureFixture[str], more: list[str]
) -> None:
    assert main(["lenses", "canon", "50", "1.4", *more]) == main(["lens", "canon 50 1.4"]) == 3
    out, err = capsys.readouterr()
    assert out == ""
    first, second = err.splitlines()
    assert "lenses: no lens of the library matches 'canon 50 1.4' (did you mean " in first
    assert first.partition("(")[2] == second.partition("(")[2]
    assert main(["lenses", "noctilux"]) == 3
    assert "`daguerre lenses` lists all" in capsys.readouterr().err


def test_a_search_is_fast_and_parses_no_lens(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lenses.library, "read", lambda *_: pytest.fail("parsed a lens"))
    lenses.find("canon")
    start = time.process_time()
    lenses.find("canon 50 1.2")
    lenses.find("ziess wide")
    assert time.process_time() - start < 0.3
