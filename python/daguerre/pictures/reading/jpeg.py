"""Checks JPEG files before they are decoded, as libjpeg fills missing pixels with grey.

Source: ITU-T T.81, annex B.
"""

from __future__ import annotations

from daguerre.errors import InputError

from .size import check_size
from .source import PictureBytes

#: Most scans: each visits all pixels, however few bytes it has.
MAX_SCANS = 500
_START_OF_SCAN, _END = b"\xff\xda", b"\xff\xd9"
#: Markers without a length: TEM, and RST0 to EOI.
_BARE = {0x01, *range(0xD0, 0xDA)}
#: Starts of frames, which have the size; not DHT, JPG and DAC, which are among them.
_FRAMES = set(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}


def check(source: PictureBytes, where: str, limit: int) -> None:
    """Checks the size, the number of scans, and that there is an end.

    Raises:
        InputError: The file is truncated, corrupt or too large.
    """
    data = source.all()
    if data.rfind(_END) < data.rfind(_START_OF_SCAN):
        raise InputError(f"{where}: truncated JPEG: the end marker is missing")
    height, width, channels = _frame(data, where)
    if height:  # 0: a later marker has it
        check_size(width, height, channels, 1, where, limit)
    scans = data.count(_START_OF_SCAN)
    if scans > MAX_SCANS:
        raise InputError(f"{where}: JPEG: wanted at most {MAX_SCANS} scans, got {scans}")


def _frame(data: bytes, where: str) -> tuple[int, int, int]:
    """Height, width and number of channels from the first frame."""
    at = 2
    while True:
        at = data.find(b"\xff", at)
        while 0 <= at < len(data) - 1 and data[at + 1] == 0xFF:  # fill bytes
            at += 1
        if at < 0 or at + 10 > len(data) or data[at + 1] == _START_OF_SCAN[1]:
            raise InputError(f"{where}: cannot be decoded: a JPEG without a frame")
        marker = data[at + 1]
        if marker in _FRAMES:
            numbers = data[at + 5 : at + 10]
            return (
                int.from_bytes(numbers[:2], "big"),
                int.from_bytes(numbers[2:4], "big"),
                numbers[4],
            )
        at += 2
        if marker not in _BARE and marker != 0:
            at += int.from_bytes(data[at : at + 2], "big")
