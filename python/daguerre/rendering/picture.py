"""Pictures of a job: a view of the scene at a frame, how it is rendered, where it goes."""

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
        name: Name in files and progress; empty: the only one, of no name.
        camera: Makes the camera from the scene of a frame.
        notes: Remarks about it, made once.
    """

    name: str = ""
    camera: Callable[[Scene], Camera] = Scene.camera
    notes: Callable[[Camera], Iterable[str]] = _nothing

    @classmethod
    def of(cls, camera: Camera | str | None = None, name: str = "") -> View:
        """A view by a camera, by one of the scene's, or by its only one."""
        if isinstance(camera, Camera):
            return cls(name, lambda scene: camera)
        return cls(name, lambda scene: scene.camera(camera))


@dataclass(frozen=True)
class Picture:
    """One picture of a job.

    Attributes:
        view: The camera.
        settings: How it is rendered.
        output: Its files.
        samples: Range of samples [begin, end); None: as many as the settings ask for.
        frame: Number in a sequence; None: there is none.
        words: Which one of several it is, for people.
        facts: The same for programs.
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
        """Samples [begin, end) of each pixel; with a noise at most."""
        return self.samples or (0, self.settings.sampling.most)


def in_order(pictures: Sequence[Picture], frames: Sequence[int] | None) -> list[Picture]:
    """Pictures of all frames: frame after frame, of each all cameras.

    Args:
        pictures: One for each camera; their files have places for cameras and frames.
        frames: Numbers of the frames; None: no sequence.
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
    """A file's name with the camera and the frame in it."""
    path = named(path, camera, several=several)
    return path if frame is None else numbered(path, frame)
