"""Table of commands."""

from __future__ import annotations

from typing import NamedTuple


class Command(NamedTuple):
    """A command: the module that holds it, and its line in `daguerre --help`."""

    module: str
    line: str


#: By headings, in the order of `daguerre --help`; a module is loaded when its command is called.
GROUPS = {
    "Make pictures": {
        "demo": Command(".demo", "Render a first picture, without any file of your own."),
        "render": Command(".render.command", "Render a scene to pictures or a sequence."),
        "merge": Command(".merge", "Add passes of one picture into one file."),
        "post": Command(".post", "Add effects of a lens to any picture, or remove them."),
        "develop": Command(".develop", "Develop photographs from a frame or a raw file."),
        "composite": Command(".composite", "Put rendered objects into a photograph."),
    },
    "Look at a scene": {
        "view": Command(".view", "Show the picture in a browser, with rings to turn."),
        "info": Command(".info", "Describe a scene and its cameras."),
    },
    "Measure": {
        "chart": Command(".chart", "Write a test chart as a scene."),
        "calibrate": Command(".calibrate", "Fit a projection to a lens."),
        "match-plate": Command(".match_plate", "Find the camera settings of a photograph."),
        "light-probe": Command(".light_probe", "Build an environment from photographs of a probe."),
    },
    "Lenses, sensors and film": {
        "lenses": Command(".lenses", "List the lenses of the library."),
        "lens": Command(".lens.command", "Show, measure, convert or fit a lens."),
        "sensors": Command(".sensors", "List the sensors of the library."),
        "sensor": Command(".sensor", "Show a sensor."),
        "stocks": Command(".stocks", "List the film stocks of the library."),
    },
    "Files for other programs": {
        "export-camera": Command(".export_camera", "Write cameras as a USD stage."),
        "export-scene": Command(".export_scene", "Write a scene for pbrt-v4 or Mitsuba 3."),
        "export-lens": Command(".export_lens", "Write a lens profile for lensfun."),
    },
    "Clusters": {
        "scheduler": Command(".cluster", "Start the scheduler of a cluster."),
        "worker": Command(".cluster", "Start a worker of a cluster."),
    },
    "This program": {
        "completion": Command(".completion.command", "Print a script that completes by TAB."),
        "version": Command(".version", "Print the version and the libraries in use."),
    },
}
#: First word of a command line by which a shell asks how to complete another.
COMPLETE = "__complete"
COMMANDS = {name: command for group in GROUPS.values() for name, command in group.items()}
