"""Checks of combinations of a render's flags; messages name the flag that is wrong."""

from __future__ import annotations

import os
from typing import Any

from daguerre import units as q
from daguerre.camera.overscan import check_overscan as overscan_of
from daguerre.cli.flags.job import JobFlags
from daguerre.cli.flags.map import MapFlags
from daguerre.cli.flags.settings import SettingsFlags
from daguerre.color.spaces import check_linear
from daguerre.errors import UsageError, suggest
from daguerre.frame.aovs import BY_NAME, EXACT_ONLY, Source, names_of
from daguerre.rendering.output import DISPARITY, EXPOSED, Output
from daguerre.rendering.parameters import TABLE
from daguerre.rendering.pixels import crop_within
from daguerre.rendering.settings import RenderSettings

#: An edge beyond any picture, px.
_FAR = 1 << 31


def check_files(flags: JobFlags, rows: SettingsFlags, maps: MapFlags) -> list[str]:
    """Checks formats, tone and channels; returns the requested groups of channels."""
    from daguerre.frame.frame import TONES, check_format

    if not flags.paths and not maps.files:
        raise UsageError(
            "nothing to write: name a picture with -o NAME.exr or -o NAME.png, or a map with "
            "--export-..."
        )
    formats = [check_format(path, (".dng",)) for path in flags.paths]
    tone = flags.tone
    if tone not in TONES:
        raise UsageError(f"--tone: wanted {' or '.join(TONES)}; got {tone!r}{suggest(tone, TONES)}")
    groups = _groups(flags.aov or [])
    drawn = (
        flags.aov,
        flags.samples,
        "noise" in rows.given(),
        flags.denoise,
        flags.preview,
    )
    if not formats and any(drawn):
        raise UsageError(
            "--aov, --samples, --noise, --denoise and --preview need a picture (-o "
            "NAME.exr), but only maps are written"
        )
    if groups and ".exr" not in formats:
        raise UsageError(
            "--aov needs an .exr output (-o NAME.exr): PNG and JPEG cannot store channels"
        )
    if flags.colorspace is not None:
        check_linear(flags.colorspace, "--colorspace")
        if ".exr" not in formats:
            raise UsageError("--colorspace needs an .exr output (-o NAME.exr); others are sRGB")
    if flags.samples and ".exr" not in formats:
        raise UsageError(
            "--samples needs an .exr output (-o NAME.exr), which stores the sums of the pass"
        )
    if flags.noisy and not flags.denoise:
        raise UsageError("--noisy needs --denoise; without it, -o writes that picture")
    for path in flags.noisy or ():
        check_format(path, (".dng",))
    if flags.denoise:
        from daguerre.rendering.denoise import check_available

        check_available()
    return groups


def check_samples(
    flags: JobFlags, rows: SettingsFlags, groups: list[str]
) -> tuple[int, int] | None:
    """Returns the range of a pass, and checks that a pass supports the other flags."""
    if not flags.samples:
        return None
    given = rows.given()
    if "noise" in given:
        raise UsageError(
            "--noise and --samples: wanted one of them, got both; adaptive sampling decides "
            "from all samples before, so it cannot be split into passes"
        )
    samples = q.sample_range("--samples", flags.samples)
    TABLE["spp"].check(samples[1], f"--samples {flags.samples}")
    if given.get("spp", samples[1]) < samples[1]:
        raise UsageError(f"--samples {flags.samples}: wanted at most --spp {given['spp']}")
    if flags.denoise:
        raise UsageError(
            "--samples and --denoise: wanted one of them, got both; denoise the merged "
            "passes with `daguerre merge --denoise`"
        )
    if found := [name for name in EXPOSED if name in groups]:
        raise UsageError(
            f"--samples and --aov {','.join(found)}: wanted one of them, got both; a pass is "
            "not exposed"
        )
    if DISPARITY in groups:
        raise UsageError(
            "--samples and --aov disparity: wanted one of them, got both; a pass can keep "
            "--aov depth"
        )
    return samples


def settings_of(
    flags: JobFlags, rows: SettingsFlags, groups: list[str], size: tuple[int, int]
) -> RenderSettings:
    """Makes the settings of a picture of this size; some channels turn ground truth on."""
    more: dict[str, Any] = {
        "resolution": size,
        "aovs": bool(groups) or flags.denoise,
        "halves": flags.denoise and "noise" in rows.given(),
        "motion": any(name in groups for name in names_of(Source.MOTION)),
    }
    if flags.like_plate is not None and "filter" not in rows.given():
        more["filter"] = "box"  # the shape of a photosite; the plate's blur is added to it
    if any(name in groups for name in (*EXACT_ONLY, DISPARITY)):
        more["gt_time"] = rows.given().get("gt_time", "mid")
    return rows.settings(**more)


def check_crop(settings: list[RenderSettings]) -> None:
    """Checks that a crop lies in each picture and its overscan, as far as they are known yet."""
    for film in (one.film for one in settings):
        beside = overscan_of(film.overscan, film.resolution, "--overscan")
        region = (-_FAR, -_FAR, _FAR, _FAR) if beside is None else beside.region(film.resolution)
        crop_within(film.crop, region, "--crop")


def check_overscan(flags: JobFlags, settings: RenderSettings) -> None:
    """Checks that overscan has a file that can hold it."""
    if settings.film.overscan is None or not flags.paths:
        return
    if not any(path.suffix.lower() == ".exr" for path in flags.paths):
        raise UsageError(
            "--overscan needs an .exr output (-o NAME.exr): other formats cannot store it"
        )


def check_truth(groups: list[str], rows: SettingsFlags, maps: MapFlags) -> None:
    """Checks that ground truth has channels, and that they fit ``--gt-lens``."""
    given = rows.given()
    means = given.get("gt_lens", "chief") != "chief"
    if not groups and (means or ("gt_time" in given and maps.export_raymap is None)):
        flag = "--gt-time" if "gt_time" in given else "--gt-lens"
        raise UsageError(f"{flag} needs ground truth to write, such as --aov depth,motion")
    if "coverage" in groups and not means:
        raise UsageError("--aov coverage needs --gt-lens mean: a single chief ray has no coverage")
    if DISPARITY in groups and means:
        raise UsageError(
            "--aov disparity needs --gt-lens chief: a mean over rays has no single position"
        )


def check_writable(output: Output) -> None:
    """Checks that files can be written, before hours are spent."""
    from daguerre.files.atomic import check_writable as check
    from daguerre.files.in_use import claim

    names = [os.path.realpath(path) for path in output.written]
    if len(set(names)) < len(names):
        raise UsageError("-o: the same file is named twice")
    if output.paths and os.path.realpath(output.checkpoint) in names:
        raise UsageError(f"-o {output.checkpoint}: this name is reserved for the checkpoint")
    if output.paths and os.path.realpath(output.preview) in names:
        raise UsageError(f"-o {output.preview}: this name is reserved for --preview")
    for path in output.written:
        check(path)
    if output.paths:
        claim(output.checkpoint)


def _groups(names: list[str]) -> list[str]:
    """Groups of channels by their names in flags, without the groups of every picture."""
    film = names_of(Source.FILM)
    groups: set[str] = set()
    for name in (part.strip() for text in names for part in text.split(",")):
        if name == "all":
            groups |= set(film)
        elif name in BY_NAME:
            groups.add(BY_NAME[name].name)
        else:
            known = [*BY_NAME, "all"]
            raise UsageError(
                f"--aov: no channel {name!r}{suggest(name, known)}; known: {', '.join(known)}"
            )
    return sorted(groups - set(names_of(Source.ALWAYS)))
