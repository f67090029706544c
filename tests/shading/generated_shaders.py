"""Shaders that the package materialx generates from a document, and what they draw.

The package writes GLSL, which Mesa runs on any CPU: no graphics card and no display are needed.
Mesa's interpreter is asked for, as its compiler takes longer than it saves on so few points. It
knows GLSL 3.3 only, and nothing in these shaders needs the 4.0 that they ask for.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

mx = pytest.importorskip("MaterialX", reason="needs the package materialx")
moderngl = pytest.importorskip("moderngl", reason="needs the package moderngl")
gen_shader = pytest.importorskip("MaterialX.PyMaterialXGenShader")
gen_glsl = pytest.importorskip("MaterialX.PyMaterialXGenGlsl")

#: Number of points across and up at which values are compared.
SIZE = 8
#: Colour and opacity of all vertices.
COLOR = (0.2, 0.5, 0.7, 1.0)
_SETTINGS = {"GALLIUM_DRIVER": "softpipe", "MESA_SHADER_CACHE_DISABLE": "true"}
_NEEDS = "needs EGL and a driver for it (apt-get install libegl1 libgl1-mesa-dri)"


def texture_coordinates() -> dict[str, NDArray[np.float64]]:
    """Both sets of coordinates at the points, shape (SIZE, SIZE, 2), t = 0 in the first row."""
    steps = (np.arange(SIZE) + 0.5) / SIZE
    s, t = np.meshgrid(steps, steps)
    return {"st": np.stack([s, t], -1), "st1": _second(np.stack([s, t], -1))}


def _second(st: Any) -> Any:
    return np.stack([0.31 + 0.52 * st[..., 1], 0.93 - 0.71 * st[..., 0]], -1)


def library() -> Any:
    """The definitions of MaterialX's standard libraries."""
    found = mx.createDocument()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), found)
    return found


@dataclass(frozen=True)
class Shader:
    """Texts of a shader, and the file of each of its samplers by name."""

    vertex: str
    fragment: str
    files: Mapping[str, str]


class Generator:
    """Generates shaders; colours become linear Rec.709, lengths metres."""

    def __init__(self, definitions: Any) -> None:
        self._definitions = definitions
        self._generator = gen_glsl.GlslShaderGenerator.create()
        self._context = gen_shader.GenContext(self._generator)
        self._context.registerSourceCodeSearchPath(mx.getDefaultDataSearchPath())
        self._generator.registerTypeDefs(definitions)
        target = self._generator.getTarget()
        colors = gen_shader.DefaultColorManagementSystem.create(target)
        colors.loadLibrary(definitions)
        self._generator.setColorManagementSystem(colors)
        units, converters = gen_shader.UnitSystem.create(target), mx.UnitConverterRegistry.create()
        for name in ("distance", "angle"):
            kind = definitions.getUnitTypeDef(name)
            converters.addUnitConverter(kind, mx.LinearUnitConverter.create(kind))
        units.loadLibrary(definitions)
        units.setUnitConverterRegistry(converters)
        self._generator.setUnitSystem(units)
        options = self._context.getOptions()
        options.shaderInterfaceType = gen_shader.ShaderInterfaceType.SHADER_INTERFACE_REDUCED
        options.targetDistanceUnit = "meter"
        options.targetColorSpaceOverride = "lin_rec709"

    def shader(self, text: str) -> Shader:
        """Shader that shows the output ``out`` of a document, given as XML."""
        document = mx.createDocument()
        mx.readFromXmlString(document, text)
        document.setDataLibrary(self._definitions)
        made = self._generator.generate("shown", document.getOutput("out"), self._context)
        pixels = made.getStage(gen_shader.PIXEL_STAGE)
        ports = [port for block in pixels.getUniformBlocks().values() for port in block]
        files = {
            port.getVariable(): port.getValue().getValueString()
            for port in ports
            if port.getType().getName() == "filename"
        }
        texts = (made.getSourceCode(gen_shader.VERTEX_STAGE), pixels.getSourceCode())
        return Shader(*(text.replace("#version 400", "#version 330") for text in texts), files)


class Screen:
    """Draws a square with texture coordinates 0 .. 1, in floats.

    Args:
        pictures: Pictures (H, W, 4) by name, row 0 on top.
    """

    def __init__(self, pictures: Mapping[str, NDArray[np.float32]]) -> None:
        self._context = _context()
        self._target = self._context.simple_framebuffer((SIZE, SIZE), 4, dtype="f4")
        self._textures = {name: self._texture(pixels) for name, pixels in pictures.items()}

    def shown(self, shader: Shader) -> NDArray[np.float32]:
        """Values at the points of ``texture_coordinates``, shape (SIZE, SIZE, 4)."""
        program = self._context.program(shader.vertex, shader.fragment)
        buffers = []
        for name in program:
            member = program[name]
            if isinstance(member, moderngl.Attribute):
                data = _vertices(name, member.dimension).astype(np.float32)
                buffers.append((self._context.buffer(data), f"{member.dimension}f", name))
            elif name in shader.files:
                unit = list(shader.files).index(name)
                member.value = unit
                self._textures[shader.files[name]].use(unit)
            else:
                assert name.endswith("Matrix"), name
                member.write(np.eye(4, dtype=np.float32))
        square = self._context.vertex_array(program, buffers)
        self._target.use()
        square.render(moderngl.TRIANGLE_STRIP)
        found = np.frombuffer(self._target.read(components=4, dtype="f4"), np.float32)
        for used in (square, program, *(buffer for buffer, *_ in buffers)):
            used.release()
        return found.reshape(SIZE, SIZE, 4)

    def close(self) -> None:
        """Frees what the context holds."""
        self._context.release()

    def _texture(self, pixels: NDArray[np.float32]) -> Any:
        height, width, channels = pixels.shape
        data = np.ascontiguousarray(pixels[::-1], np.float32)  # row 0 at the bottom
        texture = self._context.texture((width, height), channels, data, dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        texture.repeat_x = texture.repeat_y = True
        return texture


def _context() -> Any:
    libraries = {"libgl": "libGL.so.1", "libegl": "libEGL.so.1"}
    with pytest.MonkeyPatch.context() as patch:
        for name, setting in _SETTINGS.items():
            patch.setenv(name, setting)
        try:
            return moderngl.create_context(standalone=True, backend="egl", require=330, **libraries)
        except Exception as error:  # glcontext has no narrower class
            pytest.skip(f"{_NEEDS}: {error}")


def _vertices(name: str, count: int) -> NDArray[np.float64]:
    """Values of an attribute at the corners of the square, shape (4, count)."""
    st = np.array([[0, 0], [1, 0], [0, 1], [1, 1]], float)
    corners = {
        "i_position": np.column_stack([2 * st - 1, np.zeros(4)]),
        "i_texcoord_0": st,
        "i_texcoord_1": _second(st),
        "i_geomprop_st": st,
        "i_geomprop_st1": _second(st),
        "i_normal": np.tile([0.0, 0.0, 1.0], (4, 1)),
        "i_tangent": np.tile([1.0, 0.0, 0.0], (4, 1)),
        "i_bitangent": np.tile([0.0, 1.0, 0.0], (4, 1)),
        "i_color_0": np.tile(COLOR, (4, 1)),
        "i_geomprop_displayColor": np.tile(COLOR, (4, 1)),
        "i_geomprop_displayOpacity": np.tile(COLOR[3:], (4, 1)),
    }[name]
    wide = np.zeros((4, max(count, corners.shape[1])))
    wide[:, : corners.shape[1]] = corners
    return wide[:, :count]
