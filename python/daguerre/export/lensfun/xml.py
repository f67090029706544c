"""Text of a profile: a file of lensfun's database.

Source: https://lensfun.github.io/manual/latest/dbformat.html.
"""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree import ElementTree as ET

from .models import DIGITS, Fit
from .profile import LensfunProfile
from .traced import Vignetting

VERSION = "1"  # of the database's format: read by lensfun 0.3 and later
MOUNT = "Daguerre"  # of the lens and of a camera with its frame


def as_xml(profile: LensfunProfile) -> str:
    """Returns the text of a profile."""
    root = ET.Element("lensdatabase", version=VERSION)
    _named(ET.SubElement(root, "mount"), name=MOUNT)
    frame = profile.frame
    crop = f"{frame.crop_factor:.6g}"
    aspect = f"{frame.long_mm / frame.short_mm:.6g}"
    size = f"{frame.long_mm:g} x {frame.short_mm:g} mm"
    camera = ET.SubElement(root, "camera")
    _named(camera, maker=MOUNT, model=size, mount=MOUNT, cropfactor=crop)
    lens = ET.SubElement(root, "lens")
    _named(lens, maker=profile.maker, model=profile.name, mount=MOUNT, cropfactor=crop)
    _named(lens, **{"aspect-ratio": aspect}, type="rectilinear")
    ends = profile.geometry[0].focal_mm, profile.geometry[-1].focal_mm
    ET.SubElement(lens, "focal", min=_short(ends[0]), max=_short(ends[1]))
    widest = min(light.f_stop for light in profile.vignetting)
    ET.SubElement(lens, "aperture", min=_short(widest))
    calibration = ET.SubElement(lens, "calibration")
    for line in remarks(profile):
        calibration.append(ET.Comment(f" {line} "))
    for row in profile.geometry:
        fit = row.distortion[profile.model]
        _terms(calibration, "distortion", [fit], model=profile.model, focal=_short(row.focal_mm))
    for row in profile.geometry:
        _terms(calibration, "tca", [row.red, row.blue], model="poly3", focal=_short(row.focal_mm))
    for light in profile.vignetting:
        _terms(calibration, "vignetting", [light.fit], model="pa", **_setting(light))
    ET.indent(root, "    ")
    return ET.tostring(root, encoding="unicode") + "\n"


def remarks(profile: LensfunProfile) -> list[str]:
    """Lines on the residuals of a profile, for its file and for people."""
    well = "" if profile.fits else ": no model of lensfun fits this lens to 0.3 px"
    lines = [f"residuals at 24 MP, RMS over the frame (largest); {profile.model}{well}"]
    for row in profile.geometry:
        fits = {"distortion": row.distortion[profile.model], "red": row.red, "blue": row.blue}
        texts = (f"{name} {fit.rms:.2f} ({fit.largest:.2f}) px" for name, fit in fits.items())
        lines.append(f"{_short(row.focal_mm)} mm: {', '.join(texts)}")
    rms = max(light.fit.rms for light in profile.vignetting)
    largest = max(light.fit.largest for light in profile.vignetting)
    lines.append(f"vignetting: at most {rms:.2f} ({largest:.2f}) EV")
    return lines


def _named(parent: ET.Element, **texts: str) -> None:
    for name, text in texts.items():
        ET.SubElement(parent, name).text = text


def _terms(parent: ET.Element, kind: str, fits: Iterable[Fit], **setting: str) -> None:
    terms = {k: f"{v:.{DIGITS}f}" for fit in fits for k, v in fit.terms.items()}
    ET.SubElement(parent, kind, {**setting, **terms})


def _setting(light: Vignetting) -> dict[str, str]:
    return {
        "focal": _short(light.focal_mm),
        "aperture": _short(light.f_stop),
        "distance": _short(light.distance_m),
    }


def _short(value: float) -> str:
    return f"{value:.4g}"
