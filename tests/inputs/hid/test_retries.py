"""A HID device that lists and opens but cannot be read is tried again with a pause, and stands in no other's way."""

from __future__ import annotations

import pytest
from fake_hid import BrokenDevice, FakeBackend, FakeDevice, real

from teleop.config.inputs_section import InputSection
from teleop.inputs.hid import reader as hid_reader
from teleop.inputs.hid.device import HidInput
from teleop.inputs.hid.reader import LOOK_EVERY, LOOKS_APART, HidReader

F310 = bytes.fromhex(real("Logitech F310")["descriptor"])
MINUTE = 60.0


class VirtualPause:
    """In the place of the reader's Event: waiting passes virtual time, and a minute is the end."""

    def __init__(self) -> None:
        self.now = 0.0
        self.waits: list[float] = []

    def is_set(self) -> bool:
        return self.now >= MINUTE

    def set(self) -> None: ...

    def wait(self, seconds: float) -> bool:
        self.waits.append(seconds)
        self.now += seconds
        assert len(self.waits) < 10_000, "a retry without a pause"
        return self.is_set()


def minute(monkeypatch: pytest.MonkeyPatch, *devices: FakeDevice) -> tuple[HidReader, VirtualPause]:
    """A reader's thread for a minute of virtual time, in this one."""
    section = InputSection.model_validate({})
    pause = VirtualPause()
    monkeypatch.setattr(HidReader, "start", lambda self: None)
    hand = HidInput(section, FakeBackend(*devices), lambda: pause.now)
    reader = hand._reader
    reader._stop = pause  # type: ignore[assignment]
    reader._run()
    return reader, pause


def test_a_device_that_cannot_be_read_is_opened_a_few_times_a_minute(monkeypatch: pytest.MonkeyPatch) -> None:
    device = BrokenDevice(F310)
    reader, pause = minute(monkeypatch, device)
    assert 3 <= device.opened <= MINUTE / LOOK_EVERY / LOOKS_APART + 4
    assert device.closed == device.opened
    assert min(pause.waits) >= LOOK_EVERY
    assert max(pause.waits) == LOOKS_APART * LOOK_EVERY
    assert reader.refused == (
        "Pad opens, but cannot be read ([Errno 5] Input/output error): unplug it and plug it in again"
    )
    assert reader.last is None, "it was never there"


@pytest.mark.parametrize("good", [1, 2, 5])
def test_a_device_that_fails_after_some_reads_is_opened_once_a_second(
    good: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    device = BrokenDevice(F310)
    device.good = good
    minute(monkeypatch, device)
    assert device.opened <= MINUTE / LOOK_EVERY


@pytest.mark.parametrize("call", ["enumerate", "open", "descriptor", "read"])
def test_whatever_fails_for_ever_there_is_a_pause_between_two_tries(call: str, monkeypatch: pytest.MonkeyPatch) -> None:
    tries = []

    def fails(*_arguments: object):
        tries.append(call)
        raise OSError(5, "Input/output error")

    owner, name = {
        "enumerate": (FakeBackend, "enumerate"),
        "open": (FakeBackend, "open"),
        "descriptor": (FakeDevice, "get_report_descriptor"),
        "read": (FakeDevice, "read"),
    }[call]
    monkeypatch.setattr(owner, name, fails)
    reader, _ = minute(monkeypatch, FakeDevice(F310))
    assert 3 <= len(tries) <= MINUTE / LOOK_EVERY
    assert "Input/output error" in reader.refused


def test_another_device_is_read_in_its_place(monkeypatch: pytest.MonkeyPatch) -> None:
    broken = BrokenDevice(F310)
    sound = FakeDevice(F310, path=b"/dev/hidraw1")
    taken: list[str] = []
    monkeypatch.setattr(
        hid_reader.HidReader, "_read", lambda self, _device, plugged, _report: taken.append(plugged.info.path)
    )
    sound.report(b"")
    minute(monkeypatch, broken, sound)
    assert taken
    assert set(taken) == {b"/dev/hidraw1"}
