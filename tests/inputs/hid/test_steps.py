"""The waits of a reader on a clock that does not wait for it."""

from __future__ import annotations

import pytest
from fake_hid import JOYSTICK, real

from teleop.inputs.hid.backend import DeviceInfo
from teleop.inputs.hid.recording import RecordedDevice, Recording, Row
from teleop.inputs.hid.steps import Pause, PolledSteps, Read, Steps

F310 = bytes.fromhex(real("Logitech F310")["descriptor"])
REST = bytes.fromhex("7f7f7f7f08000000")
PAD = DeviceInfo(b"/dev/hidraw0", 0x1234, 0x5678, "", "Pad", *JOYSTICK, 0, port="1-2")


def test_steps_take_the_waits_that_are_over_and_the_reports_that_are_due() -> None:
    recording = Recording([PAD], F310, [Row(1.0, REST), Row(1.02, gone=True)])
    device = RecordedDevice(recording, lambda: 0.0, lambda: 0.0, 0.0)
    seen: list[tuple[float, object]] = []

    def steps() -> Steps:
        report = yield Pause(0.9)
        try:
            while True:
                seen.append((polled.time, report))
                report = yield Read(device, 0.06)
        except OSError as error:
            seen.append((polled.time, str(error)))
        yield Pause(9.0)
        return False

    polled = PolledSteps(steps(), 0.0)
    polled.advance(0.89)
    assert seen == []
    polled.advance(5.0)
    assert [what for _, what in seen] == [b"", b"", REST, "unplugged"]
    assert [time for time, _ in seen] == pytest.approx([0.9, 0.96, 1.0, 1.02])
