"""Program that decodes pictures of any kind; it may crash by itself.

Run it as ``python -I -S program.py IN OUT PACKAGE LIMIT STRAIGHT``. It imports nothing of Daguerre
and little else, since each picture pays for every import. IN has the suffix of its plug-in, PACKAGE
is the folder of OpenImageIO, LIMIT the most bytes of all pixels, STRAIGHT 1 for straight alpha. OUT
becomes a plain TIFF; the names of channels and the orientation are printed as JSON.
"""

from __future__ import annotations

import sys

SPARE = 1 << 30  # of the address space, for the program itself


def bound(size: int) -> None:
    """Limits memory and file sizes and disables core dumps, where the system can."""
    try:
        import resource
    except ImportError:  # Windows
        return
    for kind, most in (
        (resource.RLIMIT_AS, SPARE + 2 * size),
        (resource.RLIMIT_FSIZE, (64 << 20) + size),
        (resource.RLIMIT_CORE, 0),
    ):
        try:  # noqa: SIM105 -- contextlib takes 4 ms to import
            resource.setrlimit(kind, (most, most))
        except (ValueError, OSError):
            pass


def decode(source: str, target: str, limit: int, straight: int) -> str:
    """Writes the plain file; returns an error message, or an empty string."""
    import OpenImageIO as oiio

    oiio.attribute("try_all_readers", 0)
    oiio.attribute("threads", 1)
    config = oiio.ImageSpec()
    config.attribute("oiio:UnassociatedAlpha", straight)
    picture = oiio.ImageInput.open(source, config)
    if picture is None:
        return str(oiio.geterror())
    found = picture.spec()
    size = found.width * found.height * found.nchannels * found.format.basesize()
    if size > limit or found.width < 1 or found.height < 1 or found.depth > 1:
        return (
            f"image size: wanted at most {limit >> 20} MiB, got {found.width}x{found.height} "
            f"({size >> 20} MiB)"
        )
    plain = oiio.ImageSpec(found.width, found.height, found.nchannels, found.format)
    plain.attribute("compression", "none")
    plain.attribute("oiio:UnassociatedAlpha", found.get_int_attribute("oiio:UnassociatedAlpha"))
    out = oiio.ImageOutput.create("tiff")
    assert out is not None
    if not (out.open(target, plain) and out.copy_image(picture) and out.close()):
        return str(out.geterror() or picture.geterror() or "no reason given")
    names = ",".join(f'"{"".join(c for c in name if c.isalnum())}"' for name in found.channelnames)
    turn = found.get_int_attribute("Orientation", 1)
    print(f'{{"names": [{names}], "orientation": {turn}}}')
    return str(picture.geterror())


if __name__ == "__main__":
    if sys.platform != "win32":  # on Windows the package looks for its DLLs
        sys.path.append(sys.argv[3])  # its compiled module alone imports in a third of the time
    sys.path.append(f"{sys.argv[3]}/..")
    bound(int(sys.argv[4]))
    wrong = decode(sys.argv[1], sys.argv[2], int(sys.argv[4]), int(sys.argv[5]))
    sys.stderr.write(wrong.encode("ascii", "backslashreplace").decode())
    sys.exit(1 if wrong else 0)
