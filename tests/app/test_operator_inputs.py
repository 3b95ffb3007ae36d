"""An operator's devices: opened where there are some, refused where there is nothing to hold."""

from __future__ import annotations

from contextlib import ExitStack

import pytest
from fake_hid import FakeBackend, FakeDevice, real

from teleop.app import operator_inputs
from teleop.config.profile import load_profile
from teleop.core.clock import SystemClock
from teleop.core.errors import DeviceError, UsageError

WITHOUT = "nothing to hold"
F310 = real("Logitech F310")


def pad() -> FakeDevice:
    return FakeDevice(bytes.fromhex(F310["descriptor"]), (F310["vendor_id"], F310["product_id"]), "Pad")


def opened(monkeypatch: pytest.MonkeyPatch, backend: object, keys: bool) -> tuple[list[str], str]:
    def make() -> object:
        if isinstance(backend, Exception):
            raise backend
        return backend

    monkeypatch.setattr(operator_inputs, "AllDevices", make)
    with ExitStack() as stack:
        inputs, note = operator_inputs.open_devices(stack, load_profile("sim"), SystemClock(), keys, WITHOUT)
        return [each.name for each in inputs], note


@pytest.mark.parametrize("keys", [True, False])
def test_a_joystick_that_is_plugged_in_is_opened_and_closed(monkeypatch: pytest.MonkeyPatch, keys: bool):
    device = pad()
    names, note = opened(monkeypatch, FakeBackend(device), keys)
    assert (len(names), note) == (1, "")
    assert device.opened == device.closed == 1


def test_without_keys_there_must_be_a_device(monkeypatch: pytest.MonkeyPatch):
    with pytest.raises(UsageError, match=WITHOUT):
        opened(monkeypatch, FakeBackend(), keys=False)


def test_without_a_way_to_read_devices_the_keys_alone_do_with_a_note(monkeypatch: pytest.MonkeyPatch):
    broken = DeviceError("hidapi cannot be loaded")
    assert opened(monkeypatch, broken, keys=True) == ([], "hidapi cannot be loaded")
    with pytest.raises(DeviceError, match="hidapi"):
        opened(monkeypatch, broken, keys=False)
