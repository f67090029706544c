"""How true and how fast methods of demosaicing are: LibRaw, OpenImageIO, OpenCV.

Usage: bench/demosaic.py [PICTURE ...]

Pictures (sRGB; by default some of docs/gallery) at half their size are the truth; they become
mosaics of 14 bits, Bayer and X-Trans (beside themselves, as LibRaw needs 516 px). PSNR is of the
numbers in sRGB, of all three colours; false colour is the RMS error of chroma, a* and b*. Seconds
are of 24 MP: on the clock, and of all processors.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
from numpy.typing import NDArray

from daguerre.color import spaces
from daguerre.development.channels import Demosaic
from daguerre.development.dng import LEAST_XTRANS
from daguerre.pictures.tiff import CFA, TiffImage, write_tiff
from daguerre.sensors.mosaic import Mosaic as Pattern

TOP = 16383.0
USUAL = ("night_table.jpg", "garden.jpg", "flares.jpg", "axial_colour.jpg")
LIBRAW = ("linear", "ppg", "vng", "ahd", "dcb", "dht")
OPENCV = {"bilinear": "COLOR_BayerBG2RGB", "edge-aware": "COLOR_BayerBG2RGB_EA"}
XTRANS = ("fast", "vng", "good", "best")
Mosaic, Cells = NDArray[np.uint16], NDArray[Any]
BAYER = np.array([[0, 1], [1, 2]])


def main() -> None:
    """Prints a table."""
    gallery = Path(__file__).parent.parent / "docs" / "gallery"
    files = [Path(name) for name in sys.argv[1:]] or [gallery / name for name in USUAL]
    truths = [half_size(file) for file in files]
    large = tiled(truths[0], 4000, 6000)
    print(f"{'method':24} PSNR, dB  false colour  clock, s  processors, s")
    for name, cells, scale, method in methods():
        least = 0 if cells is BAYER else 2 * LEAST_XTRANS
        errors = np.mean([error_of(t, least, cells, scale, method) for t in truths], axis=0)
        mosaic = mosaic_of(large, cells)
        clock, spent = time.perf_counter(), time.process_time()
        method(mosaic)
        clock, spent = time.perf_counter() - clock, time.process_time() - spent
        print(f"{name:24} {errors[0]:8.2f} {errors[1]:13.2f} {clock:9.2f} {spent:14.2f}")


def half_size(file: Path) -> NDArray[np.float64]:
    """Linear light of a picture, means of 2 x 2 px."""
    source = oiio.ImageInput.open(str(file))
    pixels = source.read_image("float")[:, :, :3]
    source.close()
    linear = spaces.decoded(pixels, "srgb")
    height, width = (side // 4 * 2 for side in linear.shape[:2])
    cells = linear[: 2 * height, : 2 * width].reshape(height, 2, width, 2, 3)
    return np.asarray(cells.mean(axis=(1, 3)), np.float64)


def tiled(linear: NDArray[np.float64], height: int, width: int) -> NDArray[np.float64]:
    """The picture beside itself."""
    times = (-(-height // linear.shape[0]), -(-width // linear.shape[1]), 1)
    return np.tile(linear, times)[:height, :width]


def mosaic_of(linear: NDArray[np.float64], cells: Cells) -> Mosaic:
    """14 bits."""
    out, (rows, columns) = np.empty(linear.shape[:2], np.uint16), cells.shape
    for (y, x), channel in np.ndenumerate(cells):
        place = (slice(y, None, rows), slice(x, None, columns))
        out[place] = np.rint(linear[(*place, channel)] * TOP)
    return out


def error_of(
    truth: NDArray[np.float64], least: int, cells: Cells, scale: float, method: Any
) -> tuple[float, float]:
    """Errors of a picture, repeated beside itself until it has the least size."""
    light = tiled(truth, *(max(side, least) for side in truth.shape[:2]))
    return judged(method(mosaic_of(light, cells)) / scale, light)


def judged(got: NDArray[np.float64], truth: NDArray[np.float64]) -> tuple[float, float]:
    """PSNR in sRGB, dB, and the RMS error of chroma, without the border."""
    inner = (slice(8, -8), slice(8, -8))
    pair = [np.clip(light[inner], 0, 1) for light in (got, truth)]
    one, other = (spaces.encoded(light, "srgb") for light in pair)
    chroma = [lab(light)[..., 1:] for light in pair]
    psnr = -10 * np.log10(np.mean((one - other) ** 2))
    return float(psnr), float(np.sqrt(np.sum((chroma[0] - chroma[1]) ** 2, axis=-1).mean()))


def lab(rgb: NDArray[np.float64]) -> NDArray[np.float64]:
    """CIE L*a*b* of linear sRGB."""
    matrix = spaces.xyz_from_rgb(spaces.COLOR_SPACES["srgb"])
    t = rgb @ matrix.T / matrix.sum(axis=1)
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    x, y, z = np.moveaxis(f, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def methods() -> Iterator[tuple[str, Cells, float, Callable[[Mosaic], Mosaic]]]:
    """Names, mosaics, the number of white, and functions from mosaics to pictures."""
    for name in LIBRAW:
        yield f"LibRaw {name}", BAYER, 65535.0, lambda mosaic, name=name: libraw(mosaic, name)
    for name in ("linear", "MHC"):
        yield f"OpenImageIO {name}", BAYER, TOP, lambda mosaic, name=name: openimageio(mosaic, name)
    for name, code in OPENCV.items():
        yield f"OpenCV {name}", BAYER, TOP, lambda mosaic, code=code: opencv(mosaic, code)
    xtrans = Pattern.of("xtrans", ("R", "G", "B")).cells
    for name in XTRANS:
        yield (
            f"X-Trans, LibRaw {name}",
            xtrans,
            65535.0,
            lambda mosaic, name=name: libraw(mosaic, name, xtrans),
        )


def libraw(mosaic: Mosaic, name: str, cells: Cells = BAYER) -> Mosaic:
    """Through a DNG in memory."""
    import io

    import rawpy

    one = (1, 1)
    tags: dict[int, Any] = {
        50706: (1, (1, 4, 0, 0)),
        50708: (2, "bench"),
        33421: (3, cells.shape),
        33422: (1, tuple(int(cell) for cell in cells.ravel())),
        50717: (4, (int(TOP),)),
        50721: (10, (*one, 0, 1, 0, 1, 0, 1, *one, 0, 1, 0, 1, 0, 1, *one)),
        50728: (5, one * 3),
        50778: (3, (21,)),
    }
    file = io.BytesIO()
    write_tiff(file, [TiffImage(mosaic, CFA, tags)], {})
    file.seek(0)
    balance = np.ones(3)
    with rawpy.imread(file) as opened:
        pixels = Demosaic(name).run(opened, balance, xtrans=cells is not BAYER, turn=False)
    return pixels


def openimageio(mosaic: Mosaic, name: str) -> Mosaic:
    """From 3.1 on."""
    source = oiio.ImageBuf(mosaic[:, :, None])
    made = oiio.ImageBufAlgo.demosaic(source, pattern="bayer", algorithm=name, layout="RGGB")
    return np.asarray(made.get_pixels(oiio.UINT16))


def opencv(mosaic: Mosaic, code: str) -> Mosaic:
    """Its names of patterns begin at the second photosite of the second row."""
    import cv2

    return np.asarray(cv2.demosaicing(mosaic, getattr(cv2, code)))


if __name__ == "__main__":
    main()
