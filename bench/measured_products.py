"""Calibrations of products that lenses of the library are held to be, from the lensfun database.

They are read from ``lens_measured.json``, or from the package ``lensfunpy``. The database is under
CC BY-SA 3.0, so this repository has names of products and no figures of theirs.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.files.extras import hint
from daguerre.files.json_item import Item
from daguerre.files.json_text import parse

Floats = NDArray[np.float64]
Terms = dict[str, Any]  # coefficients of one focal length (and f-stop), and their model

SHARED = Path(__file__).parents[2] / "shared" / "data" / "reality"
CALIBRATIONS, CLOSEST_FOCUS = "lens_measured.json", "closest_focus.json"
HALF_DIAGONAL = 0.5 * math.hypot(36, 24)  # mm, at a crop factor of 1
PIXELS = 24e6
FAR = 1000.0  # the database's infinity, m
SETTINGS = ("focal", "aperture", "distance")
#: Models, and their coefficients in the database's order.
DISTORTION = {"ptlens": "a b c", "poly3": "k1", "poly5": "k1 k2"}
COLOUR = {"linear": "kr kb", "poly3": "vr vb cr cb br bb"}
VIGNETTING = {"pa": "k1 k2 k3"}


class Product(NamedTuple):
    """A lens, and a product of the database: the lens itself (A), or one of its family (B)."""

    lens: str
    name: str  # maker and model
    crop: float = 1.0
    match: str = "A"
    aspect: tuple[float, float] = (3.0, 2.0)


PRODUCTS = (
    Product("canon-rf-85mm-f1.2", "Canon Canon RF 85mm F1.2L USM"),
    Product("canon-rf-50mm-f1.2", "Canon Canon RF 50mm F1.2 L USM"),
    Product("canon-ef-85mm-f1.8", "Canon Canon EF 85mm f/1.8 USM"),
    Product("canon-ef-11-24mm-f4", "Canon Canon EF 11-24mm f/4L USM"),
    Product("canon-ef-15mm-f2.8-fisheye", "Canon Canon EF 15mm f/2.8 Fisheye"),
    Product("nikon-z-14-24mm-f2.8", "Nikon Nikkor Z 14-24mm f/2.8 S"),
    Product("nikon-z-14-30mm-f4", "Nikon Nikkor Z 14-30mm f/4 S"),
    Product("nikon-ai-s-50mm-f1.8", "Nikon Nikon AI-S Nikkor 50mm f/1.8"),
    Product("nikon-ai-s-50mm-f1.8", "Nikon Nikon AI-S Nikkor 50mm f/1.8", 1.528),
    Product("nikon-ai-s-50mm-f1.8", "Nikon Nikon AF Nikkor 50mm f/1.8D", match="B"),
    Product("nikon-ai-s-50mm-f1.8", "Nikon Nikon Lens Series E 50mm f/1.8", match="B"),
    Product("nikon-nikkor-50mm-f1.2", "Nikon Nikon AI-S Nikkor 50mm f/1.2", match="B"),
    Product("nikon-af-dc-135mm-f2", "Nikon Nikon AF DC-Nikkor 135mm f/2D"),
    Product("nikon-ai-135mm-f2", "Nikon Nikon AI-S Nikkor 135mm f/2", 1.528),
    Product("nikon-af-s-14-24mm-f2.8", "Nikon Nikon AF-S Zoom-Nikkor 14-24mm f/2.8G ED 146"),
    Product("nikon-af-s-70-200mm-f2.8", "Nikon Nikon AF-S Nikkor 70-200mm f/2.8E FL ED VR 164"),
    Product("sigma-50mm-f1.4", "Sigma Sigma 50mm f/1.4 DG HSM [A]", 1.005),
    Product("sigma-17-40mm-f1.8", "Sigma Sigma 17-40mm F1.8 DC | Art 025", 1.6),
    Product("sony-sonnar-55mm-f1.8", "Sony FE 55mm f/1.8 ZA"),
    Product(
        "panasonic-leica-dg-25mm-f1.4",
        "Panasonic Leica DG Summilux 25mm f/1.4 Asph.",
        2.0,
        aspect=(4.0, 3.0),
    ),
    Product("fujifilm-gf-110mm-f2", "Fujifilm GF110mmF2 R LM WR", 0.79),
    Product("voigtlander-apo-lanthar-50mm-f2", "Voigtländer APO-Lanthar 50mm F2 Aspherical"),
    Product("asahi-super-takumar-50mm-f1.4", "Pentax Super-Takumar 50mm f/1.4"),
    Product("asahi-super-takumar-50mm-f1.4", "Pentax Pentax SMC Takumar 50mm f/1.4", match="B"),
    Product("tessar-50mm-f2.8", "Zeiss Carl Zeiss Jena Tessar 50mm f/2.8", match="B"),
)


@dataclass(frozen=True)
class Calibration:
    """One measured product: distortion and lateral colour by focal length, vignetting by f-stop.

    All three are polynomials of the image height. Its unit is half of the frame's short side, and
    for vignetting half of its diagonal.
    """

    lens: str
    product: str
    match: str
    aspect: tuple[float, float]
    half_diagonal_mm: float
    distortion: tuple[Terms, ...]
    lateral_colour: tuple[Terms, ...]
    vignetting: tuple[Terms, ...]

    @property
    def size_mm(self) -> tuple[float, float]:
        """Sides of the frame."""
        share = 2 * self.half_diagonal_mm / math.hypot(*self.aspect)
        return share * self.aspect[0], share * self.aspect[1]

    @property
    def unit_mm(self) -> float:
        """Half of the frame's short side."""
        return 0.5 * min(self.size_mm)

    @property
    def pixel_mm(self) -> float:
        """Side of a pixel at 24 MP."""
        return math.sqrt(math.prod(self.size_mm) / PIXELS)

    def heights(self, count: int) -> tuple[Floats, Floats]:
        """Image heights from the axis to the corner, mm, and the frame's area at each."""
        r = self.half_diagonal_mm * (np.arange(count) + 0.5) / count
        wide, high = (0.5 * side for side in self.size_mm)
        corner = np.arcsin(np.minimum(1, high / r)) - np.arccos(np.minimum(1, wide / r))
        return r, r * corner

    def farthest(self) -> list[Terms]:
        """Vignetting of each focal length and f-stop at the farthest distance."""
        found: dict[tuple[float, float], Terms] = {}
        for terms in self.vignetting:
            setting = (terms["focal"], terms["aperture"])
            if setting not in found or terms["distance"] > found[setting]["distance"]:
                found[setting] = terms
        return list(found.values())

    def undistorted(self, terms: Terms, heights_mm: Floats) -> Floats:
        """Image heights without distortion, mm; their scale is arbitrary."""
        distorted = [0, *_distortion(terms)]
        wanted = heights_mm / self.unit_mm
        r = wanted.copy()
        for _ in range(20):
            r = r - (polyval(r, distorted) - wanted) / polyval(r, polyder(distorted))
        return np.asarray(r * self.unit_mm)

    def colour(self, terms: Terms, channel: str, heights_mm: Floats) -> Floats:
        """Heights of red (``r``) or blue (``b``) less green's, mm."""
        linear = terms.get(f"v{channel}", terms.get(f"k{channel}", 1.0))
        factors = [linear - 1, terms.get(f"c{channel}", 0.0), terms.get(f"b{channel}", 0.0)]
        return np.asarray(heights_mm * polyval(heights_mm / self.unit_mm, factors))

    def illumination(self, terms: Terms, heights_mm: Floats) -> Floats:
        """Light relative to the axis."""
        factors = [1, 0, terms["k1"], 0, terms["k2"], 0, terms["k3"]]
        return np.asarray(polyval(heights_mm / self.half_diagonal_mm, factors))


def _distortion(terms: Terms) -> list[float]:
    """Coefficients of distorted over undistorted height, by powers of the latter."""
    match terms["model"]:
        case "ptlens":
            a, b, c = terms["a"], terms["b"], terms["c"]
            return [1 - a - b - c, c, b, a]
        case "poly3":
            return [1 - terms["k1"], 0, terms["k1"]]
        case _:
            return [1, 0, terms["k1"], 0, terms["k2"]]


def calibrations(folder: Path | None) -> tuple[list[Calibration], str]:
    """Reads calibrations, with their source; None: the shared folder, else lensfunpy."""
    path = (folder or SHARED) / CALIBRATIONS
    if path.is_file():
        data = parse(path.read_bytes(), str(path))
        return [_of_file(one) for one in data.need("lenses")], data.need("source").text()
    if folder is not None:
        raise InputError(f"--data: wanted a folder with {CALIBRATIONS}, got {folder}")
    try:
        import lensfunpy
    except ImportError:
        raise InputError(
            f"measured lenses: wanted {CALIBRATIONS} in {SHARED} or in --data FOLDER, or the "
            f"package lensfunpy ({hint('lensfunpy')}); got neither"
        ) from None
    return _of_package(lensfunpy.Database().lenses), f"lensfunpy {lensfunpy.__version__}"


def closest_focus(folder: Path | None) -> list[Terms]:
    """Closest focus and magnification of products as their makers state them; [] without a file."""
    path = (folder or SHARED) / CLOSEST_FOCUS
    if not path.is_file():
        return []
    numbers = ("closest_focus_m", "magnification")
    return [
        {"lens": one.need("lens").text(), **{k: one.need(k).number(above=0) for k in numbers}}
        for one in parse(path.read_bytes(), str(path)).need("lenses")
    ]


def _of_file(one: Item) -> Calibration:
    sides = {"3:2": (3.0, 2.0), "4:3": (4.0, 3.0)}
    return Calibration(
        one.need("lens").text(),
        one.need("product").text(),
        one.need("match").choice(("A", "B")),
        sides[one.need("aspect").choice(sides)],
        one.need("half_diagonal_mm").number(above=0),
        tuple(_read(terms, DISTORTION) for terms in one.need("distortion")),
        tuple(_read(terms, COLOUR, needed=False) for terms in one.need("lateral_colour")),
        tuple(_read(terms, VIGNETTING, SETTINGS) for terms in one.need("vignetting")),
    )


def _read(
    terms: Item, models: dict[str, str], settings: Sequence[str] = SETTINGS[:1], needed: bool = True
) -> Terms:
    model = terms.need("model").choice(models)
    made: Terms = {"model": model, **{k: terms.need(k).number(above=0) for k in settings}}
    for key in models[model].split():
        if needed or terms.get(key) is not None:
            made[key] = terms.need(key).number()
    return made


def _of_package(lenses: Sequence[Any]) -> list[Calibration]:
    """Calibrations of PRODUCTS that an installed database has."""
    found = []
    for product in PRODUCTS:
        for lens in lenses:
            same = f"{lens.maker} {lens.model}" == product.name
            if same and math.isclose(lens.crop_factor, product.crop, rel_tol=1e-3):
                found.append(_of_lensfun(product, lens))
    return found


def _of_lensfun(product: Product, lens: Any) -> Calibration:
    return Calibration(
        product.lens,
        product.name,
        product.match,
        product.aspect,
        HALF_DIAGONAL / product.crop,
        tuple(_converted(one, DISTORTION) for one in lens.calib_distortion),
        tuple(_converted(one, COLOUR) for one in lens.calib_tca),
        tuple(_converted(one, VIGNETTING, SETTINGS) for one in lens.calib_vignetting),
    )


def _converted(one: Any, models: dict[str, str], settings: Sequence[str] = SETTINGS[:1]) -> Terms:
    model = one.model.name.lower()
    made: Terms = {"model": model, **{k: round(getattr(one, k), 4) for k in settings}}
    return made | dict(zip(models[model].split(), one.terms, strict=False))
