"""Kinds of pictures, recognized by their first bytes.

A file from a stranger may have any suffix, so suffixes do not count. Two kinds have no mark at
their start, TGA and RLA, and therefore need their suffix.
Sources: the specifications of the formats; for RLA and Maya's IFF, OpenImageIO's readers.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from daguerre.errors import InputError
from daguerre.files.json_item import short

from .source import PictureBytes

#: Length of the file's start that identifies a kind, bytes.
_START = 32


@dataclass(frozen=True)
class Kind:
    """A kind of picture.

    Attributes:
        name: Name of OpenImageIO's plug-in.
        title: Name for messages.
        suffixes: Suffixes that choose this plug-in.
        mark: Pattern of the first bytes; None: the suffix decides.
        here: Whether its decoder may run in this process; otherwise it runs in a process apart.
    """

    name: str
    title: str
    suffixes: tuple[str, ...]
    mark: re.Pattern[bytes] | None
    here: bool = False

    def matches(self, start: bytes) -> bool:
        """Whether first bytes have the mark of this kind."""
        return self.mark is not None and self.mark.match(start) is not None


def _kind(name: str, title: str, suffixes: str, mark: bytes | None, here: bool = False) -> Kind:
    pattern = re.compile(mark, re.DOTALL) if mark else None
    return Kind(name, title, tuple(suffixes.split()), pattern, here)


KINDS = (
    _kind("png", "PNG", "png", rb"\x89PNG\r\n\x1a\n", here=True),
    _kind("jpeg", "JPEG", "jpg jpe jpeg jif jfif jfi", rb"\xff\xd8\xff", here=True),
    _kind("webp", "WebP", "webp", rb"RIFF....WEBP", here=True),
    _kind("hdr", "Radiance", "hdr rgbe", rb"#\?", here=True),
    _kind("tiff", "TIFF", "tif tiff tx env sm vsm", rb"II[*+]\0|MM\0[*+]", here=True),
    _kind("targa", "TGA", "tga tpic", None, here=True),
    _kind("bmp", "BMP", "bmp dib", rb"BM"),
    _kind("cineon", "Cineon", "cin", rb"\x80\x2a\x5f\xd7|\xd7\x5f\x2a\x80"),
    _kind("dds", "DDS", "dds", rb"DDS "),
    _kind("dpx", "DPX", "dpx", rb"SDPX|XPDS"),
    _kind("fits", "FITS", "fits", rb"SIMPLE  ="),
    _kind("gif", "GIF", "gif", rb"GIF8[79]a"),
    _kind("ico", "ICO", "ico", rb"\x00\x00\x01\x00"),
    _kind("iff", "Maya IFF", "iff z", rb"FOR[48]....CIMG"),
    _kind("jpeg2000", "JPEG 2000", "jp2 j2k j2c jph", rb"\0\0\0\x0cjP  |\xff\x4f\xff\x51"),
    _kind("jpegxl", "JPEG XL", "jxl", rb"\xff\x0a|\0\0\0\x0cJXL "),
    _kind("pnm", "PNM", "ppm pgm pbm pnm pfm", rb"P[1-6Ff]\s"),
    _kind("psd", "PSD", "psd pdd psb", rb"8BPS"),
    _kind("sgi", "SGI", "sgi rgb rgba bw int inta", rb"\x01\xda[\x00\x01][\x01\x02]"),
    _kind("softimage", "Softimage PIC", "pic", rb"\x53\x80\xf6\x34"),
    _kind("rla", "RLA", "rla", None),
)
#: Names of other common kinds, which are refused.
_OTHERS = {
    "HEIF or AVIF": rb"....ftyp(hei|hev|mif|msf|avi[fs])",
    "a video": rb"....ftyp|....moov|\x1aE\xdf\xa3|RIFF....AVI |\x00\x00\x01[\xb3\xba]|OggS",
    "Ptex": rb"Ptex",
    "OpenVDB": rb" BDV",
    "a depth map of RenderMan (zfile)": rb"\x2f\x08\x67\xab|\xab\x67\x08\x2f",
    "a gzip file": rb"\x1f\x8b",
    "KTX2": rb"\xabKTX 20",
}
#: Names of all, for messages.
READ = ", ".join(["OpenEXR", *(kind.title for kind in KINDS)])


class UnknownPicture(InputError):
    """Reports bytes that are none of the kinds of pictures."""


def kind_of(source: PictureBytes, where: str) -> Kind:
    """Finds the kind of a picture.

    Args:
        source: The picture.
        where: Place of the picture, for messages.

    Raises:
        UnknownPicture: It is of another kind.
    """
    start = source.at(0, _START)
    for kind in KINDS:
        if kind.mark is None:
            if source.suffix in kind.suffixes and _CHECKS[kind.name](source):
                return kind
        elif kind.matches(start):
            return kind
    other = [name for name, mark in _OTHERS.items() if re.match(mark, start, re.DOTALL)]
    got = other[0] if other else short(start[:8])
    raise UnknownPicture(f"{where}: cannot be decoded: wanted one of {READ}; got {got}")


def _is_targa(source: PictureBytes) -> bool:
    """Whether a file can be a TGA (TGA file format specification 2.0, chapter 3)."""
    head = source.at(0, 18)
    return (
        len(head) == 18
        and head[1] in (0, 1)
        and head[2] in (1, 2, 3, 9, 10, 11)
        and head[16] in (8, 15, 16, 24, 32)
    )


def _is_rla(source: PictureBytes) -> bool:
    """Whether a file can be an RLA: its head has 740 bytes, with a revision at byte 26."""
    return source.size >= 740 and source.at(26, 2) in (b"\xff\xfe", b"\0\0")


_CHECKS = {"targa": _is_targa, "rla": _is_rla}


def is_known(suffix: str) -> bool:
    """Whether a kind of pictures has a suffix, in small letters and without its dot."""
    return suffix in ("exr", "sxr", "mxr") or any(suffix in kind.suffixes for kind in KINDS)
