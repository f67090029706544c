"""Makes the plan of a fitted lens from its data, format ``daguerre-lens-fit/0.1``."""

from __future__ import annotations

from typing import Any

from daguerre.errors import InputError

from .horner import Terms
from .plan import Blades, LensPlan, Mount, Pair, Segment, Vector


def plan_of(data: dict[str, Any]) -> LensPlan:
    """Makes the plan of the code from a fit, without an aim.

    Args:
        data: ``LensFit.to_dict()``.

    Raises:
        InputError: Code cannot express the fit: no setting, a tilted film, or a picture as iris.
    """
    _check(data)
    symmetric = bool(data["symmetry"]["axial"])
    pupil, wavelength, setting = data["pupil"], data["wavelength"], data["setting"]
    return LensPlan(
        name=data["lens"],
        film_z_mm=data["film"]["plane"]["center"][2],
        symmetric=symmetric,
        film_center_mm=_pair(data["film"]["center"]),
        film_half_mm=_pair(data["film"]["half"]),
        q_by_film=_pair(pupil["by_film"]),
        q_by_slope=_pair(pupil["by_slope"]),
        q_shift=_pair(pupil["shift"]),
        wavelength=(wavelength["offset"], wavelength["scale"]),
        pupil_z_mm=data["entrance_pupil_z"],
        front_z_mm=data["front"]["z"],
        front_curvature=data["front"]["curvature"],
        f_stop=setting["f_stop"],
        iris_radius_mm=data["iris"]["radius"],
        blades=_blades(setting["iris"]),
        segments=tuple(_segment(s, data["mounts"], symmetric) for s in data["segments"]),
    )


def _check(data: dict[str, Any]) -> None:
    """Checks that generated code can express the fit."""
    where = f"export of {data['lens']}"
    setting = data.get("setting")
    if setting is None:
        raise InputError(f"{where}: setting: wanted the f-stop of the fit, got none")
    if setting["iris"] == "picture":
        raise InputError(f"{where}: iris: wanted a round iris or blades, got an aperture_image")
    plane = data["film"]["plane"]
    if plane["x"] != [1, 0, 0] or plane["y"] != [0, 1, 0] or any(plane["center"][:2]):
        raise InputError(
            f"{where}: film: wanted it centred on the lens's axis and perpendicular to it, "
            "got it tilted or shifted"
        )


def _blades(iris: dict[str, Any] | None) -> Blades | None:
    if iris is None:
        return None
    return Blades(**{**iris, "edges": tuple(_pair(e) for e in iris["edges"])})


def _segment(data: dict[str, Any], mounts: list[dict[str, Any]], symmetric: bool) -> Segment:
    def vector(block: str, name: str) -> Vector:
        if symmetric:
            return Vector(*(_terms(data[block], f"{name}.{side}", 4) for side in "AB"))
        return Vector(*(_terms(data[block][axis], f"{name}.{axis}", 5) for axis in "xy"))

    return Segment(
        u_low=data["u"][0],
        u_high=data["u"][1],
        direction=vector("direction", "direction"),
        offset_mm=vector("points", "offset"),
        iris_mm=vector("points", "iris"),
        transmittance=_terms(data["light"], "transmittance", 4 if symmetric else 5),
        mounts=tuple(
            Mount(m["surface"], vector("points", f"mount{i}"), m["radius"], m["inner"])
            for i, m in enumerate(mounts)
        ),
        bend=None if data["bend"] is None else vector("bend", "bend"),
    )


def _terms(functions: dict[str, Any], name: str, variables: int) -> Terms:
    column = functions["functions"].index(name)
    rows = zip(functions["powers"], functions["coefficients"], strict=True)
    return {tuple(powers[:variables]): float(row[column]) for powers, row in rows}


def _pair(values: list[float]) -> Pair:
    x, y = values
    return x, y
