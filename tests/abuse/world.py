"""Small objects and files that calls are made of: a scene, a camera, frames, files of each kind."""

from __future__ import annotations

import json
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

import daguerre as dg
from daguerre import analysis, polynomial
from daguerre.analysis.iris import Iris
from daguerre.rendering.passes import pass_of, write_pass
from tests.cluster.fake import Fake
from tests.support.formats import mesh_files, tracked
from tests.support.pictures import light_probes
from tests.support.pictures.plate_frames import of_light, ramp

SIZE = (8, 6)
LENS = "canon-serenar-50mm-f1.8"
ZOOM = "canon-ef-24-70mm-f2.8"


class World:
    """Things that a case may ask for; those that calls change are made anew each time.

    Args:
        folder: An empty folder for files.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @property
    def scene(self) -> dg.Scene:
        """A triangle and a quad before the camera, a lamp, a sky and a camera with a name."""
        scene = dg.Scene()
        mesh = scene.add_mesh(TRIANGLE, [(0, 1, 2)], uv=[(0, 0), (1, 0), (0, 1)])
        scene.add_material(dg.Material(dg.Diffuse((0.5, 0.4, 0.3)), name="wall"))
        scene.add_texture(np.full((2, 2, 3), 0.5, np.float32))
        scene.add_instance(mesh, 0, moved(z=-3), name="thing")
        scene.add_light(dg.PointLight((10, 10, 10)), moved(y=2))
        scene.add_camera("main", dg.Camera())
        scene.set_environment(color=(1, 1, 1))
        scene.add_node("here", np.zeros(3))
        return scene

    @property
    def plated(self) -> dg.Scene:
        """The scene before a photograph, with a floor that catches the shadow of the thing."""
        scene = self.scene
        floor = scene.add_mesh(TRIANGLE * 3, [(0, 1, 2)])
        scene.add_instance(floor, 0, moved(y=-1, z=-4), name="floor")
        scene.set_catcher("floor", ("shadow", "reflection"))
        scene.set_plate(self.image)
        return scene

    @property
    def session(self) -> dg.Session:
        """A session of one sample of the scene."""
        session = dg.Session(self.scene, resolution=SIZE, halves=True)
        session.draw(0, 2)
        return session

    @property
    def cluster_session(self) -> dg.ClusterSession:
        """A session that a cluster in this process draws."""
        return dg.ClusterSession(self.scene, resolution=SIZE, halves=True, client=Fake(["w"]))

    @property
    def state(self) -> dict[str, Any]:
        """The sums of a session."""
        return self.session.state()

    @cached_property
    def profile(self) -> dg.export.LensfunProfile:
        return dg.export.lensfun_profile("tessar-50mm-f2.8")

    @cached_property
    def camera(self) -> dg.Camera:
        return dg.Camera(focal_length=40.0, iso=100, f_stop=4.0, shutter_time=0.01)

    @cached_property
    def lens(self) -> Any:
        return dg.lenses.load(LENS)

    @cached_property
    def zoom(self) -> Any:
        return dg.lenses.load(ZOOM)

    @cached_property
    def focused(self) -> Any:
        return self.lens.focused(2.0)

    @cached_property
    def bench(self) -> analysis.Bench:
        return analysis.set_up(self.lens)

    @cached_property
    def pencil(self) -> Any:
        return analysis.pencil(self.bench, 5.0)

    @cached_property
    def mtf(self) -> analysis.Mtf:
        return analysis.modulation_transfer(self.pencil, np.array([10.0, 40.0]))

    @cached_property
    def spot(self) -> analysis.Spot:
        return analysis.spot(self.pencil, grid=8)

    @cached_property
    def wavefront(self) -> Any:
        return analysis.wavefront(self.pencil, grid=16)

    @cached_property
    def ghosts(self) -> Any:
        from daguerre.analysis.ghosts import Ghosts

        return Ghosts(self.bench, 5.0, rays=64)

    @cached_property
    def ghost(self) -> Any:
        return self.ghosts.all[0]

    @cached_property
    def ghost_rays(self) -> Any:
        return analysis.ghost_rays(self.bench, self.ghost.surfaces, (0.0, 0.1, 1.0), rays=64)

    @cached_property
    def polynomial_ghosts(self) -> Any:
        return dg.polynomial.PolynomialGhosts(self.ghosts, 1, rays=64)

    @cached_property
    def glare(self) -> Any:
        from daguerre.analysis.glare import VeilingGlare

        return VeilingGlare(self.bench, walks=500)

    @cached_property
    def iris(self) -> Iris:
        return Iris(6)

    @cached_property
    def fit(self) -> polynomial.LensFit:
        return polynomial.fit(self.lens, 3, film=(8.0, 6.0))

    @cached_property
    def system(self) -> polynomial.System:
        """A thin path in one wavelength, and one of the wavelength."""
        return polynomial.propagate(10.0, degree=3)

    @cached_property
    def frame(self) -> dg.Frame:
        """A rendered frame with channels of all kinds."""
        camera = self.camera.with_(sensor_size=(36, 24))
        asked = {"aovs": True, "halves": True, "bands": 4, "gt_time": "mid"}
        return dg.render(self.scene, camera, resolution=SIZE, spp=1, **asked)

    @cached_property
    def raw(self) -> dg.Raw:
        return of_light(ramp((12, 16)) * 0.5, 0.05, focus=3.0).expose("ideal")

    @cached_property
    def picture(self) -> Any:
        return self.raw.develop()

    @property
    def image(self) -> Any:
        """Light, (6, 8, 3)."""
        return np.random.default_rng(1).random((6, 8, 3), np.float32)

    @cached_property
    def sensor(self) -> Any:
        return dg.sensors.load("ideal")

    @cached_property
    def stock(self) -> Any:
        return dg.stocks.load("generic-colour-negative-400")

    @cached_property
    def negative(self) -> Any:
        return self.stock.expose(self.frame)

    @cached_property
    def projection(self) -> dg.Projection:
        return dg.Projection("opencv", (80, 60), (80.0, 80.0), None, (0.01,))

    @cached_property
    def chart(self) -> Any:
        return dg.charts.make("checkerboard")

    @cached_property
    def charted(self) -> dg.Frame:
        """A frame of the chart, which knows where the chart is."""
        scene = dg.load(self._once("wedge.glb", dg.charts.make("step-wedge").save))
        return dg.render(scene, resolution=(80, 54), spp=1)

    @cached_property
    def calibration(self) -> Any:
        return dg.calibration.Calibration(self.projection, "left", pixel_pitch=6.0)

    @cached_property
    def take(self) -> Any:
        return dg.calibration.read_take(self.opentrackio)

    @cached_property
    def stmaps(self) -> Any:
        return dg.stmaps(self.traced, SIZE)

    @cached_property
    def traced(self) -> dg.Camera:
        return dg.Camera(lens=LENS, focus_distance=2.0)

    @cached_property
    def raymap(self) -> dg.RayMap:
        return dg.raymap(self.camera, SIZE)

    @cached_property
    def annotations(self) -> Any:
        return dg.annotate(self.scene, resolution=SIZE)

    @cached_property
    def settings(self) -> dg.RenderSettings:
        return dg.RenderSettings.of(resolution=SIZE)

    @cached_property
    def plate_camera(self) -> dg.PlateCamera:
        return dg.match_plate(self.photo, sensor="ideal", lens=LENS)

    # ------------------------------------------------------------------------------------- files

    def _once(self, name: str, make: Any) -> Path:
        path = self.folder / name
        if not path.exists():
            make(path)
        return path

    @property
    def exr(self) -> Path:
        return self._once("frame.exr", self.frame.save)

    @property
    def chart_file(self) -> Path:
        return self._once("chart.glb", self.chart.save)

    @property
    def density_file(self) -> Path:
        grid = mesh_files.vol(np.ones((2, 2, 2, 1), np.float32))
        return self._once("smoke.vol", lambda path: Path(path).write_bytes(grid))

    @property
    def photo(self) -> Path:
        """A photograph with EXIF."""
        light = of_light(0.8 * ramp((60, 90)) + 0.02, 0.05, isoSpeed=400, focus=3.0)
        return self._once("photo.dng", light.expose("ideal", 400, seed=1).save)

    @property
    def objects(self) -> Path:
        light = of_light(0.2 * ramp((60, 90)), 0.05, isoSpeed=400)
        return self._once("objects.exr", light.save)

    @property
    def camera_file(self) -> Path:
        return self._once("camera.json", self.plate_camera.save)

    @property
    def ball(self) -> Path:
        """A photograph of a mirror ball."""

        def make(path: Path) -> None:
            picture = light_probes.ball_picture(
                light_probes.mirror(light_probes.world), (96, 72), 120.0
            )
            light_probes.save(path, picture, light_probes.exposure(0.01))

        return self._once("ball.exr", make)

    @property
    def passes(self) -> list[Path]:
        """Two passes of one frame."""
        files = [self.folder / "pass0.exr", self.folder / "pass1.exr"]
        if not files[1].exists():
            scene, camera = self.scene, dg.Camera()
            for n, file in enumerate(files):
                session = dg.Session(scene, camera, resolution=SIZE)
                session.draw(n, n + 1)
                write_pass(file, session.frame(), pass_of(session))
        return files

    @property
    def ros(self) -> Path:
        return self._once("ros.yaml", lambda p: dg.calibration.write(p, self.calibration, "ros"))

    @property
    def opencv(self) -> Path:
        return self._once("cv.yml", lambda p: dg.calibration.write(p, self.calibration, "opencv"))

    @cached_property
    def stereo(self) -> dict[str, Any]:
        """Two cameras as OpenCV calibrates them."""
        k = [[80.0, 0, 40], [0, 80, 30], [0, 0, 1]]
        turn, shift = np.eye(3).tolist(), [-0.1, 0.0, 0.0]
        none = [0.0] * 5
        return {
            "M1": k, "D1": none, "M2": k, "D2": none, "R": turn, "T": shift,
            "image_size": [80, 60],
        }  # fmt: skip

    @property
    def kalibr(self) -> Path:
        return self._once("k.yaml", lambda p: dg.calibration.write(p, self.calibration, "kalibr"))

    @property
    def opentrackio(self) -> Path:
        return self._once("take.jsonl", lambda p: tracked.opentrackio(p, tracked.path(3)))

    @property
    def sample(self) -> Path:
        """One moment of the take."""
        first = self.opentrackio.read_text().splitlines()[0]
        return self._once("sample.json", lambda p: p.write_text(first))

    @property
    def kernel(self) -> str:
        """A picture of how light spreads."""
        picture = dg.Frame(np.ones((3, 3, 3), np.float32))
        return str(self._once("kernel.exr", picture.save))

    @property
    def colmap(self) -> Path:
        return self._once("model", lambda p: tracked.colmap(p, tracked.path(3)))

    @property
    def transforms(self) -> Path:
        return self._once("t.json", lambda p: tracked.nerfstudio(p, tracked.path(3)))

    @property
    def ies(self) -> Path:
        lines = "IESNA:LM-63-2002", "TILT=NONE", "1 -1 1 2 1 1 2 0 0 0 1 1 9", "0 90", "0", "9 1"
        return self._once("lamp.ies", lambda p: p.write_text("\n".join(lines)))

    @property
    def categories(self) -> Path:
        rules = {"thing*": "thing", "lamp": None}
        return self._once("categories.json", lambda p: p.write_text(json.dumps(rules)))

    @property
    def lens_file(self) -> Path:
        return self._once("lens.json", lambda p: p.write_text(json.dumps(self.lens.data)))

    @property
    def out(self) -> Path:
        """A folder to write to."""
        folder = self.folder / "out"
        folder.mkdir(exist_ok=True)
        return folder


TRIANGLE = np.array([(-1, -1, 0), (1, -1, 0), (0, 1, 0)], np.float32)


def moved(x: float = 0, y: float = 0, z: float = 0) -> Any:
    """A transform."""
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix
