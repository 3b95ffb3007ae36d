"""A pad that sends reports its descriptor does not describe: said with the report's number and the cure."""

from __future__ import annotations

import pytest
from fake_hid import FakeBackend, FakeDevice
from waiting import wait_until

from teleop.config.inputs_section import InputSection
from teleop.core.operator_input import Held
from teleop.inputs.hid.cadence import STEADY
from teleop.inputs.hid.device import HidInput, open_inputs

STICKS = "05010904a10185010930093109320935150026ff00750895048102"
VENDOR = "0600ff85310931750895048102"  # as a vendor's own report, which nothing can be read of
BARE, WITH_BLOB = bytes.fromhex(STICKS + "c0"), bytes.fromhex(STICKS + VENDOR + "c0")
REST, LONG = bytes.fromhex("0180808080"), bytes.fromhex("3101808080")
CURE = "connect it by cable, or turn it off and on with no other program using it"
TROUBLE = f"DualSense: sends report 0x31, which its descriptor does not describe: {CURE}"


def read_until(pad: HidInput, now: float, trouble: str) -> Held:
    seen: list[Held] = []

    def holds() -> bool:
        seen.append(pad.read(now))
        return seen[-1].trouble == trouble

    wait_until(holds, trouble or "no trouble")
    return seen[-1]


@pytest.mark.parametrize("descriptor", [BARE, WITH_BLOB], ids=["not described", "a vendor's"])
@pytest.mark.parametrize("readable", [0, STEADY + 2], ids=["from the start", "later"])
def test_a_dualsense_on_bluetooth_that_was_switched_says_so_and_moves_nothing(descriptor: bytes, readable: int) -> None:
    device = FakeDevice(descriptor, (0x1234, 0x5678), "DualSense")
    time = 100.0
    with open_inputs([InputSection()], lambda: time, FakeBackend(device)) as [pad]:
        device.told(*[REST] * readable, LONG)
        time += 1.0
        device.told(LONG)
        held = read_until(pad, time, TROUBLE)
        assert not held.deflections
        assert not held.presses
        device.told(REST)
        assert pad.read(time).trouble != TROUBLE


def test_a_vendors_report_beside_readable_ones_is_no_trouble() -> None:
    device = FakeDevice(WITH_BLOB, (0x1234, 0x5678), "DualSense")
    time = 100.0
    with open_inputs([InputSection()], lambda: time, FakeBackend(device)) as [pad]:
        device.told(REST, LONG)
        pad.read(time)
        time += 0.3
        device.told(REST, LONG)
        read_until(pad, time, "")
