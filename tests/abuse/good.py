"""Good arguments of every public call: by its path, else by the name of the parameter.

A path without a row gets its required parameters from ``BY_NAME``, so a new function whose
parameters have usual names needs no row. Values are made of a :class:`World` for each case.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import daguerre as dg
from daguerre.rendering.columns import columns_of
from tests.cluster.fake import Fake

from .world import LENS, SIZE, TRIANGLE, World, moved

Make = Callable[[World], Any]
FILM = {"sensor": (36.0, 24.0)}


def filmed(w: World) -> dict[str, Any]:
    """A picture with the size of its film."""
    return {"image": w.image, **FILM}


def constant(**values: Any) -> Make:
    """The same arguments for each case."""
    return lambda _: dict(values)


#: Values of parameters by name.
BY_NAME: dict[str, Make] = {
    "angles_deg": lambda w: np.array([0.0, 5.0]),
    "at": lambda w: np.zeros((3, 2)),
    "axis": lambda w: (0.0, 1.0, 0.0),
    "baseline": lambda w: 0.06,
    "bench": lambda w: w.bench,
    "begin": lambda w: 0.0,
    "calibration": lambda w: w.ros,
    "camera": lambda w: w.camera,
    "chart": lambda w: w.chart,
    "client": lambda w: Fake(["w"]),
    "count": lambda w: 3,
    "data": lambda w: w.fit.to_dict(),
    "depth": lambda w: np.full((6, 8), 2.0, np.float32),
    "directions": lambda w: np.array([(0, 0, 1.0), (0, 0, 1)]),
    "distance": lambda w: 10.0,
    "distance_m": lambda w: 2.0,
    "dz": lambda w: 0.01,
    "end": lambda w: 2.0,
    "f_number": lambda w: 2.8,
    "f_stop": lambda w: 4.0,
    "film_mm": lambda w: (2.0, 1.0),
    "film_z": lambda w: 40.0,
    "form": lambda w: dg.polynomial.sphere(50.0),
    "frame": lambda w: w.frame,
    "freq_per_mm": lambda w: np.array([10.0, 40.0]),
    "height_mm": lambda w: 5.0,
    "heights_mm": lambda w: np.array([0.0, 5.0]),
    "image": lambda w: w.image,
    "iso": lambda w: 200.0,
    "k": lambda w: 0.1,
    "lens": lambda w: w.lens,
    "light": lambda w: w.pencil,
    "metadata": lambda w: w.charted.metadata,
    "model": lambda w: dg.distortion.BrownConrady(-0.1),
    "name": lambda w: "main",
    "nm": lambda w: np.array([450.0, 550.0]),
    "origins": lambda w: np.array([(0, 0, -10.0), (1, 0, -10)]),
    "path": lambda w: w.out / "out.exr",
    "picture": lambda w: w.charted.rgb,
    "points": lambda w: np.array([(0.1, 0.2), (0.3, -0.1)]),
    "position": lambda w: (0.0, 1.0, 5.0),
    "projection": lambda w: w.projection,
    "radius": lambda w: 50.0,
    "radius_x": lambda w: 50.0,
    "radius_y": lambda w: 60.0,
    "raw": lambda w: w.raw,
    "rays": lambda w: w.spot,
    "resolution": lambda w: SIZE,
    "scene": lambda w: w.scene,
    "share": lambda w: 0.5,
    "size": lambda w: SIZE,
    "source": lambda w: w.ros,
    "stock": lambda w: w.stock,
    "target": lambda w: (0.0, 0.0, -3.0),
    "time": lambda w: 0.5,
    "time_s": lambda w: 0.5,
    "transform": lambda w: moved(z=-2),
    "wave": lambda w: w.wavefront,
    "wavelength_nm": lambda w: 550.0,
    "wavelengths_nm": lambda w: (480.0, 550.0),
    "where": lambda w: "here",
}

_RENDER: Make = lambda w: {"scene": w.scene, "resolution": SIZE, "spp": 1}  # noqa: E731
_CAMERA: Make = lambda w: {  # noqa: E731
    "focal_length": 40.0, "sensor_size": (36.0, 24.0), "f_stop": 4.0, "focus_distance": 3.0,
    "shutter_time": 0.01, "iso": 200.0, "lens": None, "transform": moved(z=1),
}  # fmt: skip

#: A picture over a photograph, with a catcher and mattes.
_PLATED: Make = lambda w: {  # noqa: E731
    "scene": w.plated, "resolution": SIZE, "spp": 2, "background": "plate",
    "cryptomatte": ("object", "material"), "halves": True,
}  # fmt: skip

#: Arguments by path.
ARGS: dict[str, Make] = {
    "dg.Camera": _CAMERA,
    "dg.Camera.from_colmap": lambda w: {"folder": w.colmap},
    "dg.Camera.from_kalibr": lambda w: {"calibration": w.kalibr},
    "dg.Camera.from_opencv": lambda w: {"calibration": w.opencv},
    "dg.Camera.from_opentrackio": lambda w: {"calibration": w.opentrackio},
    "dg.Camera.with_": _CAMERA,
    "dg.Categories.read": lambda w: {"path": w.categories},
    "dg.Conductor.of_metal": constant(name="Au", alpha=0.2),
    "dg.Spectrum": constant(wavelengths_nm=(400.0, 700.0), values=(0.5, 1.0)),
    "dg.export_scene": lambda w: {"scene": w.scene, "path": w.out / "a.xml", "resolution": SIZE},
    "dg.export_camera": lambda w: {"camera": w.camera, "path": w.out / "a.usda"},
    "dg.Frame": lambda w: {"rgb": w.image, "metadata": {}},
    "dg.Frame.encoded": constant(tone="srgb"),
    "dg.Frame.encoded_rows": constant(tone="srgb"),
    "dg.Frame.expose": constant(sensor="ideal", iso=200.0, seed=1, temperature=20.0),
    "dg.Frame.exposure_truth": constant(sensor="ideal", iso=200.0),
    "dg.Frame.save": lambda w: {"path": w.out / "a.exr"},
    "dg.Keys": constant(times=np.array([0.0, 1.0]), values=(1.0, 2.0), interpolation="linear"),
    "dg.DensityGrid.load": lambda w: {"path": w.density_file},
    "dg.DensityGrid": lambda w: {"values": np.ones((2, 3, 4), np.float32), "transform": np.eye(4)},
    "dg.LightProfile": constant(scale=2.0),
    "dg.LightProfile.cone": constant(angle=40.0, softness=0.2),
    "dg.LightProfile.focus": constant(exponent=2.0, tint=(0.1, 0.2, 0.3)),
    "dg.LightProfile.from_ies": lambda w: {"path": w.ies},
    "dg.LightProfile.stretched": constant(angle_scale=0.5),
    "dg.LightProfile.table": constant(
        theta_deg=[0.0, 90.0], values=[[1.0, 1.0], [0.5, 0.0]], phi_deg=[0.0, 90.0]
    ),
    "dg.PlateCamera": lambda w: {
        "plate": "photo.dng",
        "sha256": "00",
        "kind": "raw",
        "resolution": SIZE,
        "camera": w.camera,
    },
    "dg.PlateCamera.save": lambda w: {"path": w.out / "c.json"},
    "dg.Projection": constant(
        model="opencv",
        size=(80, 60),
        focal=(80.0, 80.0),
        principal=(40.0, 30.0),
        parameters=(0.01,),
    ),
    "dg.Projection.blended": lambda w: {"other": w.projection, "share": 0.5},
    "dg.Projection.film": constant(width_mm=36.0),
    "dg.Projection.of_field": constant(model="equidistant", size=(80, 60), field=120.0),
    "dg.Projection.project": constant(points=[(0.1, 0.2, -1.0)]),
    "dg.Projection.unproject": constant(pixels=[(10.0, 20.0)]),
    "dg.Raw": lambda w: {
        "mosaic": w.raw.mosaic,
        "sensor": w.sensor,
        "iso": 100.0,
        "black_level": 0,
        "white_level": 65535,
        "gain": 1.0,
        "neutral": w.raw.neutral,
        "white_balance": (1.0, 1.0),
    },
    "dg.Raw.develop": constant(look="neutral", ev=0.5),
    "dg.Raw.save": lambda w: {"path": w.out / "a.dng"},
    "dg.RayMap": lambda w: {
        "origin": w.raymap.origin,
        "direction": w.raymap.direction,
        "time": w.raymap.time,
    },
    "dg.RenderSettings.from_json": lambda w: {"data": w.settings.to_json()},
    "dg.RenderSettings.of": constant(resolution=SIZE, max_depth=4),
    "dg.RenderSettings.read": lambda w: {
        "values": w.settings.values(),
        "named": lambda n: f"here: {n}",
    },
    "dg.RenderSettings.with_": constant(resolution=SIZE, max_depth=4),
    "dg.RollingShutter": constant(scan_order="top", line_time=1e-5),
    "dg.Scene.add_camera": lambda w: {"name": "second", "camera": w.camera},
    "dg.Scene.add_curves": lambda w: {
        "points": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
        "counts": [4],
        "widths": 0.1,
    },
    "dg.Scene.add_instance": lambda w: {"mesh": 0, "material": 0, "transform": moved(x=1)},
    "dg.Scene.add_instances": lambda w: {
        "mesh": 0,
        "material": 0,
        "transforms": np.stack([moved(x=1), moved(x=2)]),
    },
    "dg.Scene.add_light": lambda w: {"light": dg.PointLight((1, 1, 1)), "transform": moved(y=1)},
    "dg.Scene.add_material": lambda w: {"material": dg.Diffuse((0.2, 0.2, 0.2)), "name": "m"},
    "dg.Scene.add_mesh": lambda w: {
        "positions": TRIANGLE,
        "indices": [(0, 1, 2)],
        "normals": [(0, 0, 1)] * 3,
        "uv": [(0, 0), (1, 0), (0, 1)],
        "sizes": [3],
    },
    "dg.Scene.add_node": lambda w: {"name": "node", "position": np.zeros(3)},
    "dg.Scene.add_texture": lambda w: {"pixels": np.zeros((2, 2, 3), np.float32)},
    "dg.Scene.add_variant": constant(name="night"),
    "dg.Scene.group_instances": constant(name="group", instances=[0]),
    "dg.Scene.note": constant(),
    "dg.Scene.set_catcher": constant(node="thing", effects=("shadow",)),
    "dg.Scene.set_clock": constant(duration=2.0),
    "dg.Scene.set_fog": lambda w: {"medium": dg.Medium((0.1, 0.1, 0.1))},
    "dg.Scene.set_environment": lambda w: {"image": np.ones((4, 8, 3), np.float32), "scale": 1.0},
    "dg.Scene.set_plate": lambda w: {"pixels": w.image},
    "dg.Session": lambda w: {"scene": w.scene, "resolution": SIZE},
    "dg.Session.add": lambda w: {"sums": columns_of(w.state)},
    "dg.Session.draw": constant(begin=2, end=3),
    "dg.Session.draw_round": constant(until=4),
    "dg.Session.expose": lambda w: {"camera": w.session.camera.with_(iso=800.0)},
    "dg.Session.object_ids": lambda w: {"moment": moment(w)},
    "dg.Session.relative_variance": constant(dark=0.01),
    "dg.Session.set_state": lambda w: {"state": w.state, "ranges": [(0, 2)]},
    "dg.Spin": lambda w: {
        "axis": (0.0, 1.0, 0.0),
        "revolutions_per_second": 1.0,
        "center": (0.0, 0.0, 0.0),
        "transform": np.eye(4),
        "time": 0.0,
    },
    "dg.StMaps": lambda w: {"view": w.stmaps.view},
    "dg.StMaps.save": lambda w: {"undistort": w.out / "u.exr", "redistort": w.out / "r.exr"},
    "dg.TextureSlot": constant(texture=0),
    "dg.annotate": lambda w: {"scene": w.scene, "resolution": SIZE},
    "dg.calibrate": lambda w: {"lens": w.lens, "resolution": (80, 60)},
    "dg.calibrate_all": lambda w: {
        "lens": w.lens,
        "resolution": (80, 60),
        "sensor_size": (2.0, 1.5),
    },
    "dg.calibration.Take": lambda w: {"projection": w.projection},
    "dg.calibration.Calibration.check": constant(frame=1, time_s=0.04, fps=25.0),
    "dg.calibration.Take.check": constant(frame=1, time_s=0.04, fps=24.0),
    "dg.calibration.Calibration.camera": lambda w: {"camera": w.camera},
    "dg.calibration.Take.camera": lambda w: {"camera": w.camera},
    "dg.calibration.pick": lambda w: {
        "cameras": {"left": w.calibration},
        "name": "left",
        "where": "here",
    },
    "dg.calibration.read": lambda w: {"source": w.ros},
    "dg.calibration.read_all": lambda w: {"source": w.ros},
    "dg.calibration.read_colmap": lambda w: {"source": w.colmap},
    "dg.calibration.read_kalibr": lambda w: {"source": w.kalibr},
    "dg.calibration.read_opencv": lambda w: {"source": w.opencv},
    "dg.calibration.read_opentrackio": lambda w: {"source": w.sample},
    "dg.calibration.read_ros": lambda w: {"source": w.ros},
    "dg.calibration.read_stereo": lambda w: {"source": w.stereo},
    "dg.calibration.read_take": lambda w: {"samples": w.opentrackio},
    "dg.calibration.read_track": lambda w: {"samples": w.opentrackio},
    "dg.calibration.read_transforms": lambda w: {"source": w.transforms},
    "dg.calibration.write": lambda w: {
        "path": w.out / "cal.yaml",
        "calibration": w.calibration,
        "format": "ros",
    },
    "dg.charts.Chart": lambda w: {
        "name": "checkerboard",
        "size": (1.0, 1.0),
        "patches": w.chart.patches,
        "ground": (0.5, 0.5, 0.5),
    },
    "dg.charts.Chart.distance": constant(focal_length=50.0, sensor_width=36.0),
    "dg.charts.Chart.save": lambda w: {"path": w.out / "c.glb"},
    "dg.charts.EdgeResponse": constant(
        frequency=np.linspace(0, 1, 5), response=np.linspace(1, 0, 5), angle=5.0, low=0.1, high=0.9
    ),
    "dg.charts.EdgeResponse.at": constant(frequency=[0.25]),
    "dg.charts.Patch": lambda w: {
        "name": "patch",
        "points": np.zeros((3, 2)),
        "rgb": (0.1, 0.1, 0.1),
    },
    "dg.charts.RowTime": constant(
        line_time=1e-5, readout_time=0.01, scan_order="top", turn_rate=1.0, error=0.0
    ),
    "dg.charts.edge_response": lambda w: {"region": edge()},
    "dg.charts.make": constant(name="checkerboard", columns=6),
    "dg.charts.means": lambda w: {
        "picture": w.charted.rgb,
        "chart": dg.charts.make("step-wedge"),
        "metadata": w.charted.metadata,
    },
    "dg.charts.object_points": constant(points_m=[(0.1, 0.2)]),
    "dg.charts.poses": lambda w: {"chart": w.chart, "projection": w.projection, "count": 2},
    "dg.charts.row_time": lambda w: {
        "regions": np.stack([edge(0.1), edge(0.12)]),
        "projection": w.projection,
        "turn_rate": 1.0,
    },
    "dg.charts.star_modulation": lambda w: {
        "picture": edge(),
        "center": (20.0, 20.0),
        "radii": [5.0, 8.0],
        "cycles": 4,
    },
    "dg.charts.texture_response": lambda w: {"picture": noise(1), "reference": noise(1)},
    "dg.composite": lambda w: {"plate": w.photo, "objects": w.objects, "like_plate": w.camera_file},
    "dg.development.Picture": lambda w: {"pixels": w.image},
    "dg.development.Picture.save": lambda w: {"path": w.out / "a.png"},
    "dg.development.develop": lambda w: {"source": w.raw, "ev": 0.5},
    "dg.development.save_raw": lambda w: {"path": w.out / "a.dng", "raw": w.raw},
    "dg.export.LensfunProfile": lambda w: vars(w.profile),
    "dg.export.check_suffix": constant(path="a.c"),
    "dg.export.code": lambda w: {"data": w.fit.to_dict(), "suffix": ".c"},
    "dg.export.lensfun_profile": constant(lens="tessar-50mm-f2.8"),
    "dg.export.save": lambda w: {"data": w.fit.to_dict(), "path": w.out / "a.c"},
    "dg.export.save_lensfun": lambda w: {"profile": w.profile, "path": w.out / "a.xml"},
    "dg.exposure.luminance_exposure": lambda w: {"metadata": w.frame.metadata},
    "dg.iter_render": _PLATED,
    "dg.keys": constant(pairs=[(0.0, 1.0), (1.0, 2.0)], interpolation="linear"),
    "dg.labels.coco.CocoFile": lambda w: {"path": w.out / "coco.json"},
    "dg.labels.coco.CocoFile.add": lambda w: {"seen": w.annotations, "picture": "a.png"},
    "dg.lenses.Configuration": constant(name="wide", gaps={1: 2.0}),
    "dg.lenses.Configuration.like": lambda w: {"other": w.zoom.configurations[0]},
    "dg.lenses.FirstOrder": lambda w: vars(w.lens.first_order()),
    "dg.lenses.Focused": lambda w: vars(w.focused),
    "dg.lenses.Lens": lambda w: fields(w.lens),
    "dg.lenses.Lens.at_zoom": constant(zoom_mm=40.0),
    "dg.lenses.Lens.decentered": constant(surfaces=(1, 2), shift=(0.1, 0.0)),
    "dg.lenses.Lens.rebuilt": lambda w: {"surfaces": w.lens.surfaces},
    "dg.lenses.Lens.with_gaps": constant(gaps={1: 0.5}),
    "dg.lenses.LensError": constant(message="m", code="c"),
    "dg.lenses.LensSurface": lambda w: fields(w.lens.surfaces[0]),
    "dg.lenses.LensSurface.replaced": constant(radius=40.0),
    "dg.lenses.Pupil": constant(z=1.0, diameter=2.0),
    "dg.lenses.glasses.GlassData": lambda w: fields(dg.lenses.glasses.find("N-BK7")),
    "dg.lenses.glasses.find": constant(name="N-BK7"),
    "dg.lenses.glasses.lookup": constant(name="N-BK7", maker="Schott"),
    "dg.lenses.glasses.names": constant(maker="Schott"),
    "dg.lenses.glasses.similar": constant(label="517642", nd=1.5168),
    "dg.lenses.load": constant(name_or_path=LENS),
    "dg.lenses.read": lambda w: {"path": w.lens_file},
    "dg.light_probe": lambda w: {
        "photographs": [w.ball],
        "ball": "mirror",
        "res": 16,
        "fov": 43.6,
        "sun": "off",
    },
    "dg.Frame.layer": constant(name="depth"),
    "dg.lenses.Entry": lambda w: fields(dg.lenses.find("canon")[0]),
    "dg.lenses.find": constant(words="canon 50"),
    "dg.load": lambda w: {"path": w.chart_file},
    "dg.load_frame": lambda w: {"path": w.exr},
    "dg.match_plate": lambda w: {"photo": w.photo, "sensor": "ideal", "lens": LENS},
    "dg.merge": lambda w: {"passes": w.passes},
    "dg.metering.Metered": constant(mode="spot", luminance=1.0, iso=100.0),
    "dg.metering.check_mode": constant(mode="spot"),
    "dg.metering.meter": lambda w: {"frame": w.frame, "mode": "spot", "at": (0.5, 0.5)},
    "dg.analysis.Bench": lambda w: fields(w.bench),
    "dg.analysis.Mtf": lambda w: fields(w.mtf),
    "dg.analysis.Pencil": lambda w: fields(w.pencil),
    "dg.analysis.Psf": lambda w: {
        "image": np.ones((4, 4)),
        "half_mm": 0.1,
        "center": np.zeros(2),
        "diffraction": True,
    },
    "dg.analysis.SeidelSums": constant(surfaces=np.ones((3, 7)), field_deg=5.0),
    "dg.analysis.Spot": lambda w: fields(w.spot),
    "dg.analysis.Spot.encircled_energy": constant(radii_mm=np.array([0.01, 0.1])),
    "dg.analysis.Wavefront": lambda w: fields(w.wavefront),
    "dg.analysis.best_film_z": lambda w: {"spots": [w.spot], "film_z": w.bench.film_z},
    "dg.analysis.diffraction_psf": lambda w: {"light": w.pencil, "max_grid": 32, "pixels": 8},
    "dg.analysis.geometric_psf": lambda w: {"light": w.pencil, "pixels": 8, "grid": 8},
    "dg.analysis.GhostRays": lambda w: fields(w.ghost_rays),
    "dg.analysis.ghost_rays": lambda w: {
        "bench": w.bench,
        "surfaces": w.ghost.surfaces,
        "direction": (0.0, 0.1, 1.0),
        "rays": 64,
    },
    "dg.analysis.trace_ghost": lambda w: {
        "bench": w.bench,
        "surfaces": w.ghost.surfaces,
        "rays": w.ghost_rays.rays,
    },
    "dg.analysis.ghosts.Ghosts": lambda w: {"bench": w.bench, "angle_deg": 5.0, "rays": 64},
    "dg.analysis.ghosts.Ghosts.find": lambda w: {"surfaces": w.ghost.surfaces},
    "dg.analysis.ghosts.Ghosts.paths": lambda w: {"ghost": w.ghost},
    "dg.analysis.ghosts.Ghosts.picture": constant(pixels=16),
    "dg.analysis.glare.VeilingGlare": lambda w: {"bench": w.bench, "walks": 500},
    "dg.analysis.iris.Iris": constant(blades=6, rotation=10.0),
    "dg.analysis.iris.Iris.amplitude": constant(
        x=np.linspace(-1, 1, 4), y=np.linspace(-1, 1, 4), pitch=0.5
    ),
    "dg.analysis.diffraction.PlainPupil.amplitude": constant(
        x=np.linspace(-1, 1, 4), y=np.linspace(-1, 1, 4), wavelength_nm=550.0
    ),
    "dg.analysis.diffraction.far_field": lambda w: {
        "pupil": plain_pupil(),
        "wavelength_nm": 550.0,
        "pitch_mm": 0.006,
        "size": 17,
    },
    "dg.analysis.lens_pupil.lens_pupil": lambda w: {"bench": w.bench, "film_mm": (2.0, 1.0)},
    "dg.analysis.point_spread": lambda w: {"light": w.pencil, "max_grid": 32, "pixels": 8},
    "dg.analysis.spherical_aberration": lambda w: {"bench": w.bench, "shares": [0.5, 1.0]},
    "dg.analysis.spot": lambda w: {"light": w.pencil, "grid": 8},
    "dg.analysis.wavefront": lambda w: {"light": w.pencil, "grid": 16},
    "dg.analysis.relative_illumination": lambda w: {
        "bench": w.bench,
        "heights_mm": [0.0, 5.0],
        "grid": 16,
    },
    "dg.polynomial.ErrorZone": lambda w: fields(w.fit.error),
    "dg.polynomial.ErrorZone.film_px": constant(pixels=960, width_mm=36.0),
    "dg.polynomial.Form": lambda w: fields(dg.polynomial.sphere(50.0)),
    "dg.polynomial.GhostError": lambda w: fields(w.polynomial_ghosts.all[0]),
    "dg.polynomial.GhostPolynomial": lambda w: fields(dg.polynomial.expand_ghost(w.ghost_rays, 1)),
    "dg.polynomial.GhostPolynomial.points": lambda w: {"places": w.ghost_rays.rays[:, :2]},
    "dg.polynomial.PolynomialGhosts": lambda w: {"ghosts": w.ghosts, "degree": 1, "rays": 64},
    "dg.polynomial.PolynomialGhosts.picture": constant(pixels=16),
    "dg.polynomial.expand_ghost": lambda w: {"light": w.ghost_rays, "degree": 1},
    "dg.polynomial.LensFit": lambda w: {"core": w.fit.core},
    "dg.polynomial.LensFit.evaluate": constant(
        film_points=[(1.0, 1.0)], slopes=[(0.0, 0.0)], wavelength_nm=550.0
    ),
    "dg.polynomial.LensFit.refitted": lambda w: refit(w),
    "dg.polynomial.LensFit.save": lambda w: {"path": w.out / "fit.json"},
    "dg.polynomial.LensFit.to_film": lambda w: {
        "origins": [(0.0, 0.0, -20.0)],
        "directions": [(0.0, 0.0, -1.0)],
        "wavelength_nm": 550.0,
    },
    "dg.polynomial.SceneRays": lambda w: fields(w.fit.evaluate([(1.0, 1.0)], [(0.0, 0.0)], 550.0)),
    "dg.polynomial.SeidelTerms": constant(
        spherical=1.0,
        coma=1.0,
        astigmatism=1.0,
        field_curvature=1.0,
        distortion=1.0,
        convergence=1.0,
    ),
    "dg.polynomial.SeidelTerms.sums": constant(pupil_radius=1.0, field_slope=0.1),
    "dg.polynomial.System": lambda w: {"core": w.system.core},
    "dg.polynomial.System.at": constant(wavelength=550.0),
    "dg.polynomial.System.jacobian": constant(rays=[(0.1, 0.1, 0.0, 0.0)]),
    "dg.polynomial.System.truncated": constant(degree=1),
    "dg.polynomial.asphere": constant(radius=50.0, terms={4: 1e-6}),
    "dg.polynomial.fit": lambda w: {"lens": w.lens, "degree": 3, "film": (8.0, 6.0)},
    "dg.polynomial.from_lens": lambda w: {"lens": w.lens, "degree": 3},
    "dg.polynomial.refract": lambda w: {
        "form": dg.polynomial.sphere(50.0),
        "n1": 1.0,
        "n2": 1.5,
        "degree": 3,
    },
    "dg.polynomial.wavelength_nodes": constant(from_nm=400.0, to_nm=700.0, count=3),
    "dg.post.apply_stmap": lambda w: {"image": w.image, "st": w.image[:, :, :2]},
    "dg.post.convolve": lambda w: {"image": w.image, "kernel": np.ones((3, 3)) / 9},
    "dg.post.depth_of_field": lambda w: {
        "image": w.image,
        "depth": BY_NAME["depth"](w),
        "focus": 2.0,
        "f_stop": 2.0,
        "focal_length": 50.0,
        **FILM,
    },
    "dg.post.diffract": lambda w: {"image": w.image, "f_number": 8.0, **FILM},
    "dg.post.distort": lambda w: {
        "image": w.image,
        "model": dg.distortion.BrownConrady(-0.1),
        "focal_px": 8.0,
    },
    "dg.post.motion_blur": lambda w: {"image": w.image, "motion": np.ones((6, 8, 2), np.float32)},
    "dg.post.glare": filmed,
    "dg.post.grain": filmed,
    "dg.post.halo": filmed,
    "dg.post.unvignette": lambda w: {**filmed(w), "focal_length": 50.0},
    "dg.post.vignette": lambda w: {**filmed(w), "focal_length": 50.0},
    "dg.post.spread_by": lambda w: {"image": w.image, "file": w.kernel},
    "dg.post.star": lambda w: {
        "image": w.image,
        "f_number": 8.0,
        "blades": 6,
        "sensor": (0.048, 0.036),
    },
    "dg.post.stmap": lambda w: {
        "model": dg.distortion.BrownConrady(-0.1),
        "size": SIZE,
        "focal_px": 8.0,
    },
    "dg.post.through_lens": lambda w: {"image": w.image, "lens": LENS, **FILM},
    "dg.post.undistort": lambda w: {
        "image": w.image,
        "model": dg.distortion.BrownConrady(-0.1),
        "focal_px": 8.0,
    },
    "dg.read_plate_camera": lambda w: {"path": w.camera_file},
    "dg.render": _RENDER,
    "dg.render_rig": lambda w: {
        "scene": w.scene,
        "cameras": {"a": w.camera},
        "resolution": SIZE,
        "spp": 1,
    },
    "dg.rendering.rig.disparity": lambda w: {"frame": w.frame, "baseline": 0.06},
    "dg.sensors.Curve": constant(wavelengths=np.array([400.0, 700.0]), values=np.array([0.5, 0.6])),
    "dg.sensors.DarkCurrent.factor": constant(temperature=30.0),
    "dg.sensors.DualGain": constant(iso=400.0, full_well=20000.0),
    "dg.sensors.Mosaic": lambda w: {"name": "bayer-rggb", "cells": w.sensor.pattern.cells},
    "dg.sensors.Mosaic.channel_map": constant(height=6, width=8),
    "dg.sensors.Mosaic.of": constant(name="bayer-rggb", channels=("R", "G", "B")),
    "dg.sensors.Sensor": lambda w: fields(w.sensor),
    "dg.sensors.Sensor.band_weights": constant(count=4),
    "dg.sensors.Sensor.with_": constant(full_well=20000.0),
    "dg.sensors.ideal": constant(name="ideal"),
    "dg.sensors.load": constant(name_or_path="ideal"),
    "dg.sensors.read": lambda w: {"path": library_file("sensors", "sony-a7r-ii")},
    "dg.spin": constant(axis=(0.0, 1.0, 0.0), revolutions_per_second=1.0),
    "dg.stmaps": lambda w: {"camera": w.traced, "resolution": SIZE},
    "dg.stocks.CharacteristicCurve": constant(least=0.1, gamma=0.6, toe=-2.0, shoulder=1.0),
    "dg.stocks.CharacteristicCurve.density": constant(x=[0.1, 1.0]),
    "dg.stocks.CharacteristicCurve.exposure": constant(density=[0.5]),
    "dg.stocks.Halation": constant(base=0.12, share=(0.1, 0.05, 0.0)),
    "dg.stocks.Layer": lambda w: fields(w.stock.layers[0]),
    "dg.stocks.Negative": lambda w: fields(w.negative),
    "dg.stocks.Stock": lambda w: fields(w.stock),
    "dg.stocks.Stock.with_": constant(iso=200.0),
    "dg.stocks.load": constant(name_or_path="generic-colour-negative-400"),
    "dg.stocks.read": lambda w: {"path": library_file("stocks", "generic-reversal-100")},
}

ARGS |= {
    path.replace("dg.Session.", "dg.ClusterSession."): made
    for path, made in ARGS.items()
    if path.startswith("dg.Session.")
}

#: The object of methods, by the path of its class.
RECEIVERS: dict[str, Make] = {
    "dg.Spectrum": lambda w: dg.Spectrum((400.0, 700.0), (0.5, 1.0)),
    "dg.Camera": lambda w: w.camera,
    "dg.Categories": lambda w: dg.Categories(),
    "dg.ClusterSession": lambda w: w.cluster_session,
    "dg.Frame": lambda w: w.frame,
    "dg.Keys": lambda w: dg.keys([(0.0, 1.0), (1.0, 2.0)]),
    "dg.LightProfile": lambda w: dg.LightProfile.cone(40.0),
    "dg.PlateCamera": lambda w: w.plate_camera,
    "dg.Projection": lambda w: w.projection,
    "dg.Raw": lambda w: w.raw,
    "dg.RayMap": lambda w: w.raymap,
    "dg.RenderSettings": lambda w: w.settings,
    "dg.Scene": lambda w: w.scene,
    "dg.Session": lambda w: w.session,
    "dg.Spin": lambda w: dg.spin((0, 1, 0), 1.0),
    "dg.StMaps": lambda w: w.stmaps,
    "dg.analysis.Bench": lambda w: w.bench,
    "dg.analysis.Mtf": lambda w: w.mtf,
    "dg.analysis.Pencil": lambda w: w.pencil,
    "dg.analysis.Psf": lambda w: dg.analysis.Psf(np.ones((4, 4)), 0.1, np.zeros(2), True),
    "dg.analysis.SeidelSums": lambda w: dg.analysis.SeidelSums(np.ones((3, 7)), 5.0),
    "dg.analysis.Spot": lambda w: w.spot,
    "dg.analysis.Wavefront": lambda w: w.wavefront,
    "dg.analysis.diffraction.PlainPupil": lambda w: plain_pupil(),
    "dg.analysis.GhostRays": lambda w: w.ghost_rays,
    "dg.analysis.ghosts.Ghosts": lambda w: w.ghosts,
    "dg.analysis.glare.VeilingGlare": lambda w: w.glare,
    "dg.analysis.iris.Iris": lambda w: w.iris,
    "dg.calibration.Calibration": lambda w: w.calibration,
    "dg.calibration.Take": lambda w: w.take,
    "dg.charts.Chart": lambda w: w.chart,
    "dg.charts.EdgeResponse": lambda w: dg.charts.edge_response(edge()),
    "dg.development.Picture": lambda w: w.picture,
    "dg.distortion.BrownConrady": lambda w: dg.distortion.BrownConrady(-0.1),
    "dg.distortion.Division": lambda w: dg.distortion.Division(-0.1),
    "dg.distortion.Equidistant": lambda w: dg.distortion.Equidistant(),
    "dg.distortion.Equisolid": lambda w: dg.distortion.Equisolid(),
    "dg.distortion.OpenCV": lambda w: dg.distortion.OpenCV(-0.1),
    "dg.distortion.OpenCVFisheye": lambda w: dg.distortion.OpenCVFisheye(-0.1),
    "dg.distortion.Orthographic": lambda w: dg.distortion.Orthographic(),
    "dg.distortion.Stereographic": lambda w: dg.distortion.Stereographic(),
    "dg.labels.coco.CocoFile": lambda w: coco(w),
    "dg.lenses.Configuration": lambda w: w.zoom.configurations[0],
    "dg.lenses.Lens": lambda w: w.zoom,
    "dg.lenses.LensSurface": lambda w: w.lens.surfaces[0],
    "dg.lenses.glasses.GlassData": lambda w: dg.lenses.glasses.find("N-BK7"),
    "dg.polynomial.ErrorZone": lambda w: w.fit.error,
    "dg.polynomial.GhostError": lambda w: w.polynomial_ghosts.all[0],
    "dg.polynomial.GhostPolynomial": lambda w: dg.polynomial.expand_ghost(w.ghost_rays, 1),
    "dg.polynomial.LensFit": lambda w: w.fit,
    "dg.polynomial.PolynomialGhosts": lambda w: w.polynomial_ghosts,
    "dg.polynomial.SeidelTerms": lambda w: w.system.seidel(pupil=1.0),
    "dg.polynomial.System": lambda w: w.system,
    "dg.sensors.Curve": lambda w: (
        ARGS["dg.sensors.Curve"](w) and dg.sensors.Curve(**ARGS["dg.sensors.Curve"](w))
    ),
    "dg.sensors.DarkCurrent": lambda w: dg.sensors.DarkCurrent(0.1),
    "dg.sensors.Mosaic": lambda w: w.sensor.pattern,
    "dg.sensors.Sensor": lambda w: w.sensor,
    "dg.stocks.CharacteristicCurve": lambda w: w.stock.layers[0].curve,
    "dg.stocks.Negative": lambda w: w.negative,
    "dg.stocks.Stock": lambda w: w.stock,
}


def fields(value: Any) -> dict[str, Any]:
    """The fields of a record."""
    return {name: getattr(value, name) for name in value.__dataclass_fields__}


def edge(slope: float = 0.1) -> Any:
    """A slanted edge, (40, 40)."""
    y, x = np.mgrid[0:40, 0:40]
    return np.clip((x - 20 - slope * (y - 20)) / 2 + 0.5, 0.1, 0.9)


def noise(seed: int) -> Any:
    """A texture, (64, 64)."""
    return np.random.default_rng(seed).random((64, 64))


def plain_pupil() -> Any:
    from daguerre.analysis.diffraction import PlainPupil

    return PlainPupil(8.0)


def moment(w: World) -> Any:
    """A moment of ground truth of a session."""
    return w.session.ground_truth.moment(0)


def coco(w: World) -> Any:
    from daguerre.labels.coco import CocoFile

    return CocoFile(w.out / "coco.json")


def refit(w: World) -> dict[str, Any]:
    """Rays enough to fit a lens of degree 3 again."""
    film = np.random.default_rng(3).uniform(-4, 4, (2000, 2))
    slopes = -film / 60 + np.random.default_rng(4).uniform(-0.2, 0.2, (2000, 2))
    nm = np.random.default_rng(5).uniform(420, 680, 2000)
    made = w.fit.evaluate(film, slopes, nm)
    return {
        "film_points": film, "slopes": slopes, "wavelength_nm": nm,
        "origins": made.origins, "directions": made.directions,
    }  # fmt: skip


def library_file(room: str, name: str) -> Any:
    """A file of the package's own library."""
    from pathlib import Path

    return Path(dg.__file__).parent / room / "library" / f"{name}.json"
