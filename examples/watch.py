"""Renders a scene again whenever its file changes, until Ctrl-C.

    python examples/watch.py SCENE.glb [PICTURE.png]        (default: out/watch.png)

Shows: a front end in a few lines. ``progress`` gives up a picture as soon as the file is saved
again, so the newest state is drawn first; a file that is half written is tried again.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from pathlib import Path

import daguerre as dg


def changes(path: Path) -> Iterator[int]:
    """Yields the time of each change of a file, ns."""
    seen = 0
    while True:
        stamp = path.stat().st_mtime_ns if path.exists() else seen
        if stamp != seen:
            seen = stamp
            yield stamp
        time.sleep(0.1)


def main(
    scene: str, picture: str = "out/watch.png", width: int = 480, spp: int = 64, count: int = 0
) -> None:
    """Renders after each change; ``count`` pictures, 0: without end."""
    source, target, made = Path(scene), Path(picture), 0
    target.parent.mkdir(parents=True, exist_ok=True)
    settings = dg.RenderSettings.of(resolution=(width, 9 * width // 16), spp=spp)
    for stamp in changes(source):

        def is_newest(status: dg.rendering.Status, stamp: int = stamp) -> bool:
            return source.exists() and source.stat().st_mtime_ns == stamp

        try:
            frame = dg.render(dg.load(source), settings=settings, progress=is_newest)
        except dg.DaguerreError as error:
            print(error)
            continue
        frame.save(target)
        made += 1
        print(f"{target}: {frame.metadata['samples']} of {spp} samples")
        if made == count:
            return


if __name__ == "__main__":
    main(*sys.argv[1:3])
