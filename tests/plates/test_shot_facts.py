"""Facts of a shot from EXIF and XMP: those of independent readers, and never of maker notes."""

from __future__ import annotations

import random
from fractions import Fraction
from pathlib import Path

import pytest
from PIL import Image

from daguerre.files.notes import Notes
from daguerre.pictures.exif_reader import exif_tags
from daguerre.pictures.xmp import xmp_tags
from daguerre.plates.files import read
from daguerre.plates.probe.shots import read_shot
from tests.support.formats.exif_files import (
    RATIONAL,
    SHORT,
    SHOT,
    SRATIONAL,
    block,
    photograph,
    xmp,
)

exifread = pytest.importorskip("exifread")

#: Files that are kept beside the project.
CASES = Path(__file__).parents[3] / "shared" / "cases" / "files"
USUAL = {"expTime": 1 / 200, "aperture": 8.0, "isoSpeed": 200.0, "nominalFocalLength": 50.0}
ENDINGS = (".jpg", ".png", ".webp", ".tif")


def told(found):
    return {name: found.facts.get(name) for name in USUAL}


@pytest.mark.parametrize("order", "<>")
@pytest.mark.parametrize("ending", ENDINGS)
def test_facts_are_those_of_other_readers(tmp_path, ending, order):
    """The file has a maker note and a thumbnail with other numbers under the same tags."""
    path = photograph(tmp_path / f"x{ending}", block(SHOT, order=order))
    found = read(path)
    assert told(found) == pytest.approx(USUAL)
    assert (found.facts["cameraMake"], found.facts["lensModel"]) == ("Own", "own 50mm")
    assert found.notes == ()
    if ending != ".webp":  # exifread finds none there
        with path.open("rb") as file:
            tags = exifread.process_file(file, details=False)
        assert Fraction(str(tags["EXIF ExposureTime"])) == Fraction(
            found.facts["expTime"]
        ).limit_denominator(10000)
        assert Fraction(str(tags["EXIF FNumber"])) == found.facts["aperture"]
        assert int(str(tags["EXIF ISOSpeedRatings"])) == found.facts["isoSpeed"]
    with Image.open(path) as image:
        exif = image.getexif().get_ifd(0x8769)
    assert (exif[33434], exif[33437], exif[34855]) == (Fraction(1, 200), 8, 200)


@pytest.mark.parametrize("ending", ENDINGS[:3])
def test_exif_goes_before_xmp_and_a_note_tells_the_difference(tmp_path, ending):
    packet = xmp(FNumber="56/10", ExposureTime="1/2", ISOSpeedRatings="800", Orientation=6)
    found = read(photograph(tmp_path / f"x{ending}", block(SHOT), packet))
    assert told(found) == pytest.approx(USUAL)
    assert found.size == (32, 24)
    assert found.notes == (
        "exposure time: EXIF has 0.005 s, XMP 0.5 s: took EXIF's",
        "f-number: EXIF has 8, XMP 5.6: took EXIF's",
        "ISO: EXIF has 200, XMP 800: took EXIF's",
        "orientation: EXIF has 1, XMP 6: took EXIF's",
    )


@pytest.mark.parametrize("ending", ENDINGS[:3])
def test_xmp_gives_values_that_exif_lacks(tmp_path, ending):
    packet = xmp(
        FNumber="8/1",
        ExposureTime="1/200",
        ISOSpeedRatings="200",
        FocalLength="50/1",
        Orientation=6,
    )
    found = read(photograph(tmp_path / f"x{ending}", b"", packet))
    assert told(found) == pytest.approx(USUAL)
    assert found.size == (24, 32)
    agreeing = photograph(tmp_path / f"y{ending}", block(SHOT, {274: (SHORT, (6,))}), packet)
    assert read(agreeing).notes == ("turned upright: EXIF orientation 6",)


def test_values_of_apex_count_where_alone(tmp_path):
    apex = {37377: (SRATIONAL, (-2, 1)), 37378: (RATIONAL, (497, 100)), 34855: (SHORT, (200,))}
    found = read(photograph(tmp_path / "x.jpg", block(apex)))
    assert found.facts["expTime"] == pytest.approx(4)
    assert found.facts["aperture"] == pytest.approx(5.6, rel=1e-3)
    near = {**SHOT, 37377: (SRATIONAL, (76, 10)), 37378: (RATIONAL, (6, 1))}
    found = read(photograph(tmp_path / "y.jpg", block(near)))
    assert told(found) == pytest.approx(USUAL)
    assert found.notes == ()
    far = {**SHOT, 37377: (SRATIONAL, (5, 1)), 37378: (RATIONAL, (4, 1))}
    found = read(photograph(tmp_path / "z.jpg", block(far)))
    assert told(found) == pytest.approx(USUAL)
    assert [note.split(":")[0] for note in found.notes] == ["exposure time", "f-number"]


def test_lenses_without_contacts_have_no_f_number(tmp_path):
    manual = {33437: (RATIONAL, (0, 1)), 37378: (RATIONAL, (0, 1))}
    assert "aperture" not in read(photograph(tmp_path / "x.jpg", block(manual))).facts


@pytest.mark.parametrize(
    ("tags", "iso"),
    [
        ({34855: (SHORT, (200, 200))}, 200),
        ({34855: (SHORT, (100, 0, 0))}, 100),
        ({34855: (SHORT, (65535,)), 34866: (4, (102400,))}, 102400),
        ({34865: (4, (640,))}, 640),
        ({34855: (SHORT, (65535,))}, 65535),
    ],
)
def test_iso_of_several_numbers_and_beyond_16_bits(tmp_path, tags, iso):
    assert read(photograph(tmp_path / "x.jpg", block(tags))).facts["isoSpeed"] == iso


@pytest.mark.parametrize("value", [0, 9, 65535])
def test_orientations_that_are_none(tmp_path, value):
    found = read(photograph(tmp_path / "x.jpg", block(SHOT, {274: (SHORT, (value,))})))
    assert (found.size, found.notes) == ((32, 24), ())


@pytest.mark.parametrize("packet", [b"<x", b'<!DOCTYPE x [<!ENTITY a "b">]><x>&a;</x>'])
def test_xmp_that_is_none_is_told(tmp_path, packet):
    found = read(photograph(tmp_path / "x.jpg", block(SHOT), packet))
    assert told(found) == pytest.approx(USUAL)
    assert found.notes[0].startswith("XMP: ignored")


def test_histories_in_xmp_are_not_the_shot():
    packet = xmp(FNumber="8/1").replace(
        b"</rdf:Description>",
        b"<exif:Flash><rdf:Description><exif:ExposureTime>9/1</exif:ExposureTime>"
        b"</rdf:Description></exif:Flash></rdf:Description>",
    )
    assert xmp_tags(packet) == {"FNumber": (8, 1)}


def test_damaged_blocks_lose_tags_and_no_more(tmp_path):
    whole, dice = block({**SHOT, 37382: (RATIONAL, (3, 1))}), random.Random(1)
    for _ in range(3000):
        data = bytearray(whole[: dice.choice([len(whole), dice.randrange(len(whole))])])
        for _ in range(dice.randrange(1, 6)):
            if data:
                data[dice.randrange(len(data))] = dice.randrange(256)
        assert isinstance(exif_tags(bytes(data)), dict)


@pytest.mark.parametrize("ending", ENDINGS[:3])
def test_plates_and_probes_read_the_same(tmp_path, ending):
    path = photograph(tmp_path / f"x{ending}", block(SHOT), xmp(FNumber="4/1"))
    notes = Notes()
    shot, plate = read_shot(path, None, notes), read(path)
    assert shot.facts == plate.facts
    assert [n.removesuffix(" (1 use)") for n in notes.sentences()] == list(plate.notes)


@pytest.mark.skipif(not CASES.is_dir(), reason="../shared/cases/files is not here")
@pytest.mark.parametrize("name", ["exif_and_xmp.jpg", "exif_plain.jpg", "exif_turned.jpg"])
def test_files_that_were_read_wrongly(name):
    found = read(CASES / name)
    assert told(found) == pytest.approx(USUAL)
    assert found.size == ((120, 160) if "turned" in name else (160, 120))
