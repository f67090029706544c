"""Settings of a render in a scene file: film, filter, sampler and integrator.

A scene of Daguerre has no settings: the call or the command line sets them. A note lists the flags
that repeat the file's settings.
"""

from __future__ import annotations

from dataclasses import dataclass

from daguerre.files.notes import Notes
from daguerre.units import edges_text

from .node import Node, leave_out

#: Integrators that follow light over any number of surfaces.
_PATHS = ("path", "volpath", "volpathmis", "ptracer", "prb", "prbvolpath", "bdpt", "volpath_simple")
#: Integrators that wrap another integrator.
_WRAPPERS = ("moment", "aov", "adaptive", "multichannel")
#: Reconstruction filters, and the nearest filter here.
_FILTERS = {
    "box": "box",
    "gaussian": "gaussian",
    "mitchell": "mitchell",
    "catmullrom": "mitchell",
    "tent": "tent",
    "lanczos": "mitchell",
}
#: Properties that have no effect on a converged picture.
_SAMPLING = (
    *("rr_depth", "seed", "sample_count", "emitter_samples", "bsdf_samples"),
    *("shading_samples", "samples_per_pass", "block_size"),
)
_FILES = (
    *("pixel_format", "component_format", "file_format", "compensate", "sample_border"),
    *("banner", "attach_log", "high_quality_edges", "gamma"),
)


@dataclass(frozen=True)
class Settings:
    """Settings of a render.

    Attributes:
        resolution: Width and height of the film, px.
        crop: Corners x0, y0, x1, y1 of the part that is drawn, px; None: all.
        spp: Samples per pixel.
        filter: Pixel filter.
        max_depth: Most surfaces along a path, from camera to light; None: any number.
    """

    resolution: tuple[int, int] = (768, 576)
    crop: tuple[int, int, int, int] | None = None
    spp: int = 4
    filter: str = "gaussian"
    max_depth: int | None = None

    def flags(self) -> str:
        """Flags of the command line."""
        flags = []
        if self.crop is not None:
            flags.append(f"--crop {edges_text(self.crop)}")
        flags += [f"--spp {self.spp}", f"--filter {self.filter}"]
        if self.max_depth is not None:
            flags.append(f"--max-depth {self.max_depth}")
        return " ".join(flags)


def settings_of(sensor: Node, max_depth: int | None, notes: Notes) -> Settings:
    """Settings of a sensor, with the integrator's depth.

    Raises:
        InputError: A number is wrong; the message names file, line and element.
    """
    film, sampler = sensor.nested_one("film"), sensor.nested_one("sampler")
    resolution, crop, filter_ = _film(film, notes)
    spp = 4
    if sampler is not None:
        spp = sampler.whole("sample_count", 4, 1, 1 << 30)
        sampler.skip(*_SAMPLING)
    return Settings(resolution, crop, spp, filter_, max_depth)


def _film(
    film: Node | None, notes: Notes
) -> tuple[tuple[int, int], tuple[int, int, int, int] | None, str]:
    if film is None:
        return (768, 576), None, "gaussian"
    width = film.whole("width", 768, 1, 1 << 16)
    height = film.whole("height", 576, 1, 1 << 16)
    film.skip(*_FILES)
    crop = None
    if any(film.has(f"crop_{name}") for name in ("offset_x", "offset_y", "width", "height")):
        x = film.whole("crop_offset_x", 0, 0, width - 1)
        y = film.whole("crop_offset_y", 0, 0, height - 1)
        across = film.whole("crop_width", width - x, 1, width - x)
        down = film.whole("crop_height", height - y, 1, height - y)
        crop = (x, y, x + across, y + down)
    chosen = film.nested_one("rfilter")
    if chosen is None:
        return (width, height), crop, "gaussian"
    if chosen.plugin not in _FILTERS:
        leave_out(chosen, notes, f"a filter {chosen.plugin!r} is left out")
        return (width, height), crop, "gaussian"
    return (width, height), crop, _filter(chosen, notes)


def _filter(node: Node, notes: Notes) -> str:
    """Filter with its radius, px; our Gaussian ends at 3 standard deviations, Mitsuba's at 4."""
    found = _FILTERS[node.plugin]
    if node.plugin == "gaussian":
        return f"gaussian:{3 * node.number('stddev', 0.5, above=0):g}"
    if node.plugin in ("box", "tent"):
        usual = 0.5 if node.plugin == "box" else 1.0
        return f"{found}:{node.number('radius', usual, above=0):g}"
    node.skip("B", "C", "b", "c", "lobes")
    if node.plugin != found:
        notes.add(f"a filter {node.plugin!r} is read as {found!r}")
    return found


def depth_of(scene: Node, notes: Notes) -> int | None:
    """Most surfaces along a path, from the integrator; None: any number.

    Mitsuba counts the steps between camera, surfaces and light: 2 is light from surfaces that a
    lamp lights.
    """
    integrator = scene.nested_one("integrator")
    while integrator is not None and integrator.plugin in _WRAPPERS:
        if integrator.has("aovs"):
            integrator.skip("aovs")
            notes.add("the data of an 'aov' integrator are drawn by --aov")
        integrator = integrator.nested_one("integrator")
    if integrator is None:
        return None
    integrator.skip(*_SAMPLING)
    if integrator.plugin in ("direct", "direct_projective"):
        return 1
    if integrator.plugin not in _PATHS:
        name = integrator.plugin
        leave_out(integrator, notes, f"an integrator {name!r} is left out: paths are traced")
        return None
    depth = integrator.whole("max_depth", -1, -1, 1 << 30)
    if depth in (0, 1):
        notes.add("max_depth of 0 or 1 (emitters alone) is read as 2")
    return None if depth < 0 else max(depth - 1, 1)
