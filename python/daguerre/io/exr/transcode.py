"""Program that unpacks what :mod:`daguerre.io.exr.unpack` does not; it may crash by itself.

Run it as ``python -I -S transcode.py IN OUT PACKAGE BYTES``. It imports nothing of Daguerre and
little else, since each picture pays for every import. PACKAGE is the folder of OpenImageIO, BYTES
the size of the pixels. OUT becomes IN's first part at full resolution in plain scanlines, with its
channels and windows and no other attributes.
"""

from __future__ import annotations

import sys

SPARE = 1 << 30  # of the address space, for the program itself


def limit(size: int) -> None:
    """Limits memory and file sizes and disables core dumps, where the system can."""
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
    """Writes the plain file; returns an error message, or an empty string."""
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
    if sys.platform != "win32":  # on Windows the package looks for its DLLs
        sys.path.append(sys.argv[3])  # its compiled module alone imports in a third of the time
    sys.path.append(f"{sys.argv[3]}/..")
    limit(int(sys.argv[4]))
    wrong = transcode(sys.argv[1], sys.argv[2])
    sys.stderr.write(wrong.encode("ascii", "backslashreplace").decode())
    sys.exit(1 if wrong else 0)
