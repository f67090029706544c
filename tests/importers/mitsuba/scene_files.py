"""Scene files of Mitsuba for tests, written as text."""

from __future__ import annotations

from pathlib import Path

import daguerre as dg

CAMERA = """
  <sensor type="perspective">
    <float name="fov" value="{fov}"/>
    <transform name="to_world"><lookat origin="{eye}" target="{target}" up="{up}"/></transform>
    <film type="hdrfilm">
      <integer name="width" value="{width}"/><integer name="height" value="{height}"/>
      <rfilter type="box"/>
    </film>
    <sampler type="independent"><integer name="sample_count" value="16"/></sampler>
  </sensor>
"""


def camera(
    eye: str = "0 0 5",
    target: str = "0 0 0",
    up: str = "0 1 0",
    fov: float = 40,
    size: tuple[int, int] = (32, 32),
) -> str:
    """A perspective sensor that looks at the origin from +z."""
    return CAMERA.format(eye=eye, target=target, up=up, fov=fov, width=size[0], height=size[1])


def text_of(*parts: str, version: str = "3.0.0") -> bytes:
    """A scene file of some parts."""
    return (f'<scene version="{version}">\n' + "\n".join(parts) + "\n</scene>\n").encode()


def written(folder: Path, *parts: str, version: str = "3.0.0", name: str = "scene.xml") -> Path:
    """Writes a scene file of some parts."""
    path = folder / name
    path.write_bytes(text_of(*parts, version=version))
    return path


def loaded(folder: Path, *parts: str, version: str = "3.0.0", **options: object) -> dg.Scene:
    """Reads a scene file of some parts."""
    return dg.load(written(folder, *parts, version=version), **options)  # type: ignore[arg-type]


#: A scene with something of everything, and things that nobody understands.
RICH = (
    '<default name="spp" value="16"/>',
    '<integrator type="moment"><integrator type="path"><integer name="max_depth" value="3"/>'
    '<boolean name="hide_emitters" value="true"/></integrator></integrator>',
    camera(),
    '<bsdf type="twosided" id="two"><bsdf type="mask"><float name="opacity" value="0.5"/>'
    '<bsdf type="roughplastic"><float name="alpha" value="0.2"/><float name="odd" value="1"/>'
    "</bsdf></bsdf></bsdf>",
    '<bsdf type="hair" id="hairy"><float name="beta" value="1"/></bsdf>',
    '<bsdf type="diffuse" id="idle"><rgb name="reflectance" value="1"/></bsdf>',
    '<texture type="checkerboard" id="squares"><transform name="to_uv"><scale value="5"/>'
    "</transform></texture>",
    '<shape type="sphere"><ref id="two"/><emitter type="area">'
    '<rgb name="radiance" value="1 2 3"/></emitter></shape>',
    '<shape type="cube"><ref id="hairy"/></shape>',
    '<shape type="sdfgrid"><string name="filename" value="x"/><ref id="two"/></shape>',
    '<shape type="disk"><bsdf type="diffuse"><ref id="squares" name="reflectance"/></bsdf></shape>',
    '<shape type="shapegroup" id="group"><shape type="rectangle"/></shape>',
    '<shape type="instance"><ref id="group"/><transform name="to_world"><translate x="3"/>'
    '<rotate y="1" angle="20"/></transform></shape>',
    '<emitter type="sunsky"><float name="turbidity" value="3"/></emitter>',
    '<emitter type="constant"/>',
)
#: Shapes, materials, media and lights with values of all kinds.
MANY = (
    '<default name="r" value="0.5"/>',
    '<medium type="heterogeneous" id="fog"><float name="scale" value="2"/>'
    '<rgb name="albedo" value="0.5 0.6 0.7"/><phase type="blendphase">'
    '<float name="weight" value="0.25"/><phase type="isotropic"/>'
    '<phase type="hg"><float name="g" value="0.5"/></phase></phase></medium>',
    '<alias id="fog" as="mist"/>',
    camera(),
    '<shape type="obj" id="a"><string name="filename" value="a.obj"/>'
    '<boolean name="face_normals" value="true"/><bsdf type="roughconductor">'
    '<string name="material" value="Au"/><float name="alpha_u" value="0.1"/></bsdf>'
    '<transform name="to_world"><lookat origin="0 0 0" target="1 2 3" up="0 1 0"/>'
    '<matrix value="1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1"/></transform></shape>',
    '<shape type="cylinder"><point name="p0" x="0" y="1" z="0"/>'
    '<point name="p1" value="0 2 0"/><float name="radius" value="$r"/>'
    '<ref id="mist" name="interior"/><bsdf type="null"/></shape>',
    '<shape type="sphere"><bsdf type="blendbsdf"><float name="weight" value="0.3"/>'
    '<bsdf type="dielectric"><string name="int_ior" value="water"/></bsdf>'
    '<bsdf type="principled"><float name="roughness" value="0.3"/>'
    '<float name="sheen" value="0.5"/></bsdf></bsdf></shape>',
    '<emitter type="spot"><rgb name="intensity" value="1 2 3"/>'
    '<float name="cutoff_angle" value="30"/></emitter>',
    '<emitter type="directional"><vector name="direction" value="0 -1 0"/>'
    '<spectrum name="irradiance" value="400:1, 700:2"/></emitter>',
)
#: A scene with names of Mitsuba 0.6.
OLD = (
    '<sensor type="perspective"><float name="fov" value="40"/><string name="fovAxis" value="y"/>'
    '<transform name="toWorld"><lookAt origin="0,0,5" target="0,0,0" up="0,1,0"/></transform>'
    '<film type="hdrfilm"><integer name="width" value="32"/></film></sensor>',
    '<bsdf type="diffuse" id="m"><texture type="checkerboard" name="reflectance">'
    '<float name="uscale" value="4"/><float name="voffset" value="0.5"/></texture></bsdf>',
    '<shape type="rectangle"><ref id="m"/><emitter type="area">'
    '<blackbody name="radiance" temperature="5000K" scale="1e-4"/></emitter></shape>',
    '<shape type="sphere"><bsdf type="plastic"><srgb name="diffuseReflectance" value="#8090a0"/>'
    '<float name="intIOR" value="1.6"/></bsdf></shape>',
)
