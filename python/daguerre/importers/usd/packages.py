"""Lists the files of ``.usdz`` packages as USD finds them, and checks the packages.

USD reads the head of each file in turn and ignores the directory at the end; other readers use that
directory. A package is refused unless both agree and nothing is compressed or encrypted, as the
format of ``.usdz`` demands.

Sources: USD, "usdz File Format Specification"; PKWARE, APPNOTE.TXT 4.3.7 (heads of files).
"""

from __future__ import annotations

import io
import mmap
import struct
import zipfile
from dataclasses import dataclass

from daguerre.checks import short
from daguerre.errors import InputError

#: Most files in a package.
_MAX_FILES = 65_535
_HEAD = struct.Struct("<4s5H3I2H")
_MAGIC = b"PK\x03\x04"


@dataclass(frozen=True)
class Entry:
    """A file in a package: its name, and the bytes ``begin`` to ``end`` of the package."""

    name: str
    begin: int
    end: int


def entries_of(whole: mmap.mmap | memoryview, file: str) -> list[Entry]:
    """Lists the files of a package.

    Args:
        whole: Bytes of the package.
        file: File, for messages.

    Raises:
        InputError: The package is damaged, or a file in it is compressed or encrypted.
    """
    found = _heads(whole, file)
    listed = _directory(whole, file)
    names = {entry.name for entry in found}
    if len(names) < len(found) or len(listed) != len(found):
        raise _fault(file, "a name for each file and a directory of all")
    for entry in found:
        info = listed.get(entry.name)
        if info is None or (info.file_size, info.compress_type) != (entry.end - entry.begin, 0):
            raise _fault(file, f"a directory that agrees on {short(entry.name)}")
    return found


def _heads(whole: mmap.mmap | memoryview, file: str) -> list[Entry]:
    found: list[Entry] = []
    at = 0
    while bytes(whole[at : at + 4]) == _MAGIC and at + _HEAD.size <= len(whole):
        _, _, flags, method, _, _, _, packed, size, name, extra = _HEAD.unpack_from(whole, at)
        begin = at + _HEAD.size + name + extra
        text = bytes(whole[at + _HEAD.size : at + _HEAD.size + name])
        end = begin + size
        if method or packed != size or flags & 0x2049:  # encrypted, sizes after the data, masked
            raise _fault(file, "files without compression and encryption")
        if end > len(whole):
            raise _fault(file, f"{size} bytes of {short(text.decode('utf-8', 'replace'))}")
        if len(found) == _MAX_FILES:
            raise _fault(file, f"at most {_MAX_FILES} files")
        found.append(
            Entry(text.decode("utf-8" if flags & 0x800 else "cp437", "replace"), begin, end)
        )
        at = end
    return found


def _directory(whole: mmap.mmap | memoryview, file: str) -> dict[str, zipfile.ZipInfo]:
    stream = whole if isinstance(whole, mmap.mmap) else io.BytesIO(whole)
    try:
        with zipfile.ZipFile(stream) as package:  # type: ignore[arg-type]
            listed = package.infolist()
    except (zipfile.BadZipFile, ValueError, OverflowError, NotImplementedError) as error:
        raise _fault(file, f"a directory at the end ({short(str(error))})") from None
    if any(info.flag_bits & 1 for info in listed):
        raise _fault(file, "files without compression and encryption")
    return {info.orig_filename: info for info in listed}


def _fault(file: str, wanted: str) -> InputError:
    return InputError(f"{file}: damaged package: wanted {wanted}")
