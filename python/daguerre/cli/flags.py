"""Groups of flags that several commands share: a data class each, its fields are the flags.

A command names a group as one of its parameters; :func:`with_flags` puts the group's fields into
the signature that Typer reads. Annotations must be real objects here, so no ``annotations`` future.
"""

import inspect
from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated, Any

import typer

from . import quantities as q


def option(*names: str, help: str, metavar: str | None = None, panel: str | None = None) -> Any:
    """A flag."""
    return typer.Option(
        *names, help=help, metavar=metavar, rich_help_panel=panel, show_default=False
    )


def with_flags(**groups: type) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Spreads the parameters named in ``groups`` into the flags of those data classes."""

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        parameters = []
        for parameter in inspect.signature(command, eval_str=True).parameters.values():
            group = groups.get(parameter.name)
            inner = inspect.signature(group, eval_str=True).parameters.values() if group else []
            parameters += [
                p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for p in (inner or [parameter])
            ]

        def run(**values: Any) -> Any:
            made = {
                name: group(**{f.name: values.pop(f.name) for f in fields(group)})
                for name, group in groups.items()
            }
            return command(**values, **made)

        run.__name__, run.__doc__ = command.__name__, command.__doc__
        run.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
        run.__annotations__ = {p.name: p.annotation for p in parameters}
        return run

    return decorate


_CAMERA = "Camera"
Text = str | None


@dataclass(frozen=True)
class CameraFlags:
    """The camera in a photographer's units; what is not given stays as the file says."""

    camera: Annotated[
        Text, option("-c", "--camera", metavar="NAME", help="Camera of the scene.", panel=_CAMERA)
    ] = None
    lens: Annotated[
        Text,
        option(
            "--lens",
            metavar="NAME|FILE|thin|pinhole",
            help="Lens of the library or a lens file; see `daguerre lenses`.",
            panel=_CAMERA,
        ),
    ] = None
    lens_model: Annotated[
        Text,
        option(
            "--lens-model",
            metavar="exact|thin|pinhole",
            help="How the lens is computed [exact if --lens names one].",
            panel=_CAMERA,
        ),
    ] = None
    focal_length: Annotated[
        Text, option("--focal-length", metavar="MM", help="Focal length, mm.", panel=_CAMERA)
    ] = None
    f_stop: Annotated[
        Text,
        option(
            "--f-stop",
            "--fstop",
            "--aperture",
            metavar="N",
            help="Focal length / entrance pupil diameter.",
            panel=_CAMERA,
        ),
    ] = None
    aperture_diameter: Annotated[
        Text,
        option("--aperture-diameter", metavar="MM", help="Instead of --f-stop, mm.", panel=_CAMERA),
    ] = None
    focus: Annotated[
        Text,
        option(
            "--focus",
            metavar="M",
            help="Distance of the sharp plane, m, or inf [the file's, else autofocus].",
            panel=_CAMERA,
        ),
    ] = None
    focus_at: Annotated[
        Text,
        option("--focus-at", metavar="X,Y", help="Focus on what this pixel shows.", panel=_CAMERA),
    ] = None
    focus_on: Annotated[
        Text, option("--focus-on", metavar="NODE", help="Focus on this node.", panel=_CAMERA)
    ] = None
    focus_from: Annotated[
        Text,
        option(
            "--focus-from",
            metavar="pupil|sensor",
            help="Where the focus distance starts [pupil].",
            panel=_CAMERA,
        ),
    ] = None
    focus_breathing: Annotated[
        bool | None,
        option(
            "--focus-breathing/--no-focus-breathing",
            help="Thin lens: the field narrows as it focuses closer.",
            panel=_CAMERA,
        ),
    ] = None
    blades: Annotated[
        int | None, option("--blades", metavar="N", help="Iris blades, 0 is round.", panel=_CAMERA)
    ] = None
    blade_rotation: Annotated[
        Text, option("--blade-rotation", metavar="DEG", help="Degrees.", panel=_CAMERA)
    ] = None
    blade_curvature: Annotated[
        float | None,
        option("--blade-curvature", metavar="C", help="-1 to 1; 1 is round.", panel=_CAMERA),
    ] = None
    aperture_image: Annotated[
        Path | None,
        option("--aperture-image", metavar="FILE", help="Grey picture of the iris.", panel=_CAMERA),
    ] = None
    sensor: Annotated[
        Text,
        option(
            "--sensor",
            metavar="WxH|" + "|".join(q.SENSORS),
            help="Sensor size, mm [36x24].",
            panel=_CAMERA,
        ),
    ] = None
    fit: Annotated[
        Text,
        option(
            "--fit",
            metavar="horizontal|vertical|auto|fill",
            help="Which side of the sensor the picture spans [horizontal].",
            panel=_CAMERA,
        ),
    ] = None
    shift: Annotated[
        Text, option("--shift", metavar="X,Y", help="Film shift right and up, mm.", panel=_CAMERA)
    ] = None
    shutter: Annotated[
        Text, option("--shutter", metavar="S", help="Shutter time, s: 1/48, 20ms.", panel=_CAMERA)
    ] = None
    iso: Annotated[
        float | None,
        option("--iso", metavar="N", help="For metadata and development only.", panel=_CAMERA),
    ] = None
    ev: Annotated[
        float | None,
        option("--ev", metavar="EV", help="For metadata and development only.", panel=_CAMERA),
    ] = None
    natural_vignetting: Annotated[
        bool | None,
        option(
            "--natural-vignetting/--no-natural-vignetting",
            help="Thin lens, pinhole: darken by cos^4.",
            panel=_CAMERA,
        ),
    ] = None
    near: Annotated[
        Text, option("--near", metavar="M", help="Nothing nearer is seen, m.", panel=_CAMERA)
    ] = None

    def changes(self) -> dict[str, Any]:
        """The parameters of ``Camera.with_`` that were given."""
        parsers: dict[str, tuple[str, str, Callable[[str, str], Any]]] = {
            "focal_length": ("focal_length", "--focal-length", q.length_mm),
            "f_stop": ("f_stop", "--f-stop", q.f_number),
            "aperture_diameter": ("aperture_diameter", "--aperture-diameter", q.length_mm),
            "focus": ("focus_distance", "--focus", q.distance_m),
            "focus_at": ("focus_at", "--focus-at", lambda f, t: q.numbers(f, t, 2, "480,270")),
            "blade_rotation": ("blade_rotation", "--blade-rotation", q.angle_deg),
            "sensor": ("sensor_size", "--sensor", q.sensor_mm),
            "shift": ("shift", "--shift", lambda f, t: q.numbers(f, t, 2, "0,8.5")),
            "shutter": ("shutter_time", "--shutter", q.time_s),
            "near": ("near", "--near", q.distance_m),
        }
        plain = {
            "lens": "lens",
            "lens_model": "lens_model",
            "focus_on": "focus_on",
            "focus_from": "focus_from",
            "focus_breathing": "focus_breathing",
            "blades": "blades",
            "blade_curvature": "blade_curvature",
            "fit": "sensor_fit",
            "iso": "iso",
            "ev": "exposure_compensation",
            "natural_vignetting": "natural_vignetting",
        }
        out: dict[str, Any] = {}
        for name, (parameter, flag, parse) in parsers.items():
            text = getattr(self, name)
            if text is not None:
                out[parameter] = parse(flag, text)
        for name, parameter in plain.items():
            if getattr(self, name) is not None:
                out[parameter] = getattr(self, name)
        if self.aperture_image is not None:
            from daguerre.io.iris import read_grey

            out["aperture_image"] = read_grey(self.aperture_image)
        return _resolve_rivals(out)


def _resolve_rivals(changes: dict[str, Any]) -> dict[str, Any]:
    """One way to focus and one to open the iris may be given; each replaces the file's."""
    from daguerre.errors import UsageError

    for rivals in (
        {"focus_distance": "--focus", "focus_at": "--focus-at", "focus_on": "--focus-on"},
        {"f_stop": "--f-stop", "aperture_diameter": "--aperture-diameter"},
    ):
        given = [name for name in rivals if name in changes]
        if len(given) > 1:
            flags = " and ".join(rivals[name] for name in given)
            raise UsageError(f"{flags}: wanted one of them, got {len(given)}")
        if given:
            changes |= {name: None for name in rivals if name not in given}
    return changes


_LIGHT = "Scene and light"


@dataclass(frozen=True)
class SceneFlags:
    """What the camera looks at."""

    time: Annotated[
        Text, option("--time", metavar="S", help="Scene time, s [0].", panel=_LIGHT)
    ] = None
    env: Annotated[
        Path | None,
        option(
            "--env", metavar="FILE", help="Panorama (.hdr, .exr) around the scene.", panel=_LIGHT
        ),
    ] = None
    env_scale: Annotated[
        float | None,
        option(
            "--env-scale", metavar="X", help="cd/m2 of a value of 1 in --env [1].", panel=_LIGHT
        ),
    ] = None
    env_rotation: Annotated[
        Text,
        option("--env-rotation", metavar="DEG", help="About the vertical, degrees.", panel=_LIGHT),
    ] = None
    sky: Annotated[
        Text, option("--sky", metavar="R,G,B", help="Even sky, cd/m2.", panel=_LIGHT)
    ] = None
    allow_dir: Annotated[
        list[Path] | None,
        option("--allow-dir", metavar="DIR", help="Folder that the scene may read.", panel=_LIGHT),
    ] = None

    def load(self, path: Path) -> Any:
        """Reads the scene and lights it."""
        import daguerre

        time = q.time_s("--time", self.time) if self.time is not None else 0.0
        environment = self._environment()
        scene = daguerre.load(path, time=time, allow_dirs=tuple(self.allow_dir or ()))
        if environment:
            scene.set_environment(**environment)
        elif self.env_scale is not None or self.env_rotation is not None:
            self._change(scene)
        return scene

    def _scale(self) -> float:
        import math

        from daguerre.errors import UsageError

        scale = 1.0 if self.env_scale is None else self.env_scale
        if not (0 <= scale < math.inf):
            raise UsageError(f"--env-scale: wanted a number of at least 0, got {scale}")
        return scale

    def _rotation(self) -> float:
        return q.angle_deg("--env-rotation", self.env_rotation) if self.env_rotation else 0.0

    def _environment(self) -> dict[str, Any]:
        from daguerre.errors import UsageError

        if self.env is not None and self.sky is not None:
            raise UsageError("--env and --sky: wanted one of them, got both")
        if self.sky is not None:
            color = q.numbers("--sky", self.sky, 3, "1,1,1")
            if min(color) < 0:
                raise UsageError(f"--sky: wanted colours of at least 0, got {self.sky!r}")
            return {"color": color, "scale": self._scale()}
        if self.env is not None:
            from daguerre.io.images import read_environment

            image = read_environment(self.env)
            return {"image": image, "scale": self._scale(), "rotation": self._rotation()}
        return {}

    def _change(self, scene: Any) -> None:
        from dataclasses import replace

        from daguerre.errors import UsageError

        if scene.environment is None:
            raise UsageError(
                "--env-scale, --env-rotation: the scene has no environment; give --env"
            )
        changes: dict[str, float] = {}
        if self.env_scale is not None:
            changes["scale"] = self._scale()
        if self.env_rotation is not None:
            changes["rotation"] = self._rotation()
        scene.environment = replace(scene.environment, **changes)
