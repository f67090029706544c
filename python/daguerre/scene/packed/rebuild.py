"""Puts a scene together from its parts, each of which is checked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.camera import Camera
from daguerre.checks import integers, matrix, number, short
from daguerre.errors import DaguerreError, InputError, MismatchError
from daguerre.files.packing import damage
from daguerre.motion.values import Composite, Dynamic, Keys, is_dynamic
from daguerre.scene.catcher import check_effects
from daguerre.scene.curves import layout_of, moving_curves
from daguerre.scene.lights import check_light
from daguerre.scene.materials import check_material
from daguerre.scene.mesh import mesh_of
from daguerre.scene.parts import Curves, Environment, vertices_of
from daguerre.scene.point_cache import PointCache
from daguerre.scene.scene import Scene

from .optics import joined
from .parts import ARRAYS, OF_MOMENT
from .values import printable

#: Bytes of all uses of arrays for each byte of the file: parts share some, hostile ones far more.
_USES, _FREE = 8, 1 << 26


class Rebuild:
    """One scene, part by part.

    Args:
        parts: Result of ``parts.parts_of``, from a file.
        size: Size of the file's packed bytes.
        verbatim: Whether texts stay as they are; else control characters are replaced.
    """

    def __init__(self, parts: Mapping[str, Any], size: int, *, verbatim: bool = False) -> None:
        self._parts, self._left, self._verbatim = parts, _USES * size + _FREE, verbatim
        time = number(parts["time"], "time", -1e12, 1e12, error=InputError)
        self.scene = Scene(time=time)

    def run(self) -> Scene:
        """Makes the scene.

        Raises:
            InputError: A part is wrong; the message names it.
        """
        self._textures()
        self._materials()
        for k, given in enumerate(self._parts["meshes"]):
            self._mesh(given, f"meshes[{k}]")
        self._instances(self._parts["instances"])
        for k, (light, motion) in enumerate(self._parts["lights"]):
            self._light(light, motion, f"lights[{k}]")
        self._cameras()
        self._environment()
        if (fog := self._parts.get("fog")) is not None:
            self.scene.set_fog(fog)
        if (plate := self._parts.get("plate")) is not None:
            pixels, *camera = plate
            found = _camera(camera, "plate")
            self.scene.set_plate(self._array(pixels, "plate: pixels"), found)
        self._nodes()
        self._rest()
        return self.scene

    def _array(self, value: object, where: str) -> NDArray[Any]:
        """An array, within the budget of the file."""
        if not isinstance(value, np.ndarray):
            raise InputError(f"{where}: wanted an array, got {short(value)}")
        self._left -= value.nbytes
        if self._left < 0:
            raise InputError(f"{where}: arrays are far larger than the file")
        return value

    def _text(self, value: object, where: str) -> str:
        """A text."""
        if not isinstance(value, str):
            raise InputError(f"{where}: wanted a string, got {short(value)}")
        return value if self._verbatim else printable(value)

    def _path(self, value: object, where: str, shape: tuple[int, ...]) -> Dynamic:
        """Points over time, within the budget of the file."""
        if isinstance(value, Keys):
            for one in value.values:
                if self._array(one, where).shape != shape:
                    raise InputError(f"{where}: wanted shape {shape}, got {one.shape}")
        return _dynamic(value, where)

    def _textures(self) -> None:
        for k, given in enumerate(self._parts["textures"]):
            pixels = self._array(given["pixels"], f"textures[{k}]: pixels")
            wrap = given["wrap"]
            if not isinstance(wrap, tuple) or len(wrap) != 2:
                raise InputError(f"textures[{k}]: wrap: wanted two names, got {short(wrap)}")
            names = [self._text(one, f"textures[{k}]") for one in wrap]
            self.scene.add_texture(
                pixels,
                srgb=bool(given["srgb"]),
                wrap=(names[0], names[1]),
                filter=self._text(given["filter"], f"textures[{k}]: filter"),
                min_filter=self._text(given["min_filter"], f"textures[{k}]: min_filter"),
                name=self._text(given["name"], f"textures[{k}]: name"),
            )

    def _materials(self) -> None:
        for k, (material, motion) in enumerate(self._parts["materials"]):
            where = f"materials[{k}]"
            check_material(material, where)
            if motion is not None:
                check_material(_composite(motion, where).at(self.scene.time), where)
            self.scene.add_material(material, motion=motion)

    def _mesh(self, given: Mapping[str, Any], where: str) -> None:
        arrays = {
            name: None if given[name] is None else self._array(given[name], f"{where}: {name}")
            for name in ARRAYS
        }
        name, motion = self._text(given["name"], f"{where}: name"), given.get("motion")
        if "curves" in given:
            self._curves(given["curves"], arrays, name, where)
            if motion is not None:
                self._move_curves(motion, where)
        else:
            moving = None if motion is None else self._moving(motion, arrays, name, where)
            self.scene.add_mesh(**arrays, name=name, motion=moving)  # type: ignore[arg-type]
        if "origin" in given:
            origin = given["origin"]
            if not isinstance(origin, tuple) or len(origin) != 3:
                raise InputError(f"{where}: origin: wanted three numbers, got {short(origin)}")
            x, y, z = (number(one, f"{where}: origin") for one in origin)
            self.scene.meshes[-1] = replace(self.scene.meshes[-1], origin=(x, y, z))

    def _moving(self, given: object, arrays: Mapping[str, Any], name: str, where: str) -> Dynamic:
        """Vertices of a mesh over time."""
        if not isinstance(given, Mapping):
            return _dynamic(given, where)
        moment = {
            key: None if given["rest"][key] is None else self._array(given["rest"][key], where)
            for key in OF_MOMENT
        }
        attributes = {key: arrays[key] for key in ARRAYS[2:]} | moment
        mesh = mesh_of(attributes.pop("positions"), arrays["indices"], attributes, where, name)
        shape = mesh.positions.shape
        if arrays["positions"].shape != shape:
            raise InputError(
                f"{where}: motion: wanted shape {shape}, got {arrays['positions'].shape}"
            )
        path, normals = self._path(given["path"], f"{where}: motion", shape), given["normals"]
        if normals is not None:
            normals = self._path(normals, f"{where}: motion: normals", shape)
        return PointCache(path, normals, vertices_of(mesh), mesh.indices, f"mesh {name!r}")

    def _curves(
        self, given: Mapping[str, Any], arrays: dict[str, Any], name: str, where: str
    ) -> None:
        """Curves of Bezier or linear segments, by their control points."""
        radii = self._array(given["radii"], f"{where}: radii")
        ends = self._array(given["ends"], f"{where}: ends").astype(np.int64)
        if ends.ndim != 1 or not (np.diff(ends, prepend=0) > 0).all():
            raise InputError(f"{where}: ends: whole numbers must increase")
        cubic, closed = given["cubic"] is True, given["closed"] is True
        counts = np.diff(ends, prepend=0) * (3 if cubic else 1) + 1
        last = np.cumsum(counts) - 1
        points = arrays["positions"]
        if radii.ndim != 1 or not len(points) == len(radii) == counts.sum():
            raise InputError(f"{where}: wanted {counts.sum()} positions, got {len(points)}")
        rows = {key: arrays[key] for key in ("uv", "colors")}
        if closed:  # the point that ends a curve begins it
            points, radii = np.delete(points, last, axis=0), np.delete(radii, last)
            rows = {
                key: np.delete(value, last, axis=0)
                if value is not None and len(value) == counts.sum()
                else value
                for key, value in rows.items()
            }
        self.scene.add_curves(
            points,
            counts - closed,
            2 * radii,
            basis="bezier" if cubic else "linear",
            wrap="periodic" if closed else "nonperiodic",
            name=name,
            **rows,
        )

    def _move_curves(self, given: Mapping[str, Any], where: str) -> None:
        made = self.scene.meshes[-1]
        assert isinstance(made, Curves)
        stated = given["layout"]
        counts = self._array(stated["counts"], f"{where}: counts")
        layout = layout_of(counts, stated["basis"], stated["wrap"], where)
        wanted = (int(layout.counts.sum()), 3)
        if wanted[0] > len(made.positions) + 3 * len(counts):  # before it is laid out
            raise InputError(f"{where}: motion: more points than the curves have")
        same = all(
            np.array_equal(getattr(layout.form, key), getattr(made, key))
            for key in ("starts", "ends")
        )
        if not same:
            raise InputError(f"{where}: motion: does not fit these curves")
        path = self._path(given["path"], f"{where}: motion", wanted)
        index = len(self.scene.meshes) - 1
        self.scene.motion.meshes[index] = moving_curves(path, made, layout)

    def _instances(self, given: Mapping[str, Any]) -> None:
        meshes, materials = (
            self._array(given[key], f"instances: {key}") for key in ("meshes", "materials")
        )
        transforms, named = (
            self._array(given[key], "instances") for key in ("transforms", "named")
        )
        names = [self._text(name, "instances: names") for name in given["names"]]
        rows = np.stack([meshes, materials, integers(named, "instances", "names", len(names))])
        count = rows.shape[1] if rows.ndim == 2 else -1
        if transforms.shape != (count, 4, 4):
            raise InputError("instances: all lists must have the same length")
        edges = np.flatnonzero((np.diff(rows) != 0).any(axis=0)) + 1
        for begin, end in pairwise([0, *edges.tolist(), count] if count else [0]):
            mesh, material, name = rows[:, begin].tolist()
            self.scene.add_instances(mesh, material, transforms[begin:end], name=names[name])
        self._single(given)

    def _single(self, given: Mapping[str, Any]) -> None:
        """Values of single instances that differ from their block."""
        scene = self.scene
        for k in given["hidden"]:
            i = self._index(k, "instances: hidden")
            scene.instances[i] = replace(scene.instances[i], shown=False)
        for k, effects in given["catchers"]:
            i = self._index(k, "instances: catchers")
            found = check_effects(effects, f"instances[{i}]: catcher")
            scene.instances[i] = replace(scene.instances[i], catcher=found)
        for k, motion in given["motion"]:
            i = self._index(k, "instances: motion")
            scene.motion.instances[i] = _transform(motion, f"instances[{i}]: motion")
        for k, motion in given["shown"]:
            i = self._index(k, "instances: shown")
            now = _dynamic(motion, f"instances[{i}]: shown").at(scene.time)
            values = motion.values if isinstance(motion, Keys) else [now]
            if not all(isinstance(one, bool | int | float) for one in values):
                raise InputError(f"instances[{i}]: shown: keys must be True or False")
            scene.motion.shown[i] = motion

    def _index(self, value: object, where: str) -> int:
        if type(value) is not int or not 0 <= value < len(self.scene.instances):
            raise InputError(f"{where}: wanted an instance, got {short(value)}")
        return value

    def _light(self, light: Any, motion: Any, where: str) -> None:
        lamp, transform = light
        if motion is not None:
            shown, place = _composite(motion, where).at(self.scene.time)
            check_light(shown)
            matrix(place, where)
        self.scene.add_light(lamp, matrix(transform, where), motion=motion)

    def _cameras(self) -> None:
        scene, chosen = self.scene, self._parts["default camera"]
        sizes = {
            self._text(name, "film sizes"): size for name, size in self._parts.get("film sizes", ())
        }
        for name, *given in self._parts["cameras"]:
            where = f"camera {short(self._text(name, 'cameras'))}"
            camera = _camera(given, where)
            if isinstance(camera, Camera):
                matrix(camera.transform, where)
            scene.add_camera(name, camera, film_size=sizes.get(name))
        if chosen is not None:
            if chosen not in scene.cameras:
                raise InputError(f"default camera: wanted a camera, got {short(chosen)}")
            scene.default_camera = chosen
        for alias, name in self._parts["camera aliases"]:
            scene.camera_aliases[self._text(alias, "camera aliases")] = self._text(
                name, "camera aliases"
            )

    def _environment(self) -> None:
        now, motion = self._parts["environment"], self._parts["environment motion"]
        given = now if motion is None else _composite(motion, "environment").value
        if given is None and now is None:
            return
        if not isinstance(given, Environment):
            raise InputError(f"wanted an environment, got {short(given)}")
        image = None if given.image is None else self._array(given.image, "environment: image")
        self.scene.set_environment(
            image, color=given.color, scale=given.scale, rotation=given.rotation
        )

    def _nodes(self) -> None:
        scene = self.scene
        found = dict(scene.nodes)
        scene.nodes.clear()  # so that they come in their order
        for name, position, motion, members in self._parts["nodes"]:
            name = self._text(name, "nodes")
            where = f"node {name!r}"
            mine = self._array(members, where).tolist()
            if mine and not 0 <= min(mine) <= max(mine) < len(scene.instances):
                raise InputError(
                    f"{where}: wanted instances of the scene, 0 .. "
                    f"{len(scene.instances) - 1}, got {min(mine)} .. {max(mine)}"
                )
            if position is not None:
                if motion is not None:
                    _point(np.asarray(motion.at(scene.time), np.float64), where)
                scene.add_node(name, _point(position, where), motion=motion)
            scene.group_instances(name, mine)
        for name, mine in found.items():
            scene.nodes.setdefault(name, mine)

    def _rest(self) -> None:
        duration = self._parts["duration"]
        if duration is not None:
            duration = number(duration, "duration", 0, error=InputError)
        self.scene.set_clock(duration)
        if (moments := self._parts.get("moments")) is not None:
            begin, end = (number(one, "moments", error=InputError) for one in moments)
            self.scene.moments = begin, end
        for name in self._parts["variants"]:
            self.scene.add_variant(self._text(name, "variants"))
        self.scene.note(*(self._text(one, "warnings") for one in self._parts["warnings"]))


def _camera(given: Any, where: str) -> Any:
    """A camera, with lens and sensor from their contents in the file."""
    camera, lens, sensor = given
    if lens is sensor is None:
        return camera
    if not isinstance(camera, Camera):
        raise InputError(f"{where}: wanted a camera, got {short(camera)}")
    return joined(camera, lens, sensor, where)


def _composite(motion: object, where: str) -> Composite:
    if not isinstance(motion, Composite):
        raise InputError(f"{where}: motion: wanted values over time, got {short(motion)}")
    return motion


def _transform(motion: object, where: str) -> Dynamic:
    """Checks a transform over time."""
    if isinstance(motion, Keys) and not motion.moves_matrices:
        raise InputError(f"{where}: wanted transforms over time, got {short(motion)}")
    return _dynamic(motion, where)


def _dynamic(motion: Any, where: str) -> Dynamic:
    """Checks a value over time, which is of a class that a packed scene may hold."""
    if not is_dynamic(motion):
        raise InputError(f"{where}: motion: wanted values over time, got {short(motion)}")
    found: Dynamic = motion
    return found


def _point(value: object, where: str) -> NDArray[Any]:
    """Checks a point, shape (3,)."""
    if not isinstance(value, np.ndarray) or value.shape != (3,) or value.dtype.kind != "f":
        raise InputError(f"{where}: position: wanted three numbers, got {short(value)}")
    if not np.isfinite(value).all():
        raise InputError(f"{where}: position: wanted finite numbers, got {short(value)}")
    return value


@contextmanager
def rebuilding(where: str) -> Iterator[None]:
    """Turns errors by invalid parts into ``InputError``, with ``where`` in front, once.

    Errors of another version (``MismatchError``) pass.
    """
    try:
        with np.errstate(all="ignore"), damage():
            yield
    except MismatchError:
        raise
    except DaguerreError as error:
        text = str(error)
        raise InputError(text if text.startswith(where) else f"{where}: {text}") from None


def rebuilt(parts: Mapping[str, Any], size: int, *, verbatim: bool = False) -> Scene:
    """Makes a scene from its parts.

    Args:
        parts: Result of ``parts.parts_of``, from a file.
        size: Size of the file's packed bytes.
        verbatim: Whether texts stay as they are; else control characters are replaced.

    Raises:
        InputError: A part is wrong; the message names it.
    """
    return Rebuild(parts, size, verbatim=verbatim).run()
