"""Sensor files that are written are those that are read."""

import pytest

from daguerre.errors import OutputError
from daguerre.sensors import Curve, load, names, read
from daguerre.sensors.writer import write


@pytest.mark.parametrize("name", names())
def test_every_sensor_comes_back(tmp_path, name):
    sensor = load(name)
    if name.startswith("ideal"):  # a curve before it, too, and no more than one electron a photon
        sensor = sensor.with_(infrared_cut=Curve([400.0, 700.0], [1.0, 0.5]))
    write(tmp_path / "x.json", sensor)
    assert read(tmp_path / "x.json") == sensor


def test_folders_that_are_not_there(tmp_path):
    with pytest.raises(OutputError, match="no such folder"):
        write(tmp_path / "none" / "x.json", load("ideal"))
