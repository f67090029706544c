"""Plan of a render command, checked before anything heavy is loaded."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from daguerre import units as q
from daguerre.cli.flags.map import MapFlags
from daguerre.errors import UsageError, suggest
from daguerre.frame.aovs import BY_NAME, EXACT_ONLY, Source, made_by, names_of

from .frames import numbered
from .photograph import Photograph
from .views import View, named

DEFAULT_RESOLUTION = (960, 540)
DEFAULT_SPP = 64
DISPARITY = "disparity"
EXPOSED = names_of(Source.EXPOSURE)


@dataclass(frozen=True)
class Plan:
    """One picture: its files, its size, its samples (with ``noise``: at most)."""

    outputs: list[Path]
    resolution: tuple[int, int]
    crop: tuple[int, int, int, int] | None
    wanted: tuple[int, int]
    noise: float | None
    is_pass: bool
    aovs: list[str]
    denoise: bool
    interval_s: float
    gt_time: str | None = None
    gt_lens: str = "chief"
    gt_rays: int | None = None
    overscan: str | None = None
    maps: MapFlags = field(default_factory=MapFlags)
    photograph: Photograph = field(default_factory=Photograph)
    baseline: float = 0.0

    def of_frame(self, frame: int) -> Plan:
        """The same for one frame of a sequence."""
        return self._renamed(lambda path: numbered(path, frame))

    def of_view(self, view: View, resolution: tuple[int, int], *, several: bool) -> Plan:
        """The same for one camera, whose picture may have a size of its own."""
        if self.crop is not None:
            check_crop(self.crop, resolution, self.overscan)
        if DISPARITY in self.aovs and not view.shift:
            raise UsageError("--aov disparity: wanted --stereo, got no pair")
        made = self._renamed(lambda path: named(path, view, several=several))
        return replace(made, resolution=resolution, baseline=2 * abs(view.shift))

    def _renamed(self, name: Callable[[Path], Path]) -> Plan:
        outputs = [name(path) for path in self.outputs]
        return replace(self, outputs=outputs, maps=self.maps.renamed(name))

    def with_overscan(self, overscan: str | None) -> Plan:
        """With pixels beside the picture."""
        if overscan is None:
            return self
        from daguerre.camera.overscan import check_overscan

        check_overscan(overscan, self.resolution, "--overscan")
        if self.outputs and not any(path.suffix.lower() == ".exr" for path in self.outputs):
            raise UsageError("--overscan: wanted an .exr with -o: pictures for the eye have none")
        return replace(self, overscan=overscan)

    def with_truth(self, gt_time: str | None, gt_lens: str, gt_rays: int | None) -> Plan:
        """With ground truth of that moment; some channels ask for it by themselves."""
        means = gt_lens != "chief"
        wanted = means or any(name in self.aovs for name in (*EXACT_ONLY, DISPARITY))
        if gt_time is None and gt_rays is None and not wanted:
            return self
        from daguerre.rendering.parameters import TABLE
        from daguerre.rendering.settings import RenderSettings

        given = {"gt_time": gt_time, "gt_lens": gt_lens, "gt_rays": gt_rays}
        RenderSettings.read(given, lambda name: TABLE[name].flag)
        moment = gt_time or ("mid" if wanted else None)
        if not self.aovs and (means or self.maps.export_raymap is None):
            flag = "--gt-lens" if gt_time is None else "--gt-time"
            raise UsageError(f"{flag}: wanted channels to write, say --aov depth,motion")
        if "coverage" in self.aovs and not means:
            raise UsageError(
                "--aov coverage: of the chief ray there is none; wanted --gt-lens mean"
            )
        if DISPARITY in self.aovs and means:
            raise UsageError("--aov disparity: wanted --gt-lens chief, as means have no one place")
        return replace(self, gt_time=moment, gt_lens=gt_lens, gt_rays=gt_rays)

    @property
    def motion(self) -> bool:
        """Whether motion in pixels is asked for."""
        return any(name in self.aovs for name in names_of(Source.MOTION))

    @property
    def exposed(self) -> bool:
        """Whether truth about the exposure is asked for."""
        return any(name in self.aovs for name in EXPOSED)

    @property
    def files(self) -> list[Path]:
        """All that is written: of a bracket each exposure."""
        return [file for path in self.outputs for file, _ in self.photograph.files(path)]

    @property
    def written(self) -> list[Path]:
        """The same, and maps."""
        return [*self.files, *self.maps.files]

    @property
    def checkpoint(self) -> Path:
        """Where the sums are kept until the picture is complete; there are outputs."""
        return self.outputs[0].with_suffix(".checkpoint.exr")


def make_plan(
    output: list[Path],
    res: str | None,
    crop: str | None,
    aov: list[str],
    all_aovs: bool,
    tone: str,
    denoise: bool,
    spp: int | None,
    samples: str | None,
    noise: float | None,
    checkpoint: str,
) -> Plan:
    """Checks what the flags of a render ask for.

    Raises:
        UsageError: Some value is wrong or does not go with another; the message names the flag.
    """
    from daguerre.frame.frame import TONES, check_format

    formats = [check_format(path, (".dng",)) for path in output]
    if tone not in TONES:
        raise UsageError(f"--tone: wanted {' or '.join(TONES)}; got {tone!r}{suggest(tone, TONES)}")
    resolution = q.resolution("--res", res, DEFAULT_RESOLUTION) if res else DEFAULT_RESOLUTION
    if spp is not None and not 1 <= spp < 2**32:
        raise UsageError(f"--spp: wanted a number from 1, got {spp}")
    wanted = q.sample_range("--samples", samples) if samples else (0, spp or DEFAULT_SPP)
    if noise is not None:
        wanted = (0, _ceiling(noise, spp, samples))
    if samples and spp is not None and wanted[1] > spp:
        raise UsageError(f"--samples {samples}: wanted at most --spp {spp}")
    if not formats and (aov or all_aovs or samples or noise is not None or denoise):
        raise UsageError("-o: wanted a file for the picture, since maps alone draw nothing")
    if samples and ".exr" not in formats:
        raise UsageError("--samples: a pass keeps its sums in an .exr; got none with -o")
    if samples and denoise:
        raise UsageError(
            "--samples and --denoise: denoise after merging, `daguerre merge --denoise`"
        )
    groups = _aov_groups(aov, all_aovs)
    if samples and (found := [name for name in EXPOSED if name in groups]):
        raise UsageError(f"--samples: a pass is not exposed; wanted no --aov {','.join(found)}")
    if samples and DISPARITY in groups:
        raise UsageError("--samples: wanted no --aov disparity; depth comes through a pass")
    if denoise:
        from daguerre.rendering.denoise import check_available

        check_available()
    return Plan(
        output,
        resolution,
        _crop(crop),
        wanted,
        noise,
        samples is not None,
        groups,
        denoise,
        q.time_s("--checkpoint", checkpoint),
    )


def _ceiling(noise: float, spp: int | None, samples: str | None) -> int:
    """Most samples of a pixel on the way to a noise."""
    from daguerre.rendering.adaptive import check_noise

    if samples:
        raise UsageError(
            "--noise and --samples: what is drawn for a noise depends on what was drawn before, "
            "so it has no passes; wanted one of the two"
        )
    return check_noise(noise, spp, "--noise")[1]


def _crop(text: str | None) -> tuple[int, int, int, int] | None:
    """Command line order x0, x1, y0, y1 to corners x0, y0, x1, y1; px, half open."""
    if text is None:
        return None
    x0, x1, y0, y1 = q.integers("--crop", text, 4, "100,400,50,300")
    return x0, y0, x1, y1


def check_crop(
    crop: tuple[int, int, int, int], resolution: tuple[int, int], overscan: str | None
) -> None:
    """It must lie within the picture and its overscan, as far as that is known yet."""
    from daguerre.camera.overscan import check_overscan

    beside = check_overscan(overscan, resolution, "--overscan")
    if beside is None:  # the camera decides
        return
    x0, y0, x1, y1 = crop
    left, top, right, bottom = beside.region(resolution)
    if not (left <= x0 < x1 <= right and top <= y0 < y1 <= bottom):
        raise UsageError(
            f"--crop: wanted x0 < x1 within {left}..{right} and y0 < y1 within "
            f"{top}..{bottom}; got '{x0},{x1},{y0},{y1}'"
        )


def _aov_groups(names: list[str], everything: bool) -> list[str]:
    film = names_of(Source.FILM)
    groups = set(film) if everything else set()
    for name in (part.strip() for text in names for part in text.split(",")):
        if name == "all":
            groups |= set(film)
        elif name in BY_NAME:
            groups.add(BY_NAME[name].name)
        else:
            known = [*BY_NAME, "all"]
            raise UsageError(
                f"--aov: no channels {name!r}{suggest(name, known)}; known: {', '.join(known)}"
            )
    return sorted(groups - {row.name for row in made_by(Source.ALWAYS)})


def check_outputs(plan: Plan) -> None:
    """Before hours are spent: can the files be written at all?"""
    from daguerre.files.atomic import check_writable

    names = [path.resolve() for path in plan.written]
    if len(set(names)) < len(names):
        raise UsageError("-o: the same file is named twice")
    if plan.outputs and plan.checkpoint.resolve() in names:
        raise UsageError(f"-o {plan.checkpoint}: this name is kept for the checkpoint")
    for path in plan.written:
        check_writable(path)
