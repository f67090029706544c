"""Names of files that leave the scene's folder, or are none: of buffers, of images."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

from tests.support.formats.make_gltf import png

from .bases import PIXELS, full
from .case import Case

#: Ways out to a file beside the folder; ``{up}`` is the absolute path of the outside.
LEAVING = (
    "../secret.bin",
    "./../secret.bin",
    ".//..//secret.bin",
    "sub/../../secret.bin",
    "sub/./.././../secret.bin",
    "none/../../secret.bin",
    "../scene/../secret.bin",
    "..\\secret.bin",
    "sub\\..\\..\\secret.bin",
    "sub/..\\../secret.bin",
    ".\\..\\secret.bin",
    "%2e%2e/secret.bin",
    "%2E%2E/secret.bin",
    ".%2e/secret.bin",
    "%2e./secret.bin",
    "%2e%2e%2fsecret.bin",
    "%2e%2e%2Fsecret.bin",
    "..%5csecret.bin",
    "..%5Csecret.bin",
    "%2e%2e%5csecret.bin",
    "sub%2f..%2f..%2fsecret.bin",
    "{up}/secret.bin",
    "//{up}/secret.bin",
    "///{up}/secret.bin",
    "%2f{up}/secret.bin",
    "{up}/scene/../secret.bin",
    "file://{up}/secret.bin",
    "file:{up}/secret.bin",
    "FILE:{up}/secret.bin",
    "File://localhost{up}/secret.bin",
    "file:///{up}/secret.bin",
    "file:../secret.bin",
    "file:%2e%2e/secret.bin",
    "file:..%5csecret.bin",
    "link.bin",
    "./link.bin",
    "linked/secret.bin",
    "linked/scene/../secret.bin",
    "sub/../linked/secret.bin",
    "chain.bin",
    "absolute.bin",
    "/etc/passwd",
    "/etc/hostname",
    "/dev/zero",
    "/dev/stdin",
    "/dev/fd/0",
    "/proc/self/environ",
    "/proc/self/mem",
    "/proc/self/root{up}/secret.bin",
    "/proc/self/cwd",
    "..",
    "../",
    "../..",
    "/",
    "\\\\server\\share\\secret.bin",
    "//server/share/secret.bin",
    "..;/secret.bin/../../../secret.bin",
    "../../../../../../../../../../../../../../../../etc/passwd",
    "..%2f" * 40 + "etc%2fpasswd",
    "zero.bin",
)
#: Names of no file inside: what is wrong with them.
REFUSED = {
    "http://example.org/a.bin": "refused: wanted a relative path or a data URI, got 'http:",
    "https://example.org/a.bin": "refused: wanted a relative path",
    "ftp://example.org/a.bin": "refused: wanted a relative path",
    "smb://server/a.bin": "refused: wanted a relative path",
    "javascript:0": "refused: wanted a relative path",
    "C:/windows/a.bin": "refused: wanted a relative path",
    "C:\\windows\\a.bin": "refused: wanted a relative path",
    "c:a.bin": "refused: wanted a relative path",
    "file://server/share/a.bin": "refused: wanted a local file",
    "file://127.0.0.1/a.bin": "refused: wanted a local file",
    "file://[::1/a.bin": "refused: wanted",
    "": "refused: wanted the name of a file",
    "a\0b": "refused: wanted the name of a file",
    "a%00b": "refused: wanted the name of a file",
    "../secret.bin%00.png": "refused: wanted the name of a file",
    ".": "wanted a file, got a folder",
    "sub": "wanted a file, got a folder",
    "sub/": "wanted a file, got a folder",
    "pipe.bin": "not a regular file",
    "loop.bin": "no such file|cannot read|refused",
    "x" * 5000: "no such file|cannot read|refused",
    "x/" * 3000: "no such file|cannot read|refused",
    "%252e%252e%252fsecret.bin": "no such file",
    "%25252e%25252e/secret.bin": "no such file",
    "..%c0%afsecret.bin": "no such file",
    "%c0%ae%c0%ae/secret.bin": "no such file",
    "\uff0e\uff0e/secret.bin": "no such file",
    "..\u2215secret.bin": "no such file",
    "\u2024\u2024/secret.bin": "no such file",
    "\ud800": "no such file|cannot read|refused",
    "~/secret.bin": "no such file",
    "~root/secret.bin": "no such file",
    "$HOME/secret.bin": "no such file",
    "${{HOME}}/secret.bin": "no such file",
    "%HOME%/secret.bin": "no such file",
    "`cat /etc/passwd`": "no such file",
    "|cat /etc/passwd": "no such file",
    ".../secret.bin": "no such file",
    ".. /secret.bin": "no such file",
    "..\t/secret.bin": "no such file",
    " ../secret.bin": "no such file|leaves",
    "../secret.bin ": "leaves|no such file",
    "../secret.bin.": "leaves",
    "../secret.bin#x": "leaves|no such file",
    "../secret.bin?x": "leaves|no such file",
    "secret.bin": "no such file",
    "data:": "broken data URI",
    "data:;base64": "broken data URI",
    "data:;base64,!!!!": "broken data URI",
    "data:;base64,AAAA": "is too short: wanted",
    "data:,../secret.bin": "is too short: wanted",
    "DATA:text/plain,{up}/secret.bin": "is too short: wanted",
    " data:;base64,AAAA": "no such file|cannot read|refused",
    "data:;base64,AAA": "broken data URI",
    "data:;base64,\u00e4": "broken data URI",
}


def surroundings(folder: Path, name: str, data: bytes) -> Path:
    """A folder for the scene, with links out of it, and a secret beside it; returns the folder."""
    scene = folder / "scene"
    (scene / "sub").mkdir(parents=True)
    (folder / name).write_bytes(data)
    (scene / ("link" + Path(name).suffix)).symlink_to(folder / name)
    (scene / ("chain" + Path(name).suffix)).symlink_to("link" + Path(name).suffix)
    (scene / ("absolute" + Path(name).suffix)).symlink_to("/etc/passwd")
    (scene / ("zero" + Path(name).suffix)).symlink_to("/dev/zero")
    (scene / ("loop" + Path(name).suffix)).symlink_to("loop" + Path(name).suffix)
    (scene / "linked").symlink_to(folder)
    os.mkfifo(scene / ("pipe" + Path(name).suffix))
    return scene


def _buffer(uri: str) -> Callable[[Path], Path]:
    def make(folder: Path) -> Path:
        b = full()
        scene = surroundings(folder, "secret.bin", bytes(b.binary))
        document = b.document()
        document["buffers"][0]["uri"] = uri.format(up=folder)
        (scene / "bad.gltf").write_text(json.dumps(document))
        return scene / "bad.gltf"

    return make


def _image(uri: str) -> Callable[[Path], Path]:
    def make(folder: Path) -> Path:
        scene = surroundings(folder, "secret.png", png(PIXELS))
        b = full()
        b.json["images"][0] = {"uri": uri.replace(".bin", ".png").format(up=folder)}
        return b.glb(scene / "bad.glb")

    return make


def _lens(name: str) -> Callable[[Path], Path]:
    """A camera may name a lens of the library, never a file."""

    def make(folder: Path) -> Path:
        b = full()
        b.json["cameras"][0]["extras"] = {"daguerre": {"lens": name}}
        return b.glb(folder / "bad.glb")

    return make


OUT = "leaves the scene's folder: wanted"
CASES = [
    *(
        Case(f"uri-{what} {i:02d}", make(uri), rf"{where}\.uri: {OUT}")
        for what, where, make in (
            ("buffer", r"buffers\[0\]", _buffer),
            ("image", r"images\[0\]", _image),
        )
        for i, uri in enumerate(LEAVING)
    ),
    *(
        Case(f"uri-refused {i:02d}", _buffer(uri), rf"buffers\[0\]\.\w+: .*({error})")
        for i, (uri, error) in enumerate(REFUSED.items())
    ),
    *(
        Case(f"uri-lens {i}", _lens(name), r"cameras\[0\]\.extras\.daguerre\.lens: ")
        for i, name in enumerate(("../lens.json", "/etc/passwd", "lens.json", "~/lens.json", ""))
    ),
]
