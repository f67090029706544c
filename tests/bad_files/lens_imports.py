"""Lens files of other programs, and lenses that no light passes, whatever their format."""

from __future__ import annotations

import copy
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from tests.support.lenses import lens_writers as write
from tests.support.lenses.triplet import CROWN, TRIPLET, Data, row

from .bases import beside_scene
from .case import DRAW, Case

SHOW = ("lens", "{bad}")
RENDER = ("render", "{folder}/scene.glb", "--lens", "{bad}", *DRAW, "--sky", "1,1,1")


ZOOM: Data = {
    **TRIPLET,
    "configurations": [{"name": "a", "gaps": {}}, {"name": "b", "gaps": {"1": 7.0}}],
}


def changed(surface: int, **members: Any) -> Data:
    """The triplet with members of one surface changed."""
    data = copy.deepcopy(TRIPLET)
    data["surfaces"][surface].update(members)
    return data


def many(count: int) -> Data:
    """Very many plates."""
    plate = [row("spherical", None, 0.01, 9, CROWN), row("spherical", None, 0.01, 9)]
    return {**TRIPLET, "surfaces": [*TRIPLET["surfaces"][:5], *(plate * (count // 2))]}


FLAT: Data = copy.deepcopy(TRIPLET)
for _surface in FLAT["surfaces"]:
    _surface["radius"] = None

#: Prescriptions that are bad in any format: the lens, and the error.
LENSES: dict[str, tuple[Data, str]] = {
    "overlap": (changed(1, thickness=-2.0), r"surface 2.*got -2.* \[lens-overlap\]"),
    "overlap of glass": (changed(2, thickness=-0.5), r"surface 3.*got -0\.5.* \[lens-overlap\]"),
    "edge": (changed(0, radius=11.0, thickness=0.3), r"surfaces 0 and 1.*edge.*\[lens-edge\]"),
    "edge of air": (
        changed(1, radius=12.0, thickness=0.1),
        r"surfaces 1 and 2.*(edge|stopped).*\[lens-(edge|no-light)\]",
    ),
    "no stop": (
        changed(4, kind="spherical", semi_diameter=4.0, glass=CROWN),
        r"exactly one stop, got 0.*\[lens-no-stop\]",
    ),
    "flat": (FLAT, r"afocal.*\[lens-afocal\]"),
    "thickness 1e12": (changed(1, thickness=1e12), r"\[lens-(surface|format)\]"),
    "radius 1e-9": (changed(0, radius=1e-9), r"\[lens-surface\]"),
    "index 9": (changed(0, glass={"nd": 9.0, "vd": 50.0}), r"out of range.*\[lens-glass\]"),
    "index 0.9": (changed(0, glass={"nd": 0.9, "vd": 50.0}), r"out of range.*\[lens-glass\]"),
    "1200 surfaces": (many(1200), r"surfaces: wanted at most 1000, got.*\[lens-format\]"),
    "diameter negative": (changed(0, semi_diameter=-3.0), r"\[lens-(format|surface)\]"),
}
WRITERS: dict[str, tuple[Callable[[Data], str], str]] = {
    "zmx": (write.zmx, "bad.zmx"),
    "seq": (write.seq, "bad.seq"),
    "bench": (write.optical_bench, "bad.txt"),
    "pbrt": (write.pbrt, "bad.dat"),
}

#: Bytes that are no lens in any format.
BYTES: dict[str, tuple[bytes, str]] = {
    "empty": (b"", "empty file"),
    "blanks": (b" \t\r\n" * 40, "empty file"),
    "zeros": (bytes(5000), r"\[lens-format\]"),
    "a picture": (b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR\x00\x00", "wanted text, got byte 0x"),
    "a page": (b"<!DOCTYPE html>\n<html><body>404</body></html>\n", r"\[lens-format\]"),
    "noise": (bytes(range(256)) * 20, r"\[lens-format\]"),
    "broken utf-16": (b"\xff\xfeS\x00U\x00R", "wanted UTF-16, got a broken character"),
    "20 MB": (b" " * 20_000_000, "wanted at most 16000000 bytes, got 20000000"),
    "many lines": (b"! x\n" * 450_000, r"\[lens-format\]"),
    "a long line": (b"# " + b"x" * 150_000, r"\[lens-format\]"),
}


def swap(pattern: str, new: str) -> Callable[[str], str]:
    """The text with the first match replaced; it must be there."""

    def change(text: str) -> str:
        out, count = re.subn(pattern, new, text, count=1, flags=re.MULTILINE)
        assert count == 1, pattern
        return out

    return change


def add(more: str, before: str = "") -> Callable[[str], str]:
    """The text with lines at its end, or before a pattern."""
    return swap(f"^(?=.*{before})" if before else r"\Z", more + "\n")


# From here on: (change of the good file's text, error). \3 and so on are surfaces of the file.
_F = r".*\[lens-format\]"
_S = r".*\[lens-surface\]"
ZMX: dict[str, tuple[Callable[[str], str], str]] = {
    "mode": (swap("MODE SEQ", "MODE NSC"), "line 2: MODE: wanted SEQ" + _F),
    "unit": (swap("UNIT MM", "UNIT FURLONG"), "UNIT: wanted one of MM" + _F),
    "numbers": (swap("SURF 3", "SURF 2"), "SURF: wanted surface 3 next, got 2" + _F),
    "number text": (swap("SURF 3", "SURF x"), "SURF: number: wanted a number, got 'x'" + _F),
    "number huge": (swap("SURF 3", "SURF 99999999"), "SURF: number: out of range" + _F),
    "begins at 1": (swap(r"SURF 0\n(  .*\n)+", ""), "SURF: wanted surface 0 next" + _F),
    "no surfaces": (swap(r"SURF 0(.|\n)*", ""), r"(wanted an object|wanted a Zemax)" + _F),
    "two surfaces": (swap(r"SURF 2(.|\n)*", ""), "SURF: wanted an object, surfaces" + _F),
    "type": (swap("TYPE STANDARD\n  CURV 0.045", "TYPE GRIDSAG\n  CURV 0.045"), "surface 1" + _S),
    "paraxial": (swap("TYPE STANDARD\n  CURV -", "TYPE PARAXIAL\n  CURV -"), "TYPE: wanted" + _S),
    "no type": (swap("TYPE STANDARD\n  CURV -", "TYPE\n  CURV -"), "TYPE: type: missing" + _F),
    "curvature": (swap("CURV 0.045", "CURV steep"), "CURV: value: wanted a number" + _F),
    "curvature nan": (swap("CURV 0.045", "CURV nan#"), "CURV: value: wanted a number" + _F),
    "curvature inf": (swap("CURV 0.045", "CURV 1e999 "), "CURV: value: wanted a number" + _F),
    "thickness": (swap("DISZ 3.79", "DISZ thick"), "DISZ: thickness: wanted a number" + _F),
    "no thickness": (swap("DISZ 3.79.*", "DISZ"), "DISZ: thickness: missing" + _F),
    "infinite": (swap("DISZ 3.79.*", "DISZ INFINITY"), "surface 1: DISZ: wanted a finite" + _F),
    "thickness 1e18": (swap("DISZ 3.79.*", "DISZ 1e18"), "DISZ: thickness: out of range" + _F),
    "underscores": (swap("DISZ 3.79.*", "DISZ 1_0"), "DISZ: thickness: wanted a number" + _F),
    "mirror": (swap("GLAS ___BLANK", "GLAS MIRROR"), r"surface 1: GLAS.*\[lens-mirror\]"),
    "glass": (
        swap("GLAS ___BLANK 1 .*", "GLAS N-BK77 0 0 0 0"),
        r"surface 1: glass: the catalogues Schott, .* have no 'N-BK77' \(did you mean .*lens-glass",
    ),
    "no glass": (swap("GLAS ___BLANK 1 .*", "GLAS"), "GLAS: glass: missing" + _F),
    "glass numbers": (swap("(GLAS ___BLANK 1 0) .*", r"\1 x y"), "GLAS: nd: wanted a number" + _F),
    "dPgF": (
        swap("60.32 0$", "60.32 0.9"),
        r"surface 1: glass: dPgF: theta_gF out of range: wanted 0.4 .. 0.8, got 1.44.*lens-glass",
    ),
    "abbe 1": (swap("(GLAS ___BLANK 1 0 1.62041).*", r"\1 1"), r"Vd: out of range.*\[lens-glass\]"),
    "two stops": (add("  STOP", "CURV -0.054"), r"stop, got 2.*\[lens-two-stops\]"),
    "image stop": (
        lambda t: swap("  STOP\n", "")(t) + "  STOP\n",
        r"exactly one stop, got 0.*\[lens-no-stop\]",
    ),
    "pupil 0": (swap("FLOA", "ENPD 0"), r"ENPD: wanted an aperture above 0.*\[lens-f-stop\]"),
    "pupil negative": (swap("FLOA", "ENPD -8"), r"ENPD: wanted.*\[lens-f-stop\]"),
    "pupil text": (swap("FLOA", "ENPD wide"), "ENPD: aperture: wanted a number" + _F),
    "f-number 0": (swap("FLOA", "FNUM 0 0"), r"\[lens-(f-stop|format)\]"),
    "f-number missing": (swap("FLOA", "FNUM"), "FNUM: .*missing" + _F),
    "object aperture": (
        swap("FLOA", "OBNA 0.1"),
        r"aperture: wanted a finite object distance.*\[lens-f-stop\]",
    ),
    "wider than the lens": (
        lambda t: swap("FLOA", "ENPD 90")(re.sub(r"  DIAM .*\n", "", t)),  # none that stops light
        r"\[lens-(no-light|edge)\]",
    ),
    "diameter": (swap("DIAM 9.5", "DIAM big"), "DIAM: value: wanted a number" + _F),
    "obstruction": (add("  OBSC 0 50 0", "CURV -0.054"), r"\[lens-(no-light|surface|format)\]"),
    "aperture of light": (
        add("  CLAP 4 0.5 0", "CURV -0.054"),
        r"\[lens-(no-light|surface|format)\]",
    ),
    "aperture negative": (add("  CLAP 0 -5 0", "CURV -0.054"), "CLAP: radius: out of range" + _F),
    "parameter": (add("  PARM 99999 1", "CURV -0.054"), "PARM: number: out of range" + _F),
    "parameter text": (
        lambda t: swap("TYPE STANDARD\n  CURV -", "TYPE EVENASPH\n  PARM 2 x\n  CURV -")(t),
        "PARM: value: wanted a number" + _F,
    ),
    "asphere huge": (
        swap("TYPE STANDARD\n  CURV -", "TYPE EVENASPH\n  PARM 8 1e9\n  CURV -"),
        "coefficient of the asphere" + _S,
    ),
    "cone": (
        swap("TYPE STANDARD\n  CURV -", "TYPE ODDASPHE\n  PARM 1 0.1\n  CURV -"),
        r"\[lens-(surface|format)\]",
    ),
    "terms": (
        swap("TYPE STANDARD\n  CURV -", "TYPE XASPHERE\n  XDAT 1 1e9\n  CURV -"),
        "XDAT: wanted 0 .. 60 terms" + _S,
    ),
    "terms norm": (
        swap("TYPE STANDARD\n  CURV -", "TYPE XASPHERE\n  XDAT 1 2\n  XDAT 2 1e-14\n  CURV -"),
        "XDAT: wanted 0 .. 60 terms and a radius" + _S,
    ),
    "toroid terms": (
        swap("TYPE STANDARD\n  CURV -", "TYPE TOROIDAL\n  PARM 3 1e-5\n  CURV -"),
        r"TOROIDAL: terms in y \(PARM 2-8, XDAT\) are not supported" + _S,
    ),
    "conic": (add("  CONI 1e12", "CURV -0.054"), "conic constant" + _S),
    "on edge": (
        swap("TYPE STANDARD\n  CURV -", "TYPE COORDBRK\n  PARM 3 90\n  CURV -"),
        r"\[lens-(surface|overlap|no-light|afocal|no-stop|format)\]",
    ),
    "configurations 0": (add("MNUM 0 1"), "MNUM: configurations: out of range" + _F),
    "configurations 1e6": (add("MNUM 1000000 1"), "MNUM: configurations: out of range" + _F),
    "configuration 3 of 2": (add("MNUM 2 3"), "MNUM: wanted a configuration of 1 .. 2" + _F),
    "gap of nowhere": (add("MNUM 2 1\nTHIC 99 2 5"), "THIC: wanted a surface of 0 .. 8" + _F),
    "gap of configuration 9": (add("MNUM 2 1\nTHIC 1 9 5"), "THIC: configuration: out of" + _F),
    "gap text": (add("MNUM 2 1\nTHIC 1 2 x"), "THIC: thickness: wanted a number" + _F),
    "gap missing": (add("MNUM 2 1\nTHIC 1 2"), "THIC: thickness: missing" + _F),
    "gap negative": (add("MNUM 2 1\nTHIC 2 2 -1"), r"surface 2: thickness.*-1 \[lens-overlap\]"),
    "solve ahead": (
        lambda t: add("MNUM 2 1\nTHIC 2 2 5")(add("  TCOM 5 9", "CURV -0.045")(t)),
        "TCOM: wanted a surface before" + _F,
    ),
    "solve negative": (
        lambda t: add("MNUM 2 1\nTHIC 2 2 5")(add("  TCOM 2 1", "CURV 0.049")(t)),
        r"\[lens-overlap\]",
    ),
}
SEQ: dict[str, tuple[Callable[[str], str], str]] = {
    "no object": (swap("^SO .*", ""), "wanted the object SO first, got S" + _F),
    "no image": (swap("^SI .*", ""), "wanted SO, surfaces S and the image SI" + _F),
    "behind the image": (swap("^GO", "S 1 2"), "no surface may follow the image" + _F),
    "numbers": (swap("^S -22", "S9 -22"), "wanted surface 3 next, got S9" + _F),
    "radius": (swap("^S 22.01359", "S wide"), "S: radius: wanted a number, got 'wide'" + _F),
    "radius nan": (swap("^S 22.01359", "S NaN"), "S: radius: wanted a number" + _F),
    "thickness": (swap("3.795568", "1e999"), "S: thickness: wanted a number" + _F),
    "thickness 1e17": (swap("3.795568", "1e17"), "S: thickness: out of range" + _F),
    "object": (swap("0.1e14", "far"), "SO: thickness: wanted a number" + _F),
    "mirror": (swap("1.62041:60.32", "REFL"), r"surface 1: .*mirror.*\[lens-mirror\]"),
    "bend": (swap("^S -22.*", r"\g<0>\nADE 45; BEN"), r"surface 3: BEN.*\[lens-mirror\]"),
    "diffractive": (swap("^S -22.*", r"\g<0>\nDIF DOE"), "surface 3: DIF" + _S),
    "grating": (swap("^S -22.*", r"\g<0>\nGRT"), "surface 3: GRT" + _S),
    "special": (swap("^S -22.*", r"\g<0>\nSPS QCN"), "surface 3: SPS" + _S),
    "global": (swap("^S -22.*", r"\g<0>\nGLB S1"), "surface 3: GLB" + _S),
    "return": (swap("^S -22.*", r"\g<0>\nRET S1"), "surface 3: RET" + _S),
    "glass": (
        swap("1.62041:60.32", "NBK77_SCHOTT"),
        r"surface 1: glass: the catalogues Schott, .* have no 'NBK77'.*\[lens-glass\]",
    ),
    "glass index": (swap("1.62041:60.32", "7.5:60"), r"nd: out of range.*\[lens-glass\]"),
    "glass abbe": (swap("1.62041:60.32", "1.6:0.1"), r"Vd: out of range.*\[lens-glass\]"),
    "glass empty": (swap("1.62041:60.32", "''"), r"\[lens-glass\]"),
    "two stops": (swap("^S -22.*", r"\g<0>\nSTO"), r"stop, got 2.*\[lens-two-stops\]"),
    "stop of nowhere": (add("STO S40", "GO"), "STO: wanted a surface of 0 .. 8" + _F),
    "unit": (swap("DIM M", "DIM L"), "DIM: wanted M, C or I" + _F),
    "pupil negative": (swap("DIM M", "DIM M; EPD -1"), r"EPD: wanted.*\[lens-f-stop\]"),
    "pupil text": (swap("DIM M", "DIM M; EPD wide"), "EPD: aperture: wanted a number" + _F),
    "f-number 0": (swap("DIM M", "DIM M; FNO 0"), r"FNO: .*\[lens-f(-stop|ormat)\]"),
    "object aperture": (swap("DIM M", "DIM M; NAO .1"), r"aperture: .*\[lens-f-stop\]"),
    "fields": (swap("DIM M", "DIM M; YAN 0 x"), "YAN: field: wanted a number" + _F),
    "circle": (swap("CIR 9.5;", "CIR;"), "CIR: the radius is missing" + _F),
    "circle negative": (swap("CIR 9.5;", "CIR -9.5;"), "CIR: radius: out of range" + _F),
    "obstruction": (swap("^S -22.*", r"\g<0>\nCIR OBS 50"), r"\[lens-(no-light|surface|format)\]"),
    "tilted on edge": (swap("^S -22.*", r"\g<0>\nADE 90; DAR"), r"\[lens-(surface|format)\]"),
    "tilt text": (swap("^S -22.*", r"\g<0>\nADE x"), "ADE: value: wanted a number" + _F),
    "far away": (swap("^S -22.*", r"\g<0>\nYDE 1e9; DAR"), r"\[lens-(surface|format|no-light)\]"),
    "cylinder of two": (swap("^S -22.*", r"\g<0>\nCYL; RDX 5"), "CYL: wanted one curvature" + _S),
    "toroid terms": (
        swap("^S -22.*", r"\g<0>\nYTO; A 1e-5"),
        "YTO: asphere terms are not supported" + _S,
    ),
    "anamorphic terms": (
        swap("^S -22.*", r"\g<0>\nAAS; AR 1e-5"),
        "AAS: only the terms KX and KY" + _S,
    ),
    "asphere huge": (swap("^S -22.*", r"\g<0>\nASP; J 1e9"), "coefficient of the asphere" + _S),
    "asphere text": (swap("^S -22.*", r"\g<0>\nASP; A x"), "A: value: wanted a number" + _F),
    "zoom 0": (add("ZOO 0", "GO"), "ZOO: positions: out of range" + _F),
    "zoom 1000": (add("ZOO 1000", "GO"), "ZOO: positions: out of range" + _F),
    "zoom of nothing": (add("ZOO", "GO"), "ZOO: number of positions: missing" + _F),
    "zoom of nowhere": (add("ZOO 2; ZOO THI S99 1 2", "GO"), "wanted a surface of 0 .. 8" + _F),
    "zoom of text": (add("ZOO 2; ZOO THI front 1 2", "GO"), "ZOO THI: wanted a surface" + _F),
    "zoom negative": (add("ZOO 2; ZOO THI S2 6 -1", "GO"), r"surface 2: .*-1 \[lens-overlap\]"),
    "zoom values": (add("ZOO 2; ZOO THI S2 6 x", "GO"), "ZOO: thickness: wanted a number" + _F),
    "private glass": (
        lambda t: swap("DIM M", "DIM M\nPRV\nPWL 656 588 486\n'X' 1.5 1.6\nEND")(t),
        "PRV: wanted 3 indices, got 2" + _F,
    ),
    "private formula": (
        lambda t: swap("1.62041:60.32", "'X'")(
            swap("DIM M", "DIM M\nPRV\nPWL 656 588 486\n'X' LAU\nEND")(t)
        ),
        r"surface 1: glass: wanted a table.*\[lens-glass\]",
    ),
    "private twice": (
        swap("DIM M", "DIM M\nPRV\nPWL 588 588 486\n'X' 1.5 1.6 1.7\nEND"),
        "PWL: wavelengths must differ" + _F,
    ),
    "private open": (swap("DIM M", "DIM M\nPRV\nPWL 588"), r"\[lens-format\]"),
}
BENCH: dict[str, tuple[Callable[[str], str], str]] = {
    "no rows": (
        swap(r"\[lens data\]\n(\d.*\n)+", "[lens data]\n"),
        r"\[lens data\]: no surfaces" + _F,
    ),
    "text first": (lambda t: "hello\n" + t, r"wanted a section such as \[lens data\]" + _F),
    "twice": (add("[lens data]"), r"\[lens data\]: appears twice" + _F),
    "a row twice": (swap("^2\t", "1\t"), "surface '1' appears twice" + _F),
    "short row": (swap("^3\t.*", "3"), "3: radius: missing" + _F),
    "no thickness row": (swap("^3\t.*", "3\t-22"), "3: thickness: missing" + _F),
    "radius": (swap("^1\t22.01359", "1\tround"), "1: radius: wanted a number" + _F),
    "radius nan": (swap("^1\t22.01359", "1\tNaN"), "1: radius: wanted a number" + _F),
    "radius 1e20": (swap("^1\t22.01359", "1\t1e20"), "1: radius: out of range" + _F),
    "thickness": (swap("3.795568", "thick"), "thickness: wanted a number or a variable" + _F),
    "thickness inf": (swap("3.795568", "1e999"), r"thickness: wanted a number" + _F),
    "no such distance": (swap("3.795568", "d77"), "surface 1: thickness: wanted a number or" + _F),
    "undefined": (
        lambda t: swap("3.795568", "d9")(add("d9\tundefined", r"\[lens data")(t)),
        "distance: wanted a number, got 'undefined'" + _F,
    ),
    "no distance": (
        lambda t: swap("3.795568", "d9")(add("d9", r"\[lens data")(t)),
        "a distance is missing" + _F,
    ),
    "zoom negative": (
        lambda t: swap(r"\t6\.0\t", "\td2\t")(add("d2\t6\t-1", r"\[lens data")(t)),
        r"surface 2: thickness.*-1 \[lens-overlap\]",
    ),
    "positions": (
        lambda t: add("d2" + "\t6" * 100, r"\[lens data")(t),
        "wanted at most 64 positions, got 100" + _F,
    ),
    "index": (swap("\t1.62041\t", "\tglass\t"), "nd: wanted a number" + _F),
    "abbe": (swap("\t60.32", "\t0.5"), r"Vd: out of range.*\[lens-glass\]"),
    "diameter": (swap("\t19.0\t", "\twide\t"), "diameter: wanted a number" + _F),
    "two stops": (swap("^4\t20.29192", "4\tAS"), r"stop, got 2.*\[lens-two-stops\]"),
    "odd count": (
        lambda t: add("[aspherical data]\n1\t22.01359\t0\t1e-6")(
            add("AsphericalOddCount\t-1", r"\[varia")(t)
        ),
        "count of odd powers: out of range" + _F,
    ),
    "asphere of nowhere": (add("[aspherical data]\n99\t22\t0"), "wanted the id of a surface" + _F),
    "asphere short": (add("[aspherical data]\n1"), "1: radius: missing" + _F),
    "asphere text": (add("[aspherical data]\n1\t22.01359\tk"), "1: k: wanted a number" + _F),
    "asphere huge": (
        add("[aspherical data]\n1\t22.01359\t0\t1e3\t1e9"),
        "coefficient of the asphere" + _S,
    ),
    "diffractive": (
        add("[diffractive data]\n1\t587\t1\t-1e-4"),
        "diffractive surfaces are not supported" + _S,
    ),
    "object": (add("ObjectGlass\tx", r"\[varia"), "ObjectGlass: nd: wanted a number" + _F),
    "f-number": (
        lambda t: swap("^5\tAS\t(.*?)\t\t8.6", r"5\tAS\t\1\t\t")(
            add("F-Number\tfast", r"\[lens data")(t)
        ),
        "F-Number: value: wanted a number" + _F,
    ),
}
PBRT: dict[str, tuple[Callable[[str], str], str]] = {
    "three columns": (swap("^22.*", "22 3 1.6"), "line 3: wanted 4 numbers.*got 3 words" + _F),
    "five columns": (swap("^22.*", "22 3 1.6 60 9"), "wanted 4 numbers.*got 5 words" + _F),
    "words": (swap("^22.*", "a b c d"), "radius: wanted a number, got 'a'" + _F),
    "nan": (swap("^22.*", "nan 3 1.6 9"), "radius: wanted a number" + _F),
    "index 0.5": (swap("^22.*", "22 3 .5 9"), r"surface 1: index.*0\.5.*\[lens-glass\]"),
    "index 7": (swap("^22.*", "22 3 7 9"), r"surface 1: index.*got 7.*\[lens-glass\]"),
    "index negative": (swap("^22.*", "22 3 -1 9"), r"index: out of range.*\[lens-glass\]"),
    "diameter": (swap("^22.*", "22 3 1.6 -9"), "surface 1: diameter: out of range" + _F),
    "only comments": (lambda t: "# nothing\n# here\n", r"wanted rows of radius" + _F),
    "two stops": (swap("^0.0.*", "0 1 0 8\n0 1 0 8"), r"stop, got 2.*\[lens-two-stops\]"),
    "focal length": (lambda t: "-50\n" + t, "focal length: out of range" + _F),
    "json": (lambda t: '{"radius": 5}', "wanted 4 numbers" + _F),
}
THEMES = {"zmx": ZMX, "seq": SEQ, "bench": BENCH, "pbrt": PBRT}

#: Good files that a command asks too much of.
ASKED: dict[str, tuple[tuple[str, ...], str]] = {
    "f-stop": (("--f-stop", "0.8"), r"f_stop: wanted .* opens to f/.* \[lens-f-stop\]"),
    "focus": (("--focus", "0.01"), r"nearest possible.* \[lens-focus-near\]"),
    "dark": (
        ("--shift", "300,0", "--focus", "inf"),
        r"frame: all of .* is outside the image circle.*\[lens-no-light\]",
    ),
}


def _of_bytes(name: str, data: bytes) -> Callable[[Path], Path]:
    def make(folder: Path) -> Path:
        (folder / name).write_bytes(data)
        return folder / name

    return make


def _cases() -> Iterator[Case]:
    for form, (writer, file) in WRITERS.items():
        for key, (data, error) in BYTES.items():
            yield Case(f"lens-{form}-{key}", _of_bytes(file, data), error, command=SHOW)
        for key, (lens, error) in LENSES.items():
            text = writer(lens).encode()
            yield Case(f"lens-{form}-{key}", _of_bytes(file, text), error, command=SHOW)
        for key, (change, error) in THEMES[form].items():
            text = change(writer(TRIPLET)).encode()
            yield Case(f"lens-{form}-of {key}", _of_bytes(file, text), error, command=SHOW)
        good = writer(TRIPLET).encode()
        for key, (flags, error) in ASKED.items():
            put = beside_scene(file, lambda path, good=good: path.write_bytes(good))
            yield Case(f"lens-{form}-asked {key}", put, error, command=(*RENDER, *flags))


CASES = list(_cases())
