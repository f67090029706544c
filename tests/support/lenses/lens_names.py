"""Lenses of the library that tests of every kind run through: the classical forms."""

from __future__ import annotations

CLASSICS = (
    "double-gauss-50mm-f2",
    "double-gauss-52mm-f2",
    "fisheye-16mm-f2.8",
    "heliar-100mm-f4",
    "petzval-100mm-f2.2",
    "portrait-85mm-f2",
    "sonnar-50mm-f2",
    "telephoto-200mm-f1.8",
    "telephoto-600mm-f5.6",
    "tessar-50mm-f2.8",
    "wide-angle-28mm-f3.5",
    "wide-angle-35mm-f2",
)
