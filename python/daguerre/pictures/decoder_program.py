"""Program that decodes a picture into a plain file; a crash ends this process alone.

Run it as ``python -I -S decoder_program.py FORM IN OUT PACKAGE BYTES SECONDS STRAIGHT``. It imports
nothing of Daguerre and little else, since each picture pays for every import. PACKAGE is the folder
of OpenImageIO, BYTES the most bytes of all pixels, SECONDS the time that it may take.

FORM ``tiff``: IN is a picture of any kind, with the suffix of its plug-in; STRAIGHT is 1 for
straight alpha. Names of channels and the orientation are printed as JSON.

FORM ``openexr``: OUT becomes the first part of IN, an EXR, at full resolution in scanlines, with
its channels and windows and no other attributes.
"""

from __future__ import annotations

import sys

TYPE_CHECKING = False  # typing.TYPE_CHECKING would take 4 ms to import
if TYPE_CHECKING:
    import OpenImageIO as oiio

#: Address space of the program, and bytes of an unpacked file besides its pixels.
SPARE, BESIDE = 1 << 30, 64 << 20
#: Threads, and copies of the pixels in memory.
THREADS, COPIES = {"tiff": 1, "openexr": 4}, {"tiff": 2, "openexr": 3}


def bound(form: str, size: int, seconds: int) -> None:
    """Limits memory, file sizes and time, and disables core dumps, where the system can."""
    try:
        import resource
    except ImportError:  # Windows
        return
    for kind, most in (
        (resource.RLIMIT_AS, SPARE + COPIES[form] * size),
        (resource.RLIMIT_FSIZE, BESIDE + 2 * size),
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_CPU, THREADS[form] * (seconds + 1)),  # where nobody waits any more
    ):
        try:  # noqa: SIM105 -- contextlib takes 4 ms to import
            resource.setrlimit(kind, (most, most))
        except (ValueError, OSError):
            pass


def decode(form: str, source: str, target: str, limit: int, straight: int) -> str:
    """Writes the plain file; returns an error message, or an empty string."""
    import OpenImageIO as oiio

    oiio.attribute("try_all_readers", 0)
    oiio.attribute("threads", THREADS[form])
    oiio.attribute("exr_threads", THREADS[form])
    config = oiio.ImageSpec()
    config.attribute("oiio:UnassociatedAlpha", straight)
    picture = oiio.ImageInput.open(source, config)
    if picture is None:
        return str(oiio.geterror())
    found = picture.spec()
    size = found.width * found.height * found.nchannels * found.format.basesize()
    if form == "tiff" and (size > limit or found.width < 1 or found.height < 1 or found.depth > 1):
        return (
            f"image size: wanted at most {limit >> 20} MiB, got {found.width}x{found.height} "
            f"({size >> 20} MiB)"
        )
    plain = oiio.ImageSpec(found.width, found.height, found.nchannels, found.format)
    plain.attribute("compression", "none")
    describe(form, found, plain)
    out = oiio.ImageOutput.create(form)
    assert out is not None
    if not (out.open(target, plain) and out.copy_image(picture) and out.close()):
        return str(out.geterror() or picture.geterror() or "no reason given")
    return str(picture.geterror())


def describe(form: str, found: oiio.ImageSpec, plain: oiio.ImageSpec) -> None:
    """Gives a plain picture the facts that its reader needs, or prints them."""
    if form == "openexr":
        plain.channelnames, plain.channelformats = found.channelnames, found.channelformats
        for name in ("x", "y", "full_x", "full_y", "full_width", "full_height"):
            setattr(plain, name, getattr(found, name))
        return
    plain.attribute("oiio:UnassociatedAlpha", found.get_int_attribute("oiio:UnassociatedAlpha"))
    names = ",".join(f'"{"".join(c for c in name if c.isalnum())}"' for name in found.channelnames)
    turn = found.get_int_attribute("Orientation", 1)
    print(f'{{"names": [{names}], "orientation": {turn}}}')


def main(form: str, source: str, target: str, package: str, *numbers: str) -> None:
    """Decodes a picture, and exits."""
    size, seconds, straight = map(int, numbers)
    if sys.platform != "win32":  # on Windows the package looks for its DLLs
        sys.path.append(package)  # its compiled module alone imports in a third of the time
    sys.path.append(f"{package}/..")
    bound(form, size, seconds)
    wrong = decode(form, source, target, size, straight)
    sys.stderr.write(wrong.encode("ascii", "backslashreplace").decode())
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main(*sys.argv[1:])
