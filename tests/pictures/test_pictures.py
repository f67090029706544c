"""Pictures of all kinds: told apart by their bytes, decoded here or apart, refused by name."""

from __future__ import annotations

import contextlib
import struct
import threading
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

from daguerre.errors import InputError
from daguerre.pictures import decoder, decoder_program
from daguerre.pictures.images import read_file
from daguerre.pictures.iris import read_grey
from daguerre.pictures.light import read_environment
from daguerre.pictures.reading import apart, jpeg, kinds, library, read, tiff
from daguerre.pictures.reading.source import PictureBytes
from daguerre.plates import files as plates
from daguerre.shading.picture_bytes import UnknownFormat, decoded

GREYS = (np.arange(40 * 60 * 3) % 251).astype(np.uint8).reshape(40, 60, 3)
HERE = ("png", "tif", "tga")
#: Formats that OpenImageIO writes without loss and Daguerre decodes apart.
APART = ("bmp", "dpx", "fits", "ico", "iff", "jp2", "jxl", "ppm", "sgi", "rla")


def write(path: Path, pixels: np.ndarray, kind: object = oiio.UINT8, **attributes: object) -> Path:
    """Writes a picture by its suffix."""
    height, width, channels = pixels.shape
    spec = oiio.ImageSpec(width, height, channels, kind)
    for key, value in attributes.items():
        spec.attribute(key, value)
    out = oiio.ImageOutput.create(str(path))
    assert out.open(str(path), spec), out.geterror()
    assert out.write_image(np.ascontiguousarray(pixels)), out.geterror()
    assert out.close()
    return path


def dds(pixels: np.ndarray) -> bytes:
    """A DDS of plain 24 bits, blue first."""
    height, width, _ = pixels.shape
    format = struct.pack("<8I", 32, 0x40, 0, 24, 0xFF0000, 0xFF00, 0xFF, 0)
    head = struct.pack("<7I44x", 124, 0x100F, height, width, width * 3, 0, 0)
    caps = struct.pack("<5I", 0x1000, 0, 0, 0, 0)
    return b"DDS " + head + format + caps + pixels[:, :, ::-1].tobytes()


def psd(pixels: np.ndarray) -> bytes:
    """A flat PSD of 8 bits."""
    height, width, channels = pixels.shape
    head = b"8BPS" + struct.pack(">H6xHIIHH", 1, channels, height, width, 8, 3)
    return head + bytes(12) + b"\0\0" + pixels.transpose(2, 0, 1).tobytes()


def pixels_of(path: Path) -> np.ndarray:
    return read_file(path)[:, :, :3]


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Programs that were run apart."""
    names, real = [], decoder.run
    monkeypatch.setattr(
        apart.decoder, "run", lambda words, *more: (names.append(words[1]), real(words, *more))[1]
    )
    return names


@pytest.mark.parametrize("suffix", [*HERE, *APART, "dds", "psd"])
def test_every_kind_has_its_pixels_and_the_common_ones_are_decoded_here(
    tmp_path: Path, suffix: str, runs: list[str]
) -> None:
    path = tmp_path / f"a.{suffix}"
    if suffix in ("dds", "psd"):
        path.write_bytes({"dds": dds, "psd": psd}[suffix](GREYS))
    else:
        write(path, GREYS)
    assert pixels_of(path).tolist() == GREYS.tolist()
    assert bool(runs) == (suffix not in HERE)


@pytest.mark.parametrize("suffix", [*HERE[:2], *APART[:9]])
def test_a_wrong_suffix_does_not_choose_the_reader(
    tmp_path: Path, suffix: str, runs: list[str]
) -> None:
    good = write(tmp_path / f"a.{suffix}", GREYS)
    for name in ("a.dat", "b.tga", "c.jpg", "d.dpx", "e"):
        path = tmp_path / name
        path.write_bytes(good.read_bytes())
        assert pixels_of(path).tolist() == GREYS.tolist()
        assert bool(runs) == (suffix not in HERE)


@pytest.mark.parametrize(
    ("data", "got"),
    [
        (b"\0\0\0 ftypheic" + bytes(90), "HEIF"),
        (b"\0\0\0 ftypisom" + bytes(90), "a video"),
        (b"RIFF\x50\0\0\0AVI LIST" + bytes(90), "a video"),
        (b"Ptex" + bytes(90), "Ptex"),
        (b" BDV" + bytes(90), "OpenVDB"),
        (b"\x2f\x08\x67\xab" + bytes(140), "zfile"),
        (b"\x1f\x8b\x08" + bytes(90), "gzip"),
        (b"hello, world" * 9, "b'hello, w'"),
        (b"", "b''"),
    ],
)
@pytest.mark.parametrize("suffix", ["png", "dpx", "exr", "z", ""])
def test_all_else_is_refused_by_name_before_a_library_sees_it(
    tmp_path: Path, data: bytes, got: str, suffix: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / f"a.{suffix}"
    path.write_bytes(data)
    monkeypatch.setattr(library, "read", None)
    monkeypatch.setattr(apart, "read", None)
    for reader in (read_file, read_environment, read_grey, plates.read):
        with pytest.raises(InputError, match=r"cannot be decoded|wanted") as error:
            reader(path)
        assert "\n" not in str(error.value)
    with pytest.raises(InputError, match=r"wanted one of OpenEXR, PNG, .*; got ") as error:
        read_file(path)
    assert got in str(error.value)


def test_a_texture_of_an_unknown_kind_is_a_note(tmp_path: Path) -> None:
    with pytest.raises(UnknownFormat):
        decoded(b"Ptex" + bytes(90), "a.ptx", "here")
    with pytest.raises(InputError, match=r"^here: cannot be decoded: .*got Ptex") as error:
        decoded(b"Ptex" + bytes(90), "a.png", "here")
    assert not isinstance(error.value, UnknownFormat)


@pytest.mark.parametrize("suffix", ["png", "tif"])
@pytest.mark.parametrize("kind", [oiio.UINT8, oiio.UINT16, oiio.FLOAT])
def test_both_ways_give_the_same_pixels(
    tmp_path: Path, suffix: str, kind: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With alpha, straight and premultiplied, in all types."""
    if suffix == "png" and kind == oiio.FLOAT:
        pytest.skip("PNG has no floats")
    rgba = np.random.default_rng(4).random((5, 9, 4), np.float32)
    path = write(tmp_path / f"a.{suffix}", rgba, kind, Orientation=6)
    for floats in (False, True):
        here = read.read(PictureBytes(path), "a", floats=floats)
        with monkeypatch.context() as patch:
            patch.setitem(read._CHECKS, here.kind, lambda *_: False)
            other = read.read(PictureBytes(path), "a", floats=floats)
        assert here.pixels.dtype == other.pixels.dtype
        assert np.allclose(here.pixels, other.pixels, rtol=1e-6, atol=0)
        assert (here.names, here.orientation) == (other.names, other.orientation)


@pytest.mark.parametrize(
    ("attributes", "plain"),
    [
        ({"compression": "none"}, True),
        ({"compression": "lzw"}, True),
        ({"compression": "zip"}, True),
        ({"compression": "packbits"}, True),
        ({"planarconfig": "separate"}, True),
        ({"tiff:ColorSpace": "CMYK"}, False),
        ({"oiio:BitsPerSample": 4}, False),
        ({"tiff:RowsPerStrip": 4}, True),
    ],
)
def test_only_plain_tiffs_are_decoded_here(
    tmp_path: Path, attributes: dict[str, object], plain: bool, runs: list[str]
) -> None:
    path = write(tmp_path / "a.tif", np.repeat(GREYS, 3, axis=0), **attributes)
    assert tiff.check(PictureBytes(path), "a", 1 << 30) is plain
    assert read_file(path).shape == (120, 60, 3)
    assert bool(runs) is not plain


@pytest.mark.parametrize(
    ("tag", "value"),
    [(259, 7), (259, 50000), (259, 34712), (262, 5), (262, 6), (262, 8), (262, 32803), (277, 2),
     (277, 4), (278, 0), (278, 5), (257, 4000)],
)  # fmt: skip
def test_a_tiff_with_an_odd_tag_is_decoded_apart(tmp_path: Path, tag: int, value: int) -> None:
    path = write(tmp_path / "a.tif", GREYS, compression="lzw")
    data = bytearray(path.read_bytes())
    (at,) = struct.unpack_from("<I", data, 4)
    assert tiff.check(PictureBytes(path), "a", 1 << 30)
    for entry in range(at + 2, at + 2 + 12 * data[at], 12):
        if struct.unpack_from("<H", data, entry)[0] == tag:
            struct.pack_into("<HII", data, entry + 2, 4, 1, value)
    path.write_bytes(data)
    assert not tiff.check(PictureBytes(path), "a", 1 << 30)


@pytest.mark.parametrize("tag", [256, 257, 258, 259, 262, 273, 277, 278, 279, 339])
def test_a_tiff_with_a_tag_of_no_values_is_one_error_or_is_decoded(
    tmp_path: Path, tag: int
) -> None:
    path = write(tmp_path / "a.tif", GREYS, compression="none")
    data = bytearray(path.read_bytes())
    (at,) = struct.unpack_from("<I", data, 4)
    tags = {
        struct.unpack_from("<H", data, entry)[0]: entry
        for entry in range(at + 2, at + 2 + 12 * data[at], 12)
    }
    struct.pack_into("<I", data, tags[tag] + 4, 0)
    path.write_bytes(data)
    with contextlib.suppress(InputError):
        read_file(path)


def test_tiled_tiffs_are_plain_if_all_tiles_are_there(tmp_path: Path) -> None:
    path = tmp_path / "a.tif"
    spec = oiio.ImageSpec(40, 40, 3, oiio.UINT8)
    spec.tile_width = spec.tile_height = 16
    out = oiio.ImageOutput.create(str(path))
    assert out.open(str(path), spec)
    assert out.write_image(np.zeros((40, 40, 3), np.uint8))
    out.close()
    assert tiff.check(PictureBytes(path), "a", 1 << 30)
    cut = tmp_path / "cut.tif"
    tags = tiff.read_tags(PictureBytes(path), "a")
    cut.write_bytes(path.read_bytes().replace(struct.pack("<I", tags[324][3]), b"\xff\xff\xff\x7f"))
    assert not tiff.check(PictureBytes(cut), "a", 1 << 30)


def many_tags(number: int) -> bytes:
    """A TIFF whose tags all have the same million values."""
    values = bytes(1 << 21)
    tags = b"".join(struct.pack("<HHII", 300 + i, 3, 1 << 20, 8) for i in range(number))
    return b"II*\0" + struct.pack("<I", 8 + len(values)) + values + struct.pack("<H", number) + tags


@pytest.mark.parametrize(
    ("name", "data", "said"),
    [
        ("a.tif", b"II*\0\xff\xff\xff\x7f" + bytes(90), "tags are cut off"),
        ("a.tif", b"MM\0+\0\x08\0\0" + b"\xff" * 90, "tags are cut off"),
        ("a.tif", b"II*\0\x08\0\0\0\xff\xff" + bytes(90), "tags are cut off"),
        ("a.tif", many_tags(4000), "image size"),
        ("a.jpg", b"\xff\xd8\xff\xe0\0\x02\xff\xd9", "a JPEG without a frame"),
        ("a.jpg", b"\xff\xd8\xff\xc0\0\x11\x08\xff\xff\xff\xff\x03\xff\xda\xff\xd9", "image size"),
        ("a.hdr", b"#?RADIANCE\n\n-Y 99999 +X 99999\n" + bytes(99), "image size"),
        ("a.hdr", b"#?RADIANCE\n\n-Y 9000 +X 9000\n" + bytes(99), "cannot hold 9000x9000"),
        ("a.tga", struct.pack("<3B9x2H2B", 0, 0, 10, 9000, 9000, 24, 0), "cannot hold 9000x9000"),
        ("a.tga", struct.pack("<3BHHB4x2H2B", 0, 1, 9, 2, 9, 24, 4, 4, 8, 0), "palette"),
    ],
)  # fmt: skip
def test_heads_are_checked_before_a_library_sees_them(
    tmp_path: Path, name: str, data: bytes, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / name
    path.write_bytes(data)
    monkeypatch.setattr(library, "read", None)
    monkeypatch.setattr(apart, "read", None)
    with pytest.raises(InputError, match=said):
        read_file(path)


def test_a_jpeg_of_too_many_scans_is_refused(tmp_path: Path) -> None:
    path = write(tmp_path / "a.jpg", GREYS)
    assert read_file(path).shape == (40, 60, 3)
    data = path.read_bytes()
    path.write_bytes(data[:-2] + b"\xff\xda" * jpeg.MAX_SCANS + b"\xff\xd9")
    with pytest.raises(InputError, match="at most 500 scans, got 501"):
        read_file(path)


def test_a_crash_a_loop_and_a_bomb_apart_are_errors(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path / "a.sgi", GREYS)
    program = tmp_path / "program.py"
    monkeypatch.setattr(decoder_program, "__file__", str(program))
    program.write_text("import os; os.kill(os.getpid(), 11)")
    with pytest.raises(InputError, match=r"a\.sgi: .*damaged SGI: the decoder ended by SIGSEGV"):
        read_file(path)
    monkeypatch.setattr(apart, "PATIENCE", 0.5)
    program.write_text("while True: pass")
    with pytest.raises(InputError, match="SGI took longer than 1 s"):
        read_file(path)
    monkeypatch.setattr(apart, "PATIENCE", 20)
    program.write_text("import sys; open(sys.argv[3], 'wb').write(b'II*\\0' + bytes(999))")
    with pytest.raises(InputError, match=r"image size|plain TIFF|cut off"):
        read_file(path)
    huge = path.read_bytes()[:6] + b"\xff\xff\xff\xff" + path.read_bytes()[10:]
    path.write_bytes(huge)
    monkeypatch.undo()
    with pytest.raises(InputError, match=r"a\.sgi: cannot be decoded"):
        read_file(path)


def test_the_setting_of_the_process_is_restored(tmp_path: Path) -> None:
    before = oiio.get_int_attribute("try_all_readers", 1)
    bad = tmp_path / "a.png"
    bad.write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(40))

    def many() -> None:
        for _ in range(50):
            with library._one_plugin.only():
                assert oiio.get_int_attribute("try_all_readers", 1) == 0

    threads = [threading.Thread(target=many) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    with pytest.raises(InputError):
        read_file(bad)
    assert oiio.get_int_attribute("try_all_readers", 1) == before == 1


def test_a_file_is_never_offered_to_another_plug_in(tmp_path: Path) -> None:
    """OpenImageIO itself would: it reads a PNM that is called a PNG."""
    good = write(tmp_path / "a.ppm", GREYS)
    wrong = tmp_path / "a.png"
    wrong.write_bytes(good.read_bytes())
    assert oiio.ImageInput.open(str(wrong)) is not None
    oiio.geterror()
    with pytest.raises(InputError):
        library.read(str(wrong), "a.png", 1 << 30)


def test_nothing_is_left_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(folder))
    good = write(tmp_path / "a.sgi", GREYS).read_bytes()
    other = tmp_path / "a.dat"
    for data in (good, good[:300], b"\x01\xda\0\1" + bytes(600)):
        other.write_bytes(data)
        try:
            read_file(other)
        except InputError:
            assert data != good
    assert list(folder.iterdir()) == []


def test_every_plug_in_of_the_library_is_decided_upon() -> None:
    """A new plug-in must be listed, or left out on purpose."""
    ours = {kind.name for kind in kinds.KINDS} | {"openexr"}
    theirs = set(str(oiio.get_string_attribute("input_format_list")).split(","))
    assert theirs - ours <= {
        "null", "term", "zfile", "raw", "ffmpeg", "heif", "openvdb", "ptex", "dicom", "field3d",
    }  # fmt: skip
    assert ours <= theirs
