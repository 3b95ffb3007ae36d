"""What is recorded of a device, and that it is read as the same device again."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from fake_hid import JOYSTICK, FakeBackend, FakeDevice, real

from teleop.inputs.hid.recorder import LOOK_EVERY, Recorder
from teleop.inputs.hid.recording import Row, read_recording

F310 = bytes.fromhex(real("Logitech F310")["descriptor"])
REST = bytes.fromhex("7f7f7f7f08000000")


class Seconds:
    def __init__(self) -> None:
        self.now = 50.0

    def __call__(self) -> float:
        return self.now

    def pause(self, seconds: float) -> None:
        self.now += seconds


@pytest.mark.parametrize("serial", [False, True])
def test_a_recording_is_read_as_the_device_that_it_was(tmp_path: Path, serial: bool) -> None:
    pad = FakeDevice(F310, name="Pad", usage=JOYSTICK, serial="S1")
    backend, clock = FakeBackend(pad), Seconds()
    file = tmp_path / "pad.jsonl"
    with file.open("w") as stream:
        recorder = Recorder(backend, [pad.info], stream, clock, serial)
        pad.report(REST)
        clock.now += 0.5
        recorder.step(clock.pause)
        backend.unplug(pad)
        recorder.step(clock.pause)
        backend.plug(again := FakeDevice(F310, name="Pad", usage=JOYSTICK, serial="S1", path=b"/dev/hidraw4"))
        recorder.step(clock.pause)
        again.report(REST)
        recorder.step(clock.pause)
        recorder.close()
    recording = read_recording(file)
    back = 0.5 + LOOK_EVERY
    assert recording.rows == [Row(0.5, REST), Row(0.5, gone=True), Row(back), Row(back, REST)]
    assert recording.descriptor == F310
    assert recording.infos == [pad.info._replace(path=recording.infos[0].path, serial="S1" if serial else "")]
    assert ("S1" in file.read_text()) is serial
    assert json.loads(file.read_text().splitlines()[0])["device"]["vendor"] == "1234"
    assert (pad.closed, again.closed, recorder.reports) == (1, 1, 2)


def test_the_driver_and_the_port_of_a_device_are_recorded(tmp_path: Path) -> None:
    pad, file = FakeDevice(F310), tmp_path / "pad.jsonl"
    pad.info = pad.info._replace(port="1-2.3", driver="xpad")
    with file.open("w") as stream:
        Recorder(FakeBackend(pad), [pad.info], stream, Seconds()).close()
    [info] = read_recording(file).infos
    assert (info.port, info.driver) == ("1-2.3", "xpad")


@pytest.mark.parametrize("serial", [False, True])
def test_a_serial_number_that_is_in_the_name_is_recorded_only_if_asked_for(tmp_path: Path, serial: bool) -> None:
    pad, file = FakeDevice(F310, name="Pad (E417D8)", serial="e417d8"), tmp_path / "pad.jsonl"
    with file.open("w") as stream:
        Recorder(FakeBackend(pad), [pad.info], stream, Seconds(), serial).close()
    assert ("e417d8" in file.read_text().casefold()) is serial
    assert [info.name for info in read_recording(file).infos] == ["Pad (E417D8)" if serial else "Pad"]
