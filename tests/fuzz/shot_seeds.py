"""Good raw photographs, and photographs with EXIF and XMP."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from daguerre.pictures.tiff import LINEAR_RAW, TiffImage, write_tiff
from tests.support.formats.exif_files import SHOT, block, photograph, xmp
from tests.support.pictures.plate_frames import of_light

#: A file's name and bytes.
Seed = tuple[str, bytes]


def raws(folder: Path) -> Iterator[Seed]:
    """Raw files: Bayer, X-Trans, grey, and linear colours."""
    light = np.kron(np.random.default_rng(1).random((4, 6)), np.ones((16, 16)))
    facts = {"expTime": 0.01, "aperture": 4.0, "isoSpeed": 400.0, "nominalFocalLength": 50.0}
    frame = of_light(light, 0.6 * 78 / 400, **facts)
    path = folder / "made.dng"
    for sensor in ("sony-a7r-ii", "fujifilm-x-t4", "ideal-mono"):
        frame.expose(sensor, 400).save(path)
        yield f"{sensor}.dng", path.read_bytes()
    pixels = np.random.default_rng(2).integers(0, 4096, (48, 64, 3), np.uint16)
    tags = {
        50706: (1, (1, 4, 0, 0)),
        50708: (2, "Own"),
        50717: (4, (4095, 4095, 4095)),
        50721: (10, tuple(n for v in (1, 0, 0, 0, 1, 0, 0, 0, 1) for n in (v, 1))),
        50728: (5, (1, 2, 1, 1, 1, 2)),
        50778: (3, (21,)),
    }
    write_tiff(path, [TiffImage(pixels, LINEAR_RAW, tags)], {})
    yield "linear.dng", path.read_bytes()


def tagged(folder: Path) -> Iterator[Seed]:
    """Photographs with EXIF in both orders of bytes, and with XMP."""
    packet = xmp(FNumber="56/10", ExposureTime="1/2", ISOSpeedRatings="800", Orientation=6)
    for ending in ("jpg", "png", "webp", "tif"):
        for order in "<>":
            path = photograph(folder / f"made.{ending}", block(SHOT, order=order), packet)
            yield f"tagged.{ending}", path.read_bytes()
    yield "packet.jpg", photograph(folder / "packet.jpg", packet=packet).read_bytes()


def rares(folder: Path) -> Iterator[Seed]:
    """Pictures of the kinds that are decoded apart."""
    import OpenImageIO as oiio

    from tests.pictures.test_pictures import APART, dds, psd

    pixels = (np.arange(40 * 60 * 3) % 251).astype(np.uint8).reshape(40, 60, 3)
    for ending in (*APART, "gif", "tga"):
        path = folder / f"made.{ending}"
        out = oiio.ImageOutput.create(str(path))
        out.open(str(path), oiio.ImageSpec(60, 40, 3, oiio.UINT8))
        out.write_image(pixels)
        out.close()
        yield f"rare.{ending}", path.read_bytes()
    yield "rare.dds", dds(pixels)
    yield "rare.psd", psd(pixels)
