"""Another program that unpacks what :mod:`daguerre.io.exr.unpack` does not: a crash is its own.

Run as a file, ``python -I -S transcode.py IN OUT PACKAGE BYTES``: it knows nothing of Daguerre, and
imports next to nothing, as every import is paid for once per picture. PACKAGE is the folder of
OpenImageIO, BYTES the size of the pixels. OUT is IN's first part at full size, in plain scanlines:
its channels and windows, and nothing else.
"""

from __future__ import annotations

import sys

SPARE = 1 << 30  # of the address space, for the program itself


def limit(size: int) -> None:
    """Bounds memory and the length of files, and leaves no core dump, where the system can."""
    try:
        import resource
    except ImportError:  # Windows
        return
    for kind, most in (
        (resource.RLIMIT_AS, SPARE + 3 * size),
        (resource.RLIMIT_FSIZE, SPARE + 2 * size),
        (resource.RLIMIT_CORE, 0),
    ):
        try:  # noqa: SIM105 -- contextlib takes 4 ms to import
            resource.setrlimit(kind, (most, most))
        except (ValueError, OSError):
            pass


def transcode(source: str, target: str) -> str:
    """Writes the plain file; returns what was wrong."""
    import OpenImageIO as oiio

    oiio.attribute("threads", 4)
    oiio.attribute("exr_threads", 4)
    picture = oiio.ImageInput.open(source)
    if picture is None:
        return str(oiio.geterror())
    found = picture.spec()
    plain = oiio.ImageSpec(found.width, found.height, found.nchannels, found.format)
    plain.channelnames, plain.channelformats = found.channelnames, found.channelformats
    for name in ("x", "y", "full_x", "full_y", "full_width", "full_height"):
        setattr(plain, name, getattr(found, name))
    plain.attribute("compression", "none")
    out = oiio.ImageOutput.create("openexr")
    assert out is not None
    if not (out.open(target, plain) and out.copy_image(picture) and out.close()):
        return str(out.geterror() or picture.geterror() or "no reason given")
    return str(picture.geterror())


if __name__ == "__main__":
    if sys.platform != "win32":  # there the package looks for its DLLs
        sys.path.append(sys.argv[3])  # its compiled module alone: a third of its time to import
    sys.path.append(f"{sys.argv[3]}/..")
    limit(int(sys.argv[4]))
    wrong = transcode(sys.argv[1], sys.argv[2])
    sys.stderr.write(wrong.encode("ascii", "backslashreplace").decode())
    sys.exit(1 if wrong else 0)
