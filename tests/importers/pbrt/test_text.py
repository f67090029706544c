"""The text of scenes: numbers in bulk, strings, comments, files, places of errors, and counts."""

from __future__ import annotations

import gzip
import random
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.importers.pbrt import interpreter
from daguerre.importers.pbrt.files import Files
from daguerre.importers.pbrt.lexer import Lexer
from daguerre.importers.pbrt.place import FilePlace, SceneFile

from .everything import everything
from .text import SQUARE, count, counted, read, written


class _NoFiles:
    def enter(self, name: str, place: FilePlace) -> SceneFile:
        place.fail(f"no files here: {name}")

    def leave(self) -> None:
        raise AssertionError


def _values(text: str) -> object:
    lexer = Lexer(SceneFile("a.pbrt", text.encode()), _NoFiles())
    return lexer.values(lexer.place("Shape"))


def test_numbers_in_bulk_are_those_of_their_words() -> None:
    rng = np.random.default_rng(1)
    numbers = rng.normal(size=5000) * 10.0 ** rng.integers(-30, 30, 5000)
    words = [f"{x:.9g}" for x in numbers] + ["1", "-0", "+3.", ".5", "1e5", "1E-5", "007"]
    found = _values(f"[{' '.join(words)}]")
    assert isinstance(found, np.ndarray)
    assert found.tolist() == [float(word) for word in words]


@pytest.mark.parametrize(
    "word", ["1-2", "0x10", "1_0", "nan", "inf", "1e999", "--1", "1e", ".", "x"]
)
@pytest.mark.parametrize("many", [0, 3, 500])
def test_a_word_that_is_no_number_has_its_place(word: str, many: int) -> None:
    before = "1 2\n" * many
    with pytest.raises(dg.InputError, match=rf"line {many + 2}, column 3: Shape: wanted a number"):
        _values(f"[\n{before}1 {word} 3 4]" if many else f"[\n1 {word} 3]")


def test_comments_strings_and_brackets() -> None:
    assert _values('["a]" # no ]\n "b\\"c" "d\\\\"]') == ["a]", 'b"c', "d\\"]
    assert np.array_equal(np.asarray(_values("[1 # 2 ]\n 3]")), [1, 3])
    assert _values("[true false]") == [True, False]
    assert np.array_equal(np.asarray(_values("[]")), [])
    with pytest.raises(dg.InputError, match="line 1, column 6: Shape: wanted a string, got '3'"):
        _values('["a" 3]')


def test_used_and_noted_are_all_directives(tmp_path: Path) -> None:
    path, texts = everything(tmp_path)
    scene, ledger = counted(path)
    assert ledger.waiting == 0
    assert ledger.used + ledger.noted == sum(count(text) for text in texts)
    assert ledger.used > 60
    assert ledger.noted > 5
    told = sum(int(note.rsplit("(", 1)[1].split()[0]) for note in scene.warnings)
    assert told >= ledger.noted


def test_a_directive_that_is_dropped_is_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The planted fault: a handler that forgets its directive."""
    path, texts = everything(tmp_path)
    monkeypatch.setattr(interpreter.Interpreter, "_on_Identity", lambda self, directive: None)
    _, ledger = counted(path)
    assert ledger.used + ledger.noted == sum(count(text) for text in texts)
    assert any(
        "Identity: one that the scene does not use" in note for note in ledger.notes.sentences()
    )


def test_parameters_that_nothing_reads_are_told(tmp_path: Path) -> None:
    scene = read(tmp_path, 'Shape "sphere" "float radius" 2 "float size" 3')
    assert "'size' of Shape 'sphere' is not read (1 use)" in scene.warnings
    assert not any("radius" in note for note in scene.warnings)


def test_include_stands_anywhere_and_keeps_the_state_but_import_does_not(tmp_path: Path) -> None:
    (tmp_path / "radius.pbrt").write_text('"float radius" 3')
    (tmp_path / "move.pbrt").write_text("Translate 1 0 0")
    with gzip.open(tmp_path / "packed.pbrt.gz", "wt") as stream:
        stream.write("Translate 0 5 0")
    scene = read(
        tmp_path,
        'Include "move.pbrt" Import "move.pbrt" Include "packed.pbrt.gz" '
        'Shape "sphere" Include "radius.pbrt" "float phimax" 360',
    )
    assert np.allclose(scene.instances[0].transform[:3, 3], (1, 5, 0))
    assert abs(np.linalg.det(scene.instances[0].transform)) == pytest.approx(27)


def test_places_are_those_of_the_included_file(tmp_path: Path) -> None:
    (tmp_path / "inner.pbrt").write_text('\n\n  Shape "sphere" "float radius" "a"')
    with pytest.raises(dg.InputError, match=r"inner\.pbrt: line 3, column 18: Shape: radius"):
        read(tmp_path, 'Include "inner.pbrt"')


def test_files_within_files_have_limits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for i in range(40):
        (tmp_path / f"f{i}.pbrt").write_text(f'Include "f{i + 1}.pbrt"\n' * 2)
    with pytest.raises(dg.InputError, match="too many nested files: the limit is 32"):
        read(tmp_path, 'Include "f0.pbrt"')
    (tmp_path / "f30.pbrt").write_text("")
    with pytest.raises(dg.InputError, match=r"too many files are included again: .* 10000"):
        read(tmp_path, 'Include "f10.pbrt"')
    (tmp_path / "long.pbrt").write_text("# " + "a" * (1 << 20))
    with pytest.raises(dg.InputError, match="included again: wanted at most 67108864 bytes"):
        read(tmp_path, 'Include "long.pbrt"\n' * 70)
    monkeypatch.setattr("daguerre.files.includes.MAX_FILES", 10)
    with pytest.raises(dg.InputError, match="too many files: the limit is 10"):
        read(tmp_path, 'Include "f10.pbrt"')
    monkeypatch.setattr("daguerre.importers.pbrt.files.MAX_BYTES", 100)
    with pytest.raises(dg.InputError, match="wanted at most"):
        dg.load(written(tmp_path, "# " + "a" * 200))


def test_a_packed_bomb_is_refused(tmp_path: Path) -> None:
    (tmp_path / "bomb.pbrt.gz").write_bytes(gzip.compress(b" " * (200 << 20)))
    with pytest.raises(dg.InputError, match="unpack"):
        read(tmp_path, 'Include "bomb.pbrt.gz"')


def test_files_outside_of_the_folder_are_refused(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    (tmp_path / "a.ply").write_text("ply")
    text = 'Shape "plymesh" "string filename" "../a.ply"'
    path = written(tmp_path / "in", text)
    with pytest.raises(dg.InputError, match="filename: leaves the scene's folder"):
        dg.load(path)
    with pytest.raises(dg.InputError, match=r"a\.ply"):
        dg.load(path, allow_dirs=[tmp_path])


def test_mutated_files_give_a_scene_or_one_error(tmp_path: Path) -> None:
    path, _ = everything(tmp_path)
    whole = path.read_bytes()
    words = [b'"', b"[", b"]", b"-1", b"1e38", b"0", b"nan", b"#", b"AttributeEnd", b"Shape", b" "]
    rng = random.Random(29)
    told = []
    for _ in range(500):
        data = bytearray(whole)
        for _ in range(rng.randint(1, 4)):
            at = rng.randrange(len(data))
            if rng.random() < 0.5:
                data[at : at + rng.randint(0, 3)] = rng.choice(words)
            else:
                data[at] = rng.randrange(256)
        path.write_bytes(data)
        try:
            dg.load(path)
        except dg.InputError as error:
            told.append(str(error))
    assert all(text.startswith(str(tmp_path)) for text in told)
    assert all(len(text.splitlines()) == 1 for text in told)
    assert 100 < len(told) < 500


def test_small_files_do_not_ask_for_much(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    many = " ".join(f'Shape "sphere" "float radius" {i + 1}' for i in range(50))
    assert len(read(tmp_path, many).meshes) == 1
    cut = " ".join(f'Shape "sphere" "float zmax" {i / 50}' for i in range(50))
    monkeypatch.setattr("daguerre.importers.pbrt.meshes.MAX_TRIANGLES", 300_000)
    with pytest.raises(
        dg.InputError, match="Shape: too many triangles of shapes: the limit is 300000"
    ):
        read(tmp_path, cut)
    tetrahedron = (
        'Shape "loopsubdiv" "point3 P" [0 0 0 1 0 0 0 1 0 0 0 1] '
        '"integer indices" [0 2 1 0 1 3 1 2 3 2 0 3] "integer levels" 10'
    )
    monkeypatch.setattr("daguerre.importers.pbrt.shapes._MOST_FACES", 1000)
    scene = read(tmp_path, tetrahedron)
    assert len(scene.meshes[0].indices) == 256
    assert any("gets fewer levels (7 uses)" in note for note in scene.warnings)


def test_the_folder_of_names_is_that_of_the_first_file(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "a.pbrt").write_text('Include "parts/b.pbrt"')
    (tmp_path / "parts" / "b.pbrt").write_text('Shape "sphere"')
    assert len(read(tmp_path, 'Include "parts/a.pbrt"').meshes) == 1
    assert Files(tmp_path / "x", lambda place: None).picture("x", "no.png").parent == tmp_path


def test_a_mark_of_byte_order_is_no_text(tmp_path: Path) -> None:
    path = written(tmp_path, SQUARE)
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    assert len(dg.load(path).meshes) == 1


@pytest.mark.parametrize(
    ("options", "world", "wrong"),
    [
        (
            "",
            "Scale 1e30 1e30 1e30\n" * 20 + SQUARE,
            "line 6, column 1: Scale: numbers of the matrix",
        ),
        (
            "",
            'LightSource "point" "rgb I" [-1 0 0]',
            "line 3, column 21: LightSource: I: numbers must be at least 0",
        ),
        (
            "",
            'AreaLightSource "diffuse" "rgb L" [0 -1 0]\n' + SQUARE,
            "AreaLightSource: L: numbers must be at least 0",
        ),
        ("", 'Shape "disk" "float height" 1e38', "line 3, column 1: Shape: disk: height: wanted"),
        ("", 'Shape "cylinder" "float zmax" 1e38', "line 3, column 1: Shape: cylinder: high: wan"),
        ('Camera "perspective" "float lensradius" 1e30', SQUARE, "line 1, column 1: Camera: "),
        ('Camera "perspective" "float shutterclose" 1e30', SQUARE, "line 1, column 1: Camera: "),
    ],
)
def test_values_that_fit_nowhere_have_a_place(
    options: str, world: str, wrong: str, tmp_path: Path
) -> None:
    with pytest.raises(dg.errors.InputError, match=f"scene.pbrt: .*{wrong}"):
        dg.load(written(tmp_path, world, options))


def test_a_light_outside_of_the_gamut_has_no_negative_part(tmp_path: Path) -> None:
    world = 'ColorSpace "rec2020"\nLightSource "point" "rgb I" [1 0 0]\n' + SQUARE
    ((light, _),) = dg.load(written(tmp_path, world)).lights
    assert min(light.intensity) == 0 < light.intensity[0]
