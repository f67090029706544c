"""Makes tests/references/*.json with Mitsuba 3, which shares no code with Daguerre.

Not part of the tests; run it again when a scene changes:

    pip install mitsuba==3.9.1
    python tests/support/pictures/make_references.py [SCENE ...]

Grey scenes in the monochrome variant: what it calls radiance 1 is Daguerre's luminance 1.
Mitsuba multiplies the masking of both directions; Daguerre, as most renderers today, lets their
heights be correlated. `Correlated` turns the one into the other, by the published formula.
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_mono")

from mitsuba import ScalarTransform4f as To  # noqa: E402
from references import scenes  # noqa: E402
from references.description import Description, Lamp, Mesh, Surface, View  # noqa: E402

FOLDER = Path(__file__).parents[2] / "references"
BATCHES, SPP = 24, 2048


class Correlated(mi.BSDF):  # type: ignore[misc]
    """Mitsuba's GGX plugin of the same name times G2(correlated) / (G1 G1).

    Source: Heitz 2014, JCGT 3(2), eq. 99: G2 = 1 / (1 + L(wi) + L(wo)), G1 = 1 / (1 + L).
    """

    def __init__(self, props: mi.Properties) -> None:
        mi.BSDF.__init__(self, props)
        self.alpha = props["alpha"]
        inside = {"distribution": "ggx", "alpha": self.alpha}
        if props["kind"] == "roughconductor":
            inside |= {"material": "none", "specular_reflectance": props["value"]}
        else:
            inside |= {"int_ior": props["value"], "ext_ior": 1.0}
        self.inside = mi.load_dict({"type": props["kind"], **inside})
        self.m_components = [self.inside.flags(i) for i in range(self.inside.component_count())]
        self.m_flags = self.inside.flags()

    def ratio(self, wi: mi.Vector3f, wo: mi.Vector3f) -> mi.Float:
        def mean_slope(w: mi.Vector3f) -> mi.Float:
            tan2 = (w.x**2 + w.y**2) / mi.Float(w.z**2)
            return ((1 + self.alpha**2 * tan2) ** 0.5 - 1) / 2

        a, b = mean_slope(wi), mean_slope(wo)
        value = (1 + a) * (1 + b) / (1 + a + b)
        return dr.select(dr.isfinite(value), value, 1)

    def sample(self, ctx: Any, si: Any, u1: Any, u2: Any, active: Any = True) -> Any:
        bs, weight = self.inside.sample(ctx, si, u1, u2, active)
        return bs, weight * self.ratio(si.wi, bs.wo)

    def eval(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
        return self.inside.eval(ctx, si, wo, active) * self.ratio(si.wi, wo)

    def pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
        return self.inside.pdf(ctx, si, wo, active)

    def eval_pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
        return self.eval(ctx, si, wo, active), self.pdf(ctx, si, wo, active)


mi.register_bsdf("correlated", Correlated)


def bsdf(surface: Surface) -> dict[str, Any]:
    """Mitsuba's material."""
    value = {"type": "uniform", "value": surface.value}
    if surface.kind == "diffuse":
        return {"type": "twosided", "one": {"type": "diffuse", "reflectance": value}}
    if surface.kind == "lamp":
        return {"type": "diffuse", "reflectance": {"type": "uniform", "value": 0.0}}
    rough = {"type": "correlated", "alpha": surface.alpha, "value": surface.value}
    if surface.kind == "conductor":
        smooth = {"type": "conductor", "material": "none", "specular_reflectance": value}
        one = rough | {"kind": "roughconductor"} if surface.alpha else smooth
        return {"type": "twosided", "one": one}
    if surface.alpha:
        return rough | {"kind": "roughdielectric"}
    return {"type": "dielectric", "int_ior": surface.value, "ext_ior": 1.0}


def shape(mesh: Mesh, surface: Surface) -> mi.Mesh:
    """Mitsuba's mesh, flat-shaded."""
    vertices, faces = mesh
    props = mi.Properties()
    props["face_normals"] = True
    props["bsdf"] = mi.load_dict(bsdf(surface))
    if surface.kind == "lamp":
        props["emitter"] = mi.load_dict({"type": "area", "radiance": surface.value})
    out = mi.Mesh("mesh", len(vertices), len(faces), props=props)
    values = mi.traverse(out)
    values["vertex_positions"] = np.ascontiguousarray(vertices, np.float32).ravel()
    values["faces"] = np.ascontiguousarray(faces, np.uint32).ravel()
    values.update()
    return out


def spot_picture(lamp: Lamp, size: int = 1024) -> mi.Bitmap:
    """The soft edge of KHR_lights_punctual, as the picture that Mitsuba's spot projects."""
    edge = math.tan(math.radians(lamp.outer))
    y, x = ((np.mgrid[:size, :size] + 0.5) / size * 2 - 1) * edge
    cosine = 1 / np.sqrt(1 + x**2 + y**2)
    inner, outer = (math.cos(math.radians(a)) for a in (lamp.inner, lamp.outer))
    falloff = np.clip((cosine - outer) / (inner - outer), 0, 1) ** 2
    return mi.Bitmap(falloff[..., None].astype(np.float32))


def emitter(lamp: Lamp) -> dict[str, Any]:
    """Mitsuba's light."""
    position = list(lamp.position)
    if lamp.kind == "point":
        return {"type": "point", "position": position, "intensity": lamp.strength}
    if lamp.kind == "directional":
        return {
            "type": "directional",
            "direction": list(lamp.direction),
            "irradiance": lamp.strength,
        }
    if lamp.kind == "sphere":
        return {
            "type": "sphere",
            "center": position,
            "radius": lamp.radius,
            "emitter": {"type": "area", "radiance": lamp.strength},
            "bsdf": bsdf(Surface("lamp", 0)),
        }
    target = [p + d for p, d in zip(lamp.position, lamp.direction, strict=True)]
    return {
        "type": "spot",
        "to_world": To().look_at(origin=position, target=target, up=[0, 0.1, 1]),
        "intensity": lamp.strength,
        "cutoff_angle": lamp.outer,
        "beam_width": lamp.outer * (1 - 1e-6),
        "texture": {
            "type": "bitmap",
            "bitmap": spot_picture(lamp),
            "raw": True,
            "wrap_mode": "clamp",
        },
    }


def sky(description: Description, width: int = 1024, height: int = 513) -> dict[str, Any]:
    """Mitsuba's environment: its rows lie from pole to pole, its left edge looks along -z."""
    if not callable(description.sky):
        return {"type": "constant", "radiance": description.sky}
    theta, phi = np.meshgrid(
        np.linspace(0, math.pi, height),
        (np.arange(width) + 0.5) / width * 2 * math.pi,
        indexing="ij",
    )
    direction = np.stack(
        [np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi)], axis=-1
    )
    picture = np.repeat(description.sky(direction)[..., None], 3, axis=-1)
    return {"type": "envmap", "bitmap": mi.Bitmap(picture.astype(np.float32))}


def sensor(view: View, size: tuple[int, int]) -> dict[str, Any]:
    """Mitsuba's camera."""
    out = {
        "type": "perspective" if view.aperture is None else "thinlens",
        "fov": math.degrees(2 * math.atan(18 / view.focal_length)),
        "fov_axis": "x",
        "near_clip": 1e-2,
        "far_clip": 1e3,
        "to_world": To().look_at(origin=list(view.eye), target=list(view.target), up=[0, 1, 0]),
        "film": {
            "type": "hdrfilm",
            "width": size[0],
            "height": size[1],
            "rfilter": {"type": "box"},
            "pixel_format": "luminance",
            "component_format": "float32",
        },
        "sampler": {"type": "independent"},
    }
    if view.aperture is not None:
        out |= {"aperture_radius": view.aperture / 2000, "focus_distance": view.focus}
    return out


def build(description: Description) -> mi.Scene:
    """Mitsuba's scene."""
    scene: dict[str, Any] = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": description.max_depth + 1, "rr_depth": 100},
        "sensor": sensor(description.view, description.size),
    }
    if callable(description.sky) or description.sky > 0:
        scene["sky"] = sky(description)
    for i, part in enumerate(description.parts):
        scene[f"part{i}"] = shape(*part)
    for i, lamp in enumerate(description.lamps):
        scene[f"lamp{i}"] = emitter(lamp)
    return mi.load_dict(scene)


def rounded(rows: Any) -> list[list[float]]:
    """Five significant digits."""
    return [[float(f"{v:.5g}") for v in row] for row in rows]


def as_text(data: dict[str, Any]) -> str:
    """JSON with a line for each key and each row of pixels."""
    text = json.dumps(data, separators=(",", ":"))
    return text.replace(',"', ',\n"').replace("],[", "],\n[") + "\n"


def main() -> None:
    """Renders the named scenes, or all."""
    for name in sys.argv[1:] or scenes.ALL:
        description = scenes.ALL[name]()
        scene = build(description)
        pictures = np.array(
            [np.array(mi.render(scene, spp=SPP, seed=i), np.float64) for i in range(BATCHES)]
        ).reshape(BATCHES, description.size[1], description.size[0])
        header = {
            "scene": name,
            "renderer": f"mitsuba {mi.__version__} {mi.variant()}",
            "command": f"python tests/support/pictures/make_references.py {name}",
            "spp": SPP * BATCHES,
            "batches": BATCHES,
            "size": list(description.size),
            "mean": rounded(pictures.mean(axis=0)),
            "variance_of_mean": rounded(pictures.var(axis=0, ddof=1) / BATCHES),
        }
        text = as_text(header)
        (FOLDER / f"{name}.json").write_text(text)
        error = np.sqrt(pictures.mean(axis=(1, 2)).var(ddof=1) / BATCHES)
        print(f"{name}: mean {pictures.mean():.5f} +- {error:.1e}, {len(text)} bytes", flush=True)


if __name__ == "__main__":
    main()
