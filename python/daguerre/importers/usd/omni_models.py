"""Lens distortion of NVIDIA's cameras: which attributes hold which numbers of a projection.

Pixels are counted from the corner of the picture, as NVIDIA's defaults have it (the middle of 2048
pixels is 1024), so that the centre of the first pixel is at 0.5.

Source: NVIDIA, "Lens Distortion Schemas" (``OmniLensDistortion*API``) and their declared defaults.
"""

from __future__ import annotations

from dataclasses import dataclass

PREFIX = "omni:lensdistortion:"
MODEL = PREFIX + "model"
#: Width and height, principal point, focal lengths: px. Attribute, and part of a pair or -1.
Source = tuple[str, int]
_PINHOLE = ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6", "s1", "s2", "s3", "s4")


@dataclass(frozen=True)
class OmniModel:
    """A lens distortion of NVIDIA.

    Attributes:
        name: Value of ``omni:lensdistortion:model``.
        schema: Name of the applied schema; empty: attributes of older files.
        size: Width and height of the picture, px.
        center: Principal point, px.
        focal: Focal lengths, px; empty: there are none.
        terms: Coefficients, in the order of the projection's parameters.
        field: Largest field of view, degrees; empty: none.
        defaults: Defaults of attributes other than 0.
    """

    name: str
    schema: str
    size: tuple[Source, Source]
    center: tuple[Source, Source]
    focal: tuple[Source, ...]
    terms: tuple[str, ...]
    field: str
    defaults: dict[str, tuple[float, ...]]

    @property
    def needed(self) -> tuple[str, ...]:
        """Attributes without which a calibration is none."""
        return tuple(dict.fromkeys(name for name, _ in (*self.size, *self.center, *self.focal)))


def _opencv(name: str, schema: str, terms: tuple[str, ...]) -> OmniModel:
    stem = f"{PREFIX}{name}:"
    return OmniModel(
        name,
        schema,
        ((stem + "imageSize", 0), (stem + "imageSize", 1)),
        ((stem + "cx", -1), (stem + "cy", -1)),
        ((stem + "fx", -1), (stem + "fy", -1)),
        tuple(stem + term for term in terms),
        "",
        {
            stem + "imageSize": (2048, 1024),
            **{stem + k: (v,) for k, v in {"cx": 1024, "cy": 512, "fx": 900, "fy": 800}.items()},
        },
    )


def _nominal(name: str, schema: str, terms: tuple[str, ...], slope: float) -> OmniModel:
    stem = f"{PREFIX}{name}:"
    return OmniModel(
        name,
        schema,
        ((stem + "nominalWidth", -1), (stem + "nominalHeight", -1)),
        ((stem + "opticalCenter", 0), (stem + "opticalCenter", 1)),
        (),
        tuple(stem + term for term in terms),
        stem + "maxFov",
        {
            stem + "nominalWidth": (1936,),
            stem + "nominalHeight": (1216,),
            stem + "opticalCenter": (970.9424, 600.3748),
            **({stem + "k1": (slope,)} if slope else {}),
        },
    )


def _older(name: str, terms: tuple[str, ...], focal: bool) -> OmniModel:
    return OmniModel(
        name,
        "",
        (("fthetaWidth", -1), ("fthetaHeight", -1)),
        (("fthetaCx", -1), ("fthetaCy", -1)),
        (("openCVFx", -1), ("openCVFy", -1)) if focal else (),
        terms,
        "" if focal else "fthetaMaxFov",
        {},
    )


def _poly(letters: str) -> tuple[str, ...]:
    return tuple(f"fthetaPoly{letter}" for letter in letters)


_PRISM = ("p0", "p1", "s0", "s1", "s2", "s3")
_API = "OmniLensDistortion{}API"
#: By the value of ``omni:lensdistortion:model``.
MODELS = {
    model.name: model
    for model in (
        _opencv("opencvPinhole", _API.format("OpenCvPinhole"), _PINHOLE),
        _opencv("opencvFisheye", _API.format("OpenCvFisheye"), ("k1", "k2", "k3", "k4")),
        _nominal("ftheta", _API.format("Ftheta"), tuple(f"k{i}" for i in range(6)), 0.00245),
        _nominal("kannalaBrandtK3", _API.format("KannalaBrandtK3"), ("k0", "k1", "k2", "k3"), 0.0),
        _nominal(
            "radTanThinPrism",
            _API.format("RadTanThinPrism"),
            (*(f"k{i}" for i in range(6)), *_PRISM),
            0.0,
        ),
    )
}
#: By the value of ``cameraProjectionType`` of older files.
OLDER = {
    "pinholeOpenCV": _older(
        "opencvPinhole",
        (*_poly("AB"), "p0", "p1", *_poly("CDEF"), "s0", "s1", "s2", "s3"),
        True,
    ),
    "fisheyeOpenCV": _older("opencvFisheye", _poly("ABCD"), True),
    "fisheyePolynomial": _older("ftheta", _poly("ABCDEF"), False),
    "fisheyeKannalaBrandtK3": _older("kannalaBrandtK3", _poly("ABCD"), False),
    "fisheyeRadTanThinPrism": _older("radTanThinPrism", (*_poly("ABCDEF"), *_PRISM), False),
}
PROJECTION_TYPE = "cameraProjectionType"
