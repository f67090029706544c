"""Pictures of a job: view, frame, settings and files."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from daguerre.camera.camera import Camera
from daguerre.scene.scene import Scene

from .names import named, numbered
from .output import Output
from .settings import RenderSettings


def _nothing(camera: Camera) -> Iterable[str]:
    return ()


@dataclass(frozen=True)
class View:
    """One camera of a job.

    Attributes:
        name: Name in files and progress; empty: a single camera without a name.
        camera: Function that makes the camera from the scene of a frame.
        notes: Function that makes remarks about the camera, reported once.
        unshifted: Function that makes the camera that a meter uses; None: ``camera``.
    """

    name: str = ""
    camera: Callable[[Scene], Camera] = Scene.camera
    notes: Callable[[Camera], Iterable[str]] = _nothing
    unshifted: Callable[[Scene], Camera] | None = None

    def metered(self, scene: Scene) -> Camera:
        """Returns the camera that a meter uses: of a stereo pair the middle of both."""
        return (self.unshifted or self.camera)(scene)

    @classmethod
    def of(cls, camera: Camera | str | None = None, name: str = "") -> View:
        """Makes a view from a camera, the name of a camera in the scene, or its default camera."""
        if isinstance(camera, Camera):
            return cls(name, lambda scene: camera)
        return cls(name, lambda scene: scene.camera(camera))


@dataclass(frozen=True)
class Picture:
    """One picture of a job.

    Attributes:
        view: View of the camera.
        settings: Render settings.
        output: Files to write.
        samples: Range of samples [begin, end); None: as the settings say.
        frame: Frame number in a sequence; None: not a sequence.
        words: Label among several pictures, for messages.
        facts: Camera and frame among several pictures, for programs.
    """

    view: View
    settings: RenderSettings
    output: Output
    samples: tuple[int, int] | None = None
    frame: int | None = None
    words: str = ""
    facts: dict[str, Any] = field(default_factory=dict)

    @property
    def wanted(self) -> tuple[int, int]:
        """Samples [begin, end) of each pixel; with ``noise`` the maximum."""
        return self.samples or (0, self.settings.sampling.most)


def in_order(pictures: Sequence[Picture], frames: Sequence[int] | None) -> list[Picture]:
    """Lists the pictures of all frames: frame by frame, all cameras of each.

    Args:
        pictures: Picture of each camera; their file names have placeholders for cameras and frames.
        frames: Frame numbers; None: not a sequence.
    """
    several = len(pictures) > 1
    return [
        _one_of(picture, number, several=several)
        for number in ([None] if frames is None else frames)
        for picture in pictures
    ]


def _one_of(picture: Picture, frame: int | None, *, several: bool) -> Picture:
    words: list[str] = []
    facts: dict[str, Any] = {}
    if frame is not None:
        words.append(f"frame {frame}")
        facts["frame"] = frame
    if several:
        words.append(f"camera {picture.view.name}")
        facts["camera"] = picture.view.name
    name = picture.view.name
    output = picture.output.renamed(lambda path: path_of(path, name, frame, several=several))
    return replace(picture, output=output, frame=frame, words=", ".join(words), facts=facts)


def path_of(path: Path, camera: str, frame: int | None, *, several: bool) -> Path:
    """File name with camera and frame filled in."""
    path = named(path, camera, several=several)
    return path if frame is None else numbered(path, frame)
